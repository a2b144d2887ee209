"""The reader on real pseudo-terminals: bytes at a pace, an unplugged cable, noise."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pty", reason="this system has no pseudo-terminals")

from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.simulation.errors import PRESETS
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import real_board
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.reader import Reader
from imugui.workers.serial_transport import SerialTransport
from imugui.workers.session import Session, Source, State


class Feed:
    """A virtual board on a pseudo-terminal, fed by a thread."""

    def __init__(self, link: Path, format_name: str) -> None:
        self.port = PtyPort(link)
        self.port.open()
        self.board = PtyBoard(real_board(format_name, "free", PRESETS["mpu9250"]), self.port, time.monotonic())
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.wait(0.004):
            with self._lock:
                self.board.step(time.monotonic())

    def unplug(self) -> None:
        with self._lock:
            self.board.unplug()

    def replug(self) -> None:
        with self._lock:
            self.board.replug()

    def stop(self) -> None:
        self._stop.set()
        self._thread.join()
        self.port.close()


@pytest.fixture
def feed(tmp_path: Path) -> Iterator[Feed]:
    one = Feed(tmp_path / "board", "accel-lines")
    yield one
    one.stop()


@pytest.fixture
def session(qtbot: object) -> Iterator[Session]:
    one = Session()
    yield one
    one.close()


def test_format_rate_and_samples_are_found(feed: Feed, session: Session, gaps_without_cause, qtbot) -> None:
    session.connect_to(Source("serial", feed.port.path))
    qtbot.waitUntil(lambda: session.status().samples > 300)
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    qtbot.waitUntil(lambda: session.status().rate_hz == pytest.approx(138.6, rel=0.1))
    status = session.status()
    assert status.format == "accel-lines"
    assert session.delays.used is not None
    assert session.delays.used.source == "MPU-9250, low-pass of 41 Hz"
    assert status.bad_messages <= 1
    assert gaps_without_cause(session.samples.last(session.samples.count), status.gaps, 138.6) == []
    assert status.missed_rows == 0
    assert status.has_mag
    qtbot.waitUntil(lambda: session.attitude.count >= 300)
    rows = session.attitude.last(50)
    assert np.allclose(np.linalg.norm(rows["quat"], axis=1), 1.0)
    assert (rows["t_publish"] >= rows["t_arrival"]).all()


def test_a_yanked_port_is_said_once_and_comes_back_by_itself(feed: Feed, session: Session, qtbot) -> None:
    said: list[tuple[str, str]] = []
    session.message.connect(lambda tone, text: said.append((tone, text)))
    session.connect_to(Source("serial", feed.port.path))
    qtbot.waitUntil(lambda: session.status().samples > 200)
    feed.unplug()
    qtbot.waitUntil(lambda: session.status().state is State.LOST)
    before = session.samples.count
    qtbot.wait(1200)
    assert [tone for tone, _ in said] == ["error"]
    assert "Plug it in again" in said[0][1]
    feed.replug()
    qtbot.waitUntil(lambda: session.samples.count > before)
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)
    status = session.status()
    assert [tone for tone, _ in said] == ["error", "info"]
    steps = np.diff(session.samples.last(session.samples.count)["t"])
    assert 1 <= status.gaps <= np.count_nonzero(steps > 2.5 / 138.6)
    assert max(steps.max(), 1.0) < status.gap_s + 2.0 / 138.6  # the rate is fitted, not quite that
    assert "are missing" in status.sentence
    qtbot.waitUntil(lambda: session.attitude.count >= before + 20)
    assert np.diff(session.samples.last(500)["t"]).min() > 0.0


def test_a_missing_port_is_waited_for(tmp_path: Path, session: Session, qtbot) -> None:
    session.connect_to(Source("serial", str(tmp_path / "board")))
    qtbot.waitUntil(lambda: session.status().state is State.MISSING)
    assert "no port" in session.status().sentence
    feed = Feed(tmp_path / "board", "triplets")
    try:
        qtbot.waitUntil(lambda: session.status().format == "triplets")
    finally:
        feed.stop()


def test_a_silent_port_and_garbage_are_told_apart(session: Session, qtbot) -> None:
    master, slave = os.openpty()
    try:
        session.connect_to(Source("serial", os.ttyname(slave)))
        qtbot.waitUntil(lambda: session.status().state is State.WAITING)
        qtbot.waitUntil(lambda: session.status().state is State.SILENT)
        noise = np.random.default_rng(1)
        stop = threading.Event()

        def babble() -> None:
            while not stop.wait(0.02):
                os.write(master, noise.integers(0, 256, 60, dtype=np.uint8).tobytes())

        thread = threading.Thread(target=babble)
        thread.start()
        qtbot.waitUntil(lambda: session.status().state is State.NO_MESSAGES)
        stop.set()
        thread.join()
        assert "baud" in session.status().sentence
        assert session.samples.count == 0
    finally:
        session.close()
        os.close(slave)
        os.close(master)


def test_the_loop_body_steps_without_a_thread(qtbot) -> None:
    ring = Ring(SAMPLE, 100)
    source = Source("serial", "loop://", format="triplets", baud=115200)
    transport = SerialTransport(source)
    reader = Reader(source, transport, ring, FusionWorker(ring, Ring(ATTITUDE, 100), Pipeline()))
    reader.step()
    assert reader.link.phase == "open"
    transport._port.write(b"0.01,-0.02,1.00;1.0,2.0,3.0;100.0,200.0,300.0;\r\n" * 4)
    while ring.count < 4:
        reader.step()
    assert ring.last(1)["gyr"][0] == pytest.approx(np.deg2rad([1.0, 2.0, 3.0]))
    reader.finish()
