"""Numbers, plausible values and packed rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.formats import Options
from imugui.formats.csv_line import CsvLineDecoder, CsvLineEncoder
from imugui.formats.values import NO_GNSS, GravityWatch, fault, loses_decimals, number, numbers, pack, rows_from
from imugui.samples import SAMPLE, empty_rows

NAN = math.nan
GOOD = [0.1, 0.2, 0.3, 0.0, 0.1, 9.8, 20.0, 5.0, -40.0, 25.0, 1, 50.8, 12.9, 350.0, 1.5, 27.0]


@pytest.mark.parametrize(
    ("token", "value"),
    [(b"1", 1.0), (b"-0.00", 0.0), (b"+.5", 0.5), (b"7.", 7.0), (b"-1.5e-3", -0.0015), (b"2E2", 200.0)],
)
def test_numbers(token: bytes, value: float) -> None:
    assert number(token) == value


@pytest.mark.parametrize("token", [b"nan", b"NaN", b"-nan", b"inf", b"-inf", b"INF", b"ovf", b"+ovf"])
def test_what_arduino_prints_for_no_number_is_nan(token: bytes) -> None:
    value = number(token)
    assert value is not None
    assert math.isnan(value)


@pytest.mark.parametrize(
    "token",
    [b"", b" 1", b"1_0", b"infinity", b"0x1", b"1e", b"e1", b".", b"-", b"1.2.3", b"1,2", "١".encode(), b"1\x00"],
)
def test_everything_else_is_none(token: bytes) -> None:
    assert number(token) is None
    assert numbers([b"1", token]) is None


@given(st.binary(max_size=12))
def test_numbers_are_a_subset_of_what_float_takes(token: bytes) -> None:
    value = number(token)
    if value is not None and not math.isnan(value):
        assert value == float(token)


@pytest.mark.parametrize(
    ("tokens", "cut"),
    [
        ([b"1.00", b"2.00"], False),
        ([b"1.00", b"2.0"], True),
        ([b"1.00", b"2"], True),
        ([b"1", b"2"], False),
        ([b"1.0", b"2.00"], False),
        ([b"1.00", b"nan"], False),
        ([b"nan", b"2"], False),
        ([b"1.00", b"2e1"], False),
    ],
)
def test_a_cut_line_loses_decimals(tokens: list[bytes], cut: bool) -> None:
    assert loses_decimals(tokens) == cut


def test_a_good_row_has_no_fault() -> None:
    assert fault(GOOD) == ""
    assert fault([*GOOD[:6], NAN, NAN, NAN, NAN, -1, *NO_GNSS]) == ""


def test_a_row_of_some_sensors_only_has_no_fault_when_that_is_meant() -> None:
    for missing in (slice(0, 3), slice(3, 6), slice(0, 6)):
        row = list(GOOD)
        row[missing] = [NAN] * len(row[missing])
        assert fault(row).startswith("impossible")
        assert fault(row, partial=True) == ""
    assert fault([*GOOD[:3], 1e6, 0.0, 0.0, *GOOD[6:]], partial=True) == "impossible acceleration"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({3: 400.0}, "acceleration"),
        ({4: NAN}, "acceleration"),
        ({5: math.inf}, "acceleration"),
        ({0: 70.0}, "turn rate"),
        ({2: NAN}, "turn rate"),
        ({6: -5001.0}, "magnetic field"),
        ({9: 300.0}, "temperature"),
        ({11: 90.1}, "position"),
        ({12: -180.1}, "position"),
        ({13: -10024.0}, "position"),
        ({14: -100.24}, "speed"),
        ({15: -1002.4}, "course"),
        (dict.fromkeys(range(6), 0.0), "all zero"),
    ],
)
def test_faults(changes: dict[int, float], words: str) -> None:
    row = [changes.get(k, value) for k, value in enumerate(GOOD)]
    assert words in fault(row)


EXTREMES = st.sampled_from(
    (0.0, -0.0, NAN, math.inf, 1.0, -1.0, 69.8, 69.9, 391.0, 393.0, 5000.0, -90.5, 181.0, 361.0, 1e5, 1e300)
)


@settings(max_examples=300, deadline=None)
@given(st.dictionaries(st.sampled_from([k for k in range(16) if k != 10]), EXTREMES, max_size=6))
def test_the_quick_look_lets_nothing_pass_that_is_a_fault(changes: dict[int, float]) -> None:
    row = [changes.get(k, value) for k, value in enumerate(GOOD)]
    rows = rows_from(bytearray(pack(0.5, NAN, *row)))
    decoder, encoder = CsvLineDecoder(Options()), CsvLineEncoder(with_position=True)
    back = decoder.feed(encoder.preamble() + encoder.encode(rows), 0.0)
    finite = [NAN if math.isinf(value) else value for value in row]  # inf is a word for no number
    assert len(back) == (fault(finite) == "")
    assert decoder.counts.bad_messages == 1 - len(back)


def test_packed_rows_have_the_samples_layout() -> None:
    rows = rows_from(bytearray(pack(1.0, 2.0, *GOOD) + pack(3.0, 4.0, *GOOD)))
    expected = empty_rows(SAMPLE, 2)
    expected["t"], expected["t_arrival"] = (1.0, 3.0), (2.0, 4.0)
    expected["gyr"], expected["acc"], expected["mag"] = GOOD[0:3], GOOD[3:6], GOOD[6:9]
    for name, value in zip(("temp_c", "status", "lat", "lon", "alt", "speed", "course_deg"), GOOD[9:], strict=True):
        expected[name] = value
    assert rows.tobytes() == expected.tobytes()
    assert len(rows_from(bytearray())) == 0


def test_gravity_is_watched_until_it_was_right() -> None:
    watch = GravityWatch()
    assert not any(watch.update(0.0, 0.0, 1.0) for _ in range(watch.WINDOW - 1))
    assert watch.update(0.0, 0.0, 1.0)
    assert "0.102 g" in watch.doubt
    changed = [watch.update(0.0, 0.0, 9.8) for _ in range(watch.WINDOW)]
    assert changed[-1]
    assert watch.doubt == ""
    assert watch.trusted
    assert np.count_nonzero(changed) == 1
