"""The ring gives every reader each row once, in order, and says what it missed."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.ring import Ring

NUMBER = np.dtype([("n", "i8")])


def block(first: int, n: int) -> np.ndarray:
    rows = np.zeros(n, NUMBER)
    rows["n"] = np.arange(first, first + n)
    return rows


@given(capacity=st.integers(1, 20), sizes=st.lists(st.integers(0, 50), max_size=30))
def test_last_and_since_agree_with_a_plain_list(capacity: int, sizes: list[int]) -> None:
    ring = Ring(NUMBER, capacity)
    count, pushed = 0, 0
    for size in sizes:
        ring.push(block(pushed, size))
        pushed += size
        rows, count_after, missed = ring.since(count)
        assert count_after == pushed == ring.count
        assert missed + len(rows) == pushed - count
        assert rows["n"].tolist() == list(range(pushed - len(rows), pushed))
        assert missed == max(0, pushed - count - capacity)
        count = count_after
        assert ring.last(7)["n"].tolist() == list(range(max(0, pushed - min(7, capacity)), pushed))


def test_a_copy_is_given() -> None:
    ring = Ring(NUMBER, 4)
    ring.push(block(0, 3))
    ring.last(3)["n"] = 99
    assert ring.last(3)["n"].tolist() == [0, 1, 2]


def resident_bytes() -> int:
    smaps = Path("/proc/self/smaps_rollup")
    if not smaps.is_file():
        pytest.skip("this system does not tell what a process holds")
    return 1024 * int(next(line.split()[1] for line in smaps.read_text().splitlines() if line.startswith("Rss")))


def test_a_reserved_ring_has_all_of_its_memory_before_the_first_row() -> None:
    ring = Ring(NUMBER, 1 << 22)  # 64 MiB, as it is mirrored
    before = resident_bytes()
    ring.reserve()
    reserved = resident_bytes()
    assert reserved - before > 60 << 20
    for first in range(0, 1 << 22, 1 << 16):
        ring.push(block(first, 1 << 16))
    assert resident_bytes() - reserved < 4 << 20


def test_reserving_forgets_no_row() -> None:
    ring = Ring(NUMBER, 1000)
    ring.push(block(0, 1000))
    ring.reserve()
    assert ring.last(1000)["n"].tolist() == list(range(1000))


def test_no_room_is_refused() -> None:
    with pytest.raises(ValueError, match="room"):
        Ring(NUMBER, 0)


def test_reader_and_writer_in_two_threads_lose_nothing() -> None:
    ring = Ring(NUMBER, 5000)
    total = 20_000

    def write() -> None:
        for first in range(0, total, 10):
            ring.push(block(first, 10))

    writer = threading.Thread(target=write)
    writer.start()
    count, missed_all, seen = 0, 0, []
    while count < total:
        rows, count, missed = ring.since(count)
        missed_all += missed
        seen.extend(rows["n"].tolist())
    writer.join()
    assert len(seen) + missed_all == total
    assert seen == sorted(set(seen))
