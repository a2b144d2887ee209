"""Recording beside the data path, replay as a board, and computing it all again."""

from __future__ import annotations

import json
import math
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from imugui.fusion import FILTERS
from imugui.fusion.timing import ArrivalClock
from imugui.recording import UnreadableError, is_recording, read_recording
from imugui.recording.folder import ABOUT, ATTITUDE, EVENTS, RAW, SAMPLES
from imugui.samples import SAMPLE, Rows, empty_rows
from imugui.workers.headless import spin
from imugui.workers.recorder import disk_words
from imugui.workers.session import Session, Source, State
from imugui.workers.verify import _arrival_of, verify

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")


@pytest.fixture
def session(qtbot) -> Iterator[Session]:
    one = Session()
    yield one
    one.close()


def record(session: Session, source: Source, folder: Path, rows: int) -> None:
    """Record at least so many rows, changing filter and origin and setting a marker on the way."""
    session.connect_to(source)
    spin(session, lambda status: status.samples > 50)
    assert session.record(folder, "walk", "a note")
    for part in range(1, 5):
        spin(session, lambda _, part=part: session.recording.rows >= rows * part / 4)
        if part == 1:
            session.set_filter("mahony", FILTERS["mahony"].Params(kp=2.0))
        if part == 2:
            assert session.set_origin()
            assert session.mark("here")
        if part == 3:
            session.set_filter("madgwick", use_mag=False)
    assert session.stop_recording() == folder
    assert session.recording is None


@pytest.fixture(scope="module")
def master(qapp: object, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made once, and copied for every test that may change it."""
    folder = tmp_path_factory.mktemp("master") / "one.imugui"
    one = Session()
    record(one, Source("simulator", "free", rate_hz=400.0), folder, 1200)
    one.close()
    return folder


@pytest.fixture
def recorded(master: Path, tmp_path: Path) -> Path:
    return shutil.copytree(master, tmp_path / master.name)


def test_a_recording_holds_everything_and_opens_as_a_table(recorded: Path) -> None:
    recording = read_recording(recorded)
    assert recording.warnings == ()
    assert len(recording.samples) == len(recording.attitude) >= 1200
    assert [event.kind for event in recording.events] == ["start", "filter", "origin", "marker", "filter"]
    assert recording.about["label"] == "walk"
    assert recording.about["fusion"]["filter"] == "vqf"
    assert recording.about["ended"]["rows"] == len(recording.samples)
    lines = [line for line in (recorded / SAMPLES).read_text().splitlines() if not line.startswith("#")]
    assert lines[0].startswith("t,ax,ay,az,gx,gy,gz,mx,my,mz,temp_c,status")
    assert {line.count(",") for line in lines} == {lines[0].count(",")}
    assert np.all(recording.samples["t"] == recording.attitude["t"])


def test_verify_gets_the_same_digits_through_every_change(recorded: Path) -> None:
    result = verify(recorded)
    assert (result.attitude_difference_deg, result.sample_difference) == (0.0, 0.0)
    assert result.attitudes >= 1200
    assert "largest difference 0 deg" in result.sentence


def test_verify_notices_a_changed_digit(recorded: Path) -> None:
    path = recorded / ATTITUDE
    lines = path.read_text().splitlines()
    fields = lines[-5].split(",")
    fields[1] = repr(float(fields[1]) + 1e-3)
    lines[-5] = ",".join(fields)
    path.write_text("\n".join(lines) + "\n")
    assert verify(recorded).attitude_difference_deg > 0.01


def test_a_message_that_came_in_pieces_keeps_its_own_arrival() -> None:
    """Its first piece came before the recording: only the times after it tell which of the next pieces completed it."""
    arrivals = 0.01 * np.arange(400) + np.random.default_rng(1).uniform(0.0, 0.003, 400)
    known, row = ArrivalClock(), empty_rows(SAMPLE, 1)
    for arrival in arrivals[:380]:
        row["t_arrival"] = arrival
        known.stamp(row)

    def restored() -> ArrivalClock:
        again = ArrivalClock()
        again.restore(known.state())
        return again

    candidates = (arrivals[380] - np.array([0.006, 0.004, 0.002, 0.0])).tolist()
    for true in candidates:
        head = empty_rows(SAMPLE, 20)
        head["t_arrival"] = [true, *arrivals[381:]]
        clock = restored()
        for number in range(20):
            clock.stamp(head[number : number + 1])
        assert _arrival_of(1, head, head["t"].copy(), candidates, restored) == true


@POSIX
def test_verify_starts_from_the_raw_bytes_of_a_port(session: Session, tmp_path: Path) -> None:
    link, folder = tmp_path / "board", tmp_path / "port.imugui"
    command = [sys.executable, "-m", "imugui", "simulate", "--format", "accel-lines", "--port-link", str(link)]
    board = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        record(session, Source("serial", str(link)), folder, 400)
    finally:
        board.terminate()
        board.wait()
    result = verify(folder)
    assert (folder / RAW).stat().st_size > 10_000
    assert result.raw_samples >= 390
    assert (result.attitude_difference_deg, result.sample_difference) == (0.0, 0.0)


def shown_again(session: Session, qtbot, source: Source, expected: int) -> Rows:
    before = session.attitude.count
    session.connect_to(source)
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    qtbot.waitUntil(lambda: session.attitude.count - before >= expected)
    return session.attitude.last(session.attitude.count - before)


@pytest.mark.parametrize("speed", [1.0, math.inf])
def test_a_replay_shows_what_was_shown_bit_for_bit(session: Session, qtbot, recorded: Path, speed: float) -> None:
    recording = read_recording(recorded)
    rows = shown_again(session, qtbot, Source("replay", str(recorded), speed=speed), len(recording.samples))
    assert session.status().missed_rows == 0
    assert np.array_equal(rows["t"], recording.attitude["t"])
    assert np.array_equal(rows["quat"], recording.attitude["quat"])
    assert session.filter_name == "madgwick"
    assert session.has_origin


def test_a_replay_takes_another_filter(session: Session, qtbot, recorded: Path) -> None:
    session.set_filter("complementary")
    source = Source("replay", str(recorded), speed=math.inf, follow=False)
    rows = shown_again(session, qtbot, source, 1200)
    assert session.filter_name == "complementary"
    assert not np.array_equal(rows["quat"], read_recording(recorded).attitude["quat"])


def test_seek_speed_and_pause_never_break_the_clock(session: Session, qtbot, recorded: Path) -> None:
    session.connect_to(Source("replay", str(recorded), speed=4.0))
    qtbot.waitUntil(lambda: session.player is not None and session.player.position_s > 0.5)
    player = session.player
    player.pause()
    stood = player.rows["t"][0] + player.position_s
    qtbot.waitUntil(lambda: abs(session.attitude.last(1)["t"][0] - stood) < 1e-6)  # what was handed out is through
    player.seek(1.0)
    player.set_speed(16.0)
    before = session.attitude.count
    player.play()
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    qtbot.waitUntil(lambda: session.attitude.count == session.samples.count)
    rows = session.attitude.last(session.attitude.count - before)
    assert rows["t"][0] == pytest.approx(player.rows["t"][0] + 1.0, abs=0.01)
    assert np.diff(rows["t"]).min() > 0.0
    assert np.allclose(np.linalg.norm(rows["quat"], axis=1), 1.0)
    player.seek(0.0)
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING)


def test_a_loop_begins_again(session: Session, qtbot, recorded: Path) -> None:
    session.connect_to(Source("replay", str(recorded), speed=math.inf))
    qtbot.waitUntil(lambda: session.player is not None)
    session.player.set_loop(True)
    rows = len(read_recording(recorded).samples)
    qtbot.waitUntil(lambda: session.attitude.count > 3 * rows)
    assert session.status().missed_rows == 0


@POSIX
def test_a_killed_program_loses_a_second_at_most(tmp_path: Path, qtbot) -> None:
    folder = tmp_path / "killed.imugui"
    command = [sys.executable, "-m", "imugui", "live", "--simulate", "free", "--rate", "200", "--record", str(folder)]
    program = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    lines = lambda: (folder / SAMPLES).read_bytes().count(b"\n") if (folder / SAMPLES).exists() else 0  # noqa: E731
    qtbot.waitUntil(lambda: lines() > 600)
    until = time.monotonic()
    program.send_signal(signal.SIGKILL)
    program.wait()
    recording = read_recording(folder)
    assert any("cut off" in warning for warning in recording.warnings)
    assert len(recording.samples) > 500
    assert until - time.monotonic() < 1.0
    assert verify(folder).attitude_difference_deg == 0.0


@pytest.mark.skipif(not sys.platform.startswith("linux") or os.geteuid() != 0, reason="mounts a small tmpfs")
def test_a_full_disk_ends_the_recording_only(session: Session, qtbot, tmp_path: Path) -> None:
    disk = tmp_path / "small"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", str(disk)], check=False).returncode:
        pytest.skip("no tmpfs can be mounted here")
    try:
        said: list[str] = []
        session.message.connect(lambda _, text: said.append(text))
        session.connect_to(Source("simulator", "free", rate_hz=1000.0))
        assert session.record(disk / "full.imugui")
        qtbot.waitUntil(lambda: bool(said))
        assert "is full" in said[0]
        assert session.recording is None
        before = session.samples.count
        qtbot.waitUntil(lambda: session.samples.count > before + 100)
        recording = read_recording(disk / "full.imugui")
        assert len(recording.samples) > 300
        assert recording.warnings
    finally:
        session.disconnect_source()
        subprocess.run(["umount", str(disk)], check=True)


def damage(recorded: Path, name: str, content: bytes | None) -> None:
    if content is None:
        (recorded / name).unlink()
    else:
        (recorded / name).write_bytes(content)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        (ABOUT, None, "not a recording"),
        (ABOUT, b"{", "about.json"),
        (ABOUT, b'{"imugui_recording": 99}', "newer imugui"),
        (ABOUT, b"[]", "not a recording"),
        (SAMPLES, b"", "no samples"),
        (SAMPLES, None, "No such file"),
        (EVENTS, b"\x00\xff{}\n", "cut off before its first second"),
        (EVENTS, b'{"kind": "start", "t": 0, "sample": 0, "text": "", "data": {}}\n', "filter cannot be set up"),
    ],
)
def test_damage_is_named_in_one_line(recorded: Path, name: str, content: bytes | None, words: str) -> None:
    damage(recorded, name, content)
    with pytest.raises(UnreadableError, match=words) as caught:
        verify(recorded)
    assert "\n" not in str(caught.value)


def test_half_lines_are_left_out_and_said(recorded: Path) -> None:
    for name in (SAMPLES, ATTITUDE):
        path = recorded / name
        path.write_bytes(path.read_bytes()[:-7])
    about = json.loads((recorded / ABOUT).read_text())
    del about["ended"]
    (recorded / ABOUT).write_text(json.dumps(about))
    recording = read_recording(recorded)
    assert "cut off" in recording.warnings[0]
    assert verify(recorded).attitude_difference_deg == 0.0


def test_a_folder_that_exists_is_refused_and_nothing_is_touched(session: Session, qtbot, recorded: Path) -> None:
    before = (recorded / ABOUT).read_bytes()
    session.connect_to(Source("simulator", "rest"))
    said: list[str] = []
    session.message.connect(lambda _, text: said.append(text))
    assert not session.record(recorded)
    assert "File exists" in said[0]
    assert (recorded / ABOUT).read_bytes() == before


def test_without_a_board_there_is_nothing_to_record(session: Session, tmp_path: Path) -> None:
    assert not session.record(tmp_path / "x.imugui")
    assert not session.mark()
    assert session.stop_recording() is None


def test_a_copy_is_still_a_recording(recorded: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.imugui"
    shutil.copytree(recorded, copy)
    assert is_recording(copy)
    assert is_recording(copy / ABOUT)
    assert verify(copy / ABOUT).attitude_difference_deg == 0.0


def test_disk_words() -> None:
    assert "free some space" in disk_words(OSError(28, "No space left on device"), Path("x"))
    assert "cannot be written (Read-only" in disk_words(OSError(30, "Read-only file system"), Path("x"))


def test_reading_a_long_file_can_be_cancelled(session: Session, qtbot, tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    line = b"0.01,0.0,0.0,9.81,0.0,0.0,0.0\n"
    path.write_bytes(b"t,ax,ay,az,gx,gy,gz\n" + line * 400_000)
    session.connect_to(Source("replay", str(path)))
    qtbot.waitUntil(lambda: "% read" in session.status().sentence)
    session.disconnect_source()
    assert session.status().state is State.IDLE
    assert session.samples.count == 0


@pytest.mark.parametrize("content", [b"", b"\x00" * 5000, b"hello\n" * 50, bytes(range(256)) * 40, b"t,ax\n1,2\n"])
def test_a_file_without_samples_is_refused_in_one_line(session: Session, qtbot, tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "odd.bin"
    path.write_bytes(content)
    session.connect_to(Source("replay", str(path)))
    qtbot.waitUntil(lambda: session.status().state is State.FAILED)
    assert "odd.bin" in session.status().sentence
    assert "\n" not in session.status().sentence


def test_a_huge_sparse_file_is_refused_without_reading_it(session: Session, qtbot, tmp_path: Path) -> None:
    path = tmp_path / "huge.csv"
    with path.open("wb") as stream:
        stream.truncate(2 << 30)
    session.connect_to(Source("replay", str(path)))
    qtbot.waitUntil(lambda: session.status().state is State.FAILED)
    assert "huge.csv" in session.status().sentence
