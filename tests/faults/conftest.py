"""A port whose far end is the test's, and a session on it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from imugui.formats import FORMATS
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.workers.session import Session, Source, State

FORMAT = "csv-line"


class Cable:
    """A pseudo-terminal behind a link: what is sent is exactly what the program reads."""

    def __init__(self, link: Path) -> None:
        self.link = link
        self._rows = VirtualBoard("free", 100.0, PRESETS["mpu9250-calibrated"], 1).rows(4000)
        self._encoder = FORMATS[FORMAT].encoder()
        self._sent = 0
        self.plug()

    @property
    def source(self) -> Source:
        """How to connect to it."""
        return Source("serial", str(self.link), FORMAT, 115200)

    def plug(self) -> None:
        """Plug in, at a new terminal under the same link."""
        tty = pytest.importorskip("tty", reason="this system has no pseudo-terminals")
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(self._slave))

    def pull(self) -> None:
        """Pull the plug."""
        for end in (self._slave, self._master):
            os.close(end)
        self.link.unlink(missing_ok=True)

    def send(self, data: bytes) -> None:
        """Write all of it, however slowly it is read."""
        while data:
            data = data[os.write(self._master, data) :]

    def messages(self, n: int) -> bytes:
        """The next n messages of the board."""
        rows: Rows = self._rows[self._sent : self._sent + n]
        self._sent += n
        return self._encoder.encode(rows)

    def begin(self) -> None:
        """What the board sends first, and enough to be known by."""
        self.send(self._encoder.preamble() + self.messages(5))


@pytest.fixture
def cable(tmp_path: Path) -> Iterator[Cable]:
    one = Cable(tmp_path / "board")
    yield one
    if one.link.is_symlink():
        one.pull()


@pytest.fixture
def session(qapp: object) -> Iterator[Session]:
    one = Session()
    yield one
    one.close()


@pytest.fixture
def said(session: Session) -> list[str]:
    """All that the session has told the user."""
    texts: list[str] = []
    session.message.connect(lambda _, text: texts.append(text))
    return texts


@pytest.fixture
def connect(session: Session, cable: Cable, qtbot: Any) -> Callable[[], None]:
    """Connect the session to the cable, and wait for the first samples."""

    def do() -> None:
        session.connect_to(cable.source)
        qtbot.waitUntil(lambda: session.status().state is State.WAITING)
        cable.begin()
        qtbot.waitUntil(lambda: session.samples.count == 5)

    return do
