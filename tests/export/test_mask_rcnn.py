from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("torchvision")

from export.cells import cells  # noqa: E402
from export.copy_paste import donors  # noqa: E402
from export.held_out import (  # noqa: E402
    as_callable,
    judged,
    pixel_figures,
    pixels_alone,
    together,
)
from export.mask_rcnn import MaskRCNN, freeze, load_weights  # noqa: E402
from export.segmentation_data import UNSCORED, fill  # noqa: E402
from export.segmentation_samples import Schedule, drawn, dressed  # noqa: E402
from export.train_mask_rcnn import (  # noqa: E402
    _arguments,
    advance,
    averaged,
    begin,
    forgetful,
    planned,
    resume,
    save,
)
from nostalgin_core.records import Box, Instance  # noqa: E402
from tests.export.painted_segmentation import painted  # noqa: E402

POOLS = [[painted(i) for i in range(2)], [painted(9)]]
CUT = donors(POOLS[0])
SHORT = Schedule(steps=8, rate=1e-3, warm_up=1, batch=1, short_px=(128, 160), seed=3)


def _weights(seed: int = 0) -> dict[str, np.ndarray]:
    torch.manual_seed(seed)
    return {k: v.numpy() for k, v in MaskRCNN().state_dict().items()}


def test_a_detection_is_a_box_a_label_a_score_and_a_mask() -> None:
    network = load_weights(MaskRCNN(score=0.0, detections=7), _weights()).eval()
    with torch.inference_mode():
        boxes, labels, scores, masks, pixels, rooms = network(
            torch.full((1, 1, 128, 160), 90.0)
        )
    count = len(boxes)
    assert 0 < count <= 7
    assert boxes.shape == (count, 4)
    assert labels.shape == scores.shape == (count,)
    assert masks.shape == (count, 46, 46)
    assert pixels.shape == (4, 32, 40)
    assert rooms.shape == (1, 4, 5)
    assert labels.min() >= 1
    assert labels.max() <= 6
    assert (boxes[:, 2] <= 160).all()
    assert (boxes[:, 3] <= 128).all()


def test_a_stem_that_saw_colour_sees_gray_the_same() -> None:
    weights = _weights()
    name = "backbone.body.stem.weight"
    colour = np.random.default_rng(0).normal(size=(32, 3, 3, 3)).astype(np.float32)
    network = load_weights(MaskRCNN(), weights | {name: colour})
    gray = torch.rand(1, 1, 16, 16)
    stem = network.backbone.body.stem
    padded = torch.nn.functional.pad(gray, (0, 1, 0, 1)).repeat(1, 3, 1, 1)
    want = torch.nn.functional.conv2d(padded, torch.from_numpy(colour), stem.bias, 2)
    torch.testing.assert_close(stem(gray), want, atol=1e-5, rtol=1e-4)


def test_a_network_may_answer_some_things_alone() -> None:
    fronts = replace(SHORT, answering=("facade",))
    for seed in range(4):
        every, some = (
            dressed(POOLS, CUT, np.random.default_rng(seed), schedule).answer
            for schedule in (SHORT, fronts)
        )
        assert set(every.labels.tolist()) > set(some.labels.tolist())
        assert set(some.labels.tolist()) <= {1, UNSCORED}
        np.testing.assert_array_equal(some.masks, every.masks[every.labels <= 1])


def test_networks_that_answer_together_answer_what_each_does() -> None:
    def network(label: int) -> Callable[[np.ndarray], tuple[np.ndarray, ...]]:
        box, mask = np.zeros((label, 4)), np.zeros((label, 46, 46))
        pixels, rooms = np.full((4, 8, 8), 0.2 * label), np.full((1, 1, 1), label)
        told = box, np.full(label, label), np.ones(label), mask, pixels, rooms
        return lambda _: told

    answer = together(network(1), network(2))(np.zeros(1))
    boxes, labels, scores, masks, pixels, rooms = answer
    np.testing.assert_allclose(pixels, 0.3)
    np.testing.assert_allclose(rooms, 1.5)
    assert labels.tolist() == [1, 2, 2]
    assert len(boxes) == len(scores) == len(masks) == 3


def test_training_lowers_the_loss_and_leaves_what_is_frozen() -> None:
    run = begin(_weights(), SHORT)
    before = [p.clone() for p in run.network.backbone.body.stem.parameters()]

    def loss() -> float:
        torch.manual_seed(0)
        seen = [np.random.default_rng([1, i]) for i in range(3)]
        shown = [dressed(POOLS, CUT, rng, SHORT) for rng in seen]
        inputs = [one.tensors(run.device) for one in shown]
        with torch.no_grad():
            return sum(float(sum(run.network(*i).values())) for i in inputs)

    first = loss()
    for _ in range(SHORT.steps):
        advance(run, SHORT, drawn(POOLS, CUT, run.step, SHORT))
    assert loss() < 0.8 * first
    for old, new in zip(
        before, run.network.backbone.body.stem.parameters(), strict=True
    ):
        assert torch.equal(old, new)


def test_a_branch_that_learns_alone_leaves_boxes_and_masks_as_they_are() -> None:
    alone = replace(SHORT, branch_only=True)
    run = begin(_weights(), alone)
    before = {k: v.clone() for k, v in run.network.state_dict().items()}
    for _ in range(3):
        losses = advance(run, alone, drawn(POOLS, CUT, run.step, alone))
        assert set(losses) == {"loss_kinds", "loss_ends"}
    for name, value in run.network.state_dict().items():
        assert torch.equal(value, before[name]) == (not name.startswith("branch.")), (
            name
        )


BOXES = replace(SHORT, boxes_only=True, dropout=0.3, rare=0.5)


def test_boxes_that_learn_alone_leave_features_masks_and_pixels_as_they_are() -> None:
    run = begin(_weights(), BOXES)
    before = {k: v.clone() for k, v in run.network.state_dict().items()}
    losses = advance(run, BOXES, drawn(POOLS, CUT, run.step, BOXES))
    assert set(losses) == {
        "loss_objectness",
        "loss_rpn_box_reg",
        "loss_classifier",
        "loss_box_reg",
    }
    learning = ("rpn.", "roi_heads.box_head.", "roi_heads.box_predictor.")
    for name, value in run.network.state_dict().items():
        assert torch.equal(value, before[name]) == (not name.startswith(learning)), name
    assert set(averaged(run).state_dict()) == set(before)  # and can be shipped


def test_boxes_and_branch_cannot_both_learn_alone() -> None:
    with pytest.raises(ValueError, match="nothing to learn"):
        freeze(MaskRCNN(), but_branch=True, but_boxes=True)
    flags = ["--data", "d", "--start", "s", "--into", "i"]
    with pytest.raises(SystemExit):
        _arguments([*flags, "--branch-only", "--boxes-only"])


def test_what_is_asked_for_on_the_command_line_is_what_is_planned() -> None:
    flags = ["--data", "d", "--start", "s", "--into", "i"]
    assert planned(_arguments(flags)) == Schedule()
    flags += ["--boxes-only", "--dropout", "0.3", "--rare", "0.4"]
    flags += ["--short-px", "300", "640", "--steps", "9"]
    assert planned(_arguments(flags)) == Schedule(
        steps=9, boxes_only=True, dropout=0.3, rare=0.4, short_px=(300, 640)
    )


@pytest.mark.parametrize("share", [0.0, 0.25, 0.6])
def test_dropout_loses_its_share_in_training_and_nothing_when_asked(
    share: float,
) -> None:
    network, plain = (load_weights(MaskRCNN(), _weights()) for _ in range(2))
    forgetful(network, share)
    told = torch.rand(64, 128 * 49)
    head, bare = network.roi_heads.box_head, plain.roi_heads.box_head
    with torch.no_grad():
        whole = bare(told.view(64, 128, 7, 7))
        assert torch.equal(head.eval()(told.view(64, 128, 7, 7)), whole)
        some = head.train()(told.view(64, 128, 7, 7))
    kept = some != 0
    told_of = whole != 0
    assert 1 - kept[told_of].float().mean() == pytest.approx(share, abs=0.02)
    torch.testing.assert_close(some[kept], whole[kept] / (1 - share))


@pytest.mark.parametrize("share", [-0.1, 1.0])
def test_dropout_is_a_share_below_one(share: float) -> None:
    with pytest.raises(ValueError, match="share below 1"):
        forgetful(MaskRCNN(), share)


def test_rare_kinds_are_drawn_where_they_are_asked_for_and_repeat() -> None:
    def shown(share: float) -> list[bytes]:
        schedule = replace(SHORT, rare=share)
        steps = range(12)
        return [drawn(POOLS, CUT, i, schedule)[0].image.tobytes() for i in steps]

    assert shown(1.0) == shown(1.0)
    assert all(a != b for a, b in zip(shown(0.0), shown(1.0), strict=True))


def test_the_average_is_the_mean_it_claims() -> None:
    run = begin(_weights(), BOXES)
    name = "rpn.head.cls_logits.weight"
    want = run.network.state_dict()[name].clone()
    for step in range(1, 4):
        advance(run, BOXES, drawn(POOLS, CUT, run.step, BOXES))
        decay = min(BOXES.decay, (1 + step) / (10 + step))
        want = decay * want + (1 - decay) * run.network.state_dict()[name]
    torch.testing.assert_close(run.average[name], want)
    assert not torch.equal(run.average[name], run.network.state_dict()[name])


def test_pixels_alone_are_the_whole_networks() -> None:
    network = load_weights(MaskRCNN(), _weights()).eval()
    gray = np.random.default_rng(1).uniform(0, 255, (1, 1, 96, 128))
    gray = gray.astype(np.float32)
    (alone,), whole = pixels_alone(network)(gray), as_callable(network)(gray)
    np.testing.assert_allclose(alone, whole[4], atol=1e-6)


def test_cells_themselves_are_judged_perfect() -> None:
    sample = painted(size=(416, 416))

    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        assert gray.shape[-2:] == sample.image.shape
        return (cells(sample)[:4],)

    row = pixel_figures(network, [sample])
    assert row["precision"] > 0.98
    assert row["recall"] > 0.98
    assert row["l2"] < 0.5
    assert row["occluders"] > 0.98


@pytest.mark.parametrize("schedule", [SHORT, BOXES], ids=["all", "boxes"])
def test_a_run_that_was_cut_off_ends_where_the_whole_one_does(
    tmp_path: Path, schedule: Schedule
) -> None:
    whole, parts = begin(_weights(), schedule), begin(_weights(), schedule)
    for _ in range(4):
        advance(whole, SHORT, drawn(POOLS, CUT, whole.step, schedule))
    for _ in range(2):
        advance(parts, SHORT, drawn(POOLS, CUT, parts.step, schedule))
    save(parts, tmp_path / "last.pt")
    parts = resume(tmp_path / "last.pt", schedule)
    for _ in range(2):
        advance(parts, SHORT, drawn(POOLS, CUT, parts.step, schedule))
    assert parts.step == whole.step == 4
    for name, value in whole.average.items():
        assert torch.equal(value, parts.average[name]), name


def test_the_rate_rises_then_falls_to_a_hundredth() -> None:
    schedule = Schedule(steps=100, rate=1.0, warm_up=10)
    rates = [schedule.rate_at(i) for i in range(101)]
    assert rates[0] == pytest.approx(0.1, rel=0.01)
    assert max(rates) > 0.95
    assert rates[9:] == sorted(rates[9:], reverse=True)
    assert rates[-1] == pytest.approx(0.01)


def test_the_average_of_a_run_can_be_asked() -> None:
    run = begin(_weights(), SHORT)
    advance(run, SHORT, drawn(POOLS, CUT, run.step, SHORT))
    with torch.inference_mode():
        assert len(averaged(run)(torch.full((1, 1, 64, 64), 90.0))) == 6


def test_what_is_frozen_has_no_gradient() -> None:
    network = MaskRCNN()
    freeze(network)
    learning = {n for n, p in network.named_parameters() if p.requires_grad}
    assert not any("stem" in n or "body.blocks.0." in n for n in learning)
    assert any("blocks.16." in n for n in learning)


def test_the_labels_themselves_are_judged_perfect() -> None:
    sample = painted()
    shape = sample.image.shape
    hidden = np.any([fill(t.rings, shape) for t in sample.things if t.layer], axis=0)
    instances = []
    for thing in sample.things:
        mask = fill(thing.rings, shape)
        mask = mask & ~hidden if thing.layer == 0 else mask
        whole = Box(0, 0, shape[1], shape[0])
        instances.append(Instance(thing.category, 1.0, whole, mask.astype(np.float32)))
    row = judged(sample, instances)
    assert (row["precision"], row["recall"], row["l1"]) == (1, 1, 0)
    assert row["occluders"] == 1
    assert row["fronts"] == [1, 1]
    assert judged(sample, instances[1:])["targets"][0] < 0.5
