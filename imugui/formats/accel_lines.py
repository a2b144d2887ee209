"""accel-lines: ``ACCEL x y z``, ``GYRO x y z``, ``MAG x y z``, ``TEMP t``, the screw assistant's board.

g, deg/s, uT in the AK8963's axes, degrees Celsius; CR LF. The four lines are one message. The FaBo example's
``ax: 0.01 ay: -0.02 az: 1.00``, ``gx: ..``, ``mx: ..``, ``temp: ..`` is read the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import itemgetter

from imugui.formats.base import Encoder, Options
from imugui.formats.families import FAMILIES, family, on_wire, to_wire
from imugui.formats.lines import CR, CRLF, MAX_LINE, LineDecoder
from imugui.formats.values import (
    IMPOSSIBLE_FIELD,
    IMPOSSIBLE_TEMPERATURE,
    NAN,
    NO_ROWS,
    NUMBER_CHARS,
    RAD_PER_DEG,
    loses_decimals,
    numbers,
)
from imugui.samples import GRAVITY, NO_STATUS, Rows

FAMILY = "mpu9250"
RATE_HZ = 138.6  # measured: the serial line is the limit
POINT = ord(".")

ACCEL, GYRO, MAG, TEMP = range(4)
WORDS = {b"ACCEL": ACCEL, b"GYRO": GYRO, b"MAG": MAG, b"TEMP": TEMP}
SHAPES = (b"ACCEL   ", b"GYRO   ", b"MAG   ", b"TEMP ")
WHOLE_SHAPE = b" ".join(SHAPES)
ENDED_SHAPES = tuple(shape + CRLF for shape in SHAPES)
WHOLE_WORDS = list(WORDS)
WHOLE_LENGTH = 14
WHOLE_NUMBERS = itemgetter(1, 2, 3, 5, 6, 7, 9, 10, 11, 13)
UNKNOWN = (NAN, NAN, NAN)
ALIASES = {
    (b"ax:", b"ay:", b"az:"): ACCEL,
    (b"gx:", b"gy:", b"gz:"): GYRO,
    (b"mx:", b"my:", b"mz:"): MAG,
    (b"temp:",): TEMP,
}
MESSAGE = b"ACCEL %.2f %.2f %.2f, GYRO %.2f %.2f %.2f, MAG %.2f %.2f %.2f, TEMP %.2f"
STARTS = {labels[0]: part for labels, part in ALIASES.items()} | WORDS


class AccelLinesDecoder(LineDecoder):
    """Reads ``accel-lines`` messages.

    A message ends with TEMP, or with the first line of the next one when TEMP was lost. Without a good ACCEL and
    GYRO it is bad; without a good MAG its row has NaN there. A damaged line is counted once, and the message it
    spoils is not counted again.
    """

    SEPARATORS = b" \t"

    def __init__(self, options: Options) -> None:
        super().__init__()
        chosen = family(options.family, FAMILY)
        self._mag_axes = on_wire(chosen.mag_axes, first=6)
        self._parts: list[Sequence[float] | None] = [None] * 4
        self._newest = -1  # the part that came last in the open message; -1: none is open
        self._counted = False  # a damaged line of the open message has been counted already
        self._held: list[tuple[float, bytes]] = []  # (arrival, line) of a message that so far came line by line
        self._joined = False  # the open message may have begun before the port was opened
        self.seen = f"g, deg/s, uT; {chosen.title}"
        self.rate_hz = RATE_HZ

    def feed(self, chunk: bytes, t: float) -> Rows:
        """The SAMPLE rows, shape (n,), that ``chunk`` completes; t is its host arrival time, s.

        Lines that come one by one, as from a port, wait for their TEMP: a whole message is read at once.
        """
        held = self._held
        number = len(held)
        if (
            chunk.translate(None, NUMBER_CHARS) == ENDED_SHAPES[number]
            and chunk[-2] == CR
            and (number or (self._newest < 0 and len(chunk) < MAX_LINE and self._between_lines))
        ):
            held.append((t, chunk))
            if number < TEMP:
                return NO_ROWS
            self._release()
            return self._collect() if self._packed else NO_ROWS
        if number:
            self._release()
        return super().feed(chunk, t)

    def flush(self, t: float) -> Rows:
        """The rows still held back at the end of a file: a last line without a line end counts."""
        self._release()
        return super().flush(t)

    def _release(self) -> None:
        """Read the lines that waited, at the times when they came."""
        held, self._held = self._held, []
        text = b"".join([line for _, line in held])
        self.counts.bytes += len(text)
        if len(held) > TEMP:
            self._t = held[TEMP][0]
            if self._whole(text.split()):
                return
        for self._t, line in held:
            self._line(bytes(line[:-2]))

    def resync(self) -> None:
        """Forget the half line and the half message: the port was opened (again). Counts stay."""
        self._release()
        super().resync()
        if self._newest >= 0:
            self._note("half a message dropped at the reopening")
        self._parts, self._newest, self._counted, self._joined = [None] * 4, -1, False, True

    def _end(self) -> None:
        if self._newest >= 0:
            self._finish()

    def _read(self, lines: list[bytes]) -> None:
        """Read whole messages at once where they lie in one chunk: three times quicker than line by line."""
        first = 0
        while first + 4 <= len(lines):
            four = lines[first : first + 4]
            text = b" ".join(four)
            fits = self._newest < 0 and not self._may_be_cut and text.translate(None, NUMBER_CHARS) == WHOLE_SHAPE
            if fits and self._whole(text.split(b" ")):
                first += 4
            else:
                super()._read(four[:1])
                first += 1
        super()._read(lines[first:])

    def _whole(self, words: list[bytes]) -> bool:
        """Whether the words of four lines were one undamaged message, now read."""
        if words[::4] != WHOLE_WORDS or len(words) != WHOLE_LENGTH:
            return False
        wanted = WHOLE_NUMBERS(words)
        try:
            if not wanted[2][-3] == wanted[5][-3] == wanted[8][-3] == wanted[9][-3] == POINT:
                return False
            v = list(map(float, wanted))
        except (ValueError, IndexError):
            return False
        self._counted = self._joined = False
        self._give(v)
        return True

    def _line(self, line: bytes) -> None:
        words = line.split(b" ")
        part = WORDS.get(words[0])
        if part is None or line.translate(None, NUMBER_CHARS) != SHAPES[part] or line[-3] != POINT:
            self._unusual(line)
            return
        try:
            values = [float(word) for word in words[1:]]
        except ValueError:
            self._damaged(part, "malformed", line)
            return
        self._place(part, values)

    def _unusual(self, line: bytes) -> None:
        """Lines with nan, other spacing or decimals, of the FaBo example, and everything that is not data."""
        words = line.split()
        part = STARTS.get(words[0]) if words else None
        if part is None:
            self._counted |= self._not_data(line)
            return
        if words[0] in WORDS:
            tokens, named = words[1:], True
        else:
            tokens, named = words[1::2], ALIASES.get(tuple(words[0::2])) == part
        values = numbers(tokens)
        if values is None or not named or len(values) != (1 if part == TEMP else 3):
            self._damaged(part, "malformed", line)
        elif part != TEMP and loses_decimals(tokens):
            self._damaged(part, "cut", line)
        else:
            self._place(part, values)

    def _damaged(self, part: int, reason: str, line: bytes) -> None:
        if part <= self._newest:
            self._finish()
        self._counted = True
        self._bad(reason, line)
        self._place(part, None)

    def _place(self, part: int, values: Sequence[float] | None) -> None:
        """Put a part into the open message, or into a new one where it cannot belong to the open one."""
        if part <= self._newest:
            self._finish()
        self._newest = part
        self._parts[part] = values
        if part == TEMP:
            self._finish()

    def _finish(self) -> None:
        acc, gyr, mag, temp = self._parts
        counted, joined = self._counted, self._joined
        self._parts, self._newest, self._counted, self._joined = [None] * 4, -1, False, False
        if acc and gyr:
            self._give([*acc, *gyr, *(mag or UNKNOWN), *(temp or [NAN])])
        elif joined:
            self._note("first message after opening is not whole")
        elif not counted:
            self._bad("incomplete", b"a message without " + (b"GYRO" if acc else b"ACCEL"))

    def _give(self, v: Sequence[float]) -> None:
        """Give out a message's ten values; an impossible field or temperature is bad but spoils no more than itself."""
        ax, ay, az, gx, gy, gz = v[:6]
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
            v[9],
            NO_STATUS,
        )
        if reason:
            self._bad(reason, MESSAGE % tuple(v))
        if reason == IMPOSSIBLE_FIELD:
            self._give([*v[:6], *UNKNOWN, v[9]])
        elif reason == IMPOSSIBLE_TEMPERATURE:
            self._give([*v[:9], NAN])


class AccelLinesEncoder(Encoder):
    """Writes what the board sends: two decimals, ``nan`` for what it has not measured, CR LF."""

    def preamble(self) -> bytes:
        """The sketch's boot lines."""
        return b"RESET\r\n\r\nconfiguring device.\r\nconfigured FaBo 9Axis I2C Brick\r\n"

    def encode(self, rows: Rows) -> bytes:
        """Four lines for each row."""
        columns = zip(
            (rows["acc"] / GRAVITY).tolist(),
            (rows["gyr"] / RAD_PER_DEG).tolist(),
            to_wire(rows["mag"], FAMILIES[FAMILY].mag_axes).tolist(),
            rows["temp_c"].tolist(),
            strict=True,
        )
        line = "ACCEL %.2f %.2f %.2f\r\nGYRO %.2f %.2f %.2f\r\nMAG %.2f %.2f %.2f\r\nTEMP %.2f\r\n"
        return "".join(line % (*acc, *gyr, *mag, temp) for acc, gyr, mag, temp in columns).encode()
