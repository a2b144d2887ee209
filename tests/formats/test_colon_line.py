"""colon-line: raw or scaled is decided once, said, and doubted when it does not fit."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats.colon_line import HOLD, ColonLineDecoder
from imugui.formats.values import GravityWatch
from imugui.samples import GRAVITY, SAMPLE, empty_rows

GOLDEN = b"#:858:-1362:16142:0:1:0:-5305:0:\r\n"  # the captured packet 03-5A-FA-AE-3F-0E-00-00-00-01-00-00-EB-47-00


def test_the_captured_packet() -> None:
    decoder = ColonLineDecoder(Options())
    (row,) = decoder.feed(GOLDEN, 0.0)
    assert row["acc"] / GRAVITY == pytest.approx((0.052, -0.083, 0.985), abs=5e-4)
    assert np.degrees(row["gyr"]) == pytest.approx((0.0, 1 / 16.4, 0.0))
    assert row["temp_c"] == pytest.approx(20.93, abs=0.005)
    assert row["status"] == 0
    assert np.isnan(row["mag"]).all()
    assert decoder.seen.startswith("raw counts, 16384 per g, 16.4 per deg/s")


@pytest.mark.parametrize(
    ("line", "words", "acc", "temp_c"),
    [
        (b"#:0.05:-0.08:0.99:0.00:1.25:0.00:20.93:2:\r\n", "g, deg/s, temperature in degrees", 0.99 * GRAVITY, 20.93),
        (b"#:0.51:-0.82:9.66:0.00:1.25:0.00:20.93:2:\r\n", "m/s2, deg/s, temperature in degrees", 9.66, 20.93),
        (
            b"#:0.05:-0.08:0.99:0.00:1.25:0.00:-5305:2:\r\n",
            "g, deg/s, temperature in raw counts",
            0.99 * GRAVITY,
            20.927,
        ),
        (
            b"#:858:-1362:16142:0:20.5:0:20.93:2:\r\n",
            "per deg/s, temperature in degrees",
            16142 / 16384 * GRAVITY,
            20.93,
        ),
    ],
)
def test_scales_are_told_apart(line: bytes, words: str, acc: float, temp_c: float) -> None:
    decoder = ColonLineDecoder(Options())
    (row,) = decoder.feed(line, 0.0)
    assert words in decoder.seen
    assert row["acc"][2] == pytest.approx(acc)
    assert np.degrees(row["gyr"][1]) == pytest.approx(1.25)
    assert row["temp_c"] == pytest.approx(temp_c, abs=1e-3)
    assert row["status"] == 2


def test_rows_before_the_decision_are_kept_with_their_own_arrival() -> None:
    decoder = ColonLineDecoder(Options())
    early = [decoder.feed(b"#:0.10:0.10:%d.50:0.00:0.00:0.00:20.93:0:\r\n" % (2 + k), float(k)) for k in range(2)]
    assert sum(map(len, early)) == 0
    assert "not decided" in decoder.seen
    rows = decoder.feed(b"#:0.10:0.10:9.70:0.00:0.00:0.00:20.93:0:\r\n", 2.0)
    assert rows["t_arrival"].tolist() == [0.0, 1.0, 2.0]
    assert rows["acc"][:, 2] == pytest.approx((2.5, 3.5, 9.7))
    assert decoder.counts.messages == 3


def test_the_nearest_scale_is_taken_when_none_is_close() -> None:
    decoder = ColonLineDecoder(Options())
    rows = decoder.feed(b"#:0.10:0.10:5.50:0.00:0.00:0.00:20.93:0:\r\n" * HOLD, 0.0)
    assert len(rows) == HOLD
    assert decoder.seen.startswith("m/s2")


def test_a_short_file_is_decided_at_its_end() -> None:
    decoder = ColonLineDecoder(Options())
    assert len(decoder.feed(b"#:0.10:0.10:5.50:0.00:0.00:0.00:20.93:0:\r\n", 0.0)) == 0
    assert len(decoder.flush(0.0)) == 1


def test_the_decision_stands_and_a_wrong_one_is_told() -> None:
    decoder = ColonLineDecoder(Options())
    decoder.feed(b"#:0.10:0.10:1.00:0.00:0.00:0.00:20.93:0:\r\n", 0.0)  # m/s2, at a moment of nearly free fall
    rows = decoder.feed(b"#:0.10:0.10:9.70:0.00:0.00:0.00:20.93:0:\r\n" * GravityWatch.WINDOW, 0.0)
    assert rows["acc"][0, 2] == pytest.approx(9.7 * GRAVITY)
    assert "is its unit right?" in decoder.seen
    assert "9.7 g" in decoder.seen


def test_a_shaken_start_is_forgiven_later() -> None:
    decoder = ColonLineDecoder(Options())
    decoder.feed(GOLDEN, 0.0)
    decoder.feed(b"#:100:100:4000:0:0:0:-5305:0:\r\n" * GravityWatch.WINDOW, 0.0)
    assert "is its unit right?" in decoder.seen
    decoder.feed(GOLDEN * GravityWatch.WINDOW, 0.0)
    assert "is its unit right?" not in decoder.seen


@pytest.mark.parametrize(
    "line",
    [
        b"#:858:-1362:16142:0:1:0:-5305:",
        b"#:858:-1362:16142:0:1:0:-5305:0",
        b"#:858:-1362:16142:0:1:0:-5305:0:0:",
        b"#:858:-1362:16142:0:1:0:-5305:256:",
        b"#:858:-1362:16142:0:1:0:-5305:0.5:",
        b"#:858:-1362:16142:0:1:0:-5305:nan:",
        b"#:858::16142:0:1:0:-5305:0:",
        b"5#:858:-1362:16142:0:1:0:-5305:0:",
        b":858:-1362:16142:0:1:0:-5305:0:#",
        b"#:0:0:0:0:1:0:-5305:0:",
        b"#:ovf:-1362:16142:0:1:0:-5305:0:",
        b"#:858:-1362:161\x0042:0:1:0:-5305:0:",
        GOLDEN.strip() + GOLDEN.strip(),
    ],
)
def test_damaged_lines_are_bad(line: bytes) -> None:
    decoder = ColonLineDecoder(Options())
    assert len(decoder.feed(line + b"\r\n", 0.0)) == 0
    assert decoder.counts.bad_messages == 1
    assert len(decoder.feed(GOLDEN, 0.0)) == 1


def test_connection_messages_are_chatter() -> None:
    decoder = ColonLineDecoder(Options())
    decoder.feed(b"# scanning\r\nMTC connected: D9:D2:38:9A:7E:21\r\n", 0.0)
    assert (decoder.counts.chatter, decoder.counts.bad_messages) == (2, 0)


def test_another_sensor_has_other_counts() -> None:
    decoder = ColonLineDecoder(Options(family="mpu9250"))
    (row,) = decoder.feed(GOLDEN, 0.0)
    assert row["temp_c"] == pytest.approx(21.0 - 5305 / 333.87)


def test_encoder_writes_the_cards_counts() -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["acc"][0] = np.array((858, -1362, 16142)) / 16384 * GRAVITY
    rows["gyr"][0] = np.radians((0.0, 1.0, -0.001)) / 16.4
    rows["temp_c"][0] = -5305 / 340 + 36.53
    rows["acc"][1], rows["gyr"][1] = (0.0, 0.0, 5 * GRAVITY), np.radians((0.0, 0.0, -9000.0))
    first, second, _ = FORMATS["colon-line"].encoder().encode(rows).split(b"\r\n")
    assert first == GOLDEN.strip()
    assert second == b"#:0:0:32767:0:0:-32768:nan:0:"
