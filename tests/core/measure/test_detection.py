from typing import Any

import numpy as np
import pytest

from nostalgin_core.measure.detection import (
    Matches,
    average_precision,
    covered,
    matches,
    matches_of_kind,
    table,
    together,
)

SIZE = 40


def _square(x0: int, y0: int, side: int = 8) -> np.ndarray:
    mask = np.zeros((SIZE, SIZE), bool)
    mask[y0 : y0 + side, x0 : x0 + side] = True
    return mask


NOTHING = np.zeros((SIZE, SIZE), bool)
TRUTHS = [_square(0, 0), _square(12, 0), _square(24, 0)]


def _matched(masks: list[np.ndarray], scores: list[float], **rest: object) -> Matches:
    given = {"truths": TRUTHS, "ignored": NOTHING, "least": 0.5} | rest
    return matches(scores, masks, **given)


def test_all_found_is_one_and_nothing_found_is_zero() -> None:
    assert average_precision(_matched(TRUTHS, [0.9, 0.5, 0.2])) == 1
    assert average_precision(_matched([], [])) == 0


def test_nothing_to_find_has_no_average_precision() -> None:
    assert np.isnan(average_precision(_matched(TRUTHS, [0.9, 0.5, 0.2], truths=[])))


def test_one_of_three_found_fills_a_third_of_the_recalls() -> None:
    found = average_precision(_matched(TRUTHS[:1], [0.3]))
    assert found == pytest.approx(34 / 101)  # 0, 0.01, ..., 0.33


def test_what_is_wrong_costs_only_where_it_is_surer_than_what_is_right() -> None:
    wrong = _square(0, 30)
    last = _matched([*TRUTHS, wrong], [0.9, 0.8, 0.7, 0.1])
    first = _matched([*TRUTHS, wrong], [0.9, 0.8, 0.7, 0.95])
    assert average_precision(last) == 1
    assert average_precision(first) == pytest.approx(0.75)


def test_a_front_said_twice_is_found_once() -> None:
    twice = _matched([TRUTHS[0], TRUTHS[0]], [0.9, 0.8])
    assert twice.hits.tolist() == [True, False]


def test_the_surer_of_two_takes_the_truth_both_overlap() -> None:
    near, exact = _square(1, 0), _square(0, 0)
    found = _matched([exact, near], [0.4, 0.6])
    assert found.scores.tolist() == [0.6, 0.4]
    assert found.hits.tolist() == [True, False]


def test_an_overlap_just_short_of_what_is_asked_is_no_hit() -> None:
    half = TRUTHS[0].copy()
    half[4:] = False
    assert _matched([half], [0.9], least=0.5).hits.tolist() == [True]
    assert _matched([half], [0.9], least=0.51).hits.tolist() == [False]


def test_what_lies_on_a_group_is_neither_hit_nor_miss() -> None:
    group = _square(0, 20, 16)
    inside = [_square(0, 20), _square(8, 28)]
    with_group = _matched([*TRUTHS, *inside], [0.5] * 5, ignored=group)
    assert len(with_group.hits) == 3
    assert with_group.truths == 3
    assert average_precision(with_group) == 1
    assert average_precision(_matched(inside, [0.9] * 2, truths=[], ignored=group)) != 0


def test_a_truth_beside_a_group_is_still_hit() -> None:
    over_both = TRUTHS[0] | _square(0, 8, 4)
    found = _matched([over_both], [0.9], ignored=_square(0, 0, 16))
    assert found.hits.tolist() == [True]


def test_photos_are_put_together_by_score_not_by_photo() -> None:
    right = _matched(TRUTHS, [0.3, 0.2, 0.1])
    wrong = _matched([_square(0, 30)], [0.9], truths=[])
    assert average_precision(together([right, wrong])) == pytest.approx(0.75)
    assert average_precision(together([wrong, right])) == pytest.approx(0.75)


def test_the_order_in_which_things_are_found_changes_nothing() -> None:
    rng = np.random.default_rng(4)
    masks = [_square(*rng.integers(0, 30, 2)) for _ in range(12)]
    scores = rng.uniform(size=12)
    turned = rng.permutation(12)
    one = _matched(masks, list(scores))
    two = _matched([masks[i] for i in turned], list(scores[turned]))
    np.testing.assert_array_equal(one.hits, two.hits)


def test_the_table_is_intersection_over_union() -> None:
    masks = [_square(0, 0), _square(4, 0), NOTHING]
    np.testing.assert_allclose(
        table(masks, masks), [[1, 1 / 3, 0], [1 / 3, 1, 0], [0, 0, 0]]
    )


def test_nothing_is_not_covered() -> None:
    assert covered(NOTHING, ~NOTHING) == 0
    assert covered(TRUTHS[0], ~NOTHING) == 1


def test_coco_s_own_program_agrees() -> None:
    coco = pytest.importorskip("pycocotools.coco")
    evaluation = pytest.importorskip("pycocotools.cocoeval")
    coder = pytest.importorskip("pycocotools.mask")
    rng = np.random.default_rng(11)
    images, annotations, results, ours = [], [], [], {0.5: [], 0.75: []}

    def told(image: int, mask: np.ndarray, **more: Any) -> dict[str, Any]:
        coded = coder.encode(np.asfortranarray(mask.astype(np.uint8)))
        return {"image_id": image, "category_id": 1, "segmentation": coded, **more}

    for image in range(1, 9):
        images.append({"id": image, "height": SIZE, "width": SIZE})
        places = rng.integers(0, 30, (5, 2))
        truths = [_square(*place, 9) for place in places]
        group = truths.pop() | truths.pop()
        masks = [
            _square(*np.clip(p + rng.integers(-1, 2, 2), 0, 30), 9) for p in places
        ]
        masks += [_square(*place, 9) for place in rng.integers(0, 30, (3, 2))]
        scores = rng.uniform(size=len(masks))
        for mask, crowd in [(t, 0) for t in truths] + [(group, 1)]:
            size = {"area": int(mask.sum()), "bbox": [0, 0, 1, 1]}
            number = len(annotations) + 1
            annotations.append(told(image, mask, id=number, iscrowd=crowd, **size))
        results += [
            told(image, mask, score=float(score))
            for mask, score in zip(masks, scores, strict=True)
        ]
        for least, parts in ours.items():
            parts.append(matches(list(scores), masks, truths, group, least=least))
    truth = coco.COCO()
    truth.dataset = {
        "images": images,
        "annotations": annotations,
        "categories": [{"id": 1}],
        "info": {},
    }
    truth.createIndex()
    judge = evaluation.COCOeval(truth, truth.loadRes(results), "segm")
    judge.evaluate()
    judge.accumulate()
    judge.summarize()
    for place, least in ((1, 0.5), (2, 0.75)):
        found = average_precision(together(ours[least]))
        assert 0.05 < found < 0.95
        assert found == pytest.approx(judge.stats[place], abs=1e-9)


def _of_kind(
    asked: list[bool], counted: list[bool], masks: list[np.ndarray]
) -> Matches:
    return matches_of_kind(
        [0.9 - 0.1 * i for i in range(len(masks))],
        masks,
        TRUTHS,
        NOTHING,
        asked=np.array(asked),
        counted=np.array(counted),
        least=0.5,
    )


def test_kinds_ask_for_their_own_truths_and_leave_others_out() -> None:
    wrong = _square(0, 30)
    masks = [*TRUTHS[:2], wrong]
    plain = matches([0.9, 0.8, 0.7], masks, TRUTHS, NOTHING, least=0.5)
    every = _of_kind([True] * 3, [True] * 3, masks)
    assert every.hits.tolist() == plain.hits.tolist()
    first = _of_kind([True, False, False], [False] * 3, masks)
    assert (first.hits.tolist(), first.truths) == ([True], 1)
    assert average_precision(first) == 1
    # Between two kinds that share everything out, no hit and no claim is lost.
    second = _of_kind([False, True, True], [True] * 3, masks)
    assert len(first.hits) + len(second.hits) == len(plain.hits)
    assert first.truths + second.truths == plain.truths
