"""What is compared grows with the photographs, and what lies astray is still found."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core.records import Front, Texture
from nostalgin_core.views import Marks, Stretch, View, compared, marks
from nostalgin_core.views.claims import Street, alone, street
from nostalgin_core.views.compare import ASKED, FEW, MARKED, MEET, astray, worth
from nostalgin_core.views.summary import WORDS, summary, words
from tests.core.views.test_claims import photographed, ring
from tests.core.views.test_places import row
from tests.core.views.test_views import front, whole

Filed = dict[str, list[str]]


def photographs(fronts: Sequence[Front], each: int = 1) -> tuple[Filed, list[Stretch]]:
    """Photograph every front with both its neighbours, in names of no order."""
    targets = [target for target in range(1, len(fronts) - 1) for _ in range(each)]
    names = [f"{i:05}" for i in range(len(targets))]
    np.random.default_rng(0).shuffle(names)
    filed, seen = {}, []
    for photo, target in zip(names, targets, strict=True):
        filed[photo] = [fronts[target].front_id]
        shown = (target - 1, target, target + 1)
        seen += photographed(fronts, shown, target, photo=photo, seed=int(photo))
    return filed, seen


def known_of(fronts: Sequence[Front], each: int = 1) -> Street:
    return street(fronts, *photographs(fronts, each))


def slowly(known: Street) -> set[tuple[Texture, Texture]]:
    """List what is worth comparing by asking every facade about every other."""
    beliefs, rows = alone(known), known.rows()
    of = {one: beliefs[one[0]][row] for one, row in sorted(rows.items())}
    found = set()
    for one, belief in of.items():
        meet = {
            two: float(belief @ other)
            for two, other in of.items()
            if two[0] != one[0]
            and known.strips[one[0]].ring == known.strips[two[0]].ring
        }
        likeliest = sorted(meet, key=lambda two: -meet[two])[:ASKED]
        found |= {
            (min(one, two), max(one, two)) for two in likeliest if meet[two] >= MEET
        }
    return found


@pytest.mark.parametrize("each", [1, 3])
def test_what_is_worth_comparing_is_what_asking_all_about_all_finds(each: int) -> None:
    known = known_of(ring(), each)
    assert worth(known) == slowly(known)
    assert len(worth(known)) > 30


def test_pairs_grow_with_the_photographs() -> None:
    for count in (40, 80, 160):
        known = known_of(row(count))
        pairs = worth(known)
        assert count < len(pairs) <= ASKED * len(known.rows())
        asked = Counter(one for pair in pairs for one in pair)
        assert max(asked.values()) <= 3 * ASKED


def scattered(seed: int) -> Marks:
    """Make marks that are like nobody's."""
    rng = np.random.default_rng(seed)
    looks = np.sqrt(rng.dirichlet(np.ones(128), 30)).astype(np.float32)
    at = rng.uniform(0, 100, (30, 2)).astype(np.float32)
    return Marks(at, np.ones(30, np.float32), looks, (100, 100))


@pytest.mark.parametrize("count", [5, 40, 80])
def test_what_looks_like_nothing_asks_for_few_however_many_there_are(
    count: int,
) -> None:
    known = known_of(row(count + 2))
    unlike = dict.fromkeys(worth(known), 0.01)
    pairs = astray(known, unlike, lambda one: scattered(int(one[0])))
    assert len(pairs) <= FEW * count
    if count > 2 * FEW:
        assert len(pairs) > 2 * count
    assert not pairs & unlike.keys()
    assert all(a < b and a[0] != b[0] for a, b in pairs)


def test_what_looks_like_something_near_asks_for_nothing() -> None:
    known = known_of(row(12))
    alike = dict.fromkeys(worth(known), 0.9)
    assert astray(known, alike, never) == set()


def never(_: Texture) -> Marks:
    raise AssertionError


def shown_on(
    fronts: Sequence[Front], filed: Filed, moved: dict[str, int]
) -> Callable[[Texture], View]:
    """Show what facades look like: fronts by rank, each otherwise lit and cut."""
    rank = {one.front_id: one.rank for one in fronts}

    def look(texture: Texture) -> View:
        photo, facade = texture
        at = moved.get(photo, rank[filed[photo][0]]) + facade - 1
        by = int(photo) % 5
        image = front(at, (240, 180))[3 * by :, 4 * by :]
        return whole((image * (0.6 + 0.1 * by)).astype(np.uint8))

    return look


def test_a_photograph_filed_far_off_is_held_to_its_lot() -> None:
    fronts = row(26)
    filed, seen = photographs(fronts)
    known = street(fronts, filed, seen)
    by_target = {names[0]: photo for photo, names in filed.items()}
    lost, own = (by_target["9-20-0"], 1), (by_target["9-4-0"], 1)
    near = {pair: 0.01 if lost in pair else 0.9 for pair in worth(known)}
    look = shown_on(fronts, filed, {lost[0]: 4})
    pairs = astray(known, near, lambda one: marks(look(one)))
    assert len(pairs) == FEW
    assert (min(lost, own), max(lost, own)) in pairs


def test_the_order_of_photographs_and_facades_changes_no_comparison() -> None:
    fronts = row(5)
    filed, seen = photographs(fronts)
    turned = dict(reversed(filed.items()))
    look = shown_on(fronts, filed, {})
    there = compared(fronts, filed, seen, look)
    again = compared(fronts[::-1], turned, seen[::-1], look)
    assert list(there.items()) == list(again.items())
    assert there


def test_an_elevation_is_read_about_once_however_long_the_row() -> None:
    fronts = row(2 + MARKED // 2)
    filed, seen = photographs(fronts)
    seen = [replace(one, target_score=0.4) for one in seen]  # so that none is sought
    read: Counter[Texture] = Counter()
    bare = whole(np.full((20, 20), 128, np.uint8))

    def look(texture: Texture) -> View:
        read[texture] += 1
        return bare

    alike = compared(fronts, filed, seen, look)
    assert len(read) > 1.2 * MARKED
    assert read.total() < 1.1 * len(read)
    assert len(alike) > len(read)


@pytest.mark.parametrize("marked", [0, 1, 5])
def test_a_summary_is_of_length_one_or_of_nothing(marked: int) -> None:
    some = [few(scattered(seed), marked) for seed in range(3)]
    by = words(some)
    assert by.shape == (min(3 * marked, WORDS), 128)
    for one in (*some, scattered(7)):
        length = float(np.linalg.norm(summary(one, by)))
        assert min(abs(length), abs(length - 1)) < 1e-5


def few(one: Marks, count: int) -> Marks:
    return Marks(one.at_px[:count], one.size_px[:count], one.looks[:count], one.shape)
