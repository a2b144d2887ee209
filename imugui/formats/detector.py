"""Finding a board's format from its bytes. Pure: the caller owns port and clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from imugui.formats import FORMATS, STREAM_FORMATS
from imugui.formats.base import Decoder, Options
from imugui.formats.lines import readable
from imugui.formats.values import how_many
from imugui.samples import SAMPLE, Rows

ENOUGH = 3  # good messages that decide, if they are the majority
HEAD = 65536  # bytes of a file that are read
PRINTABLE = bytes(range(0x20, 0x7F)) + b"\t\r\n"
GARBAGE_SHARE = 0.12  # more unprintable bytes than this are no text with some noise in it
GARBAGE_BYTES = 64  # so many are needed to judge
LONG_WITHOUT_LINE = 1024
MANY_LINES = 30  # of text without a message: no banner any more


PROBLEMS = {
    "device error": "the board did not find its MPU-9250 (wiring, or a sensor of another type) and has stopped",
    "GPS not detected": "the transmitter did not find its GPS (wiring) and has stopped",
    "DMP Initialization failed": "the probe's sensor did not start",
}
"""What boards of ours say when they have given up, and what it means."""


@dataclass(frozen=True)
class Detection:
    """What was found.

    ``kind`` is "format", "impossible" (a format, but no value can be true), "text", "garbage" or "silent";
    ``format`` is "" with the last three.
    """

    kind: str
    format: str
    sentence: str


class Detector:
    """Runs the decoder of every format on one stream until one of them fits; no byte is lost on the way."""

    def __init__(
        self, options: Options | None = None, mid_stream: bool = False, formats: Sequence[str] = STREAM_FORMATS
    ) -> None:
        """``mid_stream``: the first line may be cut (a port), as it is not in a file.

        ``formats``: only these. A framed one never takes part among others: a cut of the stream could look like
        its message.
        """
        if len(formats) > 1:
            formats = [name for name in formats if not FORMATS[name].framed]
        self._decoders = {name: FORMATS[name].decoder(options or Options()) for name in formats}
        self._rows: dict[str, list[Rows]] = {name: [] for name in formats}
        self._found = ""
        self._head = b""  # the first bytes, to quote from
        self._started: float | None = None  # s, the first feed
        self._first = self._newest = 0.0  # s, first byte and last feed
        self.bytes = 0
        self._unprintable = 0
        self._lines = 0
        self._is_port = mid_stream
        if mid_stream:
            for decoder in self._decoders.values():
                decoder.resync()

    @property
    def kind(self) -> str:
        """The kind of the verdict (see Detection)."""
        if self._found:
            return "format" if self._decoders[self._found].counts.messages else "impossible"
        if not self.bytes:
            return "silent"
        return "garbage" if self._is_noise() or not self._text() else "text"

    @property
    def verdict(self) -> Detection:
        """What can be said now; its format is set as soon as one is found."""
        sentences = {
            "silent": self._what_nothing,
            "garbage": self._what_garbage,
            "text": self._what_text,
            "format": self._what_fits,
            "impossible": self._what_fits,
        }
        return Detection(self.kind, self._found, sentences[self.kind]())

    @property
    def is_hopeless(self) -> bool:
        """Whether enough came to say that listening on will not help: noise, or much text and no message."""
        return not self._found and (self._is_noise() or self._lines >= MANY_LINES)

    def _is_noise(self) -> bool:
        if self.bytes < GARBAGE_BYTES:
            return False
        return self._unprintable > GARBAGE_SHARE * self.bytes or (not self._lines and self.bytes >= LONG_WITHOUT_LINE)

    def feed(self, chunk: bytes, t: float) -> None:
        """Take the bytes that arrived at t (s); an empty chunk tells that time has passed."""
        if self._started is None:
            self._started = t
        self._newest = t
        if chunk:
            self._count(chunk, t)
            names = [self._found] if self._found else list(self._decoders)
            for name in names:
                self._keep(name, self._decoders[name].feed(chunk, t))
            self._decide(ENOUGH)

    def conclude(self, at_end: bool = False) -> Detection:
        """The verdict when no more time is left: one good message is enough if nothing speaks against it.

        A format whose messages are all impossible is found too: the board speaks, but its sensor does not work.
        ``at_end``: the bytes have ended, so a last line without a line end counts.
        """
        if at_end:
            for name, decoder in self._decoders.items():
                if self._found in ("", name):
                    self._keep(name, decoder.flush(self._newest))
        self._decide(1)
        for name, decoder in self._decoders.items():
            if not self._found and decoder.counts.impossible >= max(ENOUGH, decoder.counts.bad_messages / 2):
                self._settle(name)
        return self.verdict

    def log_entries(self) -> list[tuple[float, str, str]]:
        """What was not data so far, as the decoder that came nearest saw it."""
        best = max(self._decoders.values(), key=lambda decoder: decoder.counts.messages)
        return best.log.entries()

    def take(self) -> tuple[Decoder, Rows]:
        """The decoder that fits and its rows so far, which are then forgotten; LookupError when none fits yet."""
        if not self._found:
            raise LookupError(self.verdict.sentence)
        rows = self._rows[self._found]
        self._rows[self._found] = []
        return self._decoders[self._found], np.concatenate(rows) if rows else np.empty(0, SAMPLE)

    def _count(self, chunk: bytes, t: float) -> None:
        if not self.bytes:
            self._first = t
        self.bytes += len(chunk)
        self._unprintable += len(chunk) - how_many(chunk, PRINTABLE)
        self._lines += chunk.count(b"\n")
        if len(self._head) < 1000:
            self._head += chunk[:1000]

    def _keep(self, name: str, rows: Rows) -> None:
        if len(rows):
            self._rows[name].append(rows)

    def _decide(self, enough: int) -> None:
        for name, decoder in self._decoders.items():
            good, bad = decoder.counts.messages, decoder.counts.bad_messages
            if not self._found and good >= enough and good > bad:
                self._settle(name)

    def _settle(self, name: str) -> None:
        self._found = name
        self._rows = {name: self._rows[name]}

    def _what_nothing(self) -> str:
        return f"silent: no byte in {self._newest - (self._started or 0.0):.1f} s"

    def _what_garbage(self) -> str:
        return f"{self.bytes:,} bytes, none of them a line of text" + (": wrong baud rate?" if self._is_port else "")

    def _what_fits(self) -> str:
        decoder = self._decoders[self._found]
        counts, seconds = decoder.counts, self._newest - self._first
        parts = [_plural(counts.messages, "message") + (f" in {seconds:.1f} s" if seconds else "")]
        if counts.chatter:
            parts.append(_plural(counts.chatter, "other line"))
        if counts.bad_messages:
            parts.append(_plural(counts.bad_messages, "bad message") + f", the last {self._last_bad(decoder)!r}")
        return f"{self._found}: {', '.join(parts)} ({decoder.seen})"

    def _text(self) -> list[str]:
        """The readable lines at the beginning; none when most are not."""
        lines = [line.strip() for line in self._head.split(b"\n")]
        texts = [readable(line) for line in lines[:-1] or lines if line]
        good = [text for text in texts if text]
        return good if len(good) > len(texts) / 2 else []

    def _what_text(self) -> str:
        lines = self._text()
        for line in lines:
            for words, meaning in PROBLEMS.items():
                if words in line:
                    return f"the board says {line!r}: {meaning}"
        example = lines[0][:80]
        best = max(self._decoders.values(), key=lambda decoder: decoder.counts.messages)
        table = self._decoders.get("csv-line", best)
        if best.counts.messages:
            return f"{_plural(best.counts.messages, 'good message')} but more bad ones, such as {example!r}"
        if table.counts.bad_messages:
            return f"lines of numbers in no known format, such as {example!r} (as a table: {table.seen})"
        return f"lines of text but no known message, such as {example!r}"

    @staticmethod
    def _last_bad(decoder: Decoder) -> str:
        return next((text[:80] for _, kind, text in reversed(decoder.log.entries()) if kind == "bad"), "")


def _plural(count: int, word: str) -> str:
    return f"{count:,} {word}" + ("" if count == 1 else "s")


def detect_file(path: Path, options: Options | None = None) -> Detection:
    """The format of a file, from its first 64 kB; OSError when it cannot be read."""
    with path.open("rb") as file:
        head = file.read(HEAD + 1)
    detector = Detector(options)
    detector.feed(head[:HEAD], 0.0)
    return detector.conclude(at_end=len(head) <= HEAD)
