"""PortWatch: tells every change of the serial ports, from its own thread."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from imugui.views import port_watch
from imugui.views.port_watch import PortWatch
from imugui.workers.session import Port, Session

ONE, TWO = Port("/dev/ttyUSB0", "", ""), Port("/dev/ttyUSB1", "", "")


@pytest.fixture
def ports(monkeypatch: pytest.MonkeyPatch) -> list[Port]:
    """What the computer has; a test changes it."""
    there = [ONE]
    monkeypatch.setattr(Session, "serial_ports", lambda self: list(there))
    monkeypatch.setattr(port_watch, "PERIOD_S", 0.01)
    return there


def test_only_changes_are_told(session: Session, ports: list[Port]) -> None:
    told: list[list[Port]] = []
    watch = PortWatch(session)
    watch.found.connect(told.append)
    for _ in range(3):
        watch.look()
    ports.append(TWO)
    watch.look()
    ports.clear()
    watch.look()
    assert told == [[ONE], [ONE, TWO], []]


def test_a_port_that_goes_while_it_is_looked_at(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(self: Session) -> list[Port]:
        raise OSError("No such device")

    monkeypatch.setattr(Session, "serial_ports", gone)
    told: list[list[Port]] = []
    watch = PortWatch(session)
    watch.found.connect(told.append)
    watch.look()
    assert told == []


def test_the_thread_tells_pauses_and_stops(session: Session, ports: list[Port], qtbot: QtBot) -> None:
    watch = PortWatch(session)
    with qtbot.waitSignal(watch.found):
        watch.start()
    watch.paused.set()
    watch.stop()
    assert watch.isFinished()
