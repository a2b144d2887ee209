"""The Bluetooth thread: started when used, one turn at a time, everything limited, nothing left behind."""

from __future__ import annotations

import asyncio
import threading
from concurrent.futures import CancelledError

import pytest

from imugui.workers import ble_loop
from imugui.workers.ble_loop import BoardInUseError, Radio, limited


@pytest.fixture
def radio():
    one = Radio()
    yield one
    one.stop()
    assert not one.started


async def answer() -> str:
    await asyncio.sleep(0)
    return threading.current_thread().name


def test_the_thread_starts_when_it_is_used_and_is_one(radio: Radio) -> None:
    assert not radio.started
    assert radio.submit(answer()).result(30) == "bluetooth"
    assert radio.submit(answer()).result(30) == "bluetooth"
    assert [thread.name for thread in threading.enumerate()].count("bluetooth") == 1


def test_stop_cancels_what_runs_and_closes_the_loop(radio: Radio) -> None:
    async def loop() -> asyncio.AbstractEventLoop:
        return asyncio.get_running_loop()

    where = radio.submit(loop()).result(30)
    waiting = radio.submit(asyncio.sleep(3600.0))
    radio.stop()
    assert where.is_closed()
    assert not radio.started
    with pytest.raises(CancelledError):
        waiting.result(30)
    with pytest.raises(RuntimeError, match="stopped"):
        radio.submit(answer())
    radio.stop()


def test_stop_waits_for_boards_to_be_left(radio: Radio) -> None:
    done: list[str] = []

    async def farewell() -> None:
        await asyncio.sleep(0.05)
        done.append("left")

    radio.submit(radio.claim("A")).result(30)
    radio.call(radio.leave, "A", farewell())
    radio.stop()
    assert done == ["left"]


def test_a_board_is_claimed_once_and_free_when_it_was_left(radio: Radio) -> None:
    gate = threading.Event()

    async def farewell() -> None:
        await asyncio.to_thread(gate.wait)

    radio.submit(radio.claim("F0:A")).result(30)
    with pytest.raises(BoardInUseError):
        radio.submit(radio.claim("f0:a")).result(30)
    radio.call(radio.leave, "F0:A", farewell())
    again = radio.submit(radio.claim("F0:A"))
    assert radio.submit(answer()).result(30)
    assert not again.done()
    gate.set()
    again.result(30)
    assert radio.claimed("f0:a")


def test_a_farewell_that_fails_frees_the_board(radio: Radio) -> None:
    async def farewell() -> None:
        raise OSError("gone")

    radio.submit(radio.claim("A")).result(30)
    radio.call(radio.leave, "A", farewell())
    radio.submit(radio.claim("A")).result(30)


def test_a_result_in_time_and_an_error_pass_through() -> None:
    async def wrong() -> None:
        raise KeyError("x")

    assert asyncio.run(limited(answer(), 5.0))
    with pytest.raises(KeyError):
        asyncio.run(limited(wrong(), 5.0))


def test_work_that_will_not_be_cancelled_is_cancelled_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ble_loop, "PUSH_S", 0.02)
    seen: list[str] = []

    async def stubborn() -> None:
        for word in ("first", "second"):
            try:
                await asyncio.sleep(3600.0)
            except asyncio.CancelledError:
                seen.append(word)
        await asyncio.sleep(3600.0)

    async def main() -> set[asyncio.Task[object]]:
        with pytest.raises(TimeoutError, match=r"0\.01 s"):
            await limited(stubborn(), 0.01)
        return asyncio.all_tasks() - {asyncio.current_task()}

    assert asyncio.run(main()) == set()
    assert seen == ["first", "second"]


def test_the_caller_can_be_cancelled() -> None:
    async def main() -> bool:
        inner = asyncio.ensure_future(asyncio.sleep(3600.0))
        outer = asyncio.ensure_future(limited(inner, 3600.0))
        await asyncio.sleep(0)
        outer.cancel()
        await asyncio.wait({outer})
        return inner.cancelled() and outer.cancelled()

    assert asyncio.run(main())
