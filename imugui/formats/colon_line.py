"""colon-line: ``#:ax:ay:az:wx:wy:wz:temperature:status:``, the motion card's scanner.

Nobody has written down whether the values are raw counts or scaled. The first message whose |acc| is close to
1, 9.81 or one g in counts decides; until then messages are held back (not lost), and if none is that close the
nearest is taken after HOLD messages. The decision stands for the whole connection and is shown in ``seen``;
should it be wrong, ``seen`` says that |acc| is not near 1 g.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from imugui.formats.base import Encoder, Options
from imugui.formats.families import FAMILIES, Family, family
from imugui.formats.lines import LineDecoder
from imugui.formats.values import NAN, NUMBER_CHARS, RAD_PER_DEG, GravityWatch, numbers
from imugui.samples import GRAVITY, Rows

FAMILY = "mpu6050"
RATE_HZ = 100.0
HOLD = 50
CLOSE = 1.25  # times or divided by
STATUSES = frozenset(range(256))
LONG = 100  # bytes
COLON = ord(":")
SHAPE = b"#:::::::::"
NO_TEMPERATURE_C = 150.0  # degrees Celsius; a number beyond it must be a raw count

Values = Sequence[float]


@dataclass(frozen=True)
class Scale:
    """What one unit on the wire is worth."""

    acc: float  # m/s2
    gyr: float  # rad/s
    temp: float  # degrees Celsius
    temp_zero: float  # degrees Celsius at 0
    words: str


def acc_units(sensor: Family) -> dict[str, float]:
    """What |acc| reads at rest, for each unit it may be in."""
    return {"g": 1.0, "m/s2": GRAVITY, "raw counts": sensor.acc_per_g}


def scale_for(unit: str, sensor: Family, temperature: float, has_point: bool) -> Scale:
    """The scale of a board whose acceleration is in ``unit``; its gyroscope goes with it.

    The temperature is a raw count when the acceleration is one and it has no decimal point, or when it is too far
    from any weather for degrees Celsius.
    """
    raw = unit == "raw counts"
    acc = GRAVITY / acc_units(sensor)[unit]
    gyr = RAD_PER_DEG / sensor.gyr_per_dps if raw else RAD_PER_DEG
    words = f"raw counts, {sensor.acc_per_g:g} per g, {sensor.gyr_per_dps:g} per deg/s" if raw else f"{unit}, deg/s"
    if (raw and not has_point) or abs(temperature) >= NO_TEMPERATURE_C:
        return Scale(acc, gyr, 1 / sensor.temp_per_c, sensor.temp_zero_c, f"{words}, temperature in raw counts")
    return Scale(acc, gyr, 1.0, 0.0, f"{words}, temperature in degrees Celsius")


class ColonLineDecoder(LineDecoder):
    """Reads ``colon-line`` messages."""

    SEPARATORS = b":"
    DATA_SEPARATORS = 5

    def __init__(self, options: Options) -> None:
        super().__init__()
        self._sensor = family(options.family, FAMILY)
        self._scale: Scale | None = None
        self._held: list[tuple[float, Values, bytes]] = []
        self._watch = GravityWatch()
        self.seen = "not decided yet whether raw counts or scaled"
        self.rate_hz = RATE_HZ

    def _line(self, line: bytes) -> None:
        if line.translate(None, NUMBER_CHARS) == SHAPE and line[1] == line[-1] == COLON:
            try:
                # whole numbers are read in half the time; a short one is the same as a float
                kind = float if b"." in line or len(line) > LONG else int
                values: Values | None = list(map(kind, line[2:-1].split(b":")))
            except ValueError:
                values = None
        else:
            line = line.strip()
            tokens = [token.strip() for token in line[2:-1].split(b":")]
            whole = len(tokens) == 8 and line.startswith(b"#:") and line.endswith(b":")
            values = numbers(tokens) if whole else None
        scale = self._scale
        if values is None or values[7] not in STATUSES:
            self._not_data(line)
            return
        if scale is None:
            self._hold(values, line)
            return
        ax, ay, az, gx, gy, gz, temp, status = values
        acc, gyr = scale.acc, scale.gyr
        ax, ay, az = ax * acc, ay * acc, az * acc
        temp_c = temp * scale.temp + scale.temp_zero
        reason = self._emit(self._t, gx * gyr, gy * gyr, gz * gyr, ax, ay, az, NAN, NAN, NAN, temp_c, int(status))
        if reason:
            self._bad(reason, line)
        elif not self._watch.trusted and self._watch.update(ax, ay, az):
            self.seen = f"{scale.words} {self._watch.doubt}".strip()
            self._note(self.seen)

    def _data_like(self, line: bytes) -> bool:
        return line.startswith(b"#:") or super()._data_like(line)

    def _hold(self, values: Values, line: bytes) -> None:
        norm = math.hypot(*values[:3])
        if not 0 < norm < math.inf:
            self._bad("impossible acceleration", line)
            return
        self._held.append((self._t, values, line))
        unit, ratio = self._nearest(norm)
        if ratio < CLOSE:
            self._decide(unit, values, line)
        elif len(self._held) >= HOLD:
            self._end()

    def _nearest(self, norm: float) -> tuple[str, float]:
        """The unit in which a norm is nearest to 1 g, and by what ratio (at least 1) it is off."""
        off = {unit: max(norm / g, g / norm) for unit, g in acc_units(self._sensor).items()}
        unit = min(off, key=off.__getitem__)
        return unit, off[unit]

    def _end(self) -> None:
        """Decide by the median of what is held: nothing better will come."""
        if self._held:
            by_norm = sorted(self._held, key=lambda held: math.hypot(*held[1][:3]))
            _, values, line = by_norm[len(by_norm) // 2]
            self._decide(self._nearest(math.hypot(*values[:3]))[0], values, line)

    def _decide(self, unit: str, values: Values, line: bytes) -> None:
        has_point = b"." in line.split(b":")[-3]
        self._scale = scale_for(unit, self._sensor, values[6], has_point)
        self.seen = self._scale.words
        self._note(f"decided by |acc| = {math.hypot(*values[:3]):g}: {self.seen}")
        now, held, self._held = self._t, self._held, []
        for self._t, _, line in held:
            self._line(line)
        self._t = now


class ColonLineEncoder(Encoder):
    """Writes the card's raw counts: what the scanner prints when it passes the packet on."""

    def encode(self, rows: Rows) -> bytes:
        """One line for each row; a row without status is idle (0)."""
        sensor = FAMILIES[FAMILY]
        acc = rows["acc"] / GRAVITY * sensor.acc_per_g
        gyr = rows["gyr"] / RAD_PER_DEG * sensor.gyr_per_dps
        temp = (rows["temp_c"] - sensor.temp_zero_c) * sensor.temp_per_c
        counts = np.column_stack((acc, gyr, temp))
        limited = np.clip(np.rint(counts), -32768, 32767) + 0.0  # no minus zero among integers
        status = np.maximum(rows["status"], 0)
        line = "#:" + "%.0f:" * 7 + "%d:\r\n"
        return "".join(line % (*words, s) for words, s in zip(limited.tolist(), status.tolist(), strict=True)).encode()
