"""What goes wrong with a wireless board: said in words, at once, and mended by itself."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("bleak")
from bleak import BleakAdapter, BleakClient

from imugui.formats.ble_profiles import BLE_PROFILES
from imugui.recording import read_recording
from imugui.workers import ble_link, ble_transport, reader
from imugui.workers.ble_errors import problem
from imugui.workers.ble_loop import Radio
from imugui.workers.ble_transport import BleTransport
from imugui.workers.session import Session, Source, State
from imugui.workers.verify import verify

GAP_STEP_S = 0.025  # between two samples: 2.5 intervals are missing
NEW_SERVICE = "0000aaaa-0000-1000-8000-00805f9b34fb"


class Watched:
    """A session on a board, and what it said."""

    def __init__(self, session: Session, qtbot, address: str) -> None:
        self.session, self._qtbot = session, qtbot
        self.said: list[tuple[str, str]] = []
        session.message.connect(lambda tone, text: self.said.append((tone, text)))
        session.connect_to(Source("ble", address))

    def until(self, state: State, words: str = "") -> str:
        """Wait for a state that lasts, and for words in its sentence."""

        def so() -> None:
            status = self.session.status()
            assert status.state is state, status
            assert words in status.sentence

        self._qtbot.waitUntil(so)
        return self.session.status().sentence

    def until_said(self, words: str) -> None:
        """Wait for a message, also of a state that is over before anybody looks."""
        self._qtbot.waitUntil(lambda: any(words in text for _, text in self.said))

    def until_samples(self, n: int = 5) -> None:
        """Wait for so many more."""
        before = self.session.samples.count
        self._qtbot.waitUntil(lambda: self.session.samples.count >= before + n)

    @property
    def tones(self) -> list[str]:
        return [tone for tone, _ in self.said]


@pytest.fixture(autouse=True)
def no_long_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody needs to be waited for that long here: the boards advertise more often than real ones."""
    monkeypatch.setattr(ble_link, "QUIET_S", 0.5)
    monkeypatch.setattr(ble_transport, "SEARCH_PAUSE_S", 0.05)


@pytest.fixture
def short_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """For boards that are not found."""
    monkeypatch.setattr(ble_link, "SEARCH_S", 0.6)


@pytest.fixture
def watched(card, ble_session: Session, qtbot) -> Watched:
    one = Watched(ble_session, qtbot, card.address)
    one.until_samples()
    return one


def test_a_dropped_link_is_said_once_and_comes_back(ble_lab, card, watched: Watched) -> None:
    ble_lab.drop_link(card)
    watched.until_said("out of reach or was switched off")
    watched.until_said("CONTROL.CMR is back.")
    watched.until_samples()
    watched.until(State.STREAMING, "The connection broke 1 x")
    assert watched.tones == ["error", "info"]
    assert watched.said[1][1] == "CONTROL.CMR is back."


def test_walking_away_and_back(ble_lab, card, watched: Watched, qtbot) -> None:
    watched.until_samples(60)  # enough to know the rate by
    ble_lab.leave_range(card)
    watched.until(State.LOST)
    qtbot.waitUntil(lambda: watched.session.status().age_ms > 900.0)
    ble_lab.enter_range(card)
    watched.until_said("CONTROL.CMR is back.")
    watched.until_samples()
    watched.until(State.STREAMING)
    assert watched.tones == ["error", "info"]
    status = watched.session.status()
    steps = np.diff(watched.session.samples.last(watched.session.samples.count)["t"])
    assert steps.max() > 0.8
    assert 1 <= status.gaps <= np.count_nonzero(steps > GAP_STEP_S)
    assert status.gap_s > 0.8


def test_a_weak_signal_or_battery_is_the_probable_reason(ble_lab, ble_session: Session, qtbot) -> None:
    weak = ble_lab.add_board("motion-card")
    ble_lab.set_rssi(weak, -91)
    seen = Watched(ble_session, qtbot, weak.address)
    seen.until_samples()
    qtbot.waitUntil(lambda: ble_session.status().battery_percent == 87.0)
    ble_lab.leave_range(weak, 0.05)
    seen.until_said("its signal was weak (-91 dBm)")
    ble_lab.enter_range(weak)
    seen.until_said("CONTROL.CMR is back.")
    seen.until_samples()
    ble_lab.set_battery(weak, 4)
    qtbot.waitUntil(lambda: ble_session.status().battery_percent == 4.0)
    ble_lab.leave_range(weak, 0.05)
    seen.until_said("its battery was at 4 %")


def test_the_adapter_is_switched_off_and_on(ble_lab, watched: Watched) -> None:
    ble_lab.set_powered(False)
    watched.until(State.LOST, "Bluetooth is switched off")
    ble_lab.set_powered(True)
    watched.until_samples()
    assert watched.tones == ["error", "error", "info"]


def test_the_adapter_is_pulled_and_put_back(ble_lab, watched: Watched) -> None:
    ble_lab.unplug()
    watched.until(State.LOST, "no Bluetooth adapter")
    ble_lab.plug_in()
    watched.until_samples()


def test_a_crashed_service_is_noticed_without_a_word_from_it(ble_lab, watched: Watched) -> None:
    ble_lab.kill_service()
    watched.until(State.LOST, "Bluetooth service does not answer")
    ble_lab.start_service()
    watched.until_samples()
    assert watched.tones == ["error", "info"]


def test_a_crashed_bus_is_said(ble_lab, watched: Watched) -> None:
    ble_lab.kill_bus()
    watched.until(State.LOST, "Bluetooth service does not answer")


def test_a_board_that_only_pauses_keeps_its_link(ble_lab, card, watched: Watched, qtbot) -> None:
    ble_lab.call(setattr, card, "rate_hz", 1e-6)
    sentence = watched.until(State.STALLED, "has sent nothing for")
    qtbot.waitUntil(lambda: watched.session.status().age_ms > 2_000.0)
    assert watched.until(State.STALLED, "has sent nothing for") != sentence  # asked for a sign of life, and gave it
    ble_lab.call(setattr, card, "rate_hz", 100.0)
    watched.until_samples()
    assert watched.said == []


def test_disconnecting_leaves_the_board_free(ble_lab, card, watched: Watched, qtbot) -> None:
    watched.session.disconnect_source()
    assert watched.session.status().state is State.IDLE
    qtbot.waitUntil(lambda: not card.connected)
    watched.session.connect_to(Source("ble", card.address))
    watched.until_samples()
    assert watched.said == []


def test_a_search_can_be_given_up_at_once(ble_lab, ble_session: Session, qtbot) -> None:
    Watched(ble_session, qtbot, "F0:00:00:00:00:00")
    qtbot.waitUntil(lambda: ble_session.radio.started)
    ble_session.disconnect_source()
    assert ble_session.status().state is State.IDLE


def test_a_board_that_is_not_there_is_waited_for(ble_lab, short_search, ble_session: Session, qtbot) -> None:
    seen = Watched(ble_session, qtbot, "F0:F1:F2:F3:AA:AA")
    seen.until(State.AWAY, "was not found")
    ble_lab.add_board("motion-card", address="F0:F1:F2:F3:AA:AA")
    seen.until_samples()


def test_a_board_in_somebody_elses_hands_is_not_found(ble_lab, short_search, card, ble_session: Session, qtbot) -> None:
    ble_lab.seize(card)
    seen = Watched(ble_session, qtbot, card.address)
    seen.until(State.AWAY, "connected to something else")
    ble_lab.release(card)
    seen.until_samples()


def test_a_board_of_another_program_is_told_from_one_of_ours(card, watched: Watched, short_search, qtbot) -> None:
    ours, theirs = Session(radio=watched.session.radio), Session()
    try:
        second = Watched(ours, qtbot, card.address)
        second.until(State.TAKEN, "open in this imugui already")
        other = Watched(theirs, qtbot, card.address)
        other.until(State.TAKEN, "connected to this computer already")
        watched.until_samples()
        assert watched.said == []
        watched.session.disconnect_source()
        qtbot.waitUntil(lambda: max(ours.samples.count, theirs.samples.count) > 0)
    finally:
        ours.close()
        theirs.close()


def test_a_second_client_that_hangs_up_drops_the_shared_link_which_comes_back(card, watched: Watched) -> None:
    async def come_and_go() -> None:
        """As a second program on this computer: it finds the board connected, and its leaving ends the link."""
        adapter = await BleakAdapter.get()
        (board,) = await adapter.get_connected_devices([card.model.profile.service])
        async with BleakClient(board):
            pass

    asyncio.run(come_and_go())
    watched.until_said("out of reach or was switched off")
    watched.until_said("CONTROL.CMR is back.")
    watched.until_samples()


def test_a_drop_during_the_set_up_is_tried_again(ble_lab, card, ble_session: Session, qtbot) -> None:
    ble_lab.hang_up_next(card)
    seen = Watched(ble_session, qtbot, card.address)
    seen.until_samples()
    assert "dropped while it was being set up" in seen.said[0][1]


def test_no_permission_is_said(ble_lab, card, ble_session: Session, qtbot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ble_transport, "PAUSES_S", (0.1,))
    monkeypatch.setattr(reader, "DENIED_GRACE_S", 0.0)
    ble_lab.refuse(True)
    seen = Watched(ble_session, qtbot, card.address)
    seen.until(State.DENIED, "No permission to use Bluetooth")
    ble_lab.refuse(False)
    seen.until_samples()


@pytest.mark.parametrize(
    ("name", "words"), [("CONTROL.CMR", "no characteristic that sends motion data"), ("WATCH", "none of its services")]
)
def test_a_wrong_device_is_refused_for_good(ble_lab, ble_session: Session, qtbot, name: str, words: str) -> None:
    from imugui.simulation.ble.models import MODELS  # needs what the lab needs

    card = MODELS["motion-card"]
    profile = replace(BLE_PROFILES["motion-card"], service=NEW_SERVICE, notify=NEW_SERVICE.replace("aaaa", "aaab"))
    board = ble_lab.add_board(model=replace(card, profile=profile), name=name)
    seen = Watched(ble_session, qtbot, board.address)
    seen.until(State.FAILED, words)
    qtbot.waitUntil(lambda: not board.connected)


def test_one_name_for_two_boards_is_refused(ble_lab, card, ble_session: Session, qtbot) -> None:
    twin = ble_lab.add_board("motion-card")
    sentence = Watched(ble_session, qtbot, card.name).until(State.FAILED, "Several boards")
    assert card.address in sentence
    assert twin.address in sentence


def test_a_recording_across_a_break_holds_the_gap(ble_lab, card, watched: Watched, qtbot, tmp_path: Path) -> None:
    session = watched.session
    assert session.record(tmp_path / "walk.imugui")
    watched.until_samples(30)
    ble_lab.leave_range(card, 0.05)
    watched.until(State.LOST)
    ble_lab.enter_range(card)
    watched.until_samples(30)
    folder = session.stop_recording()
    assert folder is not None
    recording = read_recording(folder)
    kinds = [event.kind for event in recording.events]
    assert kinds.index("lost") < kinds.index("connect")
    assert "out of reach" in next(event.text for event in recording.events if event.kind == "lost")
    result = verify(folder)
    assert result.raw_samples == len(recording.samples) > 40
    assert result.sample_difference == 0.0
    session.connect_to(Source("replay", str(folder), speed=8.0))
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    assert session.status().samples == len(recording.samples)


def test_pauses_grow_but_not_while_the_board_may_return() -> None:
    transport = BleTransport(Source("ble", "CARD"), Radio())
    off, away = problem("off", "CARD"), problem("away", "CARD")
    assert [transport.pause_s(off) for _ in range(7)] == [0.5, 1.0, 2.0, 4.0, 5.0, 5.0, 5.0]
    assert {transport.pause_s(away) for _ in range(7)} == {ble_transport.SEARCH_PAUSE_S}
    assert transport.pause_s(off) == 0.5
