"""Notifications of emulated boards, through unmodified bleak, to samples and attitudes."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.formats.ble_profiles import BATTERY_LEVEL
from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.workers import ble_link
from imugui.workers.ble_errors import problem
from imugui.workers.ble_link import QUEUE, BoardFacts, Link, Mailbox
from imugui.workers.ble_loop import Radio
from imugui.workers.ble_transport import BleTransport
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.intake import Intake
from imugui.workers.port_errors import LinkError
from imugui.workers.reader import Reader
from imugui.workers.session import Session, Source, State

STREAM_S = 10.0
RATE_HZ = 100.0


def test_100_hz_for_ten_seconds_with_every_notification(
    ble_lab, card, ble_session: Session, gaps_without_cause, qtbot
) -> None:
    sent: list[bytes] = []
    card.on_sent = lambda _, message: sent.append(message)
    ble_session.connect_to(Source("ble", card.address))
    wanted = int(STREAM_S * RATE_HZ)
    qtbot.waitUntil(lambda: ble_session.status().samples >= wanted, timeout=120_000)
    qtbot.waitUntil(lambda: ble_session.rate_hz == pytest.approx(RATE_HZ, rel=0.02))
    ble_lab.remove_board(card)
    qtbot.waitUntil(lambda: ble_session.status().state is State.LOST)
    status = ble_session.status()
    assert status.messages == len(sent) == status.samples
    assert (status.bad_messages, status.missed_rows, status.overflow) == (0, 0, 0)
    rows = ble_session.samples.last(status.samples)
    assert gaps_without_cause(rows, status.gaps, RATE_HZ) == []
    raw = np.array([np.frombuffer(message[:6], ">i2") for message in sent]) / 16384.0 * 9.80665
    assert rows["acc"] == pytest.approx(raw, abs=1e-9)
    assert (np.diff(rows["t"]) > 0.0).all()


def test_more_than_a_thousand_at_ten_times_the_pace_keep_their_own_arrival_times(ble_lab) -> None:
    sent: list[tuple[float, bytes]] = []
    card = ble_lab.add_board("motion-card", speed=10.0)
    card.on_sent = lambda t, message: sent.append((t, message))
    radio = Radio()
    transport = BleTransport(Source("ble", card.address), radio)
    transport.open()
    got: list[tuple[float, bytes]] = []
    try:
        while len(got) < 1200:
            got += transport.read()
        ble_lab.remove_board(card)  # which sends no more, then disconnects
        with pytest.raises(LinkError):
            while True:
                got += transport.read()
    finally:
        transport.close()
        radio.stop()
    assert [message for _, message in got] == [message for _, message in sent]
    times = [t for t, _ in got]
    assert (np.diff(times) > 0.0).all()


def test_a_busy_reader_gets_each_message_with_its_own_time(ble_lab, card) -> None:
    radio = Radio()
    transport = BleTransport(Source("ble", card.address), radio)
    transport.open()
    try:
        while card.sent < 30:  # nobody reads
            time.sleep(0.005)
        waiting = transport.read()
        while len(waiting) < 25:  # some were still on their way
            waiting += transport.read()
    finally:
        transport.close()
        radio.stop()
    intake = Intake(Source("ble", card.address))
    intake.opened(transport, waiting[0][0])
    rows = intake.feed(waiting, waiting[-1][0])
    assert rows["t_arrival"].tolist() == [t for t, _ in waiting]
    assert intake.format == "motion-card"


def test_battery_signal_and_board_are_known(ble_lab, card, ble_session: Session, qtbot) -> None:
    ble_lab.set_rssi(card, -63)
    ble_lab.call(setattr, card, "rate_hz", 10.0)  # on a busy machine, what is asked for would queue behind the stream
    ble_session.connect_to(Source("ble", card.address))
    qtbot.waitUntil(lambda: ble_session.status().battery_percent == 87.0)
    ble_lab.set_battery(card, 15)
    qtbot.waitUntil(lambda: ble_session.status().battery_percent == 15.0)
    qtbot.waitUntil(lambda: ble_session.status().board != "")
    status = ble_session.status()
    assert status.board == "imugui emulated motion card 1.0"
    assert status.rssi_dbm == -63.0


class Draining:
    """A board whose battery tells of a change while the answer to a question is on its way."""

    async def start_notify(self, _: str, told: Callable[[Any, bytearray], None]) -> None:
        self._told = told

    async def read_gatt_char(self, uuid: str) -> bytearray:
        self._told(None, bytearray([4]))
        return bytearray([87] if uuid == BATTERY_LEVEL else b"emulated")


def test_an_answer_that_was_overtaken_by_a_change_does_not_undo_it() -> None:
    link = Link(Radio(), "CARD", BoardFacts())
    link._client = Draining()
    asyncio.run(link._ask())
    assert link.facts.battery_percent == 4.0


def test_the_button_comes_with_the_samples(ble_lab, card, ble_session: Session, qtbot) -> None:
    ble_session.connect_to(Source("ble", card.address))
    qtbot.waitUntil(lambda: ble_session.samples.count > 0)
    ble_lab.press(card, 2)
    qtbot.waitUntil(lambda: ble_session.samples.last(1)["status"][0] == 2)


def test_a_message_of_another_length_is_counted_bad(ble_lab, card, ble_session: Session, qtbot) -> None:
    ble_session.connect_to(Source("ble", card.address))
    qtbot.waitUntil(lambda: ble_session.samples.count > 0)
    ble_lab.send(card, b"fourteen bytes")
    qtbot.waitUntil(lambda: ble_session.status().bad_messages == 1)


@pytest.mark.parametrize(("kind", "name"), [("thingy-52", "thingy-motion"), ("wit-ble", "wit-motion")])
def test_other_boards_are_started_and_stream(ble_lab, ble_session: Session, qtbot, kind: str, name: str) -> None:
    board = ble_lab.add_board(kind)
    ble_session.connect_to(Source("ble", board.address))
    qtbot.waitUntil(lambda: ble_session.status().samples > 25)
    qtbot.waitUntil(lambda: ble_session.status().state is State.STREAMING)
    qtbot.waitUntil(lambda: ble_session.status().rate_hz == pytest.approx(RATE_HZ, rel=0.1))
    assert ble_session.status().format == name
    assert board.written == list(board.model.profile.start)


def test_two_boards_share_one_thread(ble_lab, card, ble_session: Session, gaps_without_cause, qtbot) -> None:
    second = ble_lab.add_board("motion-card", name="CONTROL.CMR-2")
    other = Session(radio=ble_session.radio)
    try:
        for session, board in ((ble_session, card), (other, second)):
            session.connect_to(Source("ble", board.address))
        for session in (ble_session, other):
            qtbot.waitUntil(lambda s=session: s.status().samples > 25)
        assert [thread.name for thread in threading.enumerate()].count("bluetooth") == 1
        for session in (ble_session, other):
            gaps = session.status().gaps
            assert gaps_without_cause(session.samples.last(session.samples.count), gaps, RATE_HZ) == []
    finally:
        other.close()
    before = ble_session.samples.count
    qtbot.waitUntil(lambda: ble_session.samples.count > before + 20)


def test_a_board_called_by_name_has_the_profile_of_its_address(
    card, ble_session: Session, qtbot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ble_link, "ALIKE_S", 0.1)
    ble_session.connect_to(Source("ble", card.name))
    qtbot.waitUntil(lambda: ble_session.samples.count > 0)
    qtbot.waitUntil(lambda: ble_session.board.address == card.address.lower())


def test_the_reader_steps_without_a_thread(ble_lab, card, qtbot) -> None:
    radio, ring = Radio(), Ring(SAMPLE, 100)
    source = Source("ble", card.address)
    reader = Reader(source, BleTransport(source, radio), ring, FusionWorker(ring, Ring(ATTITUDE, 100), Pipeline()))
    try:
        reader.step()
        assert reader.link.phase == "open"
        assert reader.where == "CONTROL.CMR"
        while ring.count < 5:
            reader.step()
    finally:
        reader.finish()
        radio.stop()


def test_a_full_mailbox_drops_the_oldest_and_counts() -> None:
    facts = BoardFacts()
    mail = Mailbox(facts)
    for number in range(QUEUE + 7):
        mail.put(float(number), b"x")
    mail.close(problem("lost", "CARD"))
    waiting = mail.take(0.0)
    assert (len(waiting), waiting[0][0], facts.overflow) == (QUEUE, 7.0, 7)
    with pytest.raises(LinkError, match="was lost"):
        mail.take(0.0)
    mail.close(problem("silent", "CARD"))
    assert mail.problem.kind == "lost"
