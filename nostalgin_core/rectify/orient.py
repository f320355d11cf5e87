"""Find out which way every front of a photo faces.

Each front's lines vote for its own horizontal direction; all fronts share the way up
and the camera (`upright`), and a front that shows too little borrows the direction of
the street that it stands in.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Lines, Mask
from nostalgin_core.records import Facade, Photo
from nostalgin_core.rectify import camera, lines, quad, upright, vanish

MARGIN_PX = 2  # an outline's own lines lie just outside as often as inside
LEAST_INSIDE = 0.5  # of a line
HIDDEN = 0.5  # alpha up to which something else is what the camera saw
LEAST_LINES = 3.0  # whose weights support a direction
BORROWED = 0.75  # of its own votes are enough for a direction that the street has
MOST_OWN = 120  # lines of a front whose directions it may choose from
WELL_KNOWN_DEG = 1.5  # the azimuth of a front that others may borrow from
OUTLINE_DEG = 8.0  # how well a network's outline knows its directions
SMALL_PX = 800  # the long side below which a photo is enlarged to find lines
RUNNER_UP = 0.8  # of the winner's votes; closer, an outline can't tell two directions
OUTLINE_SHARE = 0.2  # of an outline's level sides have to agree with what is borrowed
BOTH = "two vanishing points"
UPRIGHT = "upright camera assumed"
NEIGHBOUR = "a neighbour's direction"

Parameters = Float[np.ndarray, " p"]


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """The lines that speak for one front, in units."""

    strict: Float[np.ndarray, "_ 4"]
    loose: Lines
    omega: Float[np.ndarray, " n"]
    length_px: Float[np.ndarray, " n"]

    @property
    def weights(self) -> Float[np.ndarray, " n"]:
        """Weigh the loose lines' votes: length times the share inside the front."""
        return self.omega * self.length_px


@dataclass(frozen=True, slots=True, eq=False)
class Oriented:
    """The upright world of a photo, and how each front's direction was found."""

    world: upright.Upright
    methods: tuple[str | None, ...]  # None: the front shows no direction


def orient(
    photo: Photo,
    facades: tuple[Facade, ...],
    *,
    detector: lines.Detector = lines.detect,
) -> Oriented:
    """Fit the upright world to the lines of all fronts.

    Each front first chooses for itself. Once the camera is known, each chooses again,
    between its own lines' directions, those of better known fronts, and the ones square
    to them; if any does, all are fitted again. A front without lines of its own then
    takes that one of the street's directions to which its outline runs.
    """
    clear = [unhidden(facade) for facade in facades]
    anywhere = np.any(clear, axis=0)
    found = detect(photo, anywhere & _framed(photo), detector=detector)
    signals = [signal(photo, found, mask) for mask in clear]
    all_lines = signal(photo, found, anywhere)
    world = _fit(_start(signals, all_lines), signals)
    again = choose_again(world, signals)
    if not np.array_equal(again, world.parameters):
        world = _fit(again, signals)
    own = UPRIGHT if world.support[0] < LEAST_LINES else BOTH
    methods: list[str | None] = []
    for i, facade in enumerate(facades):
        if world.support[i + 1] >= LEAST_LINES:
            methods.append(own)
            continue
        borrowed = borrow(world, i, outline(photo, facade))
        methods.append(None if borrowed is None else NEIGHBOUR)
        world = borrowed or world
    return Oriented(world, tuple(methods))


def _framed(photo: Photo) -> Mask:
    """Tell where the exposed frame is, without its own edge, which is a long line."""
    x0, y0, x1, y1 = photo.frame
    inner = np.zeros(photo.image.shape, bool)
    edge = MARGIN_PX + 2
    inner[y0 + edge : y1 - edge, x0 + edge : x1 - edge] = True
    return inner


def unhidden(facade: Facade) -> Mask:
    """Tell where a line may speak for a front: on it and its outline, off occluders.

    The outline of what stands before the front lies as close to the front as the
    front's own, so holes grow by the margin and take it away.
    """
    hole = facade.amodal & (facade.alpha <= HIDDEN)
    return vanish.grown(facade.amodal, MARGIN_PX) & ~vanish.grown(hole, MARGIN_PX)


def detect(
    photo: Photo, where: Mask, *, detector: lines.Detector = lines.detect
) -> tuple[Float[np.ndarray, "_ 4"], Float[np.ndarray, "_ 4"]]:
    """Find the strict and the loose lines inside `where`, in photo pixels.

    The detector's windows count pixels, and want windows of walls of twenty or more:
    a photo whose long side is below `SMALL_PX` is looked at twice as large.
    """
    if max(photo.image.shape) >= SMALL_PX:
        strict, loose = detector(photo.image, lines.STRICT, lines.LOOSE, where=where)
        return strict, loose
    h, w = photo.image.shape
    image = cv2.resize(photo.image, (2 * w, 2 * h), interpolation=cv2.INTER_CUBIC)
    inside = where.repeat(2, axis=0).repeat(2, axis=1)
    strict, loose = detector(image, lines.STRICT, lines.LOOSE, where=inside)
    return (strict - 0.5) / 2, (loose - 0.5) / 2  # pixel 0 became 0 and 1


def signal(
    photo: Photo,
    found: tuple[Float[np.ndarray, "_ 4"], Float[np.ndarray, "_ 4"]],
    mask: Mask,
) -> Signal:
    """Pick the lines of a front: those with at least half their length in its mask."""
    strict, loose = found
    strict = strict[vanish.inside(strict, mask) >= LEAST_INSIDE]
    omega = vanish.inside(loose, mask)
    loose, omega = loose[omega >= LEAST_INSIDE], omega[omega >= LEAST_INSIDE]
    where = camera.centre(photo.frame), camera.prior_focal_px(photo.frame)
    return Signal(
        vanish.to_unit(strict, *where),
        vanish.to_unit(loose, *where),
        omega,
        vanish.lengths(loose),
    )


def _start(signals: list[Signal], all_lines: Signal) -> Parameters:
    """Start from what all lines vote to be up, and each front's to be level."""
    up, share = vanish.best_vertical(
        all_lines.strict, all_lines.loose, all_lines.weights
    )
    nothing = np.array([1.0, 0.0, 0.0]), 0.0
    chosen = [
        vanish.best_horizontal(up, s.strict, s.loose, s.weights) or nothing
        for s in signals
    ]
    across = np.array([point for point, _ in chosen])
    weights = np.array(
        [votes * s.weights.sum() for (_, votes), s in zip(chosen, signals, strict=True)]
    )
    agreed = vanish.agreed_up(
        up, share * float(all_lines.weights.sum()), across, weights
    )
    return upright.start(agreed, across)


def _fit(parameters: Parameters, signals: list[Signal]) -> upright.Upright:
    """Fit the world to the lines of all fronts, each open to up and to its own."""
    front = np.repeat(np.arange(len(signals)), [len(s.loose) for s in signals])
    open_to = np.arange(len(signals) + 1) == front[:, None] + 1
    open_to[:, 0] = True
    return upright.fit(
        parameters,
        np.vstack([s.loose for s in signals]),
        open_to,
        np.concatenate([s.omega for s in signals]),
        np.concatenate([s.length_px for s in signals]),
    )


def choose_again(world: upright.Upright, signals: list[Signal]) -> Parameters:
    """Let each front vote anew, now that the camera is known.

    To choose from are its azimuth as it is, those that its own longest lines have if
    they are level, and those of better known fronts and square to them. A borrowed
    azimuth needs only `BORROWED` of the own one's votes, since the street is evidence
    as well.
    """
    parameters = world.parameters.copy()
    theta = world.parameters[3:]
    sd = np.sqrt(np.diag(world.covariance))[3:]
    up = upright.vanishing_points(parameters)[:1]
    for i, s in enumerate(signals):
        away = vanish.distance_deg(up, s.loose)[0] > vanish.VERTICAL_DEG
        level, weights = s.loose[away], s.weights[away]
        longest = np.argsort(-vanish.lengths(level), kind="stable")[:MOST_OWN]
        own = [theta[i], *upright.azimuths(world.parameters, level[longest])]
        better = theta[(sd < sd[i]) & (sd < np.radians(WELL_KNOWN_DEG))]
        azimuths = np.concatenate([own, better, better + np.pi / 2])
        trial = np.concatenate([world.parameters[:3], azimuths])
        votes = vanish.vote(upright.vanishing_points(trial)[1:], level, weights)
        votes[: len(own)] *= BORROWED
        parameters[3 + i] = azimuths[votes.argmax()]
    return parameters


def outline(photo: Photo, facade: Facade) -> Lines:
    """Simplify a front's outline to a few sides, in units; crude, but never empty."""
    hull = quad.hull(facade.amodal)
    if len(hull) < 3:
        return np.empty((0, 4))
    ring = hull.astype(np.float32)[:, None]
    few = cv2.approxPolyDP(ring, 0.02 * cv2.arcLength(ring, closed=True), closed=True)
    corners = few[:, 0].astype(np.float64)
    sides = np.hstack([corners, np.roll(corners, -1, axis=0)])
    return vanish.to_unit(
        sides, camera.centre(photo.frame), camera.prior_focal_px(photo.frame)
    )


def borrow(world: upright.Upright, i: int, sides: Lines) -> upright.Upright | None:
    """Give front `i` the well known direction to which its outline runs, if any.

    The borrowed azimuth counts as uncertain by `OUTLINE_DEG`.
    """
    sd = np.sqrt(np.diag(world.covariance))[3:]
    known = (sd < np.radians(OUTLINE_DEG / 2)) & (world.support[1:] >= LEAST_LINES)
    known[i] = False
    theta = world.parameters[3:][known]
    if not len(theta):
        return None
    azimuths = np.concatenate([theta, theta + np.pi / 2])
    trial = np.concatenate([world.parameters[:3], azimuths])
    points = upright.vanishing_points(trial)
    level = vanish.distance_deg(points[:1], sides)[0] > 2 * OUTLINE_DEG
    sides = sides[level]
    votes = vanish.vote(
        points[1:], sides, vanish.lengths(sides), aligned_deg=OUTLINE_DEG
    )
    best = azimuths[votes.argmax()]
    other = np.abs(np.sin(azimuths - best)) > np.sin(np.radians(2 * OUTLINE_DEG))
    if votes.max() < OUTLINE_SHARE or np.any(votes[other] > RUNNER_UP * votes.max()):
        return None
    parameters, covariance = world.parameters.copy(), world.covariance.copy()
    parameters[3 + i] = best
    covariance[3 + i, :] = covariance[:, 3 + i] = 0.0
    covariance[3 + i, 3 + i] = np.radians(OUTLINE_DEG) ** 2
    return upright.Upright(parameters, covariance, world.support)
