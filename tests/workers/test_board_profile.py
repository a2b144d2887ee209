"""A board's profile: known again, applied by itself, never half-written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from imugui.calibration.parts import GyroscopePart, MagnetometerPart
from imugui.calibration.profile import Board, Profile, now_utc
from imugui.calibration.profile_store import ProfileStore
from imugui.workers.board_profile import BoardProfile, board_of
from imugui.workers.session import Session, Source

SOURCE = Source("simulator", "free")


@pytest.fixture
def store(tmp_path: Path) -> ProfileStore:
    return ProfileStore(tmp_path / "profiles")


@pytest.fixture
def session(qtbot, store: ProfileStore) -> Iterator[Session]:
    one = Session(profiles=store)
    yield one
    one.close()


def profile(bias: float = 0.02) -> Profile:
    gyroscope = GyroscopePart(date=now_utc(), bias=(bias, 0.0, 0.0))
    magnetometer = MagnetometerPart(date=now_utc(), hard_iron=(5.0, 0.0, 0.0), field_ut=48.0, dip_deg=65.0)
    return Profile(gyroscope=gyroscope, magnetometer=magnetometer)


def test_it_is_applied_kept_and_known_again(session: Session, qtbot, store: ProfileStore) -> None:
    session.connect_to(SOURCE)
    qtbot.waitUntil(lambda: session.status().samples > 100)
    assert session.status().mag_trust == "uncalibrated"
    assert session.apply_profile(profile().renamed("bench"))
    qtbot.waitUntil(lambda: session.status().profile == "bench")
    assert session.status().mag_trust in ("good", "disturbed")
    before = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > before + 50)
    raw, fused = session.samples.last(1), session.attitude.last(session.attitude.count)
    row = fused[fused["t"] == raw["t"][0]] if len(raw) else fused[:0]
    if len(row):
        assert row["mag"][0] == pytest.approx(raw["mag"][0] - [5.0, 0.0, 0.0])
    session.disconnect_source()
    session.connect_to(SOURCE)
    assert session.profile is not None
    assert session.profile.board.name == "bench"
    session.connect_to(Source("simulator", "free", seed=2))
    assert session.profile is None
    session.connect_to(SOURCE)
    assert session.remove_profile()
    assert store.find(board_of(SOURCE)) is None
    assert session.profile is None


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"imugui_profile": 999}', b"\xff\xfe"])
def test_a_broken_profile_is_named_and_not_applied(session: Session, store: ProfileStore, content: bytes) -> None:
    path = store.path_of(board_of(SOURCE))
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    said: list[str] = []
    session.message.connect(lambda _, text: said.append(text))
    session.connect_to(SOURCE)
    assert "is not applied" in said[0]
    assert session.profile is None
    assert path.read_bytes() == content


def test_a_file_has_no_board_and_without_one_nothing_is_kept(session: Session, tmp_path: Path) -> None:
    assert board_of(Source("replay", "x.csv")) == Board()
    assert not session.apply_profile(profile())
    assert session.board is None


def test_a_board_that_lies_still_gives_its_bias_by_itself(session: Session, qtbot) -> None:
    session.connect_to(Source("simulator", "rest", errors="mpu9250"))
    qtbot.waitUntil(lambda: session.status().profile == "bias at rest")
    before = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > before + 400)
    rates = session.attitude.last(200)["gyr"].mean(axis=0)
    raw = session.samples.last(200)["gyr"].mean(axis=0)
    assert np.abs(raw).max() > np.deg2rad(0.5)
    assert np.abs(rates).max() < np.deg2rad(0.05)


def test_a_moving_board_does_not(store: ProfileStore) -> None:
    from imugui.simulation.board import VirtualBoard
    from imugui.simulation.errors import PRESETS

    known = BoardProfile(store, SOURCE)
    board = VirtualBoard("free", 200.0, PRESETS["mpu9250"], 1)
    board.rows(800)
    assert known.start_up_bias(board.rows(1000), 5.0) is None


def test_the_alarm_turns_red_in_a_strange_field(store: ProfileStore) -> None:
    known = BoardProfile(store, SOURCE)
    known.keep(profile())
    from imugui.samples import ATTITUDE, empty_rows

    rows = empty_rows(ATTITUDE, 300)
    rows["t"] = np.arange(300) / 100.0
    rows["quat"] = [1.0, 0.0, 0.0, 0.0]
    dip = np.deg2rad(65.0)
    rows["mag"] = 48.0 * np.array([0.0, np.cos(dip), -np.sin(dip)])
    rows["mag"][:, 0] = 0.01 * (np.arange(300) % 2)
    assert known.watch(rows[:150]) == "green"
    rows["mag"][150:] *= 1.2
    assert known.watch(rows[150:]) == "red"
