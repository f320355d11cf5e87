import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("onnx")

import torch

from export.fit_indoors import (
    LABELLED,
    RARELY,
    YORK,
    Told,
    at,
    enough,
    fit,
    report,
    scores,
)
from export.indoors import Indoors, features
from export.mask_rcnn import Backbone


def _told(seed: int = 0, each: int = 150) -> Told:
    """Rooms differ from streets in one feature, York's from all others in another."""
    rng = np.random.default_rng(seed)
    kinds = np.repeat([YORK, YORK, LABELLED[0]], each)
    rooms = np.repeat([True, False, False], each)
    rows = rng.normal(size=(3 * each, 416))
    rows[rooms, 5] += 4
    rows[kinds == YORK, 7] += 9
    names = np.array([f"photo {i}" for i in range(3 * each)])
    return Told(kinds, names, np.ones(3 * each, bool), rooms, rows)


def test_rooms_are_told_from_streets_and_not_york_from_new_york() -> None:
    told = _told()
    weights = fit(told)
    other = _told(1)
    log_odds = at(other, weights)
    assert (log_odds[other.rooms, None] > log_odds[~other.rooms]).mean() > 0.9
    moved = other.features.copy()
    moved[:, 7] += 9 * (other.kinds != YORK)
    far = Told(*other[:4], moved)
    assert (log_odds[other.rooms, None] > at(far, weights)[~other.rooms]).mean() > 0.85


def test_a_photograph_is_judged_by_what_others_taught() -> None:
    told = _told()
    ours, theirs = at(told, fit(told)), scores(told)
    gap = ours[told.rooms].mean() - ours[~told.rooms].mean()
    assert theirs[told.rooms].mean() - theirs[~told.rooms].mean() < gap
    told.learnt[:5] = False
    kept_out = scores(told)[:5]
    np.testing.assert_allclose(kept_out, at(told, fit(told.only(told.learnt)))[:5])


def test_the_report_names_the_streets_that_look_most_like_rooms() -> None:
    told = _told()
    log_odds = np.arange(450.0)
    lines = list(report(told, log_odds))
    assert lines[0].startswith("York's rooms")
    assert "photo 449 449.00" in lines[-2]
    assert lines[-1].startswith("enough")


def test_few_streets_exceed_what_is_enough() -> None:
    streets = np.random.default_rng(0).exponential(2.0, 200_000)
    share = (streets > enough(streets)).mean()
    assert share == pytest.approx(1 / RARELY, rel=0.3)


def test_the_heads_mean_is_the_fitted_function_of_the_mean_features() -> None:
    torch.manual_seed(0)
    head, weights = Indoors(), torch.randn(417)
    state = {"weight": weights[None, :-1, None, None], "bias": weights[-1:]}
    head.say.load_state_dict(state)
    with torch.inference_mode():
        taps = Backbone().body(torch.rand(1, 1, 96, 128))
        said, seen = head(taps), features(taps)
    assert said.shape == (1, 1, 3, 4)
    want = (seen.mean((2, 3)) @ weights[:-1] + weights[-1]).item()
    assert said.mean().item() == pytest.approx(want, rel=1e-4, abs=1e-5)
