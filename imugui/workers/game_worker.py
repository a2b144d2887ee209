"""The game's thread: every attitude once through the game, whatever the window does meanwhile."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Signal

from imugui.ring import Ring
from imugui.targeting.activation import Input
from imugui.workers.worker import Worker

if TYPE_CHECKING:  # start-up time
    from imugui.targeting.game import Game
    from imugui.targeting.game_look import GameLook
    from imugui.targeting.play_again import Row

TICK_S = 1.0 / 200.0

Note = Callable[[str, dict[str, Any], int], None]
"""Told what a recording must know to play the run again: what, plain values, attitude number in the ring."""


class GameWorker(Worker):
    """Plays one run after another. Pages hand it a ``Game`` and what the person does, and paint its ``look``."""

    target_done = Signal(object)  # Trial
    run_done = Signal()

    def __init__(self, attitude: Ring, note: Note) -> None:
        super().__init__()
        self.look: GameLook | None = None  # the newest picture; None while nothing is played
        self._attitude = attitude
        self._note = note
        self._asked: deque[Game | Input | None] = deque()  # in their order: what is handed is for the game before it
        self._pending: tuple[Input, ...] = ()  # for the next row
        self._game: Game | None = None
        self._count = attitude.count
        self._stepped = time.perf_counter()

    def play(self, game: Game | None) -> None:
        """Begin this run, from the next attitude on; None leaves the one that is played."""
        self._asked.append(game)

    def hand(self, kind: str, value: str = "") -> None:
        """What the person did: kinds and values of ``targeting.activation.Input``, and "select"."""
        self._asked.append(Input(kind, value))

    def step(self) -> None:
        self.stopping.wait(TICK_S)
        self.drain(time.perf_counter())

    def drain(self, now: float) -> None:
        """Everything that is new at host time ``now`` (s)."""
        rows, count, _ = self._attitude.since(self._count)
        handed: list[Input] = []
        for _ in range(len(self._asked)):
            asked = self._asked.popleft()
            if isinstance(asked, Input):
                handed.append(asked)
            else:
                handed.clear()
                self._begin(asked, count - len(rows), now)
        game = self._game
        if game is not None and not game.done:
            self._pending += game.tick(now - self._stepped, handed)
            from imugui.targeting.play_again import each_row  # start-up time

            for place, row in enumerate(each_row(rows)):
                self._play(game, row, count - len(rows) + place)
            self.look = game.look()
        if len(rows):
            self._stepped = now
        self._count = count

    def _begin(self, game: Game | None, number: int, now: float) -> None:
        self._game, self._pending, self._stepped = game, (), now
        self.look = game.look() if game else None
        self._note("start" if game else "left", {"row": number, **(begun(game) if game else {})}, number)

    def _play(self, game: Game, row: Row, number: int) -> None:
        inputs, self._pending = self._pending, ()
        if game.done:
            return
        if inputs:
            self._note("inputs", {"inputs": [list(item) for item in inputs], "row": number}, number)
        t, quat, gyr, status = row
        for trial in game.step(t, quat, gyr, status, inputs):
            self._note("trial", {"trial": asdict(trial), "row": number}, number)
            self.target_done.emit(trial)
        if game.done:
            self._note("done", {"row": number}, number)
            self.run_done.emit()


def begun(game: Game) -> dict[str, Any]:
    """All that a run begins with, as plain values."""
    return {
        "task": asdict(game.task),
        "control": asdict(game.controller.control),
        "targets": [list(target) for target in game.targets],
        "labels": asdict(game.labels),
    }
