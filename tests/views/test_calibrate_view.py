"""The Calibrate page: overview, guided flows, and that nothing changes before Apply."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, Qt
from PySide6.QtWidgets import QFileDialog, QMessageBox
from pytestqt.qtbot import QtBot

from imugui.calibration.accelerometer_flows import METHODS
from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_store import ProfileStore
from imugui.fusion.quaternion import from_rotation_vector
from imugui.samples import SAMPLE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.path import Floats
from imugui.simulation.path import Path as Course
from imugui.views.calibrate_guides import GUIDES
from imugui.views.calibrate_parts import PARTS, PartState, next_part
from imugui.views.calibrate_view import CalibrateView
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source, State

RATE_HZ = 50.0
ERRORS = replace(PRESETS["mpu9250"], mag_rate_hz=0.0)
SEED = 3


class AboutZ(Course):
    """Rests for two seconds, then turns about the vertical."""

    def quats(self, t: Floats) -> Floats:
        return from_rotation_vector(0.7 * np.maximum(np.asarray(t) - 2.0, 0.0)[:, None] * np.array([0.0, 0.0, 1.0]))


def rows_of(motion: str | Course, seconds: float, start: float = 0.0) -> Rows:
    rows = VirtualBoard(motion, RATE_HZ, ERRORS, SEED).rows(int(seconds * RATE_HZ))
    rows["t"] += start
    return rows


@pytest.fixture
def session(qapp: object, tmp_path: Path) -> Iterator[Session]:
    one = Session(profiles=ProfileStore(tmp_path / "profiles"))
    yield one
    one.close()


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> Iterator[CalibrateView]:
    page = CalibrateView(session, settings_store)
    page.resize(940, 566)
    yield shown(page)
    page.stop()


@pytest.fixture
def connected(view: CalibrateView, session: Session, qtbot: QtBot) -> CalibrateView:
    session.connect_to(Source("simulator", "rest", errors="mpu9250"))
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    qtbot.waitUntil(lambda: session.attitude.count > 5)
    view.slow_refresh()
    return view


def pump(view: CalibrateView, qtbot: QtBot, until: Callable[[], bool]) -> None:
    """Let the page work as the window's timers do, until a condition holds."""

    def step() -> bool:
        view.slow_refresh()
        view.refresh()
        return until()

    qtbot.waitUntil(step)


def press(view: CalibrateView, key: Qt.Key, qtbot: QtBot) -> None:
    qtbot.keyClick(view.focusWidget() or view, key)


def verdict_shown(view: CalibrateView) -> bool:
    return view.flow.card.isVisible()


def keep_profile(session: Session, address: str, name: str = "") -> Profile:
    profile = Profile(Board("serial", address, name))
    session.profiles.save(profile)
    return profile


def test_without_a_board_the_page_says_what_it_will_show(view: CalibrateView) -> None:
    assert view.empty.isVisible()


def test_every_part_has_a_way() -> None:
    assert {guide.part for guide in GUIDES.values()} == set(PARTS)
    assert {guide.key.removeprefix("acc ") for guide in GUIDES.values() if guide.part == "acc"} == {*METHODS, "fall"}
    assert all(guide.words and guide.accuracy and guide.title for guide in GUIDES.values())


def test_the_next_step_is_what_is_missing_first() -> None:
    states = dict.fromkeys(PARTS, PartState())
    good = PartState("good", "Good", "1 deg")
    assert next_part(states, has_mag=True) == "gyr"
    assert next_part(states | {"gyr": good}, has_mag=True) == "acc"
    assert next_part(states | {"gyr": good, "acc": good}, has_mag=False) == ""
    done = states | dict.fromkeys(("gyr", "acc", "axes", "mag"), good)
    assert next_part(done, has_mag=True) == ""
    assert next_part(done | {"gyr": PartState("warn", "Old")}, has_mag=True) == "gyr"


def test_the_gyroscope_is_calibrated_by_keyboard(connected: CalibrateView, session: Session, qtbot: QtBot) -> None:
    before = session.profile
    connected.overview.next.setFocus()
    assert "Gyroscope" in connected.overview.next.text()
    press(connected, Qt.Key.Key_Space, qtbot)
    assert connected.flow.isVisible()
    pump(connected, qtbot, lambda: connected.flow.apply.isVisible())
    assert connected.flow.card.chip.text() == "Good"
    assert any("deg/s" in line for line in connected.flow.card.figures.texts())
    assert session.profile is before
    assert session.profiles.entries() == []
    connected.flow.apply.setFocus()
    press(connected, Qt.Key.Key_Space, qtbot)
    assert session.profile is not None and session.profile.gyroscope is not None
    assert len(session.profiles.entries()) == 1
    assert connected.overview.isVisible()
    assert connected.overview.cards["gyr"].chip.text() == "Good"
    assert "Accelerometer" in connected.overview.next.text()


def test_cancel_changes_nothing(connected: CalibrateView, session: Session, qtbot: QtBot) -> None:
    connected.calibrate("gyr")
    pump(connected, qtbot, lambda: verdict_shown(connected))
    before = session.profile
    press(connected, Qt.Key.Key_Backspace, qtbot)
    assert connected.overview.isVisible()
    assert not connected.flow.running
    assert session.profile is before
    assert session.profiles.entries() == []


def test_a_board_that_is_handled_gets_no_verdict(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("gyr")
    session.samples.push(rows_of("free", 20.0)[200:])
    pump(view, qtbot, lambda: "handled" in view.flow.missing.text())
    assert not view.flow.apply.isVisible()
    assert not verdict_shown(view)
    view.flow.accept()
    assert session.profile is None


def test_the_accelerometer_offers_its_ways(connected: CalibrateView, qtbot: QtBot) -> None:
    connected.calibrate("acc")
    assert connected.choice.isVisible()
    press(connected, Qt.Key.Key_Space, qtbot)
    assert connected.flow.guide is GUIDES["acc many"]
    pump(connected, qtbot, lambda: connected.flow.picture.cube.reached == 1)
    assert "Next" in connected.flow.sentence.text()


def test_the_magnetometer_from_cloud_to_check(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("mag")
    session.samples.push(rows_of("free", 45.0))
    pump(view, qtbot, lambda: view.flow.picture.sphere.cloud_size > 1000)
    sphere = view.flow.picture.sphere.sphere
    assert 0.3 < float((sphere.levels > 0).mean()) <= 1.0
    assert any("Directions seen" in line for line in view.flow.figures.texts())
    session.samples.push(rows_of("free", 80.0)[int(45 * RATE_HZ) :])
    pump(view, qtbot, lambda: view.flow.enough.isVisible() or "check" in view.flow.sentence.text())
    view.flow.finish()
    pump(view, qtbot, lambda: "lay the board flat" in view.flow.sentence.text())
    assert view.flow.picture.sphere.sphere.goal is None
    turn = rows_of(AboutZ(), 13.0, start=100.0)
    session.samples.push(turn[:100])
    pump(view, qtbot, lambda: "once around" in view.flow.sentence.text())
    session.samples.push(turn[100:])
    pump(view, qtbot, lambda: verdict_shown(view))
    assert view.flow.card.chip.text() in ("Clean", "Suspect")
    table = view.flow.card.table_texts()
    assert any("seed 001" in cells[0] for cells in table)
    assert table[1][0] == "This calibration"


def test_a_board_that_is_still_gains_nothing(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("mag")
    session.samples.push(rows_of("rest", 30.0))
    pump(view, qtbot, lambda: "still" in view.flow.sentence.text())
    assert view.flow.bar.value() == 0
    assert not view.flow.enough.isVisible()


def test_a_gap_is_said_and_the_flow_waits(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("gyr")
    view.slow_refresh()
    assert "waits" in view.flow.trouble.text()
    session.samples.push(rows_of("rest", 1.0))
    view.slow_refresh()
    session.samples.push(rows_of("rest", 1.0, start=30.0))
    view.slow_refresh()
    assert view.flow.gaps == 1


def test_a_hidden_page_pauses(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("gyr")
    view.hide()
    session.samples.push(rows_of("rest", 4.0))
    view.show()
    qtbot.waitExposed(view)
    view.slow_refresh()
    session.samples.push(rows_of("rest", 1.0, start=60.0))
    pump(view, qtbot, lambda: "1.0 s" in view.flow.missing.text())
    assert not verdict_shown(view)


def test_temperature_says_what_is_missing(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    for key in ("temperature", "mounting", "axes", "acc fall", "acc six", "acc flat"):
        view.begin(key)
        session.samples.push(rows_of("rest", 2.0))
        pump(view, qtbot, lambda: view.flow.sentence.text() != "" and view.flow.missing.text() != "")
        assert view.flow.title.text() == GUIDES[key].title


def test_profiles_are_listed_and_renamed(view: CalibrateView, session: Session) -> None:
    keep_profile(session, "A1", "left hand")
    broken = session.profiles.folder / "broken.json"
    broken.write_text("{", encoding="utf-8")
    view.profiles.reload()
    view.slow_refresh()
    assert view.profiles.isVisible()
    texts = [view.profiles.list.item(row).text() for row in range(view.profiles.count())]
    assert texts == ["left hand", "✕ broken.json"]
    assert view.profiles.list.item(1).toolTip() != ""
    view.profiles.list.item(0).setText("right hand")
    profile = session.profiles.find(Board("serial", "A1"))
    assert profile is not None and profile.board.name == "right hand"


def test_delete_asks_first(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    keep_profile(session, "A1", "left hand")
    view.profiles.reload()
    view.profiles.do("delete")
    box = view.findChild(QMessageBox)
    assert box is not None and "left hand" in box.text()
    box.reject()
    assert len(session.profiles.entries()) == 1
    QCoreApplication.processEvents()
    view.profiles.do("delete")
    boxes = [one for one in view.findChildren(QMessageBox) if one.isVisible()]
    qtbot.mouseClick(boxes[0].button(QMessageBox.StandardButton.Yes), Qt.MouseButton.LeftButton)
    assert session.profiles.entries() == []


def test_export_and_import(
    view: CalibrateView, session: Session, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    keep_profile(session, "A1", "left hand")
    view.profiles.reload()
    there = tmp_path / "there.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(there), ""))
    view.profiles.do("export")
    session.profiles.remove(Board("serial", "A1"))
    view.profiles.reload()
    assert view.profiles.count() == 0
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(there), ""))
    view.profiles.do("take")
    assert view.profiles.count() == 1


def test_a_foreign_file_is_refused_in_words(
    view: CalibrateView, session: Session, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, qtbot: QtBot
) -> None:
    foreign = tmp_path / "foreign.json"
    foreign.write_text('{"hello": 1}', encoding="utf-8")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(foreign), ""))
    with qtbot.waitSignal(view.said) as said:
        view.profiles.do("take")
    assert said.args[0] == "error"
    assert session.profiles.entries() == []


def test_the_certificate_is_shown_and_saved(
    view: CalibrateView, session: Session, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, qtbot: QtBot
) -> None:
    keep_profile(session, "A1", "left <hand>")
    view.profiles.reload()
    view.slow_refresh()
    view.profiles.do("certificate")
    assert view.certificate.isVisible()
    assert "left <hand>" in view.certificate.title.text()
    assert "not a medical device" in view.certificate.text.toPlainText()
    there = tmp_path / "certificate.html"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(there), ""))
    qtbot.mouseClick(view.certificate.save, Qt.MouseButton.LeftButton)
    assert "left &lt;hand&gt;" in there.read_text(encoding="utf-8")
    press(view, Qt.Key.Key_Backspace, qtbot)
    assert view.overview.isVisible()


def test_the_strip_shows_the_field_now(connected: CalibrateView) -> None:
    assert connected.trust.isVisible()
    assert "µT" in connected.trust.words.whole
    assert connected.trust.chip.text() == "Not calibrated"


def test_rows_without_a_field_do_no_harm(view: CalibrateView, session: Session, qtbot: QtBot) -> None:
    view.begin("mag")
    rows = empty_rows(SAMPLE, 50)
    rows["t"] = np.arange(50) / RATE_HZ
    session.samples.push(rows)
    pump(view, qtbot, lambda: view.flow.sentence.text() != "")
    assert view.flow.bar.value() == 0
