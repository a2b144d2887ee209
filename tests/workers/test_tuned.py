"""The filter fits the board that is connected: its delays, and what was learnt of its gyroscope."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from imugui.calibration.learnt import METHOD
from imugui.calibration.parts import GyroscopePart
from imugui.calibration.profile import Profile, now_utc
from imugui.calibration.profile_file import LONGEST_DELAYS_MS
from imugui.calibration.profile_store import ProfileStore
from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.guidance.trust_profile import TURN_SHARE
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.workers.board_profile import board_of
from imugui.workers.headless import spin
from imugui.workers.session import Session, Source
from imugui.workers.tuned import FIELDS, NO_BOARD, delays_of, with_delays
from imugui.workers.verify import verify

WIRED = Source("serial", "/dev/no-such-port", "accel-lines")
VIRTUAL = Source("simulator", "free", rate_hz=200.0)
OFF = dataclasses.replace(PRESETS["mpu9250-calibrated"], gyr_scale_percent=3.0, gyr_cross_percent=1.75)


@pytest.fixture
def store(tmp_path: Path) -> ProfileStore:
    return ProfileStore(tmp_path / "profiles")


@pytest.fixture
def session(qtbot, store: ProfileStore) -> Iterator[Session]:
    one = Session("imugui", profiles=store)
    yield one
    one.close()


def plug(session: Session, source: Source) -> None:
    """As if this board were connected and had spoken, without a reader."""
    session._know(source)
    session._follow_board(source.format if source.format != "auto" else "")


def used(session: Session) -> tuple[float, float] | None:
    return delays_of(session.filter_params)


def test_the_tables_delays_are_used_until_the_user_says_others(session: Session, store: ProfileStore) -> None:
    assert used(session) == (0.0, 0.0)
    plug(session, WIRED)
    assert used(session) == (5.9, 1.0)
    assert session.delays.own is None
    assert session.set_params(dataclasses.replace(session.filter_params, mag_latency_ms=4.0, matrix_sigma=0.01))
    assert used(session) == (5.9, 4.0)
    assert session.filter_params.matrix_sigma == 0.01
    kept = store.find(board_of(WIRED))
    assert kept is not None
    assert kept.delays_ms == (5.9, 4.0)
    assert session.general_params(session.filter_params) == ImuguiParams(matrix_sigma=0.01)
    plug(session, dataclasses.replace(WIRED, address="/dev/another", format="triplets"))
    assert used(session) == (33.5, 0.0)
    plug(session, WIRED)
    assert used(session) == (5.9, 4.0)
    assert session.reset_delays()
    assert used(session) == (5.9, 1.0)
    assert session.delays.own is None


def test_of_an_unknown_board_the_users_general_delays_hold(session: Session) -> None:
    session.set_filter("imugui", ImuguiParams(gyr_latency_ms=2.0))
    plug(session, VIRTUAL)
    assert session.delays.used is None
    assert used(session) == (2.0, 0.0)
    assert session.set_params(dataclasses.replace(session.filter_params, gyr_latency_ms=3.0))
    assert session.beside().filter_params == ImuguiParams(gyr_latency_ms=2.0)
    plug(session, dataclasses.replace(VIRTUAL, seed=2))
    assert used(session) == (2.0, 0.0)


def test_other_filters_have_no_delays_and_lose_none(session: Session) -> None:
    plug(session, WIRED)
    session.set_filter("vqf")
    assert used(session) is None
    assert not session.has_delays
    session.set_filter("imugui", ImuguiParams(gyr_latency_ms=9.0))
    assert used(session) == (5.9, 1.0)
    plug(session, dataclasses.replace(VIRTUAL, seed=3))
    assert used(session) == (9.0, 0.0)


def test_delays_that_cannot_be_written_change_nothing(session: Session, store: ProfileStore) -> None:
    plug(session, WIRED)
    store.folder.write_text("a file where the folder should be")
    said: list[str] = []
    session.message.connect(lambda _, text: said.append(text))
    assert not session.set_params(dataclasses.replace(session.filter_params, gyr_latency_ms=1.0))
    assert used(session) == (5.9, 1.0)
    assert "Nothing changed" in said[0]


def test_a_calibrated_gyroscope_is_not_taken_for_the_worst(session: Session, store: ProfileStore) -> None:
    plug(session, dataclasses.replace(VIRTUAL, errors="mpu9250"))
    assert session.filter_params.matrix_worst == ImuguiParams().matrix_worst
    plug(session, dataclasses.replace(VIRTUAL, errors="mpu9250-calibrated"))
    assert session.filter_params.matrix_worst == TURN_SHARE
    assert session.general_params(session.filter_params) == ImuguiParams()
    assert session.set_params(dataclasses.replace(session.filter_params, matrix_sigma=0.01))
    assert session.filter_params.matrix_worst == TURN_SHARE
    session.set_filter("vqf")
    session.set_filter("imugui", ImuguiParams(matrix_worst=0.001))
    assert session.filter_params.matrix_worst == 0.001  # the user's word, where it is smaller
    plug(session, WIRED)
    assert session.filter_params.matrix_worst == 0.001
    scaled = GyroscopePart(date=now_utc(), method="rest", matrix_method="a turntable", turn_error_deg=0.9)
    assert session.set_params(ImuguiParams())
    assert session.apply_profile(Profile(board_of(WIRED), scaled))
    assert session.filter_params.matrix_worst == pytest.approx(np.hypot(TURN_SHARE, 0.01))


def test_without_a_board_there_is_nowhere_to_keep_anything(session: Session) -> None:
    assert not session.reset_delays()
    assert session.learnt() is None
    assert not session.keep_learnt()


def test_the_limits_of_files_are_those_of_the_form() -> None:
    highest = {item.name: item.metadata["high"] for item in dataclasses.fields(ImuguiParams)}
    assert tuple(highest[name] for name in FIELDS) == LONGEST_DELAYS_MS
    assert with_delays("no parameters", (1.0, 2.0)) == "no parameters"


def test_a_recording_tells_the_delays_and_is_computed_again_exactly(session: Session, tmp_path: Path) -> None:
    session.connect_to(dataclasses.replace(VIRTUAL, format="csv-line"))
    spin(session, lambda status: status.samples > 20)
    assert session.record(tmp_path / "one.imugui")
    spin(session, lambda _: session.recording.rows >= 60)
    assert session.set_params(dataclasses.replace(session.filter_params, gyr_latency_ms=8.0, mag_latency_ms=3.0))
    spin(session, lambda _: session.recording.rows >= 200)
    folder = session.stop_recording()
    assert folder is not None
    result = verify(folder)
    assert (result.attitude_difference_deg, result.sample_difference) == (0.0, 0.0)
    session.connect_to(Source("replay", str(folder)))
    spin(session, lambda status: status.samples >= 150)
    session.player.pause()
    assert session.board is None
    assert used(session) == (8.0, 3.0)
    assert session.delays.used is None


def teach(session: Session, board: VirtualBoard, seconds: float) -> None:
    """Fuse so much of a board at once, as a session does that looks at it."""
    session.status()
    session.samples.push(board.rows(round(100.0 * seconds)))
    session._fusion.drain()
    assert session._learning is not None
    session._learning._looked = -math.inf  # as if a second had passed
    session.status()
    session._fusion.drain()


def test_what_was_learnt_is_kept_when_asked_and_learning_begins_anew(session: Session, store: ProfileStore) -> None:
    said: list[str] = []
    session.message.connect(lambda _, text: said.append(text))
    plug(session, VIRTUAL)
    board = VirtualBoard("free", 100.0, OFF, 1)
    teach(session, board, 10.0)
    early = session.learnt()
    assert early is not None
    assert early.refusal == "10 of 20 s so far. Turn the board about all its axes."
    assert not session.keep_learnt()
    assert said == [early.refusal]
    assert store.find(board_of(VIRTUAL)) is None
    teach(session, board, 100.0)
    learnt = session.learnt()
    assert learnt is not None
    assert (learnt.refusal, learnt.samples) == ("", 11000)
    assert learnt.seconds == pytest.approx(110.0, abs=0.02)
    assert session.keep_learnt()
    assert session.profile is not None
    kept = store.find(board_of(VIRTUAL))
    assert kept is not None
    assert kept.gyroscope == session.profile.gyroscope
    assert kept.gyroscope is not None
    assert kept.gyroscope.matrix_method == METHOD
    left = np.array(kept.gyroscope.matrix) @ board.sensors.gyr.matrix - np.eye(3)
    assert np.abs(left).max() < 0.005
    assert session.fusion_settings["correction"]["gyr_matrix"] == kept.gyroscope.matrix
    session._fusion.drain()
    session.status()
    assert session.learnt() is None or session.learnt().seconds == 0.0


def test_the_bias_at_rest_after_connecting_is_the_earlier_one(session: Session) -> None:
    plug(session, VIRTUAL)
    known = session._known
    assert known is not None
    rows = VirtualBoard("rest", 100.0, OFF, 5).rows(800)
    assert known.start_up_bias(rows, 5.0) is not None
    part = known.best.gyroscope
    assert part is not None
    assert part.method == "at rest"
    assert known.profile is None
    scaled = GyroscopePart("at rest", "2026-05-01T12:00:00+00:00", matrix=((1.01, 0, 0), (0, 1, 0), (0, 0, 1)))
    known.profile = Profile(gyroscope=dataclasses.replace(scaled, matrix_method="turns", turn_error_deg=0.4))
    best = known.best.gyroscope
    assert best is not None
    assert (best.bias, best.matrix, best.turn_error_deg) == (part.bias, scaled.matrix, 0.4)
    assert (best.matrix_date, best.date > best.matrix_date) == (scaled.date, True)
    assert best.date <= now_utc()


def test_a_recording_cannot_be_taught(session: Session) -> None:
    plug(session, Source("replay", "no-such-file"))
    teach(session, VirtualBoard("free", 100.0, OFF, 1), 2.0)
    learnt = session.learnt()
    assert learnt is not None
    assert learnt.refusal == NO_BOARD
