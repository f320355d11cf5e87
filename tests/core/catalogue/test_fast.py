"""What is done fast for a million rows is what the slow and plain way gives."""

from pathlib import PurePosixPath

from hypothesis import example, given
from hypothesis import strategies as st

from nostalgin_core.catalogue import catalogue, inside, stem
from nostalgin_core.catalogue.directions import OPPOSITE_VOTES, directions

NAMES = st.text(st.sampled_from("ab. /\\Jé-\0"), max_size=9)
FACTS = st.tuples(
    st.sampled_from("abcdef"), st.sampled_from([-1, 1]), st.integers(-6, 6).map(float)
)
RINGS = st.lists(st.lists(st.none() | FACTS, min_size=3, max_size=5), max_size=7)


@given(NAMES)
@example("..")
@example(".jpg")
def test_a_stem_is_the_one_of_pathlib(name: str) -> None:
    assert stem(name) == PurePosixPath(name).stem


@given(NAMES)
@example("..")
@example("a/../b")
def test_a_path_that_leads_out_is_told(name: str) -> None:
    path = PurePosixPath(name)
    out = path.is_absolute() or ".." in path.parts or "\0" in name
    assert inside(name) == (not out)


@given(NAMES)
def test_a_path_is_compared_as_pathlib_has_it(name: str) -> None:
    path = PurePosixPath(name.replace("\\", "/"))
    slow = (path.parent / path.stem.strip()).as_posix().casefold()
    assert catalogue._path(name) == slow
    assert catalogue._last(slow) == PurePosixPath(slow).name


@given(RINGS)
def test_laws_are_settled_in_the_order_of_the_slow_way(rings: list) -> None:
    votes: dict[str, float] = {}
    for street, parity, pairs in (fact for ring in rings for fact in ring if fact):
        votes[street] = votes.get(street, 0.0) + parity * pairs
    law: dict[str, int] = {}
    untold = []
    while len(law) < len(votes):
        rest = (street for street in votes if street not in law)
        street = min(rest, key=lambda one: (-abs(votes[one]), one))
        law[street] = 1 if votes[street] >= 0 else -1
        untold += [street] if votes[street] == 0 else []
        for ring in (ring for ring in rings if len(ring) == 4):
            for place, fact in enumerate(ring):
                other = ring[(place + 2) % 4]
                if fact and other and fact[0] == street:
                    votes[other[0]] -= OPPOSITE_VOTES * law[street] * fact[1] * other[1]
    fast, warnings = directions(rings)
    assert list(fast.items()) == list(law.items())
    assert [one.partition(":")[0] for one in warnings] == untold
