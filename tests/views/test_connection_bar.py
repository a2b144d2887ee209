"""The connection bar: what is chosen is what is connected, and the verdict is in words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from imugui.formats import FORMATS
from imugui.views.connection_bar import BAUDS, ConnectionBar
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Options, Port, Session, Source, State, Status

PORT = Port("/dev/ttyUSB0", "USB Serial", "CH340")
CAPTURE = b"t,ax,ay,az,gx,gy,gz\n" + b"".join(b"%.2f,0,0,9.81,0,0,0\n" % (k / 100) for k in range(50))


@pytest.fixture
def bar(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> ConnectionBar:
    one = ConnectionBar(session, settings_store)
    one.resize(940, one.sizeHint().height())
    return shown(one)


def streaming(session: Session) -> Callable[[], bool]:
    return lambda: session.status().state is State.STREAMING


def button_text(bar: ConnectionBar) -> str:
    return bar.button.text().strip()


def test_every_format_and_baud_can_be_chosen(bar: ConnectionBar) -> None:
    formats = {bar.format.itemData(row): bar.format.itemText(row) for row in range(bar.format.count())}
    assert list(formats) == ["auto", *FORMATS]
    assert all(formats[name] == FORMATS[name].title for name in FORMATS)
    bauds = [bar.baud.itemData(row) for row in range(bar.baud.count())]
    assert bauds[0] == 0
    assert set(BAUDS) <= set(bauds)


def test_connect_and_disconnect(bar: ConnectionBar, session: Session, qtbot: QtBot) -> None:
    bar.source.choose_source("simulator", "rest")
    bar.refresh(session.status())
    assert button_text(bar) == "Connect"
    qtbot.mouseClick(bar.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(streaming(session))
    bar.refresh(session.status())
    assert button_text(bar) == "Disconnect"
    assert (bar.verdict.chip.tone, bar.verdict.chip.text()) == ("good", State.STREAMING.word)
    qtbot.mouseClick(bar.button, Qt.MouseButton.LeftButton)
    assert session.source is None


def test_what_is_connected_is_remembered(
    bar: ConnectionBar, session: Session, settings_store: SettingsStore, owned: Callable[[Any], Any]
) -> None:
    bar.format.choose("triplets")
    bar.connect_to("simulator", "turns")
    kept = settings_store.settings
    assert (kept.transport, kept.address, kept.format) == ("simulator", "turns", "triplets")
    session.disconnect_source()
    again = owned(ConnectionBar(session, settings_store))
    assert again.chosen_source() == Source("simulator", "turns", "triplets")


def test_another_choice_while_connected_is_taken_at_once(bar: ConnectionBar, session: Session, qtbot: QtBot) -> None:
    bar.connect_to("simulator", "rest")
    qtbot.waitUntil(streaming(session))
    row = bar.source.findText("Slow turns")
    bar.source.setCurrentIndex(row)
    bar.source.activated.emit(row)
    assert session.source is not None
    assert session.source.address == "turns"


def test_another_choice_while_unconnected_connects_nothing(bar: ConnectionBar, session: Session) -> None:
    bar.format.setCurrentIndex(1)
    bar.format.activated.emit(1)
    assert session.source is None


def test_baud_is_for_serial_ports_only(bar: ConnectionBar, session: Session) -> None:
    bar.show_ports([PORT])
    for transport, address, visible in (("simulator", "rest", False), ("serial", PORT.device, True)):
        bar.source.choose_source(transport, address)
        bar.baud.choose(115200)
        bar.refresh(session.status())
        assert bar.baud.isVisible() is visible
        assert bar.chosen_source().baud == (115200 if visible else 0)


def test_a_source_from_elsewhere_is_shown(bar: ConnectionBar, session: Session) -> None:
    session.connect_to(Source("simulator", "driving", "colon-line"))
    bar.refresh(session.status())
    assert bar.source.choice().address == "driving"
    assert bar.format.currentData() == "colon-line"


def test_trouble_is_told_in_full_with_a_way_to_the_log(bar: ConnectionBar, session: Session, qtbot: QtBot) -> None:
    bar.connect_to("serial", "/dev/there-is-no-such-port")
    qtbot.waitUntil(lambda: session.status().state.tone == "bad")
    status = session.status()
    bar.refresh(status)
    assert bar.verdict.chip.tone == "bad"
    assert "/dev/there-is-no-such-port" in bar.verdict.sentence()
    assert bar.verdict.sentence() == status.sentence
    with qtbot.waitSignal(bar.verdict.log_wanted):
        qtbot.mouseClick(bar.verdict.log_button, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize(
    ("state", "fmt", "offered"),
    [
        (State.NO_MESSAGES, "", True),
        (State.IMPOSSIBLE, "csv-line", True),
        (State.STALLED, "csv-line", True),
        (State.STALLED, "triplets", False),
        (State.STREAMING, "csv-line", False),
        (State.FAILED, "", False),
    ],
)
def test_columns_can_be_named_where_that_helps(
    bar: ConnectionBar, qtbot: QtBot, state: State, fmt: str, offered: bool
) -> None:
    bar.verdict.refresh(Status(state, "A sentence.", format=fmt))
    assert bar.verdict.columns_button.isVisible() is offered
    if offered:
        with qtbot.waitSignal(bar.columns_wanted):
            qtbot.mouseClick(bar.verdict.columns_button, Qt.MouseButton.LeftButton)


def test_named_columns_are_remembered_for_this_board_only(
    bar: ConnectionBar, session: Session, settings_store: SettingsStore, owned: Callable[[Any], Any]
) -> None:
    bar.show_ports([PORT, Port("/dev/ttyUSB1", "other", "")])
    bar.source.choose_source("serial", PORT.device)
    said = Options(family="mpu9250", columns=("t_ms", "ax_g"), delimiter=";")
    bar.keep_options(said)
    assert bar.chosen_source().options == said
    assert bar.chosen_source().format == "csv-line"
    assert session.source is None
    bar.source.choose_source("serial", "/dev/ttyUSB1")
    assert bar.options() == Options()
    again = owned(ConnectionBar(session, settings_store))
    again.show_ports([PORT])
    again.source.choose_source("serial", PORT.device)
    assert again.options() == said


def test_nonsense_in_the_settings_is_left_out(bar: ConnectionBar, settings_store: SettingsStore) -> None:
    bar.source.choose_source("simulator", "rest")
    settings_store.keep_board("simulator rest", {"family": "x", "columns": [1, 2], "delimiter": 3})
    assert bar.options() == Options()


def test_a_recording_is_asked_for_and_played(
    bar: ConnectionBar, session: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(CAPTURE)
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(path)], ""))
    bar.source.choose_source("replay", "")
    bar.refresh(session.status())
    assert button_text(bar) == "Open…"
    qtbot.mouseClick(bar.button, Qt.MouseButton.LeftButton)
    assert bar.source.choice().key == ("replay", str(path))
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    bar.refresh(session.status())
    assert button_text(bar) == "Connect"


def test_asking_for_a_recording_can_be_cancelled(
    bar: ConnectionBar, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([], ""))
    bar.open_recording()
    assert session.source is None


def test_another_filter_is_taken_at_once(bar: ConnectionBar, session: Session, settings_store: SettingsStore) -> None:
    settings_store.keep_filter("mahony", {"kp": 3.5})
    row = bar.tools.filter.findData("mahony")
    bar.tools.filter.setCurrentIndex(row)
    bar.tools.filter.activated.emit(row)
    assert session.filter_name == "mahony"
    assert session.filter_params.kp == 3.5
    assert settings_store.settings.filter == "mahony"
    session.set_filter("madgwick")
    bar.refresh(session.status())
    assert bar.tools.filter.currentData() == "madgwick"


def test_origin_needs_live_data(bar: ConnectionBar, session: Session, qtbot: QtBot) -> None:
    bar.refresh(session.status())
    assert not bar.tools.set_button.isEnabled()
    bar.connect_to("simulator", "rest")
    qtbot.waitUntil(session.set_origin)
    bar.refresh(session.status())
    assert bar.tools.set_button.isEnabled()
    assert bar.tools.clear_button.isEnabled()
    with qtbot.waitSignal(bar.tools.clear_wanted):
        qtbot.mouseClick(bar.tools.clear_button, Qt.MouseButton.LeftButton)


def test_fits_the_smallest_window(bar: ConnectionBar, session: Session) -> None:
    bar.source.choose_source("serial", "/dev/ttyUSB0")
    bar.refresh(session.status())
    assert bar.minimumSizeHint().width() <= 1024 - 84
