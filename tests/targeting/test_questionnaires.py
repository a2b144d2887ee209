"""Scores of the questionnaires at their ends, by hand, and what is refused."""

from __future__ import annotations

import math

import pytest

from imugui.targeting.questionnaires import (
    SUS,
    TLX,
    TLX_PAIRS,
    Answer,
    preference_p,
    raw_tlx,
    sus,
    weighted_tlx,
)


def test_raw_tlx_is_the_mean_of_six() -> None:
    assert raw_tlx((0, 20, 40, 60, 80, 100)) == 50.0
    assert (raw_tlx((0,) * 6), raw_tlx((100,) * 6)) == (0.0, 100.0)
    assert len(TLX) == 6


@pytest.mark.parametrize("ratings", [(50,) * 5, (50,) * 7, (52, *(50,) * 5), (-5, *(50,) * 5), (105, *(50,) * 5)])
def test_other_ratings_are_refused(ratings: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="TLX"):
        raw_tlx(ratings)


def test_nan_is_no_rating() -> None:
    with pytest.raises(ValueError, match="TLX"):
        raw_tlx((math.nan,) * 6)


def test_weighted_tlx_counts_what_was_chosen() -> None:
    assert len(TLX_PAIRS) == 15
    # the first of each pair: the scales are chosen 5, 4, 3, 2, 1 and 0 times
    chosen = [pair[0] for pair in TLX_PAIRS]
    assert weighted_tlx((100, 80, 60, 40, 20, 0), chosen) == pytest.approx((500 + 320 + 180 + 80 + 20) / 15)
    assert weighted_tlx((70,) * 6, chosen) == 70.0


def test_choices_that_are_not_of_their_pair_are_refused() -> None:
    chosen = [pair[0] for pair in TLX_PAIRS]
    for wrong in (chosen[:-1], [*chosen[:-1], "mental"]):
        with pytest.raises(ValueError, match="15 pairs"):
            weighted_tlx((50,) * 6, wrong)


@pytest.mark.parametrize(
    ("answers", "score"),
    [((3,) * 10, 50.0), ((5, 1) * 5, 100.0), ((1, 5) * 5, 0.0), ((4, 2, 5, 1, 3, 3, 4, 2, 4, 2), 75.0)],
)
def test_sus(answers: tuple[int, ...], score: float) -> None:
    assert sus(answers) == score
    assert len(SUS) == 10


@pytest.mark.parametrize("answers", [(3,) * 9, (0, *(3,) * 9), (6, *(3,) * 9), (2.5, *(3,) * 9)])
def test_other_answers_are_refused(answers: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="SUS"):
        sus(answers)


def test_an_answer_knows_its_score_or_that_it_has_none() -> None:
    assert Answer("P1", "speed", "tlx", (50,) * 6).score == 50.0
    assert Answer("P1", "speed", "sus", (3,) * 10).score == 50.0
    assert math.isnan(Answer("P1", "speed", "sus", (3,) * 4).score)
    assert math.isnan(Answer("P1", "speed", "preference").score)


def test_the_sign_test_of_a_preference() -> None:
    # Constantin and MacKenzie 2014: 10 of 12
    assert preference_p(10, 2) == pytest.approx(2 * (1 + 12 + 66) / 4096)
    assert preference_p(6, 0) == 0.03125
    assert preference_p(3, 3) == preference_p(0, 0) == 1.0
