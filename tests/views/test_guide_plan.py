"""The Plan step: writing, importing and exporting trajectories; what is wrong stays and says so."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFileDialog, QLineEdit
from pytestqt.qtbot import QtBot

from imugui.guidance.plan import Plan
from imugui.guidance.plan_file import read_plans
from imugui.views.guide_plan_model import COLUMNS, HEADS, PlanModel
from imugui.views.guide_plan_panel import PlanPanel
from imugui.views.guide_plan_sheet import PlanSheet, draft_of

L4 = Plan("L4", "projected", "left", 12.0, -5.0, depth_mm=40.0)
PLAIN = Plan("Training", "plain", "", yaw_deg=45.0, pitch_deg=-34.0)
Edit = Qt.ItemDataRole.EditRole


@pytest.fixture
def panel(shown: Callable[[Any], Any]) -> PlanPanel:
    widget = PlanPanel()
    widget.resize(940, 500)
    return shown(widget)


def cell(model: PlanModel, row: int, column: int) -> str:
    return str(model.data(model.index(row, column)))


def test_a_draft_reads_back_as_its_plan() -> None:
    for plan in (L4, PLAIN):
        found, wrong = draft_of(plan).read()
        assert wrong == {}
        assert str(found) == str(plan)  # NaN is not equal to itself


def test_what_is_typed_wrong_is_kept_and_the_others_go_on() -> None:
    sheet = PlanSheet([L4, PLAIN])
    sheet.edit(0, axial_deg="120")
    assert [plan.name for plan in sheet.plans] == ["Training"]
    assert "120" in sheet.problems[0]["axial_deg"]
    assert sheet.drafts[0].texts["axial_deg"] == "120"
    sheet.edit(0, axial_deg="fifteen")
    assert "fifteen" in sheet.problems[0]["axial_deg"]
    sheet.edit(0, axial_deg="15,5°")
    assert sheet.problems == [{}, {}]
    assert sheet.plans[0].axial_deg == 15.5


def test_the_same_trajectory_twice_is_named() -> None:
    sheet = PlanSheet([L4])
    sheet.append([L4])
    assert sheet.plans == sheet.plans[:1] and len(sheet.plans) == 1
    assert "row 1" in sheet.problems[1]["name"]
    sheet.edit(1, side="right")
    assert len(sheet.plans) == 2


def test_add_offers_the_other_side_then_the_next_level() -> None:
    sheet = PlanSheet()
    for _ in range(3):
        sheet.add()
    assert [(plan.name, plan.side) for plan in sheet.plans] == [("L4", "left"), ("L4", "right"), ("L5", "left")]
    sheet.load([PLAIN])
    sheet.add()
    sheet.add()
    assert [plan.name for plan in sheet.plans] == ["Training", "Training 1", "Training 2"]
    assert all(wrong == {} for wrong in sheet.problems)


def test_the_table_says_signs_in_words_and_takes_edits_in_place() -> None:
    model = PlanModel(PlanSheet([L4, PLAIN]))
    assert [cell(model, 0, i) for i in range(len(COLUMNS))] == [
        "L4", "left", "12° medial", "5° caudal", "40 mm", "2°", "5°"
    ]  # fmt: skip
    assert [cell(model, 1, i) for i in (2, 3, 4)] == ["45° left", "34° up", "–"]
    assert model.data(model.index(0, 3), Edit) == "-5"
    assert [model.headerData(i, Qt.Orientation.Horizontal) for i in range(len(HEADS))] == list(HEADS)
    changed: list[bool] = []
    model.dataChanged.connect(lambda *_: changed.append(True))
    assert model.setData(model.index(0, 2), "91")
    assert changed
    assert cell(model, 0, 2) == "✕ 91"
    assert "91" in model.data(model.index(0, 2), Qt.ItemDataRole.ToolTipRole)
    assert model.setData(model.index(0, 2), "-3")
    assert cell(model, 0, 2) == "3° lateral"


def test_a_plan_is_made_by_keyboard(panel: PlanPanel, qtbot: QtBot) -> None:
    changes: list[int] = []
    panel.changed.connect(lambda: changes.append(len(panel.plans())))
    panel.add_button.setFocus()
    qtbot.keyClick(panel.add_button, Qt.Key.Key_Space)
    editor = panel.editor
    assert editor.level.hasFocus()
    editor.level.lineEdit().selectAll()
    qtbot.keyClicks(editor.level, "T7")
    qtbot.keyClick(editor.picture, Qt.Key.Key_Right)
    for name, text in (("axial_deg", "20"), ("sagittal_deg", "-7.5"), ("depth_mm", "45")):
        line = editor.lines[name]
        line.setFocus()
        line.selectAll()
        qtbot.keyClicks(line, text)
    (plan,) = panel.plans()
    assert (plan.name, plan.side, plan.axial_deg, plan.sagittal_deg) == ("T7", "right", 20.0, -7.5)
    assert plan.depth_mm == 45.0
    assert editor.words.text() == "20° medial, 7.5° caudal"
    assert changes
    assert cell(panel.model, 0, 0) == "T7"
    qtbot.keyClick(panel.delete_button, Qt.Key.Key_Space)
    assert panel.plans() == []
    assert not editor.isEnabled()


def test_the_field_says_what_is_wrong(panel: PlanPanel, qtbot: QtBot) -> None:
    panel.load([L4, PLAIN])
    line = panel.editor.lines["axial_deg"]
    line.setFocus()
    line.selectAll()
    qtbot.keyClicks(line, "95")
    assert "Axial is 95°" in panel.editor.errors["axial_deg"].text()
    assert panel.editor.errors["axial_deg"].isVisible()
    assert "Row 1: Axial is 95°" in panel.trouble.text()
    assert panel.count.text() == "1 of 2 trajectories can be used"
    panel.table.selectRow(1)
    assert not panel.editor.errors["axial_deg"].isVisible()
    assert panel.editor.lines["yaw_deg"].isVisible() and not line.isVisible()
    assert not panel.editor.picture.isVisible()
    panel.table.selectRow(0)
    assert line.text() == "95"
    panel.editor.kind.setCurrentIndex(1)
    assert not panel.editor.errors["axial_deg"].isVisible(), "a plain plan has no axial angle"


def test_a_cell_is_edited_in_place(panel: PlanPanel, qtbot: QtBot) -> None:
    panel.load([L4])
    panel.table.setFocus()
    panel.table.setCurrentIndex(panel.model.index(0, 3))
    qtbot.keyClick(panel.table, Qt.Key.Key_F2)
    field = panel.table.findChild(QLineEdit)
    qtbot.keyClicks(field, "8")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: panel.plans()[0].sagittal_deg == 8.0)
    assert panel.editor.lines["sagittal_deg"].text() == "8"


def test_import_takes_what_is_good_and_names_the_rest(panel: PlanPanel, tmp_path: Path) -> None:
    path = tmp_path / "plans.csv"
    path.write_text("level,side,axial_deg,sagittal_deg\nL4,left,12,-5\nL5,left,99,0\nS1,right,10,\xb15\n", "cp1252")
    said: list[tuple[str, str]] = []
    panel.said.connect(lambda tone, text: said.append((tone, text)))
    panel.import_file(path)
    assert [plan.name for plan in panel.plans()] == ["L4"]
    assert "Line 3" in panel.trouble.text() and "Line 4" in panel.trouble.text()
    assert said == [("info", "1 plans taken from plans.csv.")]
    panel.import_file(path)
    assert len(panel.sheet.drafts) == 2 and len(panel.plans()) == 1, "a double is shown at its field, not swallowed"


@pytest.mark.parametrize("content", [None, b"", b"\x00\xff\xfe" * 50, b"x" * (5 << 20)])
def test_a_bad_file_changes_nothing(panel: PlanPanel, tmp_path: Path, content: bytes | None) -> None:
    panel.load([L4])
    path = tmp_path / "bad.csv"
    if content is not None:
        path.write_bytes(content)
    panel.import_file(path)
    assert [plan.name for plan in panel.plans()] == ["L4"]
    assert panel.trouble.isVisible()


def test_export_writes_what_reads_back(panel: PlanPanel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    panel.load([L4, PLAIN])
    path = tmp_path / "out.csv"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    panel.ask_export()
    plans, wrong = read_plans(path.read_text("utf-8"))
    assert wrong == []
    assert [plan.name for plan in plans] == ["L4", "Training"]
    assert math.isnan(plans[1].depth_mm)
    said: list[str] = []
    panel.said.connect(lambda tone, text: said.append(tone))
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "no" / "where.csv"), ""))
    panel.ask_export()
    assert said == ["error"]
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: ("", ""))
    panel.ask_export()
    assert said == ["error"]


def test_the_side_is_chosen_in_the_picture(panel: PlanPanel, qtbot: QtBot) -> None:
    panel.load([L4])
    picture = panel.editor.picture
    assert picture.side == "left"
    qtbot.mouseClick(picture, Qt.MouseButton.LeftButton, pos=QPoint(picture.width() - 30, 60))
    assert panel.plans()[0].side == "right"
