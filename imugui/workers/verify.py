"""Compute a recording again, from its raw bytes to its attitudes, and compare with what was recorded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui import __version__
from imugui.formats import FORMATS, Decoder, Options
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import angle_between
from imugui.fusion.timing import ArrivalClock, DeviceClock
from imugui.recording import Event, Recording, UnreadableError, raw, read_recording
from imugui.recording.folder import RAW
from imugui.samples import SAMPLE, Rows
from imugui.workers.changes import CHANGES, start_of
from imugui.workers.verify_game import GameCheck, verify_games
from imugui.workers.verify_guidance import GuidanceCheck, verify_guidance

Clock = ArrivalClock | DeviceClock
LOOK_BLOCKS = 20  # in which an arrival's effect on the times after it is looked for
CUT_AT_MOST = 50  # samples at the start of which some bytes lie before the recording
NO_GUIDANCE, NO_GAMES = GuidanceCheck(), GameCheck()
COMPARED = ("t", "gyr", "acc", "mag", "temp_c", "status", "lat", "lon", "alt", "speed", "course_deg")


@dataclass(frozen=True)
class Verification:
    """What came out. Differences are the largest, over everything compared."""

    samples: int
    attitudes: int
    raw_samples: int  # samples decoded again from the raw bytes; 0 when none were recorded
    sample_difference: float  # in the unit of the value that differs most
    attitude_difference_deg: float
    recorded_by: str
    warnings: tuple[str, ...]
    guidance: GuidanceCheck = NO_GUIDANCE
    games: GameCheck = NO_GAMES

    @property
    def sentence(self) -> str:
        source = f"{self.raw_samples} samples from raw bytes" if self.raw_samples else "recorded samples (no raw bytes)"
        text = f"{self.attitudes} attitudes computed again from {source}: "
        text += f"largest difference {self.attitude_difference_deg:.3g} deg"
        if self.recorded_by != f"imugui {__version__}":
            text += f" (recorded by {self.recorded_by})"
        return " ".join(filter(None, (f"{text}.", self.guidance.sentence, self.games.sentence, *self.warnings)))


def verify(path: Path) -> Verification:
    """Recompute and compare; UnreadableError when the recording does not hold what that needs."""
    recording = read_recording(path)
    start = _start(recording)
    samples, raw_samples, difference = recording.samples, 0, 0.0
    if recording.has_raw:
        again = decode_again(recording, start)
        raw_samples = min(len(again), len(samples))
        difference = largest_difference(again[:raw_samples], samples[:raw_samples])
        samples = again
    fused = fuse_again(samples, start, recording.events)
    attitudes, angle = compare_attitudes(fused, recording.attitude)
    made_by = str(recording.about.get("made_by", "an unknown version"))
    return Verification(
        len(samples),
        attitudes,
        raw_samples,
        difference,
        angle,
        made_by,
        recording.warnings,
        verify_guidance(recording.events, fused),
        verify_games(recording.events, fused),
    )


def _start(recording: Recording) -> Event:
    start = start_of(recording.events)
    if start is not None:
        return start
    raise UnreadableError(f"{recording.folder}: cut off before its first second was written; nothing can be computed")


def decode_again(recording: Recording, start: Event) -> Rows:
    """SAMPLE rows, shape (n,), from the raw bytes with the decoder and clock that the recording names."""
    name = start.data.get("format")
    if name not in FORMATS:
        raise UnreadableError(f"{recording.folder}: recorded from an unknown format {name!r}")
    decoder = FORMATS[name].decoder(_options(recording.about))
    fed = list(_decoded(decoder, recording.folder / RAW))
    blocks = [rows for _, rows in fed if len(rows)]
    if not blocks:
        return np.empty(0, SAMPLE)
    restored = partial(_clock, recording.folder, decoder.has_time, start)
    cut = _cut_at_the_start(blocks, recording.samples)
    if len(cut):
        arrivals = [arrival for arrival, _ in takewhile(lambda one: len(one[1]) == 0, fed)]
        arrivals.append(float(blocks[0]["t_arrival"][0]))
        head = np.concatenate((cut, *blocks[:LOOK_BLOCKS]))
        cut["t_arrival"] = _arrival_of(len(cut), head, recording.samples["t"], arrivals, restored)
    blocks[0] = np.concatenate((cut, blocks[0]))
    clock = restored()
    for block in blocks:
        _stamp(clock, block)
    return np.concatenate(blocks)


def _stamp(clock: Clock, rows: Rows) -> None:
    """What arrived together is stamped together, as it was then."""
    for block in np.split(rows, np.flatnonzero(np.diff(rows["t_arrival"])) + 1):
        clock.stamp(block)


def _clock(folder: Path, has_time: bool, start: Event) -> Clock:
    """The clock as it was when the recording began; ``has_time``: its format carries the board's own."""
    clock: Clock = DeviceClock() if has_time else ArrivalClock()
    try:
        clock.restore(start.data["clock"])
    except (KeyError, TypeError, ValueError) as error:
        raise UnreadableError(f"{folder}: its start state is damaged ({error})") from None
    return clock


def _arrival_of(
    cut: int, head: Rows, recorded_t: NDArray[np.float64], arrivals: list[float], restored: Callable[[], Clock]
) -> float:
    """Which of these arrivals completed the first ``cut`` of ``head``: the one that gives it the recorded times, s.

    The time of a sample is foretold from those before it: only the samples after it tell when it came.
    """

    def difference(arrival: float) -> float:
        again = head.copy()
        again["t_arrival"][:cut] = arrival
        _stamp(restored(), again)
        n = min(len(again), len(recorded_t))
        return float(np.max(np.abs(again["t"][:n] - recorded_t[:n])))

    return min(arrivals, key=difference)


def _decoded(decoder: Decoder, path: Path) -> Any:
    for arrival, chunk in raw.read(path):
        if arrival != arrival:
            decoder.feed(chunk, 0.0)  # what came before the recording: the decoder decides as it did then
            decoder.resync()
        elif not chunk:
            decoder.resync()
        else:
            yield arrival, decoder.feed(chunk, arrival)


def _cut_at_the_start(blocks: list[Rows], samples: Rows) -> Rows:
    """Recorded samples, of which a part of the bytes came before the recording began."""
    first = blocks[0][0]
    for missing in range(min(CUT_AT_MOST, len(samples))):
        if all(_same(samples[name][missing], first[name]) for name in ("gyr", "acc", "mag", "temp_c")):
            return samples[:missing].copy()
    return samples[:0]


def _same(a: Any, b: Any) -> bool:
    return bool(np.array_equal(a, b, equal_nan=True))


def fuse_again(samples: Rows, start: Event, events: list[Event]) -> Rows:
    """ATTITUDE rows, shape (n,), with the recorded filter, from its recorded state, through all its changes."""
    try:
        pipeline = Pipeline.from_state(start.data["pipeline"])
        blocks, done = [], 0
        for event in events:
            if event.kind in CHANGES:
                cut = max(done, min(event.sample, len(samples)))
                blocks.append(pipeline.step(samples[done:cut]))
                done = cut
                pipeline = CHANGES[event.kind](pipeline, event.data)
        blocks.append(pipeline.step(samples[done:]))
    except (KeyError, TypeError, ValueError) as error:
        raise UnreadableError(f"the recorded filter cannot be set up again: {error}") from None
    return np.concatenate(blocks)


def largest_difference(a: Rows, b: Rows) -> float:
    """The largest difference of any value of two blocks of SAMPLE rows, shape (n,); infinite where one is missing."""
    worst = 0.0
    for name in COMPARED:
        x, y = a[name].astype(float), b[name].astype(float)
        if not np.array_equal(np.isnan(x), np.isnan(y)):
            return float("inf")
        worst = max(worst, float(np.nanmax(np.abs(x - y), initial=0.0)))
    return worst


def compare_attitudes(fused: Rows, recorded: Rows) -> tuple[int, float]:
    """(attitudes of the same time, largest angle between two of them in deg); exactly 0 for equal digits."""
    if len(fused) == 0 or len(recorded) == 0:
        return 0, 0.0
    at = np.minimum(np.searchsorted(fused["t"], recorded["t"]), len(fused) - 1)
    same_time = fused["t"][at] == recorded["t"]
    a, b = fused["quat"][at][same_time], recorded["quat"][same_time]
    differ = (a != b).any(axis=1)
    angles = angle_between(a[differ], b[differ]) if differ.any() else np.zeros(1)
    return int(same_time.sum()), float(np.degrees(np.max(angles)))


def _options(about: dict[str, Any]) -> Options:
    kept = about.get("source", {}).get("options", {}) if isinstance(about.get("source"), dict) else {}
    try:
        values: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in kept.items()
        }
        return Options(**values)
    except (TypeError, AttributeError):
        return Options()
