"""The board of ``run.py bench endurance`` waits where the reader stalls, so that a long run can ask for every row."""

from __future__ import annotations

import os
import select
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

if sys.platform == "win32":
    pytest.skip("no pseudo-terminals on Windows", allow_module_level=True)

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

from _board import send

from imugui.formats import FORMATS, Options

PATIENCE_S = 20.0
STILL_S = 0.1


@pytest.fixture
def board(tmp_path: Path) -> Iterator[SimpleNamespace]:
    """A board that speaks 8000 times a second under ``link``; ``sent`` is what it counts."""
    hold, holding, stop = (threading.Event() for _ in range(3))
    sent, link = SimpleNamespace(value=0), tmp_path / "board"
    thread = threading.Thread(target=send, args=(str(link), "triplets", 8000.0, (sent, hold, holding, stop)))
    thread.start()
    yield SimpleNamespace(link=link, sent=sent, hold=hold, holding=holding)
    stop.set()
    thread.join()


def until(so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not so():
        assert time.monotonic() < end
        time.sleep(0.01)


def stalled_at(sent: SimpleNamespace) -> int:
    """How many samples there are in the terminal once it takes no more."""
    until(lambda: sent.value > 0)
    seen, since = 0, time.monotonic()
    while seen != sent.value or time.monotonic() < since + STILL_S:
        if seen != sent.value:
            seen, since = sent.value, time.monotonic()
        time.sleep(0.01)
    return seen


def read_until(port: int, over: Callable[[], bool]) -> bytes:
    """What comes until it is over."""
    text, end = b"", time.monotonic() + PATIENCE_S
    while not over():
        assert time.monotonic() < end
        if select.select([port], [], [], STILL_S)[0]:
            text += os.read(port, 1 << 16)
    return text


def rest(port: int) -> bytes:
    """What comes until nothing comes any more."""
    text = b""
    while select.select([port], [], [], STILL_S)[0]:
        text += os.read(port, 1 << 16)
    return text


def test_a_board_whose_terminal_is_full_waits_and_loses_nothing(board: SimpleNamespace) -> None:
    until(board.link.exists)
    port = os.open(board.link, os.O_RDWR | os.O_NOCTTY)
    stalled = stalled_at(board.sent)
    text = read_until(port, lambda: board.sent.value > stalled)
    board.hold.set()
    text += read_until(port, board.holding.is_set) + rest(port)
    os.close(port)
    decoder = FORMATS["triplets"].decoder(Options())
    assert len(decoder.feed(text, 0.0)) == board.sent.value > stalled
    assert decoder.counts.bad_messages == 0
