"""The Target page, played as a person plays it: with keys, with the mouse, with a study that goes on."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.targeting.game_look import GameLook
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.states import State
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import PREFERENCE
from imugui.targeting.tasks import BUTTON, Task
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.views.target_file import PLAIN
from imugui.views.target_frame import PLAY, RESULTS, STUDY
from imugui.views.target_view import CLICK, NO_BOARD, TargetView
from imugui.workers.session import Session, Source
from imugui.workers.session import State as LinkState

EASY = Task(targets=1, tolerance_px=60.0, selection=BUTTON)
PATIENT = Control(stale_s=1.0)  # a busy machine is not a failure
Show = Callable[[Any], Any]


@pytest.fixture
def page(session: Session, settings_store: SettingsStore, shown: Show, qtbot: QtBot) -> Iterator[TargetView]:
    """The page with nothing connected, an easy task, and its timers."""
    view = shown(TargetView(session, settings_store))
    view.resize(940, 566)
    view.activateWindow()
    view.frame.play.task.set_value(EASY)
    view.frame.play.control.set_value(PATIENT)
    yield view
    view.stop()


@pytest.fixture
def live(page: TargetView, session: Session, qtbot: QtBot) -> TargetView:
    """The same with the virtual board that is turned by hand."""
    session.connect_to(Source("simulator", "hand"))
    qtbot.waitUntil(
        lambda: session.status().state is LinkState.STREAMING and session.attitude.count > 50, timeout=20000
    )
    page.slow_refresh()
    return page


def until(page: TargetView, qtbot: QtBot, true: Callable[[], bool]) -> None:
    """Let the page live until something is so."""

    def look() -> bool:
        page.refresh()
        page.slow_refresh()
        return true()

    qtbot.waitUntil(look)


@pytest.fixture
def in_window(
    session: Session, settings_store: SettingsStore, shown: Show, qtbot: QtBot
) -> tuple[MainWindow, TargetView]:
    """The page in front of the whole window, with a board that waits for a hand."""
    window = shown(MainWindow(session, settings_store))
    window.show_page("target")
    page = window.page()
    assert isinstance(page, TargetView)
    page.frame.play.control.set_value(PATIENT)
    session.connect_to(Source("simulator", "hand"))
    qtbot.waitUntil(lambda: session.status().state is LinkState.STREAMING)
    page.slow_refresh()
    return window, page


def begin(page: TargetView, qtbot: QtBot) -> GameLook:
    """Start a run with Enter, and wait until it is armed."""
    page.frame.scene.setFocus()
    QTest.keyClick(page.frame.scene, Qt.Key.Key_Return)
    until(page, qtbot, lambda: state(page) is State.READY)
    assert page.desk.look is not None
    return page.desk.look


def state(page: TargetView) -> State | None:
    return page.desk.look.state if page.desk.look is not None else None


def test_without_a_board_the_page_teaches(page: TargetView) -> None:
    page.slow_refresh()
    assert page.frame.front is page.frame.empty
    assert not page.frame.run.start_button.isEnabled()
    assert page.frame.run.start_button.toolTip() == NO_BOARD
    page.start()
    assert not page.desk.playing


def test_studies_and_results_need_no_board(page: TargetView) -> None:
    page.frame.select(STUDY)
    assert page.frame.front is page.frame.setup
    page.frame.select(RESULTS)
    assert page.frame.front is page.frame.results
    page.frame.select(PLAY)
    assert page.frame.front is page.frame.empty


def test_played_with_the_keyboard_alone(live: TargetView, qtbot: QtBot) -> None:
    scene = live.frame.scene
    look = begin(live, qtbot)
    assert not live.frame.tabs.isTabEnabled(1)
    held = {
        Qt.Key.Key_Right: lambda one: one.target.x - one.view.x > 15.0,
        Qt.Key.Key_Left: lambda one: one.view.x - one.target.x > 15.0,
        Qt.Key.Key_Up: lambda one: one.target.y - one.view.y > 15.0,
        Qt.Key.Key_Down: lambda one: one.view.y - one.target.y > 15.0,
    }
    QTest.keyPress(scene, Qt.Key.Key_Space)
    until(live, qtbot, lambda: state(live) is State.ENGAGED)
    for key, far in held.items():
        if far(look):
            QTest.keyPress(scene, key)
            until(live, qtbot, lambda far=far: not far(live.desk.look))
            QTest.keyRelease(scene, key)
    QTest.keyRelease(scene, Qt.Key.Key_Space)
    until(live, qtbot, lambda: live.desk.look.position_ok and live.desk.look.mode == "")
    QTest.keyPress(scene, Qt.Key.Key_Z)
    until(live, qtbot, lambda: live.desk.look.mode == "zoom")
    up = live.desk.look.target.size > live.desk.look.view.size
    QTest.keyPress(scene, Qt.Key.Key_Up if up else Qt.Key.Key_Down)
    until(live, qtbot, lambda: live.desk.look.size_ok)
    for key in (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Z):
        QTest.keyRelease(scene, key)
    until(live, qtbot, lambda: live.desk.look.matched and live.desk.look.mode == "")
    QTest.keyClick(scene, Qt.Key.Key_Return)
    until(live, qtbot, lambda: not live.desk.playing)
    (trial,) = live.trials
    assert not trial.error
    assert trial.condition == "custom"
    assert live.frame.tabs.isTabEnabled(1)
    live.frame.select(RESULTS)
    until(live, qtbot, lambda: live.frame.results.shown is not None)
    assert live.frame.results.model.rowCount() == 1


def test_played_with_the_mouse(live: TargetView, qtbot: QtBot) -> None:
    scene, scale = live.frame.scene, live.frame.scene.place().scale
    look = begin(live, qtbot)
    middle = QPoint(scene.width() // 2, scene.height() // 2)
    way = QPoint(round((look.target.x - look.view.x) * scale), -round((look.target.y - look.view.y) * scale))
    QTest.mousePress(scene, Qt.MouseButton.LeftButton, pos=middle)
    until(live, qtbot, lambda: state(live) is State.ENGAGED)
    QTest.mouseMove(scene, middle + way)
    until(live, qtbot, lambda: live.desk.look.position_ok)
    QTest.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=middle + way)
    until(live, qtbot, lambda: live.desk.look.mode == "")
    QTest.mousePress(scene, Qt.MouseButton.RightButton, pos=middle)
    until(live, qtbot, lambda: live.desk.look.mode == "zoom")
    grow = (look.target.size - live.desk.look.view.size) / 2.0 * scale
    QTest.mouseMove(scene, middle - QPoint(0, round(grow)))
    until(live, qtbot, lambda: live.desk.look.matched)
    QTest.mouseRelease(scene, Qt.MouseButton.RightButton, pos=middle)
    QTest.mouseClick(scene, Qt.MouseButton.MiddleButton, pos=middle)
    until(live, qtbot, lambda: not live.desk.playing)
    assert [trial.error for trial in live.trials] == [False]


def test_a_latched_mapping_goes_on_without_a_key(live: TargetView, qtbot: QtBot) -> None:
    latched = dataclasses.replace(PRESETS["thesis position"], stale_s=1.0, lag_s=0.0)
    live.frame.play.control.set_value(latched)
    scene = live.frame.scene
    look = begin(live, qtbot)
    QTest.keyClick(scene, Qt.Key.Key_Space)  # short: pan
    until(live, qtbot, lambda: live.desk.look.mode == "pan")
    QTest.mousePress(scene, Qt.MouseButton.LeftButton, pos=QPoint(200, 200))
    QTest.mouseMove(scene, QPoint(240, 200))
    QTest.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=QPoint(240, 200))
    until(live, qtbot, lambda: live.desk.look.view.x > look.view.x + 20.0)
    assert live.desk.look.mode == "pan"
    QTest.keyClick(scene, Qt.Key.Key_Space)
    until(live, qtbot, lambda: live.desk.look.mode == "")


def test_escape_stops_wherever_the_focus_is(in_window: tuple[MainWindow, TargetView], qtbot: QtBot) -> None:
    window, page = in_window
    for focus in (page.frame.scene, page.frame.run.leave_button, window.bar.button):
        begin(page, qtbot)
        focus.setFocus()
        QTest.keyClick(focus, Qt.Key.Key_Escape)
        until(page, qtbot, lambda: state(page) is State.FAULT)
        page.frame.scene.setFocus()
        QTest.keyClick(page.frame.scene, Qt.Key.Key_Return)
        QTest.keyClick(page.frame.scene, Qt.Key.Key_Backspace)
        until(page, qtbot, lambda: state(page) is State.DISARMED)
        QTest.keyClick(page.frame.scene, Qt.Key.Key_Return)
        until(page, qtbot, lambda: state(page) is State.READY)
        page.leave()


def test_another_page_in_front_disarms(in_window: tuple[MainWindow, TargetView], qtbot: QtBot) -> None:
    window, page = in_window
    begin(page, qtbot)
    window.show_page("live")
    until(page, qtbot, lambda: state(page) is State.DISARMED)


def test_lost_keys_are_said(live: TargetView, qtbot: QtBot) -> None:
    begin(live, qtbot)
    qtbot.waitUntil(live.frame.scene.hasFocus)
    live.slow_refresh()
    assert live.frame.scene.hint != CLICK
    live.frame.run.leave_button.setFocus()
    live.slow_refresh()
    assert live.frame.scene.hint == CLICK


def test_what_is_recorded_is_said(live: TargetView, session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    foot = live.frame.foot
    assert "Nothing is recorded" in foot.state.text()
    with qtbot.waitSignal(live.record_wanted):
        foot.button.click()
    begin(live, qtbot)
    assert session.record(tmp_path / "one.imugui")
    live.slow_refresh()
    assert "began before the recording" in foot.why.whole
    live.leave()
    begin(live, qtbot)
    live.slow_refresh()
    assert foot.why.whole == "Runs are kept in one.imugui."


def test_settings_are_remembered(session: Session, tmp_path: Path, owned: Show, qapp: QApplication) -> None:
    store = SettingsStore(tmp_path / "settings.json")
    first = owned(TargetView(session, store))
    first.frame.play.task.form.editor("targets").setValue(9)
    first.frame.play.play.editor("picture").setCurrentText(PLAIN)
    first.stop()
    second = owned(TargetView(session, store))
    assert second.frame.play.task.value().targets == 9
    assert second.frame.scene.plain


def small(**values: object) -> StudyPlan:
    """One person, two conditions, one block of one easy target."""
    made = {"blocks": 1, "practice_runs": 0, "rest_s": 0.0, **values}
    return StudyPlan(("P01",), {"a": PATIENT, "b": PATIENT}, EASY, **made)  # type: ignore[arg-type]


def test_a_study_records_each_run_and_asks_at_the_end(
    live: TargetView, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    live.frame.select(STUDY)
    live.create_study(tmp_path / "study", small())
    assert live.frame.front is live.frame.scene
    assert live.frame.foot.why.whole == "Each run of the study is recorded into its folder."
    for _ in range(2):
        live.start()
        until(live, qtbot, lambda: state(live) is State.READY and live.desk.playing)
        assert session.recording is not None
        assert live.desk.recorded
        QTest.keyPress(live.frame.scene, Qt.Key.Key_Space)
        until(live, qtbot, lambda: state(live) is State.ENGAGED)
        QTest.keyRelease(live.frame.scene, Qt.Key.Key_Space)
        live.desk.go_on()  # selects where the view stands: a miss, but a target
        until(live, qtbot, lambda: not live.desk.playing)
        assert session.recording is None
    assert len(list((tmp_path / "study").glob("*.imugui"))) == 2
    assert live.study_desk.step.kind == PREFERENCE
    until(live, qtbot, lambda: live.frame.front is live.frame.questions)
    live.frame.questions.choices[0].click()
    until(live, qtbot, lambda: live.frame.front is live.frame.scene)
    assert live.frame.run.start_button.text().strip() == "Through"
    live.frame.study.results_button.click()
    until(live, qtbot, lambda: live.frame.results.shown is not None)
    assert live.frame.results.model.rowCount() == 2


def test_a_killed_study_goes_on_at_its_block(
    live: TargetView, session: Session, qtbot: QtBot, tmp_path: Path, owned: Show
) -> None:
    store = SettingsStore(tmp_path / "settings.json")
    live.frame.select(STUDY)
    live.create_study(tmp_path / "study", small())
    live.start()
    until(live, qtbot, lambda: state(live) is State.READY)
    # another window opens the folder as it lies on the disk, as after a crash
    other = owned(TargetView(session, store))
    other.open_study(tmp_path / "study")
    assert (other.study_desk.step.condition, other.study_desk.step.block) == ("a", 1)
    other.stop()
    third = owned(TargetView(session, store))
    assert third.frame.setup.resume_button.text() == "Resume study"
