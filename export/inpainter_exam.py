"""Questions that no training saw, and how well a network answers them."""

import cv2
import numpy as np
import torch

from export.inpainter import Generator
from export.inpainting_data import Sheet
from export.inpainting_samples import Sample, guessed, tensors
from nostalgin_core.arrays import Gray
from nostalgin_core.measure.free_form import free_form_share


def exam(pictures: tuple[Sheet, ...], *, count: int = 24) -> list[Sample]:
    """Set the held-out questions: fronts of the time at their own size, to 256 px.

    A half is of block 993. Holes are free-form, 20 to 30 % of the crop.
    """
    kept = [p for p in pictures if p.held_out and p.kind == "front"]
    tuned = [p for p in kept if "/00993" in p.name]
    others = [p for p in kept if "/00993" not in p.name]
    rng = np.random.default_rng(993)
    questions = []
    for group in (tuned, others):
        for index in rng.permutation(len(group))[: count // 2]:
            sheet = group[index]
            h, w = (min(256, n // 8 * 8) for n in sheet.image.shape)
            y = rng.integers(sheet.image.shape[0] - h + 1)
            x = rng.integers(sheet.image.shape[1] - w + 1)
            image = np.ascontiguousarray(sheet.image[y : y + h, x : x + w])
            known = sheet.known[y : y + h, x : x + w]
            hole = free_form_share((h, w), least=rng.uniform(0.18, 0.25), rng=rng)
            if (hole & known).any() and (known & ~hole).any():
                made = guessed(image, hole | ~known)
                questions.append(Sample(image, hole | ~known, hole & known, made))
    return questions


def answer(generator: Generator, question: Sample) -> Gray:
    """Fill one held-out picture."""
    image, hole, guesses, _ = tensors([question])
    with torch.no_grad():
        made = generator(image, hole, guesses)[1][0, 0].numpy()
    return np.clip(np.round((made + 1) * 127.5), 0, 255).astype(np.uint8)


def navier_stokes(question: Sample) -> Gray:
    """Fill with the classical method that all figures are measured against."""
    return cv2.inpaint(
        question.image, question.hole.astype(np.uint8), 3, cv2.INPAINT_NS
    )


def before(question: Sample) -> Gray:
    """Give the guess that the network starts from."""
    return question.guess


def marks(made: list[Gray], questions: list[Sample]) -> tuple[float, float]:
    """Give l1 and l2 in percent, over the scored texels, mean over the pictures."""
    off = [
        (m.astype(float) - q.image)[q.scored] / 255
        for m, q in zip(made, questions, strict=True)
    ]
    return (
        100 * float(np.mean([np.abs(d).mean() for d in off])),
        100 * float(np.mean([np.square(d).mean() for d in off])),
    )


def picture(made: list[Gray], questions: list[Sample]) -> Gray:
    """Lay truth, hole, the classical fill and ours side by side, one row a picture."""
    rows = []
    for ours, question in zip(made, questions, strict=True):
        cut = np.where(question.hole, np.uint8(255), question.image)
        row = np.hstack([question.image, cut, navier_stokes(question), ours])
        rows.append(np.pad(row, ((0, 4), (0, 1024 - row.shape[1]))))
    return np.vstack(rows)
