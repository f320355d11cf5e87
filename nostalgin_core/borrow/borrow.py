"""What a front's own photograph does not show is taken from its neighbours'.

A tax photograph was taken for one building and shows its neighbours as well, past
other cars and other people. Each such view is laid over the front's own elevation
(`aligned`), given its tones (`tones`), and lends the texels that are hidden or torn in
the own, where both agree round about. What the own photograph shows stays, bit for
bit; a view that does not fit is told and left apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import UInt8

from nostalgin_core import evidence, inpaint, rests, views
from nostalgin_core.arrays import Mask
from nostalgin_core.borrow import patched, tones
from nostalgin_core.borrow.aligned import Aligned, aligned, warped
from nostalgin_core.records import Elevation
from nostalgin_core.views import Marks, View

Sources = UInt8[np.ndarray, "h w"]

DRAWN_IN_PX: Final = 3  # what a lender saw, beside what hides it there
LEAST_LIKE: Final = 0.35  # correlation of all that both saw
# Light falls otherwise, and what is of one front looks different: then so many patches
# that agree, of those found, tell that both are, unless they look like nothing at all.
MANY, MOST, LEAST_LIT = 40, 0.6, 0.15
LEAST_AGREEING: Final = 0.4  # the same round a texel
LEAST_SHARP: Final = 0.3  # pixels of the lender's photograph for a texel
MIRRORED: Final = "one of both is printed in a mirror: turn the photograph round"
CLEAR_PX: Final = 12.0  # from where a lender is hidden, a texel has its full worth


@dataclass(frozen=True, slots=True, eq=False)
class Lender:
    """A front as another photograph shows it."""

    photo: str  # its key
    view: Elevation


@dataclass(frozen=True, slots=True)
class Fit:
    """How a lender's view lies over the own, and what came of it."""

    photo: str
    facade: int
    fits: bool
    why: str  # it does not; empty if it does
    likeness: float  # correlation of what both saw; 0 where nothing was compared
    patches: int  # that agree on how they lie
    error_px: float  # median of these, in texels of the own
    lent: int  # texels


@dataclass(frozen=True, slots=True, eq=False)
class Borrowed:
    """A front with what other photographs show of it, and where that comes from."""

    elevation: Elevation
    sources: Sources  # per texel: 0, or the place of its photograph in `photos`, from 1
    photos: tuple[str, ...]
    fits: tuple[Fit, ...]  # of all lenders
    unseen: int  # texels that the own photograph does not show


@dataclass(frozen=True, slots=True, eq=False)
class _Laid:
    """A lender's view over the own."""

    image: patched.Map
    worth: patched.Map  # 0 where it lends nothing


def borrow(own: Elevation, lenders: Sequence[Lender]) -> Borrowed:
    """Fill the holes of an elevation with what other photographs show there."""
    hole = inpaint.holes(own.evidence)
    nowhere = np.zeros(own.image.shape, np.uint8)
    unseen = int(hole.sum())
    if not hole.any() or not lenders:
        return Borrowed(own, nowhere, (), (), unseen)
    edge = inpaint.rim(own.evidence, hole)
    wanted = hole | edge
    known = View(own.image, own.evidence == evidence.PHOTOGRAPHED)
    here = views.marks(known)
    fits, laid = [], []
    for one in lenders:
        seen = View(one.view.image, one.view.evidence == evidence.PHOTOGRAPHED)
        there = views.marks(seen)
        rough = views.overlay(here, there)
        exact = None if rough is None else aligned(known, seen, rough.matrix)
        fit, over = _laid(one, known, seen, exact, wanted)
        if fit.likeness < LEAST_LIT and mirrored(known, here, seen, there):
            fit = replace(fit, why=MIRRORED)
        fits.append(fit)
        laid.append(over)
    usable = [(n, one) for n, one in enumerate(laid) if one is not None]
    if not usable:
        return Borrowed(own, nowhere, (), tuple(fits), unseen)
    label = patched.chosen(
        [one.worth for _, one in usable], [one.image for _, one in usable]
    )
    label[~patched.whole(label > 0)] = 0
    numbers = np.array([0, *(n + 1 for n, _ in usable)], np.uint8)
    shown = np.choose(
        label, [own.image.astype(np.float32), *(one.image for _, one in usable)]
    )
    made, sources = _filled(own, shown.astype(np.float32), numbers[label], edge)
    return _told(made, sources, lenders, fits, unseen)


def over(own: Elevation, other: Elevation) -> View | None:
    """Show another elevation of a front as it lies over the own; None: it fits not."""
    known, seen = (
        View(one.image, one.evidence == evidence.PHOTOGRAPHED) for one in (own, other)
    )
    rough = views.overlay(views.marks(known), views.marks(seen))
    exact = None if rough is None else aligned(known, seen, rough.matrix)
    return None if exact is None else warped(seen, exact.matrix, own.image.shape)


def mirrored(own: View, here: Marks, seen: View, there: Marks) -> bool:
    """Tell whether an elevation fits another one in a mirror, given both's marks."""
    turned = View(*(np.ascontiguousarray(one[:, ::-1]) for one in seen))
    rough = views.overlay(here, views.turned(there))
    exact = None if rough is None else aligned(own, turned, rough.matrix)
    if exact is None:
        return False
    return views.likeness(own, turned, exact.matrix) >= LEAST_LIKE


def _laid(
    one: Lender, own: View, seen: View, exact: Aligned | None, wanted: Mask
) -> tuple[Fit, _Laid | None]:
    """Lay a lender over the own elevation, and tell how it fits."""
    apart = Fit(one.photo, one.view.facade, False, "", 0.0, 0, 0.0, 0)  # noqa: FBT003
    if exact is None:
        return replace(apart, why="patches of one are not found in the other"), None
    alike = views.likeness(own, seen, exact.matrix)
    told = replace(
        apart, likeness=alike, patches=exact.patches, error_px=exact.error_px
    )
    if not of_one(exact, alike):
        return replace(told, why="what both saw looks different"), None
    shape = own.image.shape
    there = warped(seen, exact.matrix, shape, DRAWN_IN_PX)
    image = tones.toned(own, there)
    agree = tones.agreement(own.image, image, own.known & there.known)
    sharp = patched.sharpness(one.view.photo_from_elevation @ exact.matrix, shape)
    inside = np.pad(there.known, 1).astype(np.uint8)
    away = cv2.distanceTransform(inside, cv2.DIST_L2, 3)[1:-1, 1:-1]
    worth = sharp * agree * (0.4 + 0.6 * np.minimum(1, away / CLEAR_PX))
    usable = there.known & wanted & (agree >= LEAST_AGREEING) & (sharp >= LEAST_SHARP)
    fit = replace(told, fits=True)
    return fit, _Laid(image, np.where(usable, worth, 0).astype(np.float32))


def of_one(exact: Aligned, alike: float) -> bool:
    """Tell by likeness, or by many patches that agree, if views are of one front."""
    sure = exact.patches >= MANY and exact.share >= MOST
    return alike >= (LEAST_LIT if sure else LEAST_LIKE)


def _filled(
    own: Elevation, shown: patched.Map, sources: Sources, edge: Mask
) -> tuple[Elevation, Sources]:
    """Put what was lent into the holes, and let it go on under their soft rims."""
    patch = sources > 0
    sure = own.evidence == evidence.PHOTOGRAPHED
    lent = patched.joined(own.image.astype(np.float32), shown, sure, patch)
    share = np.where(edge, inpaint.kept(own.alpha), 0).astype(np.float32)
    mixed = share * own.image + (1 - share) * lent
    lent_mostly = patch & (share < 0.5)
    image = np.where(patch, np.clip(np.round(mixed), 0, 255), own.image)
    marked = np.where(lent_mostly, np.uint8(rests.ANOTHER), own.evidence)
    made = replace(own, image=image.astype(np.uint8), evidence=marked)
    return made, np.where(lent_mostly, sources, 0).astype(np.uint8)


def _told(
    made: Elevation,
    sources: Sources,
    lenders: Sequence[Lender],
    fits: Sequence[Fit],
    unseen: int,
) -> Borrowed:
    """Count what each lender lent, and name the photographs by number."""
    counts = np.bincount(sources.ravel(), minlength=len(lenders) + 1)
    photos = tuple(sorted({o.photo for n, o in enumerate(lenders) if counts[n + 1]}))
    place = [
        0,
        *((photos.index(o.photo) + 1 if o.photo in photos else 0) for o in lenders),
    ]
    lent = tuple(
        replace(fit, lent=int(n)) for fit, n in zip(fits, counts[1:], strict=True)
    )
    return Borrowed(made, np.array(place, np.uint8)[sources], photos, lent, unseen)
