"""The exported table: what is on screen, in its units, readable by our own import."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.formats.columns import read_name
from imugui.fusion.attitude import from_euler
from imugui.ring import Ring
from imugui.samples import GRAVITY
from imugui.signals.channels import QUANTITIES, UNITS
from imugui.signals.scope import Scope
from imugui.signals.table import LINES, Table, column_name, csv_pieces, make_table

Push = Callable[..., Any]


@pytest.fixture
def scope(rings: tuple[Ring, Ring], push: Push) -> Scope:
    one = Scope(*rings, "ENU")
    push(np.arange(100) * 0.01, acc=(0.0, 0.0, GRAVITY), gyr=(math.radians(90.0), 0.0, 0.0))
    one.refresh()
    return one


def text(table: Table, header: dict[str, str] | None = None) -> list[str]:
    return "".join(csv_pieces(table, header or {})).splitlines()


def test_the_table_holds_what_is_on_screen_in_its_units(scope: Scope) -> None:
    scope.choice.plots = {"acc", "gyr"}
    scope.choice.next_unit("acc")
    lines = text(make_table(scope.feed, scope.choice, 0.5, 2.0), {"program": "imugui"})
    assert lines[0] == "# program: imugui"
    assert lines[1] == "t_s,acc_x_g,acc_y_g,acc_z_g,gyr_x_deg/s,gyr_y_deg/s,gyr_z_deg/s"
    assert lines[2] == "0.500000,0,0,1,90,0,0"
    assert len(lines) == 2 + 50


def test_missing_values_are_empty(scope: Scope) -> None:
    scope.choice.plots = {"acc", "mag", "interval"}
    lines = text(make_table(scope.feed, scope.choice, -1.0, 0.005))
    assert lines[0].endswith("mag_z_uT,interval_s_ms")
    assert lines[1] == f"0.000000,0,0,{GRAVITY:.9g},,,,"


def test_rows_of_both_histories_meet_by_time(scope: Scope, rings: tuple[Ring, Ring], push: Push) -> None:
    samples, _ = push(np.array([1.00]))
    rings[0].push(samples[:0])
    extra = samples.copy()
    extra["t"] = 1.01
    rings[0].push(extra)  # a sample that the fusion has not yet seen
    scope.refresh()
    scope.choice.plots = {"acc", "interval"}
    lines = text(make_table(scope.feed, scope.choice, 0.995, 2.0))
    assert [line.split(",")[0] for line in lines[1:]] == ["1.000000", "1.010000"]
    assert lines[2].split(",")[1:4] == ["", "", ""]
    assert float(lines[2].split(",")[4]) == pytest.approx(10.0)


def test_angles_are_folded(rings: tuple[Ring, Ring], push: Push) -> None:
    scope = Scope(*rings, "ENU")
    t = np.arange(400) * 0.01
    quat = from_euler(3.0 * t, 0.0 * t, 0.0 * t)
    push(t, quat=quat, local=quat)
    scope.refresh()
    scope.choice.plots = {"euler"}
    table = make_table(scope.feed, scope.choice, 0.0, 9.0)
    assert np.abs(table.columns[1][1]).max() <= 180.0 + 1e-9


def test_a_gap_is_no_row(rings: tuple[Ring, Ring], push: Push) -> None:
    scope = Scope(*rings, "ENU")
    push(np.concatenate((np.arange(50) * 0.01, 3.0 + np.arange(50) * 0.01)))
    scope.refresh()
    assert len(make_table(scope.feed, scope.choice, 0.0, 9.0)) == 100


def test_nothing_chosen_is_an_empty_table(scope: Scope) -> None:
    scope.choice.plots = set()
    assert text(make_table(scope.feed, scope.choice, 0.0, 9.0)) == ["t_s"]


def test_long_tables_come_in_pieces() -> None:
    n = 2 * LINES + 1
    pieces = list(csv_pieces(Table((("t_s", np.arange(n) * 1.0), ("a", np.zeros(n)))), {}))
    assert len(pieces) == 2 + 3
    assert "".join(pieces).count("\n") == 1 + n


@pytest.mark.parametrize("key", ["acc", "gyr", "mag", "temp"])
def test_our_own_import_knows_the_names(key: str) -> None:
    quantity = QUANTITIES[key]
    for unit in UNITS[quantity.kind]:
        name = column_name(quantity.channels[0], unit)
        column = read_name(name.replace("temp_c", "temp"))
        assert column is not None
        assert column.factor == pytest.approx(1.0 / unit.scale)
