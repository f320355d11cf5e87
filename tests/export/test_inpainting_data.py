import json
from pathlib import Path

import cv2
import numpy as np
import pytest
import torch

from export.inpainter_exam import exam, marks
from export.inpainter_trainer import Recipe, Trainer
from export.inpainting_data import Sheet, fronts, held_out, painted, straighten
from export.masks import outlines, standing
from export.train_inpainter import batch
from nostalgin_core.homography import between
from nostalgin_core.measure.free_form import free_form, free_form_share

SQUARE = np.array([[-0.5, -1.0], [0.5, -1.0], [0.5, 0.0], [-0.5, 0.0]])


def sheets(*, count: int = 4) -> tuple[Sheet, ...]:
    rng = np.random.default_rng(0)
    made = []
    for number in range(count):
        image = cv2.resize(rng.integers(0, 256, (12, 9), np.uint8), (90, 120))
        known = np.ones(image.shape, bool)
        known[:20, :30] = False
        kind = "front" if number < 3 else "plain"
        made.append(Sheet(f"noise/{number}", image, known, number == 0, kind))
    return tuple(made)


@pytest.fixture
def labelled(tmp_path: Path) -> Path:
    """Write one tax photograph with a slanting front and a person before it."""
    for folder in ("labels", "photos"):
        (tmp_path / "taxphotos" / folder).mkdir(parents=True)
    front = np.zeros((200, 160), np.uint8)
    front[:, ::16] = 250
    quad = np.array([[40, 30], [200, 60], [200, 260], [40, 280]], float)
    corners = np.array([[0, 0], [159, 0], [159, 199], [0, 199]], float)
    photo = cv2.warpPerspective(front, between(corners, quad), (240, 300))
    person = [[100, 200], [130, 200], [130, 290], [100, 290]]
    cv2.fillPoly(photo, [np.array(person)], 255)
    cv2.imwrite(str(tmp_path / "taxphotos/photos/prefix_00996_0001.jpg"), photo)
    objects = [
        {"category": "facade", "polygon": quad.tolist(), "quad": quad.tolist()},
        {
            "category": "facade",
            "polygon": quad.tolist(),
            "quad": quad.tolist(),
            "group": True,
        },
        {"category": "person", "polygon": person},
    ]
    label = tmp_path / "taxphotos/labels/00996_0001.json"
    label.write_text(json.dumps({"objects": objects}))
    return tmp_path


def test_a_front_is_straightened_without_the_person_before_it(labelled: Path) -> None:
    (sheet,) = fronts(labelled, "taxphotos")
    assert 180 < sheet.image.shape[0] < 240
    assert not sheet.known[-20:, 75:85].any()
    assert sheet.known[:100, 10:-10].all()
    bright = (sheet.image > 120) & sheet.known
    columns = bright[10:110].mean(0)
    assert ((columns > 0.9) | (columns < 0.1)).mean() > 0.9


def test_straightening_a_straight_front_changes_nothing() -> None:
    coarse = np.random.default_rng(0).integers(0, 256, (9, 8), np.uint8)
    photo = cv2.resize(coarse, (80, 90), interpolation=cv2.INTER_CUBIC)
    quad = np.array([[0, 0], [79, 0], [79, 89], [0, 89]], float)
    everything = np.ones(photo.shape, bool)
    image, known = straighten(photo, quad, everything, ~everything)
    again = cv2.resize(image, (80, 90))
    assert known.all()
    assert np.abs(again.astype(int) - photo).mean() < 5


def test_block_993_and_about_a_tenth_are_never_trained_on() -> None:
    assert held_out("taxphotos", "00993_0031")
    kept = [held_out("historic_streets", f"{n}f-a") for n in range(2000)]
    assert 0.07 < np.mean(kept) < 0.13


def test_painted_fronts_are_part_of_what_is_learnt_from() -> None:
    sheet = next(painted())
    assert sheet.kind == "painted"
    assert not sheet.held_out
    assert sheet.known.all()
    always = Recipe(crop=64, batch=4, fronts=0.0, painted=1.0)
    for sample in batch(always, 0, (*sheets(), sheet), (SQUARE,)):
        assert (sample.hole == sample.scored).all()
        assert sample.image.max() <= sheet.image.max()
    never = Recipe(crop=64, batch=8, fronts=1.0, painted=0.0)
    drawn = batch(never, 0, (*sheets(), sheet), (SQUARE,))
    assert any((sample.hole != sample.scored).any() for sample in drawn)


def test_strokes_cover_the_share_asked_for() -> None:
    for seed in range(10):
        rng = np.random.default_rng(seed)
        hole = free_form_share((100, 120), least=0.2, rng=rng)
        assert 0.2 <= hole.mean() < 0.6
        assert free_form((100, 120), rng=rng).any()


def test_silhouettes_stand_on_the_lowest_row() -> None:
    for seed in range(10):
        hole = standing((100, 120), (SQUARE,), rng=np.random.default_rng(seed))
        assert hole[-1].any()
        assert not hole[:15].any()


def test_silhouettes_have_unit_height_and_feet_at_zero(labelled: Path) -> None:
    (labelled / "historic_streets/labels").mkdir(parents=True)
    (outline,) = outlines(labelled)
    assert np.isclose(np.ptp(outline[:, 1]), 1)
    assert np.isclose(outline[:, 1].max(), 0)


def test_a_step_draws_the_same_samples_every_time() -> None:
    recipe = Recipe(crop=64, batch=3)
    first, second = (batch(recipe, 7, sheets(), (SQUARE,)) for _ in range(2))
    other = batch(recipe, 8, sheets(), (SQUARE,))
    for a, b in zip(first, second, strict=True):
        assert a.image.tobytes() == b.image.tobytes()
        assert (a.hole == b.hole).all()
    assert any((a.hole != b.hole).any() for a, b in zip(first, other, strict=True))


def test_what_was_never_seen_is_hidden_and_not_scored() -> None:
    for sample in batch(Recipe(crop=64, batch=8), 0, sheets(), (SQUARE,)):
        assert (sample.hole | ~sample.scored).all()
        assert sample.scored.any()
        assert (sample.guess[~sample.hole] == sample.image[~sample.hole]).all()


@pytest.mark.parametrize("critic_from", [0, 10**9])
def test_a_resumed_training_equals_an_uninterrupted_one(critic_from: int) -> None:
    recipe = Recipe(width=4, crop=64, batch=2, critic_from=critic_from)
    whole = Trainer(recipe)
    for step in range(2):
        whole.advance(batch(recipe, step, sheets(), (SQUARE,)))
    before = Trainer(recipe)
    before.advance(batch(recipe, 0, sheets(), (SQUARE,)))
    state = torch.load(saved(before), weights_only=True)
    after = Trainer(recipe)
    after.restore(state)
    after.advance(batch(recipe, 1, sheets(), (SQUARE,)))
    for name, weights in whole.generator.state_dict().items():
        assert torch.equal(weights, after.generator.state_dict()[name])
        assert torch.equal(whole.averaged[name], after.averaged[name])


def saved(trainer: Trainer) -> "torch.types.FileLike":
    """Write a trainer's state to memory, and open it again."""
    import io  # noqa: PLC0415

    file = io.BytesIO()
    torch.save(trainer.state(), file)
    file.seek(0)
    return file


def test_the_loss_falls_on_one_picture() -> None:
    recipe = Recipe(width=4, crop=64, batch=2, rate=1e-2)
    trainer = Trainer(recipe)
    samples = batch(recipe, 0, sheets(), (SQUARE,))
    losses = [trainer.advance(samples)["fine"] for _ in range(15)]
    assert min(losses[5:]) < 0.97 * losses[0]


def test_the_exam_asks_held_out_fronts_alone_and_marks_the_truth_perfect() -> None:
    questions = exam(sheets())
    assert len(questions) == 1
    truth = [question.image for question in questions]
    assert marks(truth, questions) == (0.0, 0.0)
