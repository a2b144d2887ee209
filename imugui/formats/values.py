"""What the text decoders share below the line: number tokens, plausible values, rows as bytes."""

from __future__ import annotations

import math
import re
import string
import struct
from collections.abc import Iterable, Sequence

import numpy as np

from imugui.samples import GRAVITY, SAMPLE, Rows

NAN = math.nan
RAD_PER_DEG = math.pi / 180
DIGITS = string.digits.encode()
LETTERS = string.ascii_letters.encode()
NUMBER_CHARS = DIGITS + b".+-"
"""Every character of a plain decimal number; what is left of a line without them is its shape."""

ACC_LIMIT = 40 * GRAVITY  # m/s2; the widest of the boards' sensors ends at 16 g
GYR_LIMIT = 4000 * RAD_PER_DEG  # rad/s; the widest ends at 2000 deg/s
MAG_LIMIT = 5000.0  # uT; the AK8963 ends at 4912
TEMP_LIMIT = 150.0  # degrees Celsius, of either sign
GNSS_LIMITS = ((-90.0, 90.0), (-180.0, 180.0), (-1000.0, 100_000.0), (0.0, 2000.0), (-360.0, 360.0))
"""Lowest and highest latitude, longitude, altitude (m), speed (m/s) and course."""
ACC_LIMIT2, GYR_LIMIT2, MAG_LIMIT2 = ACC_LIMIT**2, GYR_LIMIT**2, MAG_LIMIT**2
IMPOSSIBLE_FIELD = "impossible magnetic field"
IMPOSSIBLE_TEMPERATURE = "impossible temperature"
ALL_ZERO = "impossible: all zero, the sensor does not answer"
NO_GNSS = (NAN, NAN, NAN, NAN, NAN)

# each digit can be read in one way only: else a long run of them takes for ever
_NUMBER = re.compile(rb"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_PLAIN = re.compile(rb"[+-]?\d+(?:\.\d*)?")
_NOT_FINITE = re.compile(rb"[+-]?(?:nan|inf|ovf)", re.IGNORECASE)
_LETTERS = {"f": "d", "i": "h"}


Row = Sequence[float]
"""(gyr 3, acc 3, mag 3, temp_c, status, lat, lon, alt, speed, course_deg) in SAMPLE's units; status is an int."""


def _layout() -> struct.Struct:
    fields = [SAMPLE[name] for name in SAMPLE.names or ()]
    return struct.Struct("=" + "".join(f"{math.prod(field.shape)}{_LETTERS[field.base.kind]}" for field in fields))


pack = _layout().pack
"""One SAMPLE row as bytes, from t, t_arrival and the values of a Row: ten times quicker than filling a numpy row."""


NO_ROWS: Rows = np.empty(0, SAMPLE)
"""What a chunk gives that completes nothing; one for all, as there is nothing in it to change."""


def rows_from(packed: bytearray) -> Rows:
    """The SAMPLE rows whose bytes are in ``packed``, shape (n,), without a copy."""
    return np.frombuffer(packed, SAMPLE) if packed else NO_ROWS


def number(token: bytes) -> float | None:
    """The value of one ASCII number; NaN for the board's ``nan``, ``inf`` and ``ovf``; None when it is no number.

    Narrower than float(), which also takes ``1_000``, ``infinity`` and digits of other scripts.
    """
    if _NUMBER.fullmatch(token):
        return float(token)
    return NAN if _NOT_FINITE.fullmatch(token) else None


def numbers(tokens: Iterable[bytes]) -> list[float] | None:
    """The values of all tokens, or None when one of them is no number."""
    values: list[float] = []
    for token in tokens:
        value = number(token)
        if value is None:
            return None
        values.append(value)
    return values


def loses_decimals(tokens: Sequence[bytes]) -> bool:
    """Whether the last number has fewer decimals than the first: the sign of a line that was cut.

    A board prints all numbers of a line with the same count.
    """
    first, last = tokens[0], tokens[-1]
    if not (_PLAIN.fullmatch(first) and _PLAIN.fullmatch(last)):
        return False
    return len(last.partition(b".")[2]) < len(first.partition(b".")[2])


def how_many(line: bytes, characters: bytes) -> int:
    """How many of these characters a line holds."""
    return len(line) - len(line.translate(None, characters))


def looks_numeric(line: bytes, separators: bytes, at_least: int) -> bool:
    """Whether a line was probably meant as data: enough separators, and a third of it digits."""
    return how_many(line, separators) >= at_least and 3 * how_many(line, DIGITS) >= len(line)


def fault(row: Row, partial: bool = False) -> str:
    """Why no sensor of ours can have measured this, in words; empty when it can.

    Acceleration and turn rate must be there, unless ``partial``.
    """
    gyr, acc, mag, temp, position = row[0:3], row[3:6], row[6:9], row[9], row[11:]
    if not (math.hypot(*acc) < ACC_LIMIT or (partial and math.isnan(sum(acc)))):  # so that NaN is caught too
        return "impossible acceleration"
    if not (math.hypot(*gyr) < GYR_LIMIT or (partial and math.isnan(sum(gyr)))):
        return "impossible turn rate"
    if not any(acc) and not any(gyr):
        return ALL_ZERO
    if math.hypot(*mag) >= MAG_LIMIT:
        return IMPOSSIBLE_FIELD
    if abs(temp) >= TEMP_LIMIT:
        return IMPOSSIBLE_TEMPERATURE
    if any(value < low or value > high for value, (low, high) in zip(position, GNSS_LIMITS, strict=True)):
        return "impossible position, speed or course"
    return ""


def field_or_nan(mx: float, my: float, mz: float) -> tuple[float, float, float]:
    """A magnetic field, or three NaN when an axis is missing or all are exactly zero: it was never measured."""
    if math.isnan(mx + my + mz) or not (mx or my or mz):
        return NAN, NAN, NAN
    return mx, my, mz


class GravityWatch:
    """Notices a wrong scale of the accelerometer: over many samples |acc| stays near 1 g whatever the hand does."""

    WINDOW = 200

    def __init__(self) -> None:
        self.trusted = False  # once a window was right there is nothing more to watch: units don't change
        self.doubt = ""  # one phrase, or empty
        self._norms: list[float] = []

    def update(self, ax: float, ay: float, az: float) -> bool:
        """Take one sample (m/s2) as long as the scale is not trusted; True when ``doubt`` changed."""
        self._norms.append(math.hypot(ax, ay, az))
        if len(self._norms) < self.WINDOW:
            return False
        median = sorted(self._norms)[self.WINDOW // 2]
        self._norms.clear()
        before = self.doubt
        self.trusted = 0.5 * GRAVITY < median < 2 * GRAVITY
        self.doubt = "" if self.trusted else f"but |acc| is mostly {median / GRAVITY:.3g} g: is its unit right?"
        return self.doubt != before
