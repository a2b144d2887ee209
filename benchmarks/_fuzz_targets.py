"""What is fuzzed: each target takes any bytes and must neither raise, nor hang, nor keep more than it may.

A refusal in words is right: UnreadableError, TableError, ProfileError, StudyError and ValueError of the readers that
promise them, in one line. Everything else that is raised is a find.
"""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache, partial
from pathlib import Path

import _fuzz_seeds as seeds
import numpy as np

from imugui import settings
from imugui.calibration import profile_file
from imugui.calibration.certificate import certificate_html
from imugui.formats import FORMATS, STREAM_FORMATS, Options
from imugui.formats.base import LinkLog
from imugui.formats.column_map import from_json
from imugui.formats.detect import BaudSearch, candidate_bauds
from imugui.formats.detector import Detector
from imugui.formats.lines import MAX_LINE
from imugui.fusion import FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.timing import ArrivalClock, DeviceClock
from imugui.guidance import plan_file, session_file
from imugui.guidance.report import report_csv
from imugui.guidance.report import report_html as guidance_html
from imugui.recording import UnreadableError, read_recording, read_samples
from imugui.recording.events import Event, from_lines
from imugui.recording.folder import ABOUT, ATTITUDE, EVENTS, RAW, SAMPLES
from imugui.recording.summary import summarise
from imugui.ring import Ring
from imugui.samples import ATTITUDE as ATTITUDE_ROW
from imugui.samples import SAMPLE, Rows
from imugui.targeting import study_store
from imugui.targeting.measures import runs_csv
from imugui.targeting.results import results
from imugui.targeting.results_report import report_html as study_html
from imugui.targeting.study import Study
from imugui.targeting.study_plan import before_it_starts, orders, plan_from, turns
from imugui.targeting.study_report import study_results
from imugui.targeting.trials import read_trials, trials_csv
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.player import Player
from imugui.workers.verify import verify

NOW = datetime(2026, 11, 1, tzinfo=UTC)
MOST_FUSED = 50  # rows of an input: the filter is slow, and not what is fuzzed
MOST_STEPS = 20_000  # of a study that a mutated plan may ask for: more only takes long


@dataclass(frozen=True)
class Target:
    """One reader of something from outside, with good inputs to begin from."""

    run: Callable[[bytes], None]
    seeds: Callable[[], Sequence[bytes]]


def one_line(error: Exception) -> None:
    """A refusal is one line of words."""
    if not str(error) or "\n" in str(error):
        raise AssertionError(f"not a sentence: {error!r}")


@cache
def home() -> Path:
    """A folder for what can only be read from a disk; in memory where there is such a place."""
    memory = Path("/dev/shm")  # noqa: S108
    return Path(tempfile.mkdtemp(prefix="imugui-fuzz-", dir=memory if memory.is_dir() else None))


def put(name: str, data: bytes) -> Path:
    """A file with this content."""
    path = home() / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def decode(name: str, data: bytes) -> None:
    """Any bytes, in any pieces: every byte counted, rows that can be true, a bounded memory."""
    decoder, size = FORMATS[name].decoder(Options()), 1 + (data[0] if data else 0) * 16
    rows = [decoder.feed(data[at : at + size], float(at)) for at in range(0, len(data), size)]
    rows += [decoder.flush(float(len(data)))]
    decoder.resync()
    found = np.concatenate(rows)
    kept = getattr(decoder, "_pending", b"")
    if decoder.counts.bytes != len(data) or decoder.counts.samples != len(found):
        raise AssertionError(f"miscounted: {decoder.counts}")
    if len(kept) > MAX_LINE + 1 or len(decoder.log) > LinkLog.CAPACITY:
        raise AssertionError("unbounded")
    if np.isinf(np.concatenate([found[one].ravel() for one in ("gyr", "acc", "mag", "temp_c")])).any():
        raise AssertionError("infinite values in rows")
    fuse(found[:MOST_FUSED], decoder.has_time)


def fuse(rows: Rows, timed: bool) -> None:
    """Whatever was decoded goes through clock and filter: unit quaternions or NaN, times that do not stand still."""
    clock = DeviceClock() if timed else ArrivalClock()
    for at in range(0, len(rows), 7):
        clock.stamp(rows[at : at + 7])
    fused = Pipeline("complementary").step(rows)
    norms = np.linalg.norm(fused["quat"], axis=1)
    if len(fused) != len(rows) or not np.allclose(norms[np.isfinite(norms)], 1.0, atol=1e-3):
        raise AssertionError("attitudes that are none")


def detect(data: bytes) -> None:
    """A verdict in words on any bytes, from a file and from a port."""
    detector = Detector()
    size = 1 + (data[0] if data else 0) * 16
    search = BaudSearch(candidate_bauds(), 0.0)
    for number, at in enumerate(range(0, len(data), size)):
        detector.feed(data[at : at + size], number * 0.01)
        search.feed(data[at : at + size], number * 0.4)
        if not detector.verdict.sentence or not search.verdict.sentence:
            raise AssertionError("no words")
    found = detector.conclude(at_end=True)
    if found.format:
        detector.take()


def read_table(name: str, data: bytes) -> None:
    """Any file: samples, or why there are none."""
    path = put(name, data)
    try:
        rows = read_samples(path).rows
    except UnreadableError as error:
        one_line(error)
        return
    play(rows, [])


def play(rows: Rows, events: list[Event]) -> None:
    """Rows of a file as they are replayed."""
    player = Player(rows, events, math.inf)
    player.overview()
    while not player.ended:
        player.due(0.0, 4096)
    player.seek(player.duration_s / 2)
    if player.wait_s(0.0) < 0.0:
        raise AssertionError("a negative wait")


RECORDED = (ABOUT, SAMPLES, ATTITUDE, EVENTS, RAW)


def read_folder(data: bytes) -> None:
    """A recording of which one file is anything: read, summed up, replayed and verified, or refused in words."""
    name = RECORDED[data[0] % len(RECORDED)] if data else ABOUT
    folder = seeds.recording(home())
    before = (folder / name).read_bytes()
    (folder / name).write_bytes(data[1:])
    try:
        summarise(folder)
        found = read_recording(folder)
        play(found.samples, found.events)
        verify(folder)
    except UnreadableError as error:
        one_line(error)
    finally:
        (folder / name).write_bytes(before)


def follow_events(data: bytes) -> None:
    """Events of any kind: what they did is done again, or refused as the reader expects it."""
    events, _ = from_lines(data.decode("utf-8", "replace").splitlines())
    samples = Ring(SAMPLE, 1000)
    worker = FusionWorker(samples, Ring(ATTITUDE_ROW, 1000), Pipeline("complementary"))
    try:
        worker.follow(events, 0)
    except (KeyError, TypeError, ValueError):
        return
    samples.push(seeds.rows()[:50])
    worker.drain()


def read_settings(data: bytes) -> None:
    """Any settings file: loaded, and what was loaded can be saved and is the same again."""
    path = put("settings.json", data)
    store, problems = settings.load(path)
    if any("\n" in one for one in problems):
        raise AssertionError("not a sentence")
    settings.save(path, store)
    if settings.load(path) != (store, []):
        raise AssertionError("not the same again")
    for board in store.boards.values():
        for table in board.get("tables") or () if isinstance(board.get("tables"), list) else ():
            from_json(table)
    for name, values in store.filters.items():
        if name in FILTERS:
            Pipeline(name, settings.from_mapping(FILTERS[name].Params, values)[0])


def read_profile(data: bytes) -> None:
    """Any profile: taken whole, usable and printable, or refused in words."""
    try:
        profile = profile_file.load(put("profile.json", data))
    except profile_file.ProfileError as error:
        one_line(error)
        return
    profile.correction(21.0)
    profile.warnings(NOW, 21.0)
    certificate_html(profile, NOW, 21.0)
    profile_file.from_text(profile_file.to_text(profile))


def read_plans(data: bytes) -> None:
    """Any table of plans: those that are right, a sentence for each that is not."""
    plans, said = plan_file.load_plans(put("plans.csv", data))
    if plan_file.read_plans(plan_file.write_plans(plans)) != (plans, []) or any("\n" in one for one in said):
        raise AssertionError("not the same again")


def read_guidance(data: bytes) -> None:
    """Any guidance session: what is right of it can be reported and saved."""
    for left in home().glob("guidance*"):
        left.unlink()
    kept, _ = session_file.load(put("guidance.json", data))
    guidance_html(kept.readings, kept.plans, None, NOW)
    report_csv(kept.readings, kept.plans, None, NOW)
    again, left_out = session_file.from_text(session_file.to_text(kept))
    if left_out or again.plans != kept.plans or len(again.readings) != len(kept.readings):
        raise AssertionError("not the same again")


def read_study_plan(data: bytes) -> None:
    """Any plan of a study: taken whole, or refused in words."""
    try:
        values = json.loads(data)
        plan = plan_from(values if isinstance(values, dict) else {})
    except (ValueError, RecursionError) as error:
        one_line(error) if isinstance(error, ValueError) and type(error) is ValueError else None
        return
    if len(plan.participants) * len(plan.conditions) * plan.blocks * plan.runs < MOST_STEPS:
        turns(plan), orders(plan), before_it_starts(plan)


STUDY_FILES = (study_store.PLAN, study_store.TRIALS, study_store.ANSWERS)


def read_study(data: bytes) -> None:
    """A study of which one file is anything: opened, repaired and reported."""
    name = STUDY_FILES[data[0] % len(STUDY_FILES)] if data else study_store.PLAN
    folder = seeds.study(home())
    before = {one: (folder / one).read_bytes() for one in STUDY_FILES}
    (folder / name).write_bytes(data[1:])
    try:
        with np.errstate(all="ignore"):  # as in read_targets
            found = study_results(study_store.load(folder))
            study_html(found, NOW)
        runs_csv(found.runs)
        study = Study.open(folder)
        study.next_step(study.people[0])
    except study_store.StudyError as error:
        one_line(error)
    finally:
        for one in folder.glob("*broken*"):
            one.unlink()
        for one, content in before.items():
            (folder / one).write_bytes(content)


def read_targets(data: bytes) -> None:
    """Any table of targets: results and a report of what is right of it."""
    trials, _ = read_trials(data.decode("utf-8", "surrogateescape"))
    with np.errstate(all="ignore"):  # a movement of 1e308 s has no figures, and the page says n/a
        found = results(trials)
        study_html(found, NOW)
        runs_csv(found.runs)
    if len(read_trials(trials_csv(trials))[0]) != len(trials):
        raise AssertionError("not the same again")


TARGETS: dict[str, Target] = {
    **{name: Target(partial(decode, name), partial(seeds.stream, name)) for name in STREAM_FORMATS},
    **{name: Target(partial(decode, name), partial(seeds.stream, name)) for name in FORMATS if FORMATS[name].framed},
    "detector": Target(detect, seeds.streams),
    "recording": Target(read_folder, seeds.recorded_files),
    "events": Target(follow_events, seeds.events),
    "csv": Target(partial(read_table, "table.csv"), seeds.tables),
    "settings": Target(read_settings, seeds.settings_files),
    "profile": Target(read_profile, seeds.profiles),
    "plans": Target(read_plans, seeds.plans),
    "guidance": Target(read_guidance, seeds.guidance_sessions),
    "study-plan": Target(read_study_plan, seeds.study_plans),
    "study": Target(read_study, seeds.study_files),
    "trials": Target(read_targets, seeds.trial_tables),
}
"""All targets by name."""
