"""What streams do: stall, jump in time, change their rate, send only NaN or the end of the range. Told the time."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import pytest

from imugui.formats import FORMATS
from imugui.fusion import FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.timing import ArrivalClock
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.intake import Intake
from imugui.workers.transport import Source
from imugui.workers.verdict import Facts, State, judge, oddity

RATE_HZ = 100.0
SOURCE = Source("serial", "/dev/ttyUSB0", "accel-lines", 115200)


class Port:
    """What the intake knows of a transport: that its rate can be set."""

    baud = 115200

    def set_baud(self, baud: int) -> None:
        self.baud = baud


def intake(source: Source = SOURCE) -> Intake:
    one = Intake(source)
    one.opened(Port(), 0.0)
    return one


def lines(n: int, format_name: str = "accel-lines") -> list[bytes]:
    """So many messages of a board that is turned about."""
    encoder = FORMATS[format_name].encoder()
    rows = VirtualBoard("free", RATE_HZ, PRESETS["mpu9250-calibrated"], 1).rows(n)
    return [encoder.encode(rows[k : k + 1]) for k in range(n)]


def feed(into: Intake, messages: Iterable[bytes], start: float, rate_hz: float = RATE_HZ) -> Rows:
    """Feed message after message, evenly in time; all rows."""
    return np.concatenate([into.feed(one, start + k / rate_hz) for k, one in enumerate(messages)])


def verdict(into: Intake, now: float, sample_t: float, rows: Rows) -> tuple[State, str]:
    facts = Facts(
        now, "open", SOURCE.address, opened=0.0, byte_t=sample_t, sample_t=sample_t, period_s=into.clock.period,
        format=into.format, findings=into.seen, odd=oddity(rows),
    )  # fmt: skip
    found = judge(facts)
    return found.state, found.sentence


@pytest.mark.parametrize("stall_s", [60.0, 900.0])
def test_a_stall_is_said_counted_and_forgiven(stall_s: float) -> None:
    into = intake()
    before = feed(into, lines(600), 1.0)
    last = float(before["t_arrival"][-1])
    state, words = verdict(into, last + 30.0, last, before)
    assert state is State.STALLED
    assert "has sent nothing for 30 s" in words
    after = feed(into, lines(600), last + stall_s)
    assert len(before) + len(after) == 1200
    assert into.clock.gaps == 1
    assert into.clock.gap_s == pytest.approx(stall_s, abs=0.1)
    assert into.clock.period == pytest.approx(0.01, rel=0.01)
    times = np.concatenate((before["t"], after["t"]))
    assert np.diff(times).min() > 0.0
    assert times[-1] == pytest.approx(after["t_arrival"][-1], abs=0.05)
    assert verdict(into, float(after["t_arrival"][-1]), float(after["t_arrival"][-1]), after)[0] is State.STREAMING


def test_a_clock_survives_rows_that_come_once_in_ten_minutes() -> None:
    clock = ArrivalClock()
    for k in range(200):
        rows = empty_rows(SAMPLE, 7)
        rows["t_arrival"] = 561.0 * (k // 2)
        clock.stamp(rows)
        assert np.isfinite(rows["t"]).all()
    assert clock.period > 0.0


def test_ten_times_the_rate_is_followed_and_nothing_is_lost() -> None:
    into = intake()
    feed(into, lines(500), 1.0)
    flood = feed(into, lines(10_000), 6.0, 10.0 * RATE_HZ)
    assert len(flood) == 10_000
    assert np.diff(flood["t"]).min() > 0.0
    assert into.clock.period == pytest.approx(0.001, rel=0.02)


@pytest.mark.parametrize("jump_s", [3600.0, -3600.0, -0.5, 1e9])
def test_a_clock_of_the_board_that_jumps_leaves_time_in_order(jump_s: float) -> None:
    header = b"t,ax,ay,az,gx,gy,gz\n"
    into = intake(Source("serial", "COM3", "csv-line", 115200))
    row = lambda t: b"%.3f,0.1,0.2,9.8,0.01,0.02,0.03\n" % t  # noqa: E731
    whole = feed(into, [header, *(row(5000.0 + k / 100) for k in range(300))], 1.0)
    jumped = feed(into, [row(5003.0 + jump_s + k / 100) for k in range(300)], 4.01)
    assert (len(whole), len(jumped)) == (300, 300)
    times = np.concatenate((whole["t"], jumped["t"]))
    assert np.diff(times).min() > 0.0
    fused = Pipeline("complementary").step(np.concatenate((whole, jumped)))
    assert np.allclose(np.linalg.norm(fused["quat"], axis=1), 1.0)


def test_a_sensor_that_sends_only_nan_is_named() -> None:
    into = intake()
    text = b"ACCEL: nan nan nan\r\nGYRO: nan nan nan\r\nMAG: nan nan nan\r\nTEMP: nan\r\n"
    found = VirtualBoard("rest", RATE_HZ, PRESETS["ideal"], 1).rows(1)
    spoiled = [FORMATS["accel-lines"].encoder().encode(found).replace(b"0", b"nan"), text]
    rows = feed(into, spoiled * 100, 1.0)
    assert len(rows) == 0
    into.tick(Port(), 8.0)
    state, words = judge(Facts(8.0, "open", "COM3", opened=0.0, byte_t=7.9, findings=into.seen)), into.seen
    assert state.state is State.NO_MESSAGES
    assert "bad message" in words or "numbers" in words


@pytest.mark.parametrize("name", FILTERS)
def test_rows_of_nan_hold_the_attitude_and_the_good_ones_go_on(name: str) -> None:
    pipeline = Pipeline(name)
    good = VirtualBoard("free", RATE_HZ, PRESETS["mpu9250-calibrated"], 1).rows(300)
    bad = good[100:200].copy()
    for field in ("gyr", "acc", "mag"):
        bad[field] = math.nan
    fused = pipeline.step(np.concatenate((good[:100], bad, good[200:])))
    assert np.allclose(np.linalg.norm(fused["quat"], axis=1), 1.0)
    assert np.all(fused["quat"][100:200] == fused["quat"][99])
    assert pipeline.skipped == 100


@pytest.mark.parametrize(
    ("sensor", "end", "words"),
    [
        ("gyr", np.radians(250.0), "gyroscope is at the end of its range"),
        ("gyr", np.radians(1998.05), "gyroscope is at the end of its range"),
        ("acc", 3.999 * GRAVITY, "accelerometer is at the end of its range"),
    ],
)
def test_a_sensor_at_the_end_of_its_range_is_named(sensor: str, end: float, words: str) -> None:
    rows = VirtualBoard("free", RATE_HZ, PRESETS["mpu9250-calibrated"], 1).rows(100)
    assert oddity(rows) == ""
    rows[sensor][50:60, 1] = -end
    assert words in oddity(rows)
    rows[sensor][50:60, 1] = -end * np.linspace(0.9, 0.999, 10)  # a fast turn that is all there
    assert oddity(rows) == ""


def test_a_defect_of_a_filter_costs_its_rows_once_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    from imugui.ring import Ring
    from imugui.samples import ATTITUDE

    samples, attitude = Ring(SAMPLE, 1000), Ring(ATTITUDE, 1000)
    worker = FusionWorker(samples, attitude, Pipeline("complementary"))
    rows = VirtualBoard("free", RATE_HZ, PRESETS["ideal"], 1).rows(60)
    samples.push(rows[:20])
    worker.drain()
    samples.push(rows[20:40])
    with monkeypatch.context() as broken:
        broken.setattr(FILTERS["complementary"], "update", lambda *_: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            worker.drain()
    samples.push(rows[40:])
    worker.drain()
    assert attitude.count == samples.count == 60
    fused = attitude.last(60)
    assert np.isnan(fused["quat"][20:40]).all()
    assert np.isfinite(fused["quat"][40:]).all()
