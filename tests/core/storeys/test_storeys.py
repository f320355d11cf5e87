import numpy as np
import pytest

from nostalgin_core.storeys import COUNTS, scores


def front(
    storeys: int, *, bays: int = 4, rows: int = 30, ground: float = 1.4
) -> np.ndarray:
    """Paint a wall with rows of windows over a shop, and a cornice."""
    height = round(rows * (storeys - 1 + ground + 0.3))
    image = np.full((height, bays * 28), 170, np.uint8)
    for storey in range(storeys - 1):
        top = round(rows * (storey + 0.3 + 0.2))
        for bay in range(bays):
            image[top : top + rows // 2, bay * 28 + 8 : bay * 28 + 20] = 60
    image[-round(rows * ground) + 6 :, 6:-6] = 90
    rng = np.random.default_rng(storeys)
    return np.clip(image + rng.normal(0, 6, image.shape), 0, 255).astype(np.uint8)


def counted(image: np.ndarray, seen: np.ndarray | None = None) -> float:
    whole = np.ones(image.shape, bool)
    found = scores(image, whole if seen is None else seen)
    assert found.max() > 0.1
    return float(COUNTS[found.argmax()])


@pytest.mark.parametrize("storeys", [4, 5, 6, 8, 12, 20])
def test_rows_of_windows_are_counted(storeys: int) -> None:
    assert counted(front(storeys)) == pytest.approx(storeys, rel=0.15)


@pytest.mark.parametrize("gain", [0.5, 1.3])
def test_light_changes_no_count(gain: float) -> None:
    image = front(6)
    ramp = np.linspace(0.7, 1.1, image.shape[0])[:, None]
    lit = np.clip(image * gain * ramp, 0, 255).astype(np.uint8)
    assert counted(lit) == pytest.approx(6, rel=0.15)


def test_what_no_camera_saw_is_not_looked_at() -> None:
    image = front(6)
    seen = np.ones(image.shape, bool)
    seen[-60:, 20:70] = False
    spoiled = image.copy()
    spoiled[~seen] = 255
    assert np.array_equal(scores(image, seen), scores(spoiled, seen))


@pytest.mark.parametrize("shape", [(1, 1), (3, 400), (400, 3), (60, 60)])
def test_a_plain_wall_shows_no_storeys(shape: tuple[int, int]) -> None:
    plain = np.full(shape, 128, np.uint8)
    assert np.allclose(scores(plain, np.ones(shape, bool)), 0.0, atol=1e-6)
    assert not scores(plain, np.zeros(shape, bool)).any()


def test_a_large_picture_says_what_its_small_one_says() -> None:
    image = front(5, rows=60)
    large = np.kron(image, np.ones((4, 4), np.uint8))
    assert counted(large) == pytest.approx(counted(image), rel=0.05)
