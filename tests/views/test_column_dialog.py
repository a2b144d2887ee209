"""The dialog that names the columns of a board that sends bare numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QLabel
from pytestqt.qtbot import QtBot

from imugui.formats import FAMILIES, FORMATS
from imugui.views.column_dialog import ColumnDialog
from imugui.workers.session import Options

LINES = ("1000,0.01,-0.02,1.00,0.5,0.6,0.7", "1010,0.02,-0.03,0.99,0.5,0.6,0.7")
Show = Callable[[Any], Any]


def ok(dialog: ColumnDialog) -> Any:
    return dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)


def slots(dialog: ColumnDialog) -> list[str]:
    return [box.currentData() for box in dialog.meanings]


def test_as_many_columns_as_the_board_sends_with_their_values(shown: Show) -> None:
    dialog = shown(ColumnDialog(LINES, Options()))
    assert slots(dialog) == ["t", "ax", "ay", "az", "gx", "gy", "gz"]
    assert any("1000" in label.text() and "1010" in label.text() for label in dialog.findChildren(QLabel))
    assert ok(dialog).isEnabled()


def test_what_is_said_can_be_decoded(shown: Show, qtbot: QtBot) -> None:
    dialog = shown(ColumnDialog(LINES, Options()))
    dialog.units["t"].choose("ms")
    dialog.family.choose("aligned")
    with qtbot.waitSignal(dialog.named) as named:
        qtbot.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    options = named.args[0]
    assert options.columns == ("t_ms", "ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps")
    assert options.family in FAMILIES
    decoder = FORMATS["csv-line"].decoder(options)
    rows = decoder.feed(("\n".join(LINES * 2) + "\n").encode(), 0.0)
    assert len(rows) > 0
    assert abs(rows["acc"][-1][2] - 9.7) < 0.2


def test_what_is_missing_is_said_and_cannot_be_used(shown: Show) -> None:
    dialog = shown(ColumnDialog(LINES, Options()))
    dialog.meanings[3].choose("")
    assert "az" in dialog.problem.text()
    assert dialog.problem.tone == "warn"
    assert not ok(dialog).isEnabled()
    dialog.meanings[3].choose("az")
    assert ok(dialog).isEnabled()


def test_another_number_of_columns_keeps_what_was_said(shown: Show) -> None:
    dialog = shown(ColumnDialog((), Options(columns=("t_us", "ax_mg", "skip"))))
    assert slots(dialog) == ["t", "ax", ""]
    assert (dialog.units["t"].currentData(), dialog.units["a"].currentData()) == ("us", "mg")
    dialog.width_box.setValue(5)
    assert slots(dialog)[:3] == ["t", "ax", ""]
    assert len(slots(dialog)) == 5
    dialog.width_box.setValue(2)
    assert slots(dialog) == ["t", "ax"]
    assert dialog.units["t"].currentData() == "us"


def test_cancel_says_nothing(shown: Show, qtbot: QtBot) -> None:
    dialog = shown(ColumnDialog(LINES, Options()))
    with qtbot.assertNotEmitted(dialog.named):
        dialog.reject()
