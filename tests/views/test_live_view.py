"""The Live page: what it shows of the newest row, and that it never shows an old one as alive."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from imugui.fusion.attitude import from_euler
from imugui.views.live_view import LiveView
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Port, Session, Source, State

Push = Callable[..., Any]
BLANK = "---.-"


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> LiveView:
    page = LiveView(session, settings_store)
    page.resize(940, 560)
    return shown(page)


def angles(view: LiveView) -> tuple[str, ...]:
    return tuple(readout.text() for readout in view.angles.readouts.values())


def show(view: LiveView) -> None:
    view.slow_refresh()
    view.refresh()


def test_without_a_source_the_page_says_what_it_will_show(view: LiveView) -> None:
    show(view)
    assert view.empty.isVisible()
    assert not view.scene.isVisible()
    said = " ".join(label.text() for label in view.empty.findChildren(QLabel))
    assert "yaw, pitch and roll" in said
    assert "not a medical device" in said
    assert [button.text().strip() for button in view.empty.buttons()] == [
        "Start the simulated board",
        "Open a recording",
        "Bluetooth",
    ]


def test_yaw_pitch_and_roll(view: LiveView, push_attitude: Push) -> None:
    push_attitude(from_euler(*np.radians((30.04, -20.0, 100.0))))
    show(view)
    assert not view.empty.isVisible()
    assert angles(view) == ("+30.0", "−20.0", "+100.0")
    assert view.heading.compass.text() == "060°"
    assert view.angles.quat.text() != "w ------  x ------  y ------  z ------"


def test_the_picture_turns_with_the_board(view: LiveView, push_attitude: Push) -> None:
    push_attitude()
    show(view)
    level = view.scene.grab().toImage()
    push_attitude(from_euler(0.0, 0.6, 0.6))
    show(view)
    assert view.scene.grab().toImage() != level


@pytest.mark.parametrize(("pitch_deg", "doubtful"), [(84.0, False), (86.0, True), (-89.0, True)])
def test_near_the_pole_yaw_and_roll_are_marked(
    view: LiveView, push_attitude: Push, pitch_deg: float, doubtful: bool
) -> None:
    push_attitude(from_euler(0.1, np.radians(pitch_deg), 0.2))
    show(view)
    doubts = {name: bool(readout.doubt()) for name, readout in view.angles.readouts.items()}
    assert doubts == {"Yaw": doubtful, "Pitch": False, "Roll": doubtful}


def test_stale_data_never_look_alive(view: LiveView, push_attitude: Push, session: Session) -> None:
    push_attitude(from_euler(0.5, 0.1, 0.0))
    show(view)
    alive = view.scene.grab().toImage()
    push_attitude(from_euler(0.5, 0.1, 0.0), age_s=0.7)
    view.refresh()
    assert angles(view) == (BLANK, BLANK, BLANK)
    assert view.scene.accessibleDescription() == State.IDLE.word
    assert view.heading.compass.text() == "---°"
    assert (view.heading.rest.text(), view.heading.field.text()) == ("no data", "no data")
    assert view.scene.grab().toImage() != alive


def test_new_data_bring_the_page_back(view: LiveView, push_attitude: Push) -> None:
    push_attitude(age_s=5.0)
    show(view)
    push_attitude()
    show(view)
    assert angles(view) == ("+0.0", "+0.0", "+0.0")
    assert view.scene.accessibleDescription() == ""


def test_rest_and_field_chips(view: LiveView, push_attitude: Push) -> None:
    push_attitude(rest=True)
    show(view)
    assert (view.heading.rest.tone, view.heading.rest.text()) == ("good", "At rest")
    push_attitude(rest=False)
    show(view)
    assert view.heading.rest.text() == "Moving"


@pytest.mark.parametrize(("convention", "yaw"), [("ENU", "+0.0"), ("NWU", "−90.0"), ("NED", "+90.0")])
def test_display_convention(
    view: LiveView, push_attitude: Push, settings_store: SettingsStore, convention: str, yaw: str
) -> None:
    settings_store.update(convention=convention)
    push_attitude()
    show(view)
    assert angles(view) == (yaw, "+0.0", "+0.0")
    assert view.angles.convention.text() == convention


def test_decimals(view: LiveView, push_attitude: Push, settings_store: SettingsStore) -> None:
    settings_store.update(decimals=2)
    push_attitude(from_euler(np.radians(12.345), 0.0, 0.0))
    show(view)
    assert angles(view)[0] in ("+12.34", "+12.35")


def test_views_from_the_axes(view: LiveView, push_attitude: Push) -> None:
    push_attitude()
    show(view)
    seen = []
    for look in (view.view_default, view.view_from_x, view.view_from_y, view.view_from_z):
        look()
        seen.append(view.scene.camera())
    assert len(set(seen)) == 4
    view.view_default()
    assert view.scene.camera() == seen[0]


def test_a_port_is_asked_for(view: LiveView, qtbot: QtBot) -> None:
    view.show_ports([Port("/dev/ttyUSB7", "USB Serial", "CH340")])
    button = next(one for one in view.empty.buttons() if "ttyUSB7" in one.accessibleName())
    with qtbot.waitSignal(view.wanted) as wanted:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert wanted.args == ["serial", "/dev/ttyUSB7"]


def test_the_board_is_turned_by_hand(view: LiveView, qtbot: QtBot, session: Session) -> None:
    session.connect_to(Source("simulator", "hand"))
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    qtbot.waitUntil(lambda: session.attitude.count > 20)
    show(view)
    assert view.hint.isVisible()
    before = session.attitude.last(1)["quat"][0]
    for _ in range(10):
        qtbot.keyClick(view.scene, Qt.Key.Key_Right)
    qtbot.waitUntil(lambda: abs(float(session.attitude.last(1)["quat"][0] @ before)) < np.cos(np.radians(15) / 2))
    session.disconnect_source()
    show(view)
    assert not view.hint.isVisible()


def test_the_origin_is_told_with_its_age(view: LiveView, qtbot: QtBot, session: Session) -> None:
    session.connect_to(Source("simulator", "rest"))
    qtbot.waitUntil(session.set_origin)

    def told_at_once() -> bool:
        view.origin_moved()
        show(view)
        return view.origin.text() == "Relative to the origin set 0 s ago"

    qtbot.waitUntil(told_at_once)
    qtbot.waitUntil(lambda: float(session.attitude.last(1)["local"][0][0]) > 0.999)
    show(view)
    assert all(abs(float(text.replace("−", "-"))) < 3.0 for text in angles(view))
    session.clear_origin()
    show(view)
    assert view.origin.text() == ""


def test_while_another_filter_has_taken_over_it_says_so(view: LiveView, session: Session, push_attitude: Push) -> None:
    push_attitude(sigma_tilt=0.01, sigma_heading=0.02)
    show(view)
    assert view.angles.sigma.isVisible()
    assert not view.angles.takeover.isVisible()
    session._fusion.filter_note = "VQF has taken over for now: its numbers have failed."
    push_attitude()
    show(view)
    assert not view.angles.sigma.isVisible()
    assert (view.angles.takeover.tone, view.angles.takeover.text()) == ("warn", "VQF has taken over for now")
    assert view.angles.why.text() == "Its numbers have failed."
    session._fusion.filter_note = ""
    show(view)
    assert not view.angles.takeover.isVisible()
    assert not view.angles.why.isVisible()
