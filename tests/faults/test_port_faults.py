"""What ports do to a program: closed in a line, back under another name, flooded, taken by another program."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import serial
import serial.tools.list_ports

from imugui.recording import raw, read_recording
from imugui.recording.folder import RAW
from imugui.workers.session import Session, State
from imugui.workers.transport import Source
from imugui.workers.verify import verify

Connect = Callable[[], None]
HALF = b"0.123,4.56,-7"


def test_a_port_that_closes_in_a_line_loses_nothing_that_was_whole(
    connect: Connect, cable: Any, session: Session, said: list[str], qtbot: Any, tmp_path: Path
) -> None:
    connect()
    assert session.record(tmp_path / "cut.imugui")
    cable.send(cable.messages(60) + HALF)
    qtbot.waitUntil(lambda: session.samples.count == 65)
    qtbot.waitUntil(lambda: session.recording.rows >= 60)
    cable.pull()
    qtbot.waitUntil(lambda: session.status().state is State.LOST and bool(said))
    assert "Plug it in again" in said[-1]
    cable.plug()
    qtbot.waitUntil(lambda: session.status().state is not State.LOST)
    cable.send(cable.messages(40))
    qtbot.waitUntil(lambda: session.samples.count == 105)
    assert "is back" in said[-1]
    assert session.status().bad_messages == 0
    assert any("half a line dropped" in text for _, _, text in session.link_log())
    folder = session.stop_recording()
    assert folder is not None
    kept = read_recording(folder)
    assert len(kept.samples) == 100
    assert kept.warnings == ()
    # bytes of before the recording come first, and what was half is kept as it came
    assert HALF in b"".join(data for arrival, data in raw.read(folder / RAW) if arrival == arrival)
    assert [event.kind for event in kept.events] == ["start", "lost", "connect"]


def test_what_arrives_while_a_recording_ends_has_its_bytes_or_is_not_in_it(
    connect: Connect, cable: Any, session: Session, qtbot: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    connect()
    assert session.record(tmp_path / "ends.imugui")
    cable.send(cable.messages(60))
    qtbot.waitUntil(lambda: session.recording.rows >= 60)
    reader = session._reader
    real = reader.record

    def record(tap: Any) -> None:
        real(tap)
        cable.send(cable.messages(20))
        qtbot.waitUntil(lambda: session.samples.count == 85)

    monkeypatch.setattr(reader, "record", record)
    folder = session.stop_recording()
    assert folder is not None
    result = verify(folder)
    assert result.raw_samples == len(read_recording(folder).samples) >= 60
    assert result.sample_difference == 0.0


def test_a_board_that_comes_back_under_another_name_is_found(
    connect: Connect,
    cable: Any,
    session: Session,
    said: list[str],
    qtbot: Any,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ports = [str(cable.link)]

    def comports() -> list[Any]:
        about = {"vid": 0x0403, "pid": 0x6001, "serial_number": "A600", "location": "1-2", "description": "FT232"}
        return [SimpleNamespace(device=device, **about) for device in ports]

    monkeypatch.setattr(serial.tools.list_ports, "comports", comports)
    connect()
    cable.pull()
    ports.clear()
    qtbot.waitUntil(lambda: session.status().state is State.LOST)
    cable.link = tmp_path / "another"
    cable.plug()
    ports.append(str(cable.link))
    qtbot.waitUntil(lambda: session.status().state is not State.LOST)
    cable.send(cable.messages(20))
    qtbot.waitUntil(lambda: session.samples.count == 25)
    assert said[-1] == f"{cable.link} is back."
    assert session.board is not None
    assert session.board.address == "A600"  # and with it its profile


def test_a_flood_is_read_to_the_last_message(connect: Connect, cable: Any, session: Session, qtbot: Any) -> None:
    connect()
    flood = cable.messages(3900)
    thread = threading.Thread(target=cable.send, args=(flood,))
    thread.start()
    qtbot.waitUntil(lambda: session.attitude.count == session.samples.count == 3905)
    thread.join()
    status = session.status()
    assert (status.samples, status.bad_messages, status.missed_rows) == (3905, 0, 0)
    assert np.diff(session.samples.last(3900)["t"]).min() > 0.0


def test_two_programs_on_one_port(connect: Connect, cable: Any, session: Session, said: list[str], qtbot: Any) -> None:
    other = serial.Serial(str(cable.link), exclusive=True)
    session.connect_to(cable.source)
    qtbot.waitUntil(lambda: session.status().state is State.BUSY and bool(said))
    assert "in use by another program" in said[-1]
    other.close()
    connect()
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)


def test_a_port_that_does_not_open_holds_nobody_up(
    session: Session, cable: Any, qtbot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside, may_go_on, real = threading.Event(), threading.Event(), serial.serial_for_url

    def slow(*args: Any, **options: Any) -> Any:
        inside.set()
        may_go_on.wait(60)
        return real(*args, **options)

    monkeypatch.setattr(serial, "serial_for_url", slow)
    session.connect_to(cable.source)
    assert inside.wait(30)
    session.disconnect_source()
    assert not may_go_on.is_set()
    assert session.status().state is State.IDLE
    session.connect_to(Source("simulator", "rest"))
    qtbot.waitUntil(lambda: session.samples.count > 10)
    may_go_on.set()
    session.close()
    cable.send(cable.messages(5))
    assert session.source is None
