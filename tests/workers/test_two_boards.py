"""Two boards on one rigid body, one on a serial port, one on Bluetooth: the attitude of one in the other's frame."""

from __future__ import annotations

import math
import sys
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import angle_between, from_rotation_vector, multiply
from imugui.fusion.relative import Relative, align
from imugui.fusion.timing import ArrivalClock
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.path import Floats, Path
from imugui.simulation.pty_board import PtyBoard
from imugui.simulation.pty_port import PtyPort
from imugui.simulation.wire import Wire
from imugui.workers.session import Session, Source, State

DEGREE = math.pi / 180
SWITCH_S = 0.001
STOOD_STILL_S = 0.2
START_S = 1000.0
IDENTITY = (1.0, 0.0, 0.0, 0.0)
FORMAT = "triplets"
FASTER = 1.03  # the clock of the serial board


class Body:
    """A rigid body that lies still, until it is turned to and fro about two axes from a host time on."""

    def __init__(self) -> None:
        self.turns_from = math.inf

    def quats(self, host: Floats) -> Floats:
        t = np.maximum(host - self.turns_from, 0.0)
        zero = np.zeros_like(t)
        yaw, pitch = 40 * DEGREE * (1 - np.cos(0.7 * t)), 25 * DEGREE * (1 - np.cos(t))
        tilted = multiply(
            from_rotation_vector(np.stack((zero, zero, yaw), axis=1)),
            from_rotation_vector(np.stack((zero, pitch, zero), axis=1)),
        )
        return multiply(tilted, from_rotation_vector([0.2, -0.1, 0.0]))


class Fixed(Path):
    """Where a board on the body is, on the board's own time."""

    live = True  # made shortly before it is sent: nobody knows before when the body will be turned

    def __init__(self, body: Body, began: float = math.nan) -> None:
        self._body, self._began = body, began

    def quats(self, t: Floats) -> Floats:
        if math.isnan(self._began):
            self._began = time.monotonic() - float(t[0])
        return self._body.quats(self._began + t)


@pytest.fixture(autouse=True)
def hand_over_soon() -> Iterator[None]:
    """As in the program: a busy thread lets the readers in after a millisecond."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_S)
    yield
    sys.setswitchinterval(before)


@pytest.fixture
def body() -> Body:
    return Body()


@pytest.fixture
def serial_source(body: Body) -> Iterator[Source]:
    port = PtyPort()
    port.open()
    form = FORMATS[FORMAT]
    moving = VirtualBoard(Fixed(body), FASTER * form.rate_hz, PRESETS["ideal"], seed=3)  # what is left is the timing
    board = PtyBoard(Wire(moving, form), port, time.monotonic(), boot_s=0.0)
    stop = threading.Event()
    thread = threading.Thread(target=board.run_until, args=(stop,))
    thread.start()
    yield Source("serial", port.path, FORMAT, form.bauds[0])
    stop.set()
    thread.join(5.0)
    port.close()


@pytest.fixture
def ble_source(ble_lab, body: Body) -> Source:
    moving = VirtualBoard(Fixed(body), FORMATS["motion-card"].rate_hz, PRESETS["ideal"], seed=4)
    return Source("ble", ble_lab.add_board("motion-card", board=moving).address)


@pytest.fixture
def pair(ble_session: Session, serial_source: Source, ble_source: Source, qtbot) -> Iterator[tuple[Session, Session]]:
    """Tool on the serial port and reference on Bluetooth, both in the same window: one Bluetooth, one profile store."""
    ble_session.set_filter(ble_session.filter_name, use_mag=False)
    tool = ble_session.beside()
    for session, source in ((tool, serial_source), (ble_session, ble_source)):
        session.connect_to(source)
    for session in (tool, ble_session):
        qtbot.waitUntil(lambda s=session: s.status().state is State.STREAMING)
    tool.measure_against(ble_session)
    yield tool, ble_session
    tool.measure_against(None)
    tool.close()


def test_one_rigid_body_stays_one_while_it_turns(pair: tuple[Session, Session], body: Body, qtbot) -> None:
    tool, reference = pair
    relative = tool.relative
    assert relative is not None
    qtbot.waitUntil(lambda: relative.attitude.count > 200)
    assert not relative.aligned
    assert tool.set_origin()
    assert relative.aligned
    assert tool.has_origin
    first = tool.shown.count
    body.turns_from = time.monotonic() + 0.1
    qtbot.waitUntil(lambda: time.monotonic() > body.turns_from + 6.5)
    waited_s = max(np.diff(session.samples.last(session.samples.count)["t_arrival"]).max() for session in pair)
    if waited_s > STOOD_STILL_S:  # then the emulated boards give samples up, and stay behind the body
        pytest.skip(f"this machine stood still for {waited_s:.2f} s while the boards sent")
    rows = tool.shown.last(tool.shown.count - first)
    own = tool.attitude.last(len(rows))
    assert np.degrees(angle_between(own["quat"], own["quat"][0])).max() > 60.0
    assert np.degrees(angle_between(rows["quat"], IDENTITY)).max() < 1.0
    assert len(rows) > 5.0 * tool.rate_hz
    rates = tool.rate_hz / FORMATS[FORMAT].rate_hz, reference.rate_hz / FORMATS["motion-card"].rate_hz
    assert rates == pytest.approx((FASTER, 1.0), abs=0.01)


def stream(body: Body, format_name: str, speed: float, seed: int) -> Rows:
    """Attitudes of a calibrated board on the body, its bytes arriving late by up to 8 ms, on its own clock."""
    form = FORMATS[format_name]
    began = START_S + 0.013 * seed
    path = Fixed(body, began)
    wire = Wire(VirtualBoard(path, speed * form.rate_hz, PRESETS["mpu9250-calibrated"], seed), form)
    decoder, clock, delays = form.decoder(Options()), ArrivalClock(), np.random.default_rng(seed)
    blocks: list[Rows] = []
    for message in wire.messages(int(11.0 * wire.board.rate_hz)):  # the first lines may be a greeting
        sampled = began + sum(map(len, blocks)) / wire.board.rate_hz
        rows = decoder.feed(message, sampled + delays.uniform(0.0, 0.008))
        clock.stamp(rows)
        blocks.append(rows)
    return Pipeline(use_mag=False).step(np.concatenate(blocks))


@pytest.mark.parametrize(("tool_speed", "reference_speed"), [(1.03, 1.0), (1.0, 1.03)])
def test_two_calibrated_boards_with_clocks_that_differ(body: Body, tool_speed: float, reference_speed: float) -> None:
    body.turns_from = START_S + 4.0
    tool, reference = stream(body, FORMAT, tool_speed, 3), stream(body, "motion-card", reference_speed, 4)
    relative = Relative()
    still = [rows["t_arrival"] < START_S + 3.5 for rows in (tool, reference)]
    relative.step(tool[still[0]], reference[still[1]])
    assert relative.newest is not None
    relative.alignment = align(relative.newest[1], relative.newest[0], same_north=False)
    rows = relative.step(tool[~still[0]], reference[~still[1]])
    assert len(rows) > 1000
    assert np.degrees(angle_between(rows["quat"], IDENTITY)).max() < 1.0
