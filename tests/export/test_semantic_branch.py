import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("torchvision")

from export.mask_rcnn import Backbone  # noqa: E402
from export.semantic_branch import (  # noqa: E402
    KINDS,
    SemanticBranch,
    from_trial,
    losses,
    probabilities,
)


def _seen(height: int, width: int) -> tuple[dict, list]:
    torch.manual_seed(0)
    with torch.no_grad():
        taps, pyramid = Backbone().both(torch.rand(1, 1, height, width))
    return taps, list(pyramid.values())


@pytest.mark.parametrize("size", [(64, 64), (96, 160), (224, 32)])
def test_every_cell_of_four_pixels_gets_an_answer(size: tuple[int, int]) -> None:
    with torch.no_grad():
        answer = probabilities(SemanticBranch()(*_seen(*size)))
    assert answer.shape == (1, KINDS + 1, size[0] // 4, size[1] // 4)


def test_a_cell_is_ground_front_or_what_hides_it() -> None:
    with torch.no_grad():
        answer = probabilities(SemanticBranch()(*_seen(64, 96)))
    torch.testing.assert_close(answer[:, :KINDS].sum(1), torch.ones(1, 16, 24))
    assert 0 <= answer.min() <= answer.max() <= 1


def test_the_taps_are_silent_at_first() -> None:
    taps, pyramid = _seen(64, 96)
    branch = SemanticBranch()
    with torch.no_grad():
        loud = {name: 100 * tap for name, tap in taps.items()}
        torch.testing.assert_close(branch(taps, pyramid), branch(loud, pyramid))


def _truth(kind: int, *, counted: float = 1.0) -> torch.Tensor:
    """All cells of one kind, no ends."""
    truth = torch.zeros(1, 5, 4, 4)
    truth[:, kind] = counted
    truth[:, 4] = counted
    return truth


@pytest.mark.parametrize("kind", range(KINDS))
def test_a_right_answer_costs_nothing_and_a_wrong_one_what_it_is_sure_of(
    kind: int,
) -> None:
    logits = torch.full((1, 4, 4, 4), -20.0)
    logits[:, kind] = 20
    right = losses(logits, _truth(kind))
    wrong = losses(logits, _truth((kind + 1) % KINDS))
    assert float(right["loss_kinds"] + right["loss_ends"]) == pytest.approx(0, abs=1e-6)
    assert float(wrong["loss_kinds"]) == pytest.approx(40, rel=1e-4)


def test_what_does_not_count_teaches_nothing() -> None:
    logits = torch.randn(1, 4, 4, 4, requires_grad=True)
    sum(losses(logits, _truth(0, counted=0.0)).values()).backward()
    assert logits.grad is not None
    assert float(logits.grad.abs().max()) == 0


def test_a_missed_end_costs_more_than_one_made_up() -> None:
    truth = _truth(0)
    none = losses(torch.full((1, 4, 4, 4), -3.0), truth)["loss_ends"]
    truth[:, 3] = 1
    missed = losses(torch.full((1, 4, 4, 4), -3.0), truth)["loss_ends"]
    made_up = losses(torch.full((1, 4, 4, 4), 3.0), _truth(0))["loss_ends"]
    assert none < made_up < missed


def test_the_trials_weights_answer_as_they_did() -> None:
    branch = SemanticBranch()
    old = {"levels.": "a.", "middle.": "b.", "top.": "c."}
    trial = {
        short + name.removeprefix(long): np.asarray(value)
        for name, value in branch.state_dict().items()
        for long, short in old.items()
        if name.startswith(long)
    }
    again = SemanticBranch()
    state = {k: torch.from_numpy(v) for k, v in from_trial(trial).items()}
    again.load_state_dict(state)
    seen = _seen(64, 64)
    with torch.no_grad():
        torch.testing.assert_close(again(*seen), branch(*seen))
