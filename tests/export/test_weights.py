from pathlib import Path

import numpy as np
import pytest

from export.weights import mean_weights


@pytest.fixture
def networks(tmp_path: Path) -> list[str]:
    for name, value in (("one", 1.0), ("two", 4.0)):
        np.savez(tmp_path / f"{name}.npz", conv=np.full((2, 3), value, np.float16))
    return [str(tmp_path / "one.npz"), str(tmp_path / "two.npz")]


def test_a_network_mixed_with_itself_is_itself(networks: list[str]) -> None:
    mixed = mean_weights([networks[1], f"{networks[1]}@3"])
    np.testing.assert_array_equal(mixed["conv"], np.full((2, 3), 4.0))


def test_shares_weigh_what_is_mixed(networks: list[str]) -> None:
    np.testing.assert_allclose(mean_weights(networks)["conv"], 2.5)
    np.testing.assert_allclose(
        mean_weights([f"{networks[0]}@2", networks[1]])["conv"], 2.0
    )


def test_a_share_of_nothing_is_refused(networks: list[str]) -> None:
    with pytest.raises(ValueError, match="positive"):
        mean_weights([networks[0], f"{networks[1]}@0"])
