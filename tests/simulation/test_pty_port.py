"""The virtual board as a serial port, read through a real pseudo-terminal."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

if sys.platform == "win32":
    pytest.skip("no pseudo-terminals on Windows", allow_module_level=True)

from collections.abc import Iterator

from imugui.formats import FORMATS, STREAM_FORMATS
from imugui.formats.base import Options
from imugui.simulation import pty_port
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import real_board


class Reader:
    """A plain reader of a port, as a serial program opens it."""

    def __init__(self, path: str) -> None:
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)

    def read(self) -> bytes:
        """What has arrived so far, without waiting."""
        parts = []
        with contextlib.suppress(BlockingIOError):
            while part := os.read(self.fd, 65536):
                parts.append(part)
        return b"".join(parts)

    def read_all(self) -> bytes:
        """Everything that was written before; a pseudo-terminal passes a block on after a moment."""
        parts = []
        while select.select([self.fd], [], [], 0.15)[0]:
            parts.append(self.read())
        return b"".join(parts)

    def close(self) -> None:
        os.close(self.fd)


@pytest.fixture
def port(tmp_path: Path) -> Iterator[PtyPort]:
    port = PtyPort(tmp_path / "board")
    port.open()
    yield port
    port.close()


@pytest.fixture
def reader(port: PtyPort) -> Iterator[Reader]:
    reader = Reader(port.path)
    yield reader
    reader.close()


@pytest.mark.parametrize("form", STREAM_FORMATS)
def test_a_second_of_any_format_arrives_whole(port: PtyPort, reader: Reader, form: str) -> None:
    rate_hz = FORMATS[form].rate_hz
    board = PtyBoard(real_board(form, "turns", seed=2), port, start_t=50.0, boot_s=0.0)
    decoder = FORMATS[form].decoder(Options())
    sent, rows = 0, 0
    for k in range(101):
        sent += board.step(50.0 + k / 100)
        rows += len(decoder.feed(reader.read(), 50.0 + k / 100))
    rows += len(decoder.feed(reader.read_all(), 52.0)) + len(decoder.flush(52.0))
    assert rows == sent == int(rate_hz) + 1
    assert decoder.counts.bad_messages == 0
    assert port.dropped_bytes == 0


def test_bytes_pass_unchanged_in_both_directions_and_are_not_echoed(port: PtyPort, reader: Reader) -> None:
    every_byte = bytes(range(256))
    os.write(reader.fd, b"are you there?\n")
    assert port.write(every_byte) == 0
    assert reader.read_all() == every_byte


def test_opening_the_port_resets_the_board_as_on_an_arduino(port: PtyPort) -> None:
    board = PtyBoard(real_board("accel-lines", "rest"), port, start_t=0.0, boot_s=0.2)
    assert board.step(1.0) == 0
    for opened_at in (2.0, 4.0):
        reader = Reader(port.path)
        assert board.step(opened_at) == board.step(opened_at + 0.1) == 0
        assert board.step(opened_at + 0.25) > 0
        assert reader.read_all().startswith(b"RESET\r\n")
        reader.close()
        assert board.step(opened_at + 1.0) == 0
    assert board.unheard + board.pacer.skipped > 400


def test_a_reader_that_stalls_never_blocks_the_board_and_loses_whole_lines(port: PtyPort, reader: Reader) -> None:
    board = PtyBoard(real_board("triplets", "turns", seed=3), port, start_t=0.0, boot_s=0.0)
    sent = sum(board.step(0.2 * k) for k in range(100))
    assert sent == int(19.8 * board.pacer.rate_hz) + 1
    assert port.dropped_bytes > 20_000
    chunk = reader.read_all()
    for k in range(100, 110):
        board.step(0.2 * k)
        chunk += reader.read()
    chunk += reader.read_all()
    decoder = FORMATS["triplets"].decoder(Options())
    rows = len(decoder.feed(chunk, 0.0))
    assert decoder.counts.bad_messages == 0
    assert chunk.endswith(b"\n")
    assert rows > 10 * 0.2 * 0.9 * board.pacer.rate_hz


def test_what_one_reader_left_is_not_given_to_the_next(port: PtyPort) -> None:
    board = PtyBoard(real_board("triplets", "turns"), port, start_t=0.0, boot_s=0.0)
    reader = Reader(port.path)
    for k in range(100):
        board.step(0.2 * k)
    reader.close()
    board.step(20.0)
    reader = Reader(port.path)
    assert reader.read_all() == b""
    board.step(20.1)
    assert reader.read_all().startswith(b"---Parameters")
    reader.close()


def test_unplugging_ends_the_readers_stream_and_replugging_serves_the_same_link(port: PtyPort) -> None:
    board = PtyBoard(real_board("triplets", "turns"), port, start_t=0.0, boot_s=0.0)
    reader, link = Reader(port.path), Path(port.path)
    board.step(0.1)
    assert reader.read_all()
    board.unplug()
    with pytest.raises(OSError, match="Input/output error"):
        os.write(reader.fd, b"x")
    reader.close()
    assert not link.is_symlink()
    assert not port.has_reader()
    assert board.step(0.2) == 0
    board.unplug()
    board.replug()
    reader = Reader(str(link))
    assert board.step(0.3) > 0
    assert b";" in reader.read_all()
    reader.close()


def test_a_link_replaces_an_old_link_but_never_a_file(tmp_path: Path) -> None:
    link = tmp_path / "ttyBoard"
    link.symlink_to("/dev/pts/nowhere")
    port = PtyPort(link)
    port.open()
    assert link.resolve() == Path(port.name)
    port.close()
    assert not link.is_symlink()
    link.write_text("precious")
    with pytest.raises(FileExistsError, match="exists and is not a link"):
        port.open()
    assert link.read_text() == "precious"
    assert not port.has_reader()


def test_a_link_that_cannot_be_made_is_said_and_leaves_nothing_open(tmp_path: Path) -> None:
    port = PtyPort(tmp_path / "nowhere" / "board")
    with pytest.raises(OSError, match=r"nowhere/board to the virtual port cannot be made: No such file"):
        port.open()
    assert port.name == ""


def test_a_link_that_another_port_took_over_is_left_alone(tmp_path: Path) -> None:
    first, second = PtyPort(tmp_path / "board"), PtyPort(tmp_path / "board")
    first.open()
    second.open()
    first.close()
    assert Path(second.path).resolve() == Path(second.name)
    second.close()


def test_without_pseudo_terminals_the_reason_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pty_port.sys, "platform", "win32")
    with pytest.raises(OSError, match="no pseudo-terminals"):
        PtyPort().open()


def test_the_loop_speaks_by_the_clock_until_it_is_told_to_stop(port: PtyPort, reader: Reader) -> None:
    board = PtyBoard(real_board("colon-line", "aiming"), port, start_t=time.monotonic(), boot_s=0.0)
    stop = threading.Event()
    thread = threading.Thread(target=board.run_until, args=(stop,))
    thread.start()
    decoder = FORMATS["colon-line"].decoder(Options())
    rows, give_up = [], time.monotonic() + 10.0
    while sum(map(len, rows)) < 30 and time.monotonic() < give_up:
        select.select([reader.fd], [], [], 1.0)
        rows.append(decoder.feed(reader.read(), 0.0))
    stop.set()
    thread.join(10.0)
    assert not thread.is_alive()
    assert len(np.concatenate(rows)) >= 30
    assert decoder.counts.bad_messages == 0
