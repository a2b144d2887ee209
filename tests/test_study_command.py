"""``imugui study``: a whole study of simulated people, killed in the middle, and its figures computed once more."""

from __future__ import annotations

import csv
import math
import os
import re
import signal
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from html import unescape
from itertools import product
from pathlib import Path

import pytest

from imugui.cli import parser
from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan, codes
from imugui.targeting.study_simulated import simulate_study

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="stops and kills a process with signals")
COMMAND = (sys.executable, "-m", "imugui", "study")
TARGETS, RUNS_OF_ONE = 5, 8
WAIT_S = 60.0

Row = dict[str, str]


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120.0, check=False)


def rows_of(path: Path) -> list[Row]:
    """A table of the study as any other program reads it."""
    return list(csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")))


def whole_rows(path: Path) -> int:
    text = path.read_text() if path.exists() else ""
    return sum(line.startswith(("0,", "1,")) for line in text.split("\n")[:-1])


def kill_within_a_block(process: subprocess.Popen[bytes], table: Path, least: int) -> int:
    """Stop the program when so many targets are kept and the newest block is not complete, then kill it."""
    until = time.monotonic() + WAIT_S
    while time.monotonic() < until and process.poll() is None:
        if whole_rows(table) >= least and whole_rows(table) % TARGETS:
            process.send_signal(signal.SIGSTOP)
            os.waitpid(process.pid, os.WUNTRACED)
            if whole_rows(table) % TARGETS:
                process.kill()
                process.wait(WAIT_S)
                return whole_rows(table)
            process.send_signal(signal.SIGCONT)
        time.sleep(0.001)
    raise AssertionError("the program ended before it could be killed within a block")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, bytes, str]]:
    """The default study, killed once and resumed: folder, table when it was killed, summary."""
    folder = tmp_path_factory.mktemp("study") / "out"
    command = [*COMMAND, "simulate", "--out", str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        kill_within_a_block(process, folder / "trials.csv", 27)
        table = (folder / "trials.csv").read_bytes()
        done = run("simulate", "--out", folder, "--resume")
    finally:
        process.kill()
        process.wait(WAIT_S)
    assert done.returncode == 0, done.stderr
    assert "P01 was interrupted in block" in done.stderr
    yield folder, table, done.stdout


@POSIX
def test_a_killed_study_goes_on_at_the_interrupted_block_and_nothing_is_lost(study: tuple[Path, bytes, str]) -> None:
    folder, before, _ = study
    after = (folder / "trials.csv").read_text().split("\n")
    killed = before.decode().split("\n")
    # every row that was kept is still there, in its place; those of the interrupted block are marked
    left = (whole_rows(folder / "trials.csv") - 6 * RUNS_OF_ONE * TARGETS) % TARGETS
    for old, new in zip(killed[:-1], after, strict=False):
        assert new.partition(",")[2] == old.partition(",")[2]
    marked = [row for row in rows_of(folder / "trials.csv") if row["interrupted"] == "1"]
    assert 1 <= len(marked) == left < TARGETS
    assert len({(row["participant"], row["condition"], row["block"]) for row in marked}) == 1
    again = [row for row in rows_of(folder / "trials.csv") if row["interrupted"] == "0"]
    keys = [(row["participant"], row["condition"], row["block"], row["run"], row["index"]) for row in again]
    assert len(set(keys)) == len(keys) == 6 * RUNS_OF_ONE * TARGETS


@POSIX
def test_killed_and_resumed_gives_the_digits_of_a_study_that_was_not(
    study: tuple[Path, bytes, str], tmp_path: Path
) -> None:
    plan = StudyPlan(codes(1), name="position against speed", simulated=True, preference=False, rest_s=0.0)
    simulate_study(plan, tmp_path / "one")
    alone = rows_of(tmp_path / "one" / "trials.csv")
    resumed = [
        row for row in rows_of(study[0] / "trials.csv") if (row["participant"], row["interrupted"]) == ("P01", "0")
    ]
    assert resumed == alone
    assert len(alone) == RUNS_OF_ONE * TARGETS


def by_run(rows: list[Row]) -> dict[tuple[str, str, int], list[Row]]:
    found: dict[tuple[str, str, int], list[Row]] = defaultdict(list)
    for row in rows:
        if (row["interrupted"], row["practice"]) == ("0", "0"):
            found[row["participant"], row["condition"], int(row["block"])].append(row)
    return found


def each(rows: list[Row], name: str) -> list[float]:
    return [float(row[name]) for row in rows]


def bits(row: Row) -> float:
    """log2(way / width + 1) of the pan, and of the zoom on the logarithm of the size."""
    tolerance, size = float(row["tolerance_px"]), float(row["to_size"])
    way = math.dist((float(row["from_x"]), float(row["from_y"])), (float(row["to_x"]), float(row["to_y"])))
    zoom = abs(math.log(size / float(row["from_size"]))) / math.log((size + tolerance) / (size - tolerance))
    return math.log2(way / (2.0 * tolerance) + 1.0) + math.log2(zoom + 1.0)


def rotations(rows: list[Row]) -> list[float]:
    return [float(word) for row in rows for word in row["max_rotation_deg"].split()]


FIGURES = {
    "targets": len,
    "movement_time_s": lambda rows: statistics.fmean(each(rows, "movement_time_s")),
    "elapsed_time_s": lambda rows: max(each(rows, "t_end")) - min(each(rows, "t_start")),
    "nominal_throughput": lambda rows: sum(map(bits, rows)) / sum(each(rows, "movement_time_s")),
    "activations": lambda rows: sum(each(rows, "activations")),
    "mean_largest_rotation_deg": lambda rows: statistics.fmean(rotations(rows)),
    "min_angle_x_deg": lambda rows: min(each(rows, "min_x_deg")),
    "max_angle_z_deg": lambda rows: max(each(rows, "max_z_deg")),
    "pan_time_s": lambda rows: sum(each(rows, "pan_time_s")),
    "zoom_time_s": lambda rows: sum(each(rows, "zoom_time_s")),
    "overshoots": lambda rows: statistics.fmean(each(rows, "overshoots")),
    "error_percent": lambda rows: 100.0 * statistics.fmean(each(rows, "error")),
    "clutches": lambda rows: sum(each(rows, "clutches")),
}
"""Figures of a run from its targets, written once more for this test."""


@POSIX
def test_every_run_in_the_results_follows_from_the_raw_trials(study: tuple[Path, bytes, str]) -> None:
    raw = by_run(rows_of(study[0] / "trials.csv"))
    runs = [row for row in rows_of(study[0] / "runs.csv") if row["practice"] == "0"]
    assert len(runs) == len(raw) == 6 * 2 * 3
    for one in runs:
        own = raw[one["participant"], one["condition"], int(one["block"])]
        for name, figure in FIGURES.items():
            assert float(one[name]) == pytest.approx(figure(own), rel=1e-12, abs=1e-12), name


def person_logs(raw: dict[tuple[str, str, int], list[Row]], person: str, condition: str) -> float:
    """The logarithm of the geometric mean over the blocks of the mean time of a target."""
    times = [statistics.fmean(each(raw[person, condition, block], "movement_time_s")) for block in (1, 2, 3)]
    return statistics.fmean(map(math.log, times))


@POSIX
def test_the_result_in_the_report_follows_from_the_raw_trials(study: tuple[Path, bytes, str]) -> None:
    folder, _, summary = study
    raw = by_run(rows_of(folder / "trials.csv"))
    d = [person_logs(raw, person, "speed") - person_logs(raw, person, "position") for person in codes(6)]
    mean, spread = statistics.fmean(d), statistics.stdev(d)
    half = 2.570581835636314 * spread / math.sqrt(6)  # Student's t, 5 degrees of freedom
    flips = [abs(sum(sign * one for sign, one in zip(signs, d, strict=True))) for signs in product((1, -1), repeat=6)]
    p = sum(flip >= abs(sum(d)) - 1e-12 for flip in flips) / len(flips)
    low, ratio, high = (math.exp(value) for value in (mean - half, mean, mean + half))
    words = (
        f"Movement time per target with speed is {ratio:.2f} times that with position "
        f"(95 % limits {low:.2f} to {high:.2f}; p = {p:.2g}, 6 people)."
    )
    page = unescape(re.sub("<[^>]+>", " ", (folder / "report.html").read_text()))
    assert words in page
    assert summary == f"Simulated people: {words} Report: {folder / 'report.html'}\n"
    for one in raw.values():
        assert f"{max(each(one, 't_end')) - min(each(one, 't_start')):.1f}" in page


@POSIX
def test_the_report_says_who_played_and_what_is_left_out(study: tuple[Path, bytes, str]) -> None:
    page = unescape((study[0] / "report.html").read_text())
    assert "Study results: position against speed (simulated people)" in page
    assert "Nobody took part: these people are simulated." in page
    assert re.search(r"Left out: [1-4] targets? of blocks that were interrupted and began again", page)
    assert "60 practice targets are left out." in page


@POSIX
def test_the_report_is_made_again_with_the_same_figures(
    study: tuple[Path, bytes, str], capsys: pytest.CaptureFixture[str]
) -> None:
    folder, _, summary = study
    runs = (folder / "runs.csv").read_bytes()
    (folder / "runs.csv").unlink()
    assert call("report", str(folder)) == 0
    assert capsys.readouterr() == (summary, "")
    assert (folder / "runs.csv").read_bytes() == runs


@POSIX
def test_a_folder_with_something_in_it_is_refused(
    study: tuple[Path, bytes, str], capsys: pytest.CaptureFixture[str]
) -> None:
    table = (study[0] / "trials.csv").read_bytes()
    assert call("simulate", "--out", str(study[0])) == 2
    words = f"imugui: {study[0]} is not empty: a study needs a folder of its own\n"
    assert capsys.readouterr() == ("", words)
    assert (study[0] / "trials.csv").read_bytes() == table


def call(*arguments: str) -> int:
    """The command in this process; its exit status."""
    try:
        parsed = parser().parse_args(["study", *arguments])
        return int(parsed.run(parsed))
    except SystemExit as end:
        return int(str(end.code))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("simulate", "--out", "new", "--participants", "0"), "A study has 1 to 500 participants."),
        (("simulate", "--out", "new", "--blocks", "0"), "blocks: 0 is outside 1 to 50."),
        (("simulate", "--out", "new", "--resume"), "holds no study: there is no study.json"),
        (("report", "new"), "holds no study: there is no study.json"),
        (("simulate",), "--out"),
        ((), "simulate|report"),
    ],
)
def test_bad_usage_is_one_line_and_status_2(
    arguments: tuple[str, ...],
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(*arguments) == 2
    assert words in capsys.readouterr().err.splitlines()[-1]
    assert list(tmp_path.iterdir()) == []


def test_a_study_with_people_is_not_played_on_by_simulated_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Study.create(tmp_path / "real", StudyPlan(codes(2)))
    assert call("simulate", "--out", str(tmp_path / "real"), "--resume") == 2
    assert "is a study with people: only they can go on with it" in capsys.readouterr().err


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert call("simulate", "--out", str(tmp_path / "file" / "in")) == 2
    assert capsys.readouterr().err == f"imugui: {tmp_path / 'file' / 'in'}: Not a directory\n"
