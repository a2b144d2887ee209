"""triplets: ``ax,ay,az;gx,gy,gz;mx,my,mz[;][lat,lon,0;heading,speed,alt]``, the RC-car tracker's receiver.

g, deg/s, mG in the AK8963's axes, degrees, m/s, m; CR LF. Four groups (an older firmware) are read as
latitude, longitude and speed, except when the fourth ends in the literal ``0``: that is a cut five-group line.
"""

from __future__ import annotations

from collections.abc import Sequence

from imugui.formats.base import Encoder, Options
from imugui.formats.families import FAMILIES, family, on_wire, to_wire
from imugui.formats.lines import LineDecoder
from imugui.formats.values import (
    ALL_ZERO,
    NAN,
    NO_GNSS,
    NUMBER_CHARS,
    RAD_PER_DEG,
    loses_decimals,
    numbers,
    pack,
)
from imugui.samples import GRAVITY, NO_STATUS, Rows

FAMILY = "mpu9250"
IMU_RATE_HZ = 140.0  # measured in the recordings' start-up seconds
GNSS_RATE_HZ = 9.6  # a stream of nothing but position lines holds one every 104 ms
UT_PER_MG = 0.1
POINT = ord(".")

SHAPES = frozenset((b",,;,,;,,;", b",,;,,;,,;,,;,,", b",,;,,;,,;,,;,,;"))
"""What the receiver sends, without its numbers: three groups and an empty one, or five."""
BENCH_SHAPE = b",,;,,;,,"  # the bench sketch has no final semicolon: a cut can only be seen in the last number


class TripletsDecoder(LineDecoder):
    """Reads ``triplets`` lines."""

    SEPARATORS = b",;"

    def __init__(self, options: Options) -> None:
        super().__init__()
        chosen = family(options.family, FAMILY)
        self._mag_axes = on_wire(chosen.mag_axes, UT_PER_MG, 6)
        self._with_position = 0
        self._answered = False  # the message before this one measured something
        self.seen = f"g, deg/s, mG; {chosen.title}"
        self.rate_hz = IMU_RATE_HZ

    def _line(self, line: bytes) -> None:
        shape = line.translate(None, NUMBER_CHARS)
        if shape in SHAPES or (shape == BENCH_SHAPE and line[-3] == POINT):
            try:
                values = list(map(float, line.rstrip(b";").replace(b";", b",").split(b",")))
            except ValueError:
                self._not_data(line)
                return
            self._accept(values, line)
        else:
            self._unusual(line)

    def _unusual(self, line: bytes) -> None:
        """Lines with nan, spaces or exponents, of the older firmware, and everything that is not data."""
        groups = [group.split(b",") for group in line.strip().removesuffix(b";").split(b";")]
        tokens = [token.strip() for group in groups for token in group]
        values = numbers(tokens)
        bench = len(groups) == 3 and not line.rstrip().endswith(b";")
        whole = len(groups) in (3, 4, 5) and all(len(group) == 3 for group in groups)
        if values is None or not whole:
            self._not_data(line)
        elif (len(groups) == 4 and tokens[-1] == b"0") or (bench and loses_decimals(tokens)):
            self._bad("cut", line)
        else:
            self._accept(values, line)

    def _accept(self, v: Sequence[float], line: bytes) -> None:
        ax, ay, az, gx, gy, gz = v[:6]
        if gx == gy == gz and self._is_false(v, line):
            return
        if len(v) == 15 and v[11] != 0:
            self._bad("malformed", line)
            return
        lat, lon, alt, speed, course_deg = NO_GNSS if len(v) == 9 else _gnss(v)
        (i, x), (j, y), (k, z) = self._mag_axes
        reason = self._emit(
            self._t,
            gx * RAD_PER_DEG,
            gy * RAD_PER_DEG,
            gz * RAD_PER_DEG,
            ax * GRAVITY,
            ay * GRAVITY,
            az * GRAVITY,
            v[i] * x,
            v[j] * y,
            v[k] * z,
            NAN,
            NO_STATUS,
            lat,
            lon,
            alt,
            speed,
            course_deg,
        )
        if reason:
            self._bad(reason, line)
        else:
            self._answered = True
            self._with_position += len(v) > 9

    def _is_false(self, v: Sequence[float], line: bytes) -> bool:
        """Deal with a payload of one repeated word or of zeros; True when the line needs nothing more.

        A single one with other words between the zeros (line 945 of the first recorded run) counts as a message that
        measured nothing: zero rates and forces, which filters skip, and neither field nor position. Several in a row
        are what a receiver prints that missed its parameters after a reset.
        """
        if not any(v[:6]) and not (self._answered and any(v[6:9])):
            self._bad(ALL_ZERO, line)
        elif not any(v[:6]):
            self._answered = False
            self._note(f"acceleration and turn rate all zero, the rest is not used: {self._text(line)}")
            self._packed += pack(self._t, self._t, *[0.0] * 6, NAN, NAN, NAN, NAN, NO_STATUS, *NO_GNSS)
        elif is_repeated_word(v):
            self._bad("impossible: one radio word repeated", line)
        else:
            return False
        return True

    def flush(self, t: float) -> Rows:
        """The rows still held back at the end of a file, and the rate of what it was full of."""
        rows = super().flush(t)
        mostly_position = self._with_position > 0.9 * self.counts.messages
        self.rate_hz = GNSS_RATE_HZ if mostly_position else IMU_RATE_HZ
        return rows


def _gnss(v: Sequence[float]) -> tuple[float, ...]:
    """(lat, lon, alt, speed, course_deg) of a message's values."""
    if len(v) == 15:
        return v[9], v[10], v[14], v[13], v[12]
    if len(v) == 12:
        return v[9], v[10], NAN, v[11], NAN
    return NO_GNSS


def is_repeated_word(v: Sequence[float]) -> bool:
    """Whether a radio payload of one repeated word made these values (g, deg/s, mG; at least 9).

    Accelerometer and gyroscope words each equal on all axes do not happen to a board that moves; to one
    at rest (gyroscope near 0) they can, then the magnetometer decides: its axes differ by the sensitivities only.
    """
    acc, gyr, mag = v[0:3], v[3:6], v[6:9]
    if max(acc) - min(acc) > 0.025 or max(gyr) - min(gyr) > 0.005:
        return False
    if abs(gyr[0]) > 0.1:
        return True
    small, large = min(map(abs, mag)), max(map(abs, mag))
    return large <= 1.06 * small and (max(mag) < 0 or min(mag) > 0)


class TripletsEncoder(Encoder):
    """Writes what the receiver sends: two decimals, CR LF, a position where the row has one."""

    def preamble(self) -> bytes:
        """The receiver's start-up lines and the GO after its parameter exchange."""
        return b"---Parameters RF transmission---\r\n4\r\n500\r\n16\r\n0.0001\r\n0.0153\r\n1.4994\r\nGO\r\n"

    def encode(self, rows: Rows) -> bytes:
        """One line for each row."""
        imu = zip(
            (rows["acc"] / GRAVITY).tolist(),
            (rows["gyr"] / RAD_PER_DEG).tolist(),
            (to_wire(rows["mag"], FAMILIES[FAMILY].mag_axes) / UT_PER_MG).tolist(),
            strict=True,
        )
        line = "%.2f,%.2f,%.2f;%.2f,%.2f,%.2f;%.2f,%.2f,%.2f;"
        lines = [line % (*acc, *gyr, *mag) for acc, gyr, mag in imu]
        for k in (rows["lat"] == rows["lat"]).nonzero()[0]:
            lines[k] += _position(rows[k])
        return "".join(line + "\r\n" for line in lines).encode()


def _position(row: Rows) -> str:
    altitude = "nan" if row["alt"] != row["alt"] else str(round(float(row["alt"])))
    return f"{row['lat']:.6f},{row['lon']:.6f},0;{row['course_deg']:.2f},{row['speed']:.2f},{altitude}"
