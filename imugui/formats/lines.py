"""Lines out of a byte stream, with a bounded buffer, and what to do with those that are not data."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from imugui.formats.base import Decoder
from imugui.formats.values import (
    ACC_LIMIT2,
    GYR_LIMIT2,
    MAG_LIMIT2,
    NAN,
    NO_ROWS,
    TEMP_LIMIT,
    fault,
    field_or_nan,
    looks_numeric,
    pack,
)
from imugui.samples import SAMPLE, Rows

CRLF = b"\r\n"
CR = ord("\r")
MAX_LINE = 4096
"""Bytes; more without a line end is no text of ours, often a wrong baud rate."""


def readable(line: bytes) -> str | None:
    """The text of a line, or None when it holds anything unprintable."""
    try:
        text = line.decode().replace("\t", " ")
    except UnicodeDecodeError:
        return None
    return text if text.isprintable() else None


class LineDecoder(Decoder):
    """A decoder of text lines. A subclass reads one line at a time in ``_line`` and hands rows to ``_emit``."""

    SEPARATORS = b",;:"
    DATA_SEPARATORS = 2  # a line with so many separators and mostly digits was meant as data

    def __init__(self) -> None:
        super().__init__()
        self.partial = False  # some sensors may be missing
        self._t = 0.0
        self._pending = b""
        self._skipped = 0  # bytes of the overlong line that is being dropped
        self._may_be_cut = False  # the next line may have lost its start when the port was opened
        self._between_lines = True  # the next byte begins a line of which nothing was lost
        self._packed = bytearray()

    def feed(self, chunk: bytes, t: float) -> Rows:
        """The SAMPLE rows, shape (n,), that ``chunk`` completes; t is its host arrival time, s."""
        self._t = t
        size = len(chunk)
        self.counts.bytes += size
        # one whole line, as it comes from a port: cutting and joining would cost as much as reading it
        is_line = 2 < size < MAX_LINE and chunk.find(b"\n") == size - 1 and chunk[-2] == CR and type(chunk) is bytes
        if is_line and self._between_lines:
            self._line(chunk[:-2])
        else:
            self._read(self._split(bytes(chunk)))
            self._between_lines = not (self._pending or self._skipped or self._may_be_cut)
        return self._collect() if self._packed else NO_ROWS

    def flush(self, t: float) -> Rows:
        """The rows still held back at the end of a file: a last line without a line end counts."""
        self._t = t
        last, self._pending, self._skipped = self._pending, b"", 0
        self._read([last.rstrip(b"\r")])
        self._end()
        return self._collect() if self._packed else NO_ROWS

    def resync(self) -> None:
        """Forget the half line: the port was opened (again) in the middle of a stream. Counts stay."""
        if self._pending:
            self._note(f"half a line dropped at the reopening: {self._text(self._pending)}")
        self._pending, self._skipped, self._may_be_cut, self._between_lines = b"", 0, True, False

    @abstractmethod
    def _line(self, line: bytes) -> None:
        """Read one line, without its line end and never empty."""

    def _end(self) -> None:
        """Let go of what was held back for later lines; there will be none."""

    def _read(self, lines: list[bytes]) -> None:
        if self._may_be_cut and lines:
            if lines[0]:
                self._line(lines[0])
            self._may_be_cut = False
            del lines[0]
        for line in lines:
            if line:
                self._line(line)

    def _split(self, chunk: bytes) -> list[bytes]:
        lines = chunk.replace(b"\r\n", b"\n").split(b"\n")
        lines[0] = self._pending + lines[0]
        self._pending = lines.pop()
        if self._skipped and lines:
            self._note(f"{self._skipped + len(lines.pop(0))} bytes without a line end dropped")
            self._skipped = 0
        if self._skipped or len(self._pending) > MAX_LINE + 1:  # with its CR
            self._skip(self._pending)
            self._pending = b""
        if lines:
            lines[0] = lines[0].removesuffix(b"\r")  # it came with the chunk before
        if len(chunk) < MAX_LINE:
            return lines if not lines or len(lines[0]) <= MAX_LINE or self._skip_whole(lines[0]) else lines[1:]
        return [line for line in lines if len(line) <= MAX_LINE or self._skip_whole(line)]

    def _skip(self, part: bytes) -> None:
        if not self._skipped:
            self.counts.overlong += 1
            self._note(f"more than {MAX_LINE} bytes without a line end: {self._text(part[:40])}")
        self._skipped += len(part)

    def _skip_whole(self, line: bytes) -> bool:
        """Drop a line that is too long but ended within its chunk; always False, for use as a filter."""
        self.counts.overlong += 1
        self._note(f"a line of {len(line)} bytes dropped: {self._text(line[:40])}")
        return False

    def _emit(
        self, t: float, gx: float, gy: float, gz: float, ax: float, ay: float, az: float, mx: float, my: float,
        mz: float, temp: float, status: float, lat: float = NAN, lon: float = NAN, alt: float = NAN,
        speed: float = NAN, course: float = NAN,
    ) -> str:  # fmt: skip
        """Pack a row (values.Row) taken at t; or say why it is impossible."""
        # written out because every row passes here: a quick look that is True only where fault() finds nothing
        if not (
            (0 < ax * ax + ay * ay + az * az < ACC_LIMIT2 or (ax is NAN and self.partial))
            and (gx * gx + gy * gy + gz * gz < GYR_LIMIT2 or (gx is NAN and self.partial))
            and (mx is NAN or 0 < mx * mx + my * my + mz * mz < MAG_LIMIT2)
            and (temp is NAN or -TEMP_LIMIT < temp < TEMP_LIMIT)
            and (
                lat is lon is alt is speed is course is NAN
                or (
                    -90 <= lat <= 90
                    and -180 <= lon <= 180
                    and 0 <= alt < 9000
                    and 0 <= speed < 500
                    and 0 <= course <= 360
                )
            )
        ):
            row = (gx, gy, gz, ax, ay, az, mx, my, mz, temp, status, lat, lon, alt, speed, course)
            reason = fault(row, self.partial)
            if reason:
                return reason
            mx, my, mz = field_or_nan(mx, my, mz)
        self._packed += pack(t, self._t, gx, gy, gz, ax, ay, az, mx, my, mz, temp, status, lat, lon, alt, speed, course)
        return ""

    def _collect(self) -> Rows:
        rows, counts = np.frombuffer(self._packed, SAMPLE), self.counts  # without a copy
        self._packed = bytearray()
        n = len(rows)
        counts.messages += n
        counts.samples += n
        return rows

    def _not_data(self, line: bytes, reason: str = "malformed") -> bool:
        """Sort a line that gave no values: damaged data is bad (True), readable text is chatter."""
        if line.isspace():
            return False
        if readable(line) is None:
            self._bad("unreadable bytes", line)
        elif self._data_like(line):
            self._bad(reason, line)
        else:
            self._chatter(line)
            return False
        return True

    def _chatter(self, line: bytes) -> None:
        self.counts.chatter += 1
        self.log.add(self._t, "chatter", self._text(line))

    def _data_like(self, line: bytes) -> bool:
        return looks_numeric(line, self.SEPARATORS, self.DATA_SEPARATORS)

    def _bad(self, reason: str, line: bytes) -> None:
        if self._may_be_cut:
            self._note(f"first line after opening, {reason}: {self._text(line)}")
            return
        self.counts.bad_messages += 1
        self.counts.impossible += reason.startswith("impossible")
        self.log.add(self._t, "bad", f"{reason}: {self._text(line)}")

    def _note(self, text: str) -> None:
        self.log.add(self._t, "note", text)

    @staticmethod
    def _text(line: bytes) -> str:
        return readable(line) or line.decode("ascii", "backslashreplace")
