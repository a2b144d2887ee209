"""Messages that come as one piece: over Bluetooth LE one notification is one message of a fixed length.

There is no line end to find and no half message to keep: a chunk is a message or it is bad.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import NDArray

from imugui.formats.base import Decoder
from imugui.formats.values import GravityWatch, Row, fault, field_or_nan, pack, rows_from
from imugui.samples import Rows

INT16 = (-32768, 32767)


class FramedDecoder(Decoder):
    """A decoder of notifications. A subclass reads one message of LENGTH bytes in ``_message``."""

    LENGTH = 0

    def __init__(self) -> None:
        super().__init__()
        self._t = 0.0
        self._watch = GravityWatch()
        self._scale = ""  # what ``seen`` says of the units

    def feed(self, chunk: bytes, t: float) -> Rows:
        """The SAMPLE row, shape (1,), of one notification, or none; t is its host arrival time, s."""
        self._t = t
        message = bytes(chunk)
        self.counts.bytes += len(message)
        if not message:
            return rows_from(bytearray())
        if len(message) != self.LENGTH:
            self._bad(f"{len(message)} bytes instead of {self.LENGTH}", message)
            return rows_from(bytearray())
        row = self._message(message)
        return rows_from(bytearray()) if row is None else self._accept(row, message)

    def flush(self, t: float) -> Rows:
        """Nothing: no part of a message is ever held back."""
        return rows_from(bytearray())

    def resync(self) -> None:
        """Nothing to forget: a new link begins with a whole message."""

    @abstractmethod
    def _message(self, message: bytes) -> Row | None:
        """The values of one message; None when it carries none (it has then been counted)."""

    def _accept(self, row: Row, message: bytes) -> Rows:
        reason = fault(row)
        if reason:
            self._bad(reason, message)
            return rows_from(bytearray())
        self.counts.messages += 1
        self.counts.samples += 1
        if not self._watch.trusted and self._watch.update(row[3], row[4], row[5]):
            self.seen = f"{self._scale} {self._watch.doubt}".strip()
            self.log.add(self._t, "note", self.seen)
        mag = field_or_nan(row[6], row[7], row[8])
        return rows_from(bytearray(pack(self._t, self._t, *row[:6], *mag, *row[9:])))

    def _bad(self, reason: str, message: bytes) -> None:
        self.counts.bad_messages += 1
        self.counts.impossible += reason.startswith("impossible")
        self.log.add(self._t, "bad", f"{reason}: {message.hex(' ')}")


def to_counts(values: NDArray[np.float64]) -> NDArray[np.int16]:
    """Values of any shape, already in counts, as a board's converter gives them: rounded, limited, 0 for NaN."""
    return np.clip(np.rint(np.nan_to_num(values, nan=0.0)), *INT16).astype(np.int16)
