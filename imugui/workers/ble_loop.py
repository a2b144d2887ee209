"""Bluetooth's one thread: one event loop for the life of the program, made when it is first needed."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import sys
import threading
from collections.abc import Awaitable, Callable, Collection, Coroutine
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, TypeVar

T = TypeVar("T")

PUSH_S = 2.0  # what runs over its time is cancelled again after this long
PUSHES = 4
LEAVE_S = 5.0  # how long the end waits for boards to be disconnected (BlueZ needs 2 s)


async def limited(work: Awaitable[T], limit_s: float) -> T:
    """The result of ``work``; TimeoutError after ``limit_s``.

    Cancelled work may wait once more, for an answer that a hung service never gives: it is cancelled until it ends.
    """
    task = asyncio.ensure_future(work)
    try:
        done, _ = await asyncio.wait({task}, timeout=limit_s)
    finally:
        await _end(task)
    if not done:
        raise TimeoutError(f"no answer within {limit_s:g} s")
    return task.result()


async def _end(task: asyncio.Future[Any]) -> None:
    for _ in range(PUSHES):
        if task.done():
            return
        task.cancel()
        await asyncio.wait({task}, timeout=PUSH_S)
    if task.done() and not task.cancelled():
        task.exception()  # looked at; nobody else may


async def _over(tasks: Collection[asyncio.Future[Any]]) -> None:
    if tasks:
        await asyncio.wait(tasks, timeout=LEAVE_S)


async def _close_bus() -> None:
    """On Linux bleak keeps its connection to the message bus for as long as the loop lives, and never closes it."""
    module = sys.modules.get("bleak.backends.bluezdbus.manager")
    managers = getattr(module, "_global_instances", {})
    bus = getattr(managers.get(asyncio.get_running_loop()), "_bus", None)
    if bus is not None:
        with contextlib.suppress(Exception):  # the bus died before
            bus.disconnect()
            await limited(bus.wait_for_disconnect(), PUSH_S)


class BoardInUseError(Exception):
    """A board is open in this program already."""


@dataclass
class Claim:
    """A board that is in use."""

    leaving: bool = False
    freed: asyncio.Event = field(default_factory=asyncio.Event)


class Radio:
    """The Bluetooth thread, shared by all sessions of a program; ``stop`` it once, at the end.

    One scan or connection attempt runs at a time: whoever makes one holds ``turn``. Several at once were seen to wait
    for ever on BlueZ. A board is claimed before it is connected: two clients would share one link, and the first to
    leave would drop it for both.
    """

    def __init__(self) -> None:
        self.turn = asyncio.Lock()
        self._claims: dict[str, Claim] = {}  # by address
        self._leaving: set[asyncio.Task[None]] = set()
        self._guard = threading.Lock()
        self._thread: threading.Thread | None = None
        self._ready: Future[asyncio.AbstractEventLoop] = Future()
        self._ending = asyncio.Event()
        self._stopped = False

    # from any thread

    def submit(self, work: Coroutine[Any, Any, T]) -> Future[T]:
        """Let ``work`` run in the Bluetooth thread; RuntimeError after ``stop``."""
        try:
            return asyncio.run_coroutine_threadsafe(work, self._running())
        except RuntimeError:
            work.close()
            raise

    def call(self, act: Callable[..., None], *arguments: Any) -> None:
        """Let ``act`` run in the Bluetooth thread, without waiting for it; nothing happens when there is no thread."""
        if self.started:
            with contextlib.suppress(RuntimeError):  # the loop is closed
                self._ready.result().call_soon_threadsafe(act, *arguments)

    @property
    def started(self) -> bool:
        """Whether the thread runs."""
        return self._thread is not None and self._thread.is_alive()

    def stop(self) -> None:
        """Disconnect what is connected, end the loop and the thread; waits, for some seconds at the most."""
        with self._guard:
            self._stopped = True
        self.call(self._ending.set)
        if self._thread is not None:
            self._thread.join()

    def _running(self) -> asyncio.AbstractEventLoop:
        with self._guard:
            if self._stopped:
                raise RuntimeError("Bluetooth was stopped")
            if self._thread is None:
                self._thread = threading.Thread(target=lambda: asyncio.run(self._main()), name="bluetooth", daemon=True)
                self._thread.start()
        return self._ready.result()

    # in the Bluetooth thread

    async def claim(self, address: str) -> None:
        """Take a board for oneself, once whoever leaves it has left; BoardInUseError when it is in use."""
        address = address.lower()
        while (other := self._claims.get(address)) is not None:
            if not other.leaving:
                raise BoardInUseError(address)
            await limited(other.freed.wait(), 2.0 * LEAVE_S)
        self._claims[address] = Claim()

    def claimed(self, address: str) -> bool:
        """Whether a board is in use, and not just being left."""
        claim = self._claims.get(address.lower())
        return claim is not None and not claim.leaving

    def leave(self, address: str, farewell: Coroutine[Any, Any, None]) -> None:
        """Disconnect a claimed board beside everything else; it is free when that is done."""
        address = address.lower()
        self._claims[address].leaving = True
        task = asyncio.get_running_loop().create_task(self._leave(address, farewell))
        self._leaving.add(task)
        task.add_done_callback(self._leaving.discard)

    async def _leave(self, address: str, farewell: Coroutine[Any, Any, None]) -> None:
        try:
            with contextlib.suppress(Exception):  # a link that cannot be taken down in order is gone already
                await limited(farewell, LEAVE_S)
        finally:
            self._claims.pop(address).freed.set()

    async def _main(self) -> None:
        logging.getLogger("bleak").setLevel(logging.ERROR)  # its warnings are said in our own words
        self._ready.set_result(asyncio.get_running_loop())
        await self._ending.wait()
        await _over(self._leaving)
        await _close_bus()
        rest = asyncio.all_tasks() - {asyncio.current_task()}
        for task in rest:
            task.cancel()
        await _over(rest)
        await _over(self._leaving)  # by attempts that were just cancelled
