"""The virtual board's end of the wire: its rows in the words of any format, with the faults of real wires."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from imugui.fields import field
from imugui.formats import FORMATS
from imugui.formats.base import Format
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS, Errors
from imugui.simulation.path import Path

MAG_RATES_HZ = {"accel-lines": 8.0, "triplets": 100.0, "thingy-motion": 10.0}
"""How often the real boards behind the formats measure the field; the others as the errors say."""


@dataclass(frozen=True)
class Faults:
    """What happens to the bytes on their way; the defaults are nothing."""

    cut_percent: float = field(0.0, "Lines cut short", unit="%", low=0.0, high=100.0, step=1.0)
    flip_percent: float = field(0.0, "Lines with a wrong byte", unit="%", low=0.0, high=100.0, step=1.0)
    pause_every_s: float = field(
        0.0, "Silent once every", unit="s", low=0.0, high=3600.0, step=1.0, tip="0: never; what is said then is lost"
    )
    pause_s: float = field(0.5, "Silent for", unit="s", low=0.0, high=600.0, step=0.1)


NO_FAULTS = Faults()


class Wire:
    """Turns the board's rows into bytes, the format's preamble first; equal seeds give equal faults."""

    def __init__(self, board: VirtualBoard, form: Format, faults: Faults = NO_FAULTS, seed: int = 0) -> None:
        self.board, self.form, self.faults = board, form, faults
        self.spoiled = 0  # lines or messages cut or altered so far
        self._rng = np.random.default_rng(seed)
        self.restart()

    def restart(self) -> None:
        """The board was reset: its preamble comes first again."""
        self._encoder = self.form.encoder()
        self._greeting = self._encoder.preamble()

    def take(self, n: int) -> bytes:
        """The bytes of the next n samples; of a framed format only one after the other (see ``messages``)."""
        return b"".join(self.messages(n))

    def messages(self, n: int) -> list[bytes]:
        """The next n samples as they leave the board: line by line, or message by message of a framed format."""
        rows = self.board.rows(n)
        every, silent = self.faults.pause_every_s, self.faults.pause_s
        if every > 0.0:
            rows = rows[rows["t"] % every < every - silent]
        chunk = self._encoder.encode(rows) if len(rows) else b""
        chunk, self._greeting = self._greeting + chunk, b""
        size = self.form.message_bytes
        if self.form.framed:
            return [self._spoil(chunk[at : at + size]) for at in range(0, len(chunk), size)]
        return [self._spoil(line) for line in chunk.splitlines(keepends=True)]

    def skip(self, n: int) -> None:
        """Let n samples pass without a word: nobody listens, or the board is starting."""
        self.board.rows(n)

    def _spoil(self, line: bytes) -> bytes:
        if self.faults.cut_percent == self.faults.flip_percent == 0.0:
            return line
        cut, cut_at, flip, flip_at = self._rng.random(4)
        wrong = bytes([self._rng.integers(256)])
        whole = line
        if 100 * flip < self.faults.flip_percent:
            at = int(flip_at * len(line))
            line = line[:at] + wrong + line[at + 1 :]
        if 100 * cut < self.faults.cut_percent:
            line = line[: int(cut_at * len(line))]
        self.spoiled += line != whole
        return line


def real_board(
    format_name: str, motion: str | Path, errors: Errors = PRESETS["mpu9250"], seed: int = 0, faults: Faults = NO_FAULTS
) -> Wire:
    """A board that speaks FORMATS[format_name] at its own rate and with its own magnetometer's rate.

    ValueError: unknown format or motion.
    """
    if format_name not in FORMATS:
        raise ValueError(f"unknown format {format_name!r}; there are {', '.join(FORMATS)}")
    form = FORMATS[format_name]
    errors = replace(errors, mag_rate_hz=MAG_RATES_HZ.get(format_name, errors.mag_rate_hz))
    return Wire(VirtualBoard(motion, form.rate_hz, errors, seed), form, faults, seed)
