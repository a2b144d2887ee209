"""The Guide page as a whole, on the virtual board: from an empty page to readings, and all that takes trust away."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox
from pytestqt.qtbot import QtBot

from imugui.guidance.plan import Plan
from imugui.guidance.reading import reading_from
from imugui.guidance.registration import from_mark
from imugui.views.guide_aim_words import component_words, due_words
from imugui.views.guide_desk import FILE_NAME, GuideDesk
from imugui.views.guide_view import GuideView
from imugui.views.settings_store import SettingsStore
from imugui.views.shortcuts import KEYS
from imugui.workers.session import Session, Source, State

AHEAD = Plan("Ahead", "plain", "", tolerance_deg=2.0)
ASIDE = Plan("Aside", "plain", "", yaw_deg=3.0, pitch_deg=-2.0)
LEFT = Plan("L4", "projected", "left", 1.0, 0.5)
Key = Qt.Key


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> Iterator[GuideView]:
    page = GuideView(session, settings_store)
    page.resize(940, 566)
    yield shown(page)
    page.stop()


def pump(view: GuideView, qtbot: QtBot, until: Callable[[], bool]) -> None:
    """Let the page work as the window's timers do, until a condition holds."""

    def step() -> bool:
        view.refresh()
        view.slow_refresh()
        return until()

    qtbot.waitUntil(step)


def type_plan(view: GuideView, *plans: Plan) -> None:
    view.plan.load(plans)
    view.plan.changed.emit()


@pytest.fixture
def connected(view: GuideView, session: Session, qtbot: QtBot) -> GuideView:
    session.connect_to(Source("simulator", "hand"))
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    qtbot.waitUntil(lambda: session.attitude.count > 5)
    view.slow_refresh()
    return view


@pytest.fixture
def green(connected: GuideView, qtbot: QtBot) -> GuideView:
    """Registered by the origin, aiming straight at the first plan, held."""
    view = connected
    type_plan(view, AHEAD, ASIDE, LEFT)
    view.register()
    view.register_panel.choose("origin")
    qtbot.keyClick(view.register_panel.stage.scene, Key.Key_Space)
    view.take()
    pump(view, qtbot, lambda: view.desk.guide.registration is not None)
    view.go("aim")
    pump(view, qtbot, lambda: view.desk.guide.look.armed)
    return view


def test_imuguis_own_filter_counts_its_heading_from_the_registration(
    connected: GuideView, session: Session, qtbot: QtBot
) -> None:
    """Although the magnetometer is switched off only for the registration."""
    view = connected
    session.set_filter("imugui")
    qtbot.waitUntil(lambda: session.attitude.last(1)["sigma_heading"][0] > math.radians(2.0), timeout=5000)
    view.register()
    view.register_panel.choose("origin")
    view.take()
    pump(view, qtbot, lambda: view.desk.guide.registration is not None)
    pump(view, qtbot, lambda: 0.0 < view.desk.guide.look.heading_sigma_deg < 0.5)
    assert not session.use_mag


def test_without_a_board_the_page_says_what_it_will_show_and_plans(view: GuideView, qtbot: QtBot) -> None:
    assert view.empty.isVisible()
    assert view.foot.line.text() == "Research tool, not a medical device"
    qtbot.mouseClick(view.steps.buttons["plan"], Qt.MouseButton.LeftButton)
    assert view.plan.isVisible() and not view.empty.isVisible()
    qtbot.mouseClick(view.plan.add_button, Qt.MouseButton.LeftButton)
    assert [plan.name for plan in view.desk.guide.plans] == ["L4"]
    qtbot.mouseClick(view.steps.buttons["aim"], Qt.MouseButton.LeftButton)
    assert view.empty.isVisible()
    view.take()
    assert view.desk.guide.readings == []


def test_the_page_has_keys_for_what_is_done_while_aiming(view: GuideView) -> None:
    actions = {key.action: key for key in KEYS if "Guide" in key.words}
    assert set(actions) == {"take", "next_plan", "previous_plan", "register"}
    assert all(key.page and callable(getattr(view, action)) for action, key in actions.items())


def test_a_session_by_keyboard_alone(connected: GuideView, session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    view = connected
    assert session.use_mag, "the program's default; guidance does without"
    qtbot.keyClick(view.steps.buttons["plan"], Key.Key_Space)
    for name in ("Ahead", "Other"):
        qtbot.keyClick(view.plan.add_button, Key.Key_Space)
        editor = view.plan.editor
        editor.kind.setFocus()
        qtbot.keyClick(editor.kind, Key.Key_Down)
        editor.level.lineEdit().selectAll()
        qtbot.keyClicks(editor.level.lineEdit(), name)
    assert [(plan.name, plan.kind) for plan in view.desk.guide.plans] == [("Ahead", "plain"), ("Other", "plain")]
    qtbot.keyClick(view.plan.next_button, Key.Key_Space)
    assert view.tool.isVisible()
    qtbot.keyClick(view.tool.next_button, Key.Key_Space)
    panel = view.register_panel
    assert panel.isVisible()
    for _ in range(2):
        qtbot.keyClick(panel.method, Key.Key_Down)
    assert session.record(tmp_path / "guided")
    qtbot.waitUntil(lambda: session.recording is not None and session.recording.rows > 0)
    qtbot.keyClick(panel.take_button, Key.Key_Space)
    pump(view, qtbot, lambda: view.desk.guide.registration is not None)
    assert not session.use_mag and not panel.mag.isChecked()
    assert session.has_origin
    qtbot.keyClick(panel.next_button, Key.Key_Space)
    target = view.aim.target
    assert target.hasFocus()
    pump(view, qtbot, lambda: view.desk.guide.look.armed)
    qtbot.keyClick(target, Key.Key_Space)
    assert len(view.desk.guide.readings) == 1
    assert view.aim.reading.said.text().startswith("✓ Taken: Ahead")
    view.next_plan()
    pump(view, qtbot, lambda: view.desk.guide.look.armed)
    view.take()
    assert [reading.name for reading in view.desk.guide.readings] == ["Ahead", "Other"]
    for reading in view.desk.guide.readings:
        assert reading.error_deg < 1.0
        assert reading.rows[1] - reading.rows[0] > 10
        assert reading_from(reading.to_dict()).registration_id == reading.registration_id
    assert view.report.count.text() == "2 readings"
    path = session.stop_recording()
    assert path is not None
    from imugui.workers.verify import verify

    check = verify(path).guidance
    assert (check.readings, check.recomputed, check.registrations) == (2, 2, 2)
    assert check.reading_difference_deg < 1e-9
    assert check.registration_difference_deg < 1e-9


def test_the_mouse_and_the_arrow_keys_bring_the_cross_to_the_plan(green: GuideView, qtbot: QtBot) -> None:
    target = green.aim.target
    green.next_plan()
    pump(green, qtbot, lambda: green.desk.guide.look.colour in ("amber", "red") and not target.scale.gliding)
    assert target.turned_by_hand
    centre, cross = target.centre().toPoint(), target.cross().toPoint()
    qtbot.mousePress(target, Qt.MouseButton.LeftButton, pos=cross)
    qtbot.mouseMove(target, centre)
    qtbot.mouseRelease(target, Qt.MouseButton.LeftButton, pos=centre)
    pump(green, qtbot, lambda: green.desk.guide.look.error_deg < 0.5)
    before = green.desk.guide.look.aim.offset
    for _ in range(10):
        qtbot.keyClick(target, Key.Key_Right)

    def moved() -> bool:
        return green.desk.guide.look.aim.offset[0] - before[0] > math.radians(1.0)

    pump(green, qtbot, moved)
    across, along = np.degrees(np.subtract(green.desk.guide.look.aim.offset, before))
    assert abs(along) < 0.3 < across


def test_every_loss_of_trust_is_seen_at_the_next_frame_and_bars_the_reading(
    green: GuideView, session: Session, qtbot: QtBot
) -> None:
    guide, aim = green.desk.guide, green.aim
    assert aim.numbers.error.text() != "---.-"
    across, along = component_words(guide.look.aim, AHEAD)
    assert across.endswith(("left", "right", "°")) and along.endswith(("high", "low", "°"))
    assert component_words(None, AHEAD) == ("–", "–")
    assert due_words(guide.look)[0] in ("good", "warn")
    aim.reading.button.click()
    assert len(guide.readings) == 1
    registration = guide.registration
    green.desk.remove_registration()

    def barred(words: str) -> bool:
        green.take()
        return words in aim.reading.said.text()

    pump(green, qtbot, lambda: barred("no registration"))
    assert len(guide.readings) == 1
    pump(green, qtbot, lambda: aim.target.spoken().startswith("Not trusted. There is no registration"))
    assert guide.look.colour == "hatched"
    green.desk.register(registration)
    pump(green, qtbot, lambda: guide.look.armed)
    green.desk.select(2)
    pump(green, qtbot, lambda: barred("side is not confirmed"))
    pump(green, qtbot, lambda: guide.look.colour == "hatched")
    assert aim.side.isVisible() and "LEFT" in aim.side.words.text()
    qtbot.keyClick(aim.side.button, Key.Key_Space)
    assert not aim.side.isVisible()
    pump(green, qtbot, lambda: guide.look.trusted)
    session.set_filter("madgwick", None, False)
    pump(green, qtbot, lambda: guide.look.colour == "hatched")
    pump(green, qtbot, lambda: barred("since the registration"))
    assert green.register_panel.chip.text() == "No longer good"
    session.disconnect_source()
    green.refresh()
    assert guide.look.colour == "blank"
    assert aim.target.cross() is None
    assert aim.numbers.error.text() == "---.-"
    assert len(guide.readings) == 1


def test_another_zero_or_tool_axis_ends_the_registration(green: GuideView) -> None:
    said: list[tuple[str, str]] = []
    green.said.connect(lambda tone, text: said.append((tone, text)))
    green.origin_moved()
    assert green.desk.guide.registration is None
    assert said[0][0] == "warn" and "origin was moved" in said[0][1]
    green.desk.register(from_mark((0.0, 1.0, 0.0), "prone", rows=((0, 1),)))
    green.origin_moved()
    assert green.desk.guide.registration is not None, "another way stands on its own"
    green.tool.chosen.emit((0.0, 1.0, 0.0), 0.0)
    assert green.desk.guide.registration is None, "nor does it outlive the tool's axis"
    assert "tool axis" in said[1][1]
    assert green.steps.buttons["tool"].text().endswith("+y")


def test_the_magnetometer_is_used_only_when_asked_for(connected: GuideView, session: Session, qtbot: QtBot) -> None:
    panel = connected.register_panel
    assert not panel.mag.isChecked()
    panel.take()
    qtbot.waitUntil(lambda: not session.use_mag)
    panel.take()
    panel.mag.setChecked(True)
    panel.take()
    qtbot.waitUntil(lambda: session.use_mag)


def test_a_recording_is_offered_and_the_sound_is_off(
    green: GuideView, session: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert green.foot.state.text() == "▲ Nothing is recorded"
    with qtbot.waitSignal(green.record_wanted):
        qtbot.keyClick(green.foot.button, Key.Key_Space)
    green.take()
    assert "cannot be computed again" in green.aim.reading.said.text()
    session.record(tmp_path / "one")
    green.slow_refresh()
    assert green.foot.state.text().startswith("✓ Recording")
    assert not green.foot.button.isVisible()
    beeps: list[bool] = []
    monkeypatch.setattr(QApplication, "beep", lambda *_: beeps.append(True))
    green.refresh()
    assert green.desk.guide.look.beep_hz > 0.0 and beeps == [], "no sound until it is wanted"
    green.aim.sound.setChecked(True)
    pump(green, qtbot, lambda: len(beeps) >= 2)


def test_the_boards_button_is_a_key(view: GuideView, push_attitude: Callable[..., Any]) -> None:
    for status, pressed in ((-1, False), (0, False), (1, True), (1, False), (0, False), (3, True)):
        push_attitude(status=status)
        view.desk.pull()
        assert view.desk.pressed is pressed
    view.go("aim")
    push_attitude(status=0)
    push_attitude(status=1)
    view.refresh()
    assert view.aim.reading.said.text() == "", "without a board the page does not measure"


def test_what_was_made_outlives_the_program(session: Session, tmp_path: Path, owned: Callable[[Any], Any]) -> None:
    store = SettingsStore(tmp_path / "settings.json")
    first = owned(GuideView(session, store))
    type_plan(first, AHEAD, LEFT)
    first.desk.set_axis((0.0, 0.0, 1.0), 0.4)
    first.stop()
    second = owned(GuideView(session, store))
    assert [plan.name for plan in second.desk.guide.plans] == ["Ahead", "L4"]
    assert len(second.plan.sheet.drafts) == 2
    assert second.desk.guide.tool_axis == (0.0, 0.0, 1.0)
    assert second.desk.guide.registration is None


def test_a_broken_session_file_is_said_when_the_page_is_seen(
    session: Session, tmp_path: Path, owned: Callable[[Any], Any], qtbot: QtBot
) -> None:
    (tmp_path / FILE_NAME).write_text("{broken", "utf-8")
    page = owned(GuideView(session, SettingsStore(tmp_path / "settings.json")))
    said: list[str] = []
    page.said.connect(lambda _, text: said.append(text))
    page.show()
    page.slow_refresh()
    assert "not used" in said[0]
    assert (tmp_path / "guidance.broken-1.json").is_file()
    page.slow_refresh()
    assert len(said) == 2


def test_a_folder_that_cannot_be_written_is_said(session: Session, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", "utf-8")
    desk = GuideDesk(session, tmp_path / "file" / FILE_NAME)
    said: list[str] = []
    desk.said.connect(lambda _, text: said.append(text))
    desk.set_plans([AHEAD])
    desk.flush()
    assert "cannot be kept" in said[-1]


def test_the_report_is_saved_and_readings_deleted(
    green: GuideView, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    green.take()
    pump(green, qtbot, lambda: green.desk.guide.look.armed)
    green.take()
    green.go("report")
    report = green.report
    assert report.model.rowCount() == 2
    assert report.summary.text().startswith("Error: mean 0.")
    html, table = tmp_path / "report.html", tmp_path / "report.csv"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(html), ""))
    qtbot.keyClick(report.html_button, Key.Key_Space)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(table), ""))
    qtbot.keyClick(report.csv_button, Key.Key_Space)
    registration = green.desk.guide.registration
    assert registration is not None
    assert registration.id in html.read_text("utf-8") and "Not a medical device" in html.read_text("utf-8")
    assert "Ahead" in table.read_text("utf-8")
    report.table.selectRow(0)
    for answer, left in ((QMessageBox.StandardButton.No, [1, 2]), (QMessageBox.StandardButton.Yes, [2])):
        monkeypatch.setattr(QMessageBox, "question", lambda *_, answer=answer: answer)
        qtbot.keyClick(report.delete_button, Key.Key_Space)
        assert [reading.number for reading in green.desk.guide.readings] == left
