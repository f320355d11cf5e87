"""Who photographs from a roof or from the air shows no street's front."""

import json
from pathlib import Path

import numpy as np
import pytest

import nostalgin_core
from nostalgin_core import matte, segment, session
from nostalgin_core.photo import decode
from nostalgin_core.records import Elevation, Matted, Photo, Rejection
from nostalgin_core.rectify import above, orient, upright
from nostalgin_core.rectify.rectify import rectify
from nostalgin_core.segment import Network
from tests.data import DATA, needs_data
from tests.painted_front import Painted, photograph

FROM_ABOVE = (  # of historic_streets: from roofs, windows and the air
    *("707864f-a", "708949f-b", "712796f-a", "716148f-b", "716457f-a", "717493f-c"),
    *("710365f-a", "711917f-a", "712124f-b", "712950f-c", "721818f-a"),
    *("718145f-a", "718567f-a", "718568f-a", "720101f-b", "721409f-b", "722429f-b"),
    *("723359f-b", "730133f-b", "730184f-b"),
)
FROM_THE_STREET = ("711426f-b", "712123f-b", "711703f-a", "729327f-a")


def views_of(painted: Painted) -> tuple[Elevation | Rejection, ...]:
    return rectify(painted.photo, painted.matted)


@pytest.mark.parametrize("tilt_deg", [2.0, 12.0, 25.0])
def test_a_camera_that_stands_on_the_street_is_believed(tilt_deg: float) -> None:
    assert all(views_of(photograph(tilt_deg=tilt_deg)))


@pytest.mark.parametrize("tilt_deg", [-20.0, -28.0])
def test_all_fronts_that_are_seen_from_above_are_rejected(tilt_deg: float) -> None:
    views = views_of(photograph(tilt_deg=tilt_deg))
    assert [one.facade for one in views] == [0, 1]
    for one in views:
        assert isinstance(one, Rejection)
        assert one.reason == above.REASON
        assert f"{-tilt_deg:.0f} degrees down" in one.detail
        assert "from the street" in one.detail


@pytest.mark.parametrize("tilt_deg", [3.0, 12.0])
def test_the_cameras_height_is_told_in_heights_of_the_front(tilt_deg: float) -> None:
    painted = photograph(tilt_deg=tilt_deg)
    views = views_of(painted)
    down, top = painted.planes[0][:, 1], painted.planes[0][:, 2]
    true = float((top + down) @ down / (down @ down))
    assert above.height(painted.photo, painted.matted, views) == pytest.approx(
        true, abs=0.05
    )


def test_what_tells_too_little_is_passed_on() -> None:
    painted = photograph(tilt_deg=4.0)
    views = views_of(painted)
    world = orient.orient(painted.photo, painted.matted.facades).world
    steep = world.parameters.copy()
    steep[2] = np.radians(-60)

    def told(support: float, views: above.Views) -> tuple[Elevation | Rejection, ...]:
        some = np.full_like(world.support, support)
        leaning = upright.Upright(steep, world.covariance, some)
        return above.refused(painted.photo, painted.matted, views, leaning)

    assert not any(told(50.0, views))
    assert told(above.SUPPORTED / 2, views) == views
    nothing = Rejection(painted.photo.key, "rectify", "too few lines", "", 0)
    assert told(50.0, [nothing]) == (nothing,)
    assert above.refused(painted.photo, Matted((), ()), (), world) == ()


def test_a_level_camera_is_high_only_by_two_fronts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(above, "HIGH", -1.0)
    painted = photograph(tilt_deg=4.0)
    world = orient.orient(painted.photo, painted.matted.facades).world
    both = views_of(painted)
    assert not any(both)
    monkeypatch.undo()
    first, second = views_of(painted)
    monkeypatch.setattr(above, "HIGH", -1.0)
    one = (first, Rejection(painted.photo.key, "rectify", "too few lines", "", 1))
    assert above.refused(painted.photo, painted.matted, one, world) == one
    assert second


@pytest.fixture(scope="module")
def shipped() -> Network:
    folder = Path(nostalgin_core.__file__).parent / "models"
    sums = json.loads((folder / "models.lock").read_text())
    return session.load((folder / "segment.onnx").read_bytes(), sums["segment.onnx"])


def reasons(name: str, network: Network) -> list[str | None]:
    """Tell why each front of a real photograph is rejected, None where it is not."""
    path = DATA / "historic_streets" / "photos" / f"{name}.jpg"
    photo = decode(path.read_bytes(), name=name)
    assert isinstance(photo, Photo)
    found = segment.segment(photo, network)
    assert not isinstance(found, Rejection)
    matted = matte.matte(photo, found)
    assert isinstance(matted, Matted)
    views = rectify(photo, matted)
    return [one.reason if isinstance(one, Rejection) else None for one in views]


@needs_data
@pytest.mark.parametrize("name", FROM_ABOVE)
def test_real_views_from_above_give_no_front(name: str, shipped: Network) -> None:
    told = reasons(name, shipped)
    assert above.REASON in told
    assert None not in told


@needs_data
@pytest.mark.parametrize("name", FROM_THE_STREET)
def test_real_streets_are_not_seen_from_above(name: str, shipped: Network) -> None:
    assert above.REASON not in reasons(name, shipped)
