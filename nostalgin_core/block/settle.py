"""One block from its facades: who shows which front, and which cuboids follow."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from nostalgin_core import views
from nostalgin_core.block import assign, astray, block, corner, lent, meant
from nostalgin_core.records import (
    Assignment,
    Block,
    Front,
    Rejection,
    Seen,
    Texture,
)
from nostalgin_core.views import Alike, Claim, Stretch

LENDERS: Final = 5  # of one front: so its cost is bounded


class Shown(NamedTuple):
    """A facade that a wall wears, and others of the same front."""

    texture: Texture
    front_id: str
    lenders: tuple[Texture, ...]  # of other photographs, the most probable


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """A block whose facades have their fronts, and whose cuboids stand."""

    fronts: tuple[Front, ...]  # with the corners that photographs told
    assignments: tuple[Assignment, ...]
    rejections: tuple[Rejection, ...]
    block: Block
    claims: tuple[Claim, ...] = ()  # what every facade shows, as far as that is told

    def worn(self) -> tuple[Texture, ...]:
        """List the facades that a wall wears: only these need inpainting."""
        textures = {
            wall.texture
            for building in self.block.buildings
            for wall in building.walls
            if wall.texture is not None
        }
        return tuple(sorted(textures))

    def shown(self) -> tuple[Shown, ...]:
        """Tell of each facade that a wall wears which others are claimed to show it."""
        fronts = {(one.photo, one.facade): one.front_id for one in self.assignments}
        told: dict[str, list[tuple[float, Texture]]] = {}
        for one in self.claims:
            offer = (-one.probability, (one.photo, one.facade))
            told.setdefault(one.front_id, []).append(offer)
        made = []
        for texture in self.worn():
            name = fronts.get(texture, "")
            others = sorted(o for o in told.get(name, ()) if o[1][0] != texture[0])
            lenders = tuple(sorted(other for _, other in others[:LENDERS]))
            made.append(Shown(texture, name, lenders))
        return tuple(made)

    def fronts_of(self, building_id: str) -> list[Front]:
        """List the fronts of one building, in ring order."""
        walls = next(
            building.walls
            for building in self.block.buildings
            if building.building_id == building_id
        )
        own = {wall.front_id for wall in walls}
        return [front for front in self.fronts if front.front_id in own]


def settle(
    name: str,
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Sequence[Seen],
    *,
    stretches: Sequence[Stretch] = (),
    alike: Alike | None = None,
    heights_m: Mapping[str, float] | None = None,
    widths_m: Mapping[str, float] | None = None,
) -> Settled:
    """Give a block's facades to its fronts, and raise its buildings.

    `candidates` names for each photo, by key, the fronts that it may show; `stretches`
    tell where facades stand on their street, and `alike` how probably two look like one
    front; `heights_m` are heights that are known, by building, `widths_m` widths of
    streets, by plain name.
    """
    two = assign.two_fronted(fronts, candidates, seen)
    turned = corner.with_corners(fronts, two)
    heard = views.heard(turned, candidates, stretches, alike)
    claims, seen = views.claims(heard), meant.meant(seen, views.owned(heard))
    outcomes = assign.assign(turned, candidates, seen)
    outcomes = astray.outvoted(outcomes, claims, turned, candidates, seen)
    own = tuple(one for one in outcomes if isinstance(one, Assignment))
    rejections = tuple(one for one in outcomes if isinstance(one, Rejection))
    assignments = (*own, *lent.lent(turned, own, claims, seen))
    stands = raised(
        name, turned, assignments, seen, heights_m=heights_m, widths_m=widths_m
    )
    return Settled(turned, assignments, rejections, stands, claims)


def raised(
    name: str,
    fronts: Sequence[Front],
    assignments: Sequence[Assignment],
    seen: Sequence[Seen],
    *,
    heights_m: Mapping[str, float] | None = None,
    widths_m: Mapping[str, float] | None = None,
) -> Block:
    """Raise a block's buildings from the proportions of the facades they wear."""
    aspects = {
        (one.photo, one.facade): {
            "aspect": one.aspect,
            "aspect_sd": one.aspect_sd,
            "storeys": one.storeys,
            "clear": one.clear,
        }
        for one in seen
    }
    return block.block(
        name, fronts, assignments, aspects, heights_m=heights_m, widths_m=widths_m
    )
