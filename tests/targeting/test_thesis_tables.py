"""The published tables, and the statistics that guidance-teleop.md F.1 computed from them (TV-A3)."""

from __future__ import annotations

import pytest

from imugui.targeting.thesis_tables import POSITION, SPEED, TABLES, TAUS_S, lag_test, lines


def test_the_averages_of_both_tables() -> None:
    assert [line.tau_s for line in lines()] == list(TAUS_S)
    assert [line.position_s for line in lines()] == pytest.approx([36.4, 39.0, 37.6, 54.4], rel=1e-9)
    assert [line.speed_s for line in lines()] == pytest.approx([56.8, 58.0, 59.6, 70.2], rel=1e-9)


def test_five_runs_for_each_time_constant() -> None:
    for table in TABLES.values():
        assert {len(runs) for runs in table.values()} == {5}


def test_the_ratios_and_welch_tests_between_the_mappings() -> None:
    assert [line.ratio for line in lines()] == pytest.approx([1.56, 1.49, 1.59, 1.29], abs=5e-3)
    assert [round(line.test.p, 4) for line in lines()] == [0.0031, 0.0006, 0.0002, 0.0060]


def test_no_effect_of_the_lag_up_to_one_second_but_at_two() -> None:
    for table, up_to_one, all_four in ((POSITION, 0.82, 0.0008), (SPEED, 0.78, 0.020)):
        assert lag_test(table, 1.0).p == pytest.approx(up_to_one, abs=5e-3)
        assert lag_test(table).p == pytest.approx(all_four, rel=0.01)


def test_at_two_seconds_both_are_slower_as_printed() -> None:
    """+44 % and +21 % against the mean of the shorter lags."""
    for table, percent in ((POSITION, 44), (SPEED, 21)):
        short = [run for tau, runs in table.items() if tau < 2.0 for run in runs]
        rise = sum(table[2.0]) / 5 / (sum(short) / len(short)) - 1.0
        assert round(100 * rise) == percent


def test_other_tables_of_the_same_form_can_be_given() -> None:
    found = lines({1.0: (10.0, 12.0)}, {1.0: (20.0, 24.0)})
    assert (found[0].ratio, found[0].test.difference) == (2.0, 11.0)
