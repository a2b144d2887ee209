"""One verdict in words for everything that a link can be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows
from imugui.workers.verdict import Facts, State, judge, oddity

OPEN = {"phase": "open", "where": "/dev/ttyUSB0", "opened": 100.0}


@pytest.mark.parametrize(
    ("facts", "state", "words"),
    [
        (Facts(5.0, "idle"), State.IDLE, "Connect"),
        (Facts(5.0, "opening", "COM3"), State.OPENING, "COM3"),
        (Facts(5.0, "failed", problem="x cannot be read: gone."), State.FAILED, "cannot be read"),
        (Facts(5.0, "lost", problem="the cable was pulled", opened=1.0), State.LOST, "cable"),
        (Facts(5.0, "lost", problem="no port", problem_kind="missing"), State.MISSING, "no port"),
        (Facts(5.0, "lost", problem="in use", problem_kind="busy"), State.BUSY, "in use"),
        (Facts(5.0, "lost", problem="usermod", problem_kind="denied"), State.DENIED, "usermod"),
        (Facts(5.0, "lost", problem="odd", problem_kind="other"), State.FAILED, "odd"),
        (Facts(5.0, "ended", "walk.csv"), State.ENDED, "walk.csv"),
        (Facts(101.0, **OPEN), State.WAITING, "first byte"),
        (Facts(103.5, **OPEN), State.SILENT, "reset button"),
        (Facts(103.0, **OPEN, byte_t=102.9), State.SEARCHING, "finding out"),
        (
            Facts(107.0, **OPEN, byte_t=106.9, findings="4,113 bytes, none of them a line"),
            State.NO_MESSAGES,
            "4,113 bytes",
        ),
        (Facts(107.0, **OPEN, byte_t=107.0, sample_t=106.99), State.STREAMING, ""),
        (Facts(107.0, **OPEN, byte_t=107.0, sample_t=106.99, odd="zero"), State.IMPOSSIBLE, "zero"),
        (Facts(110.0, **OPEN, byte_t=107.0, sample_t=107.0), State.STALLED, "nothing for 3 s"),
        (Facts(110.0, **OPEN, byte_t=107.0, sample_t=107.0, paused=True), State.PAUSED, "Space"),
        (Facts(110.0, **OPEN, byte_t=109.9, sample_t=107.0), State.STALLED, "no message for 3 s"),
        (Facts(108.5, **OPEN, byte_t=107.0, sample_t=107.0, period_s=1.0), State.STREAMING, ""),
        (Facts(107.0, **OPEN, byte_t=107.0, sample_t=107.0, breaks=1, missing_s=2.5), State.STREAMING, "2.5 s"),
    ],
)
def test_verdict(facts: Facts, state: State, words: str) -> None:
    verdict = judge(facts)
    assert verdict.state is state
    assert words in verdict.sentence


def test_every_state_has_a_word_and_a_tone() -> None:
    assert len({state.word for state in State}) == len(State)
    assert {state.tone for state in State} == {"neutral", "good", "warn", "bad"}


def rows(acc: tuple[float, float, float], gyr: float = 0.01, noise: float = 0.05) -> Rows:
    made = empty_rows(SAMPLE, 100)
    random = np.random.default_rng(0)
    made["acc"] = acc + noise * random.standard_normal((100, 3))
    made["gyr"] = gyr + noise * random.standard_normal((100, 3))
    return made


@pytest.mark.parametrize(
    ("block", "words"),
    [
        (rows((0.0, 0.0, GRAVITY)), ""),
        (rows((0.1, 0.0, 1.0)), "units"),
        (rows((0.0, 0.0, 16384.0)), "units"),
        (rows((0.0, 0.0, 0.0), noise=0.0), "zero"),
        (rows((0.0, 0.0, GRAVITY), noise=0.0), ""),
        (rows((0.0, 0.0, GRAVITY), gyr=1.0, noise=0.0), "stands still"),
        (rows((math.nan, 0.0, 0.0)), "no numbers"),
        (rows((0.0, 0.0, 0.0))[:5], ""),
    ],
)
def test_oddity_names_what_is_impossible(block: Rows, words: str) -> None:
    found = oddity(block)
    assert words in found
    assert bool(found) == bool(words)
