"""The game on a live session: its thread, what a recording keeps of a run, and the proof."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QTimer

from imugui.recording.folder import EVENTS
from imugui.ring import Ring
from imugui.samples import ATTITUDE, empty_rows
from imugui.targeting.game import Game
from imugui.targeting.settings import PRESETS as CONTROLS
from imugui.targeting.states import State
from imugui.targeting.tasks import Task, target_list
from imugui.workers.game_worker import GameWorker
from imugui.workers.session import Session, Source
from imugui.workers.verify import verify

EASY = Task(targets=3, pan_low_px=30.0, pan_high_px=60.0, tolerance_px=100.0, zoom_low=1.1, zoom_high=1.2)
"""So easy that a board which is merely turned hits it."""


def game(task: Task) -> Game:
    return Game(task, CONTROLS["position"], target_list(task, 1, 0))


@pytest.fixture
def session(qtbot) -> Iterator[Session]:
    one = Session(use_mag=False)
    one.connect_to(Source("simulator", "free", rate_hz=400.0))
    qtbot.waitUntil(lambda: one.samples.count > 50)
    yield one
    one.close()


def press_again(player: GameWorker) -> None:
    """A busy machine lets the input go stale, which holds the view until the button is pressed anew."""
    if player.look is not None and player.look.state is State.HOLD:
        player.hand("release", "pan")
        player.hand("press", "pan")


@pytest.fixture
def recorded(session: Session, tmp_path: Path, qtbot) -> Path:
    folder = tmp_path / "played.imugui"
    assert session.record(folder)
    qtbot.waitUntil(lambda: session.recording.rows > 0)
    player = session.game
    again = QTimer()
    again.timeout.connect(lambda: press_again(player))
    with qtbot.waitSignal(player.run_done, timeout=30_000):
        player.play(game(EASY))
        player.hand("confirm")
        player.hand("press", "pan")
        again.start(20)
    again.stop()
    count = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > count + 200)
    session.stop_recording()
    return folder


def test_a_run_is_played_again_from_the_recording_to_the_last_digit(recorded: Path) -> None:
    found = verify(recorded).games
    assert (found.runs, found.recomputed, found.trials, found.problems) == (1, 1, 3, ())
    assert "1 of 1 runs of the game played again, 3 targets: the same to the last digit" in verify(recorded).sentence


def test_a_time_that_was_not_played_is_found_out(recorded: Path) -> None:
    lines = (recorded / EVENTS).read_text().splitlines()
    number = next(number for number, line in enumerate(lines) if '"trial"' in line)
    event = json.loads(lines[number])
    event["data"]["trial"]["movement_time_s"] -= 0.1
    lines[number] = json.dumps(event)
    (recorded / EVENTS).write_text(
        "\n".join([*lines, '{"kind": "game", "t": 0, "sample": 1, "text": "trial", "data": {}}'])
    )
    found = verify(recorded).games
    assert len(found.problems) == 2
    assert "movement_time_s" in " ".join(found.problems)
    assert "damaged" in " ".join(found.problems)


def rows_of(n: int, t: float) -> np.ndarray:
    rows = empty_rows(ATTITUDE, n)
    rows["t"] = t + np.arange(n) * 0.005
    rows["quat"], rows["gyr"], rows["status"] = (1.0, 0.0, 0.0, 0.0), 0.0, 0
    return rows


def test_it_holds_when_nothing_comes_and_says_so_before_the_next_row(qtbot) -> None:
    ring, notes = Ring(ATTITUDE, 1000), []
    worker = GameWorker(ring, lambda text, data, number: notes.append((text, number)))
    worker.play(game(Task()))
    worker.hand("confirm")
    worker.drain(0.0)
    ring.push(rows_of(40, 0.0))
    worker.drain(0.2)
    assert worker.look.state is State.READY
    worker.hand("press", "pan")
    ring.push(rows_of(20, 0.2))
    worker.drain(0.3)
    assert worker.look.state is State.ENGAGED
    worker.drain(0.45)
    assert worker.look.state is State.HOLD
    assert [text for text, _ in notes] == ["start", "inputs", "inputs"]
    ring.push(rows_of(20, 0.3))
    worker.drain(0.5)
    assert notes[-1] == ("inputs", 60), "that it was stale is kept with the next row"
    assert worker.look.state is State.HOLD
    worker.play(None)
    worker.drain(0.6)
    assert worker.look is None
