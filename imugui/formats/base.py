"""What a board format is: a decoder from bytes to SAMPLE rows and an encoder back."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from imugui.formats.column_map import ColumnMap
from imugui.samples import Rows


@dataclass(frozen=True)
class Options:
    """What a person may say about a board; the defaults leave everything to the format."""

    family: str = ""  # key of FAMILIES, "" = the format's own
    columns: tuple[str, ...] = ()  # csv-line: names with units, such as ("t_s", "ax_g"); () = from the header line
    delimiter: str = ""  # csv-line: "," "\t" ";" or " "; "" = found by itself
    tables: tuple[ColumnMap, ...] = ()  # of a file: what its tables hold and how they are written; () = guessed


@dataclass
class Counts:
    """How much of what has passed through a decoder."""

    bytes: int = 0
    messages: int = 0  # good ones
    bad_messages: int = 0  # damaged, incomplete or impossible ones
    impossible: int = 0  # those of the bad ones that were well formed
    chatter: int = 0  # readable lines that are not data: banners, comments
    samples: int = 0  # rows given out
    overlong: int = 0  # runs of bytes without a line end, dropped


class LinkLog:
    """The newest lines that were not data, each (t, kind, text) with kind "chatter", "bad" or "note"."""

    CAPACITY = 500
    TEXT_LENGTH = 200

    def __init__(self) -> None:
        self.dropped = 0  # entries that fell out at the old end
        self._entries: deque[tuple[float, str, str]] = deque(maxlen=self.CAPACITY)

    def add(self, t: float, kind: str, text: str) -> None:
        """Append an entry; a long text is shortened and says by how much."""
        if len(text) > self.TEXT_LENGTH:
            text = f"{text[: self.TEXT_LENGTH]}... ({len(text) - self.TEXT_LENGTH} more characters)"
        self.dropped += len(self._entries) == self.CAPACITY
        self._entries.append((t, kind, text))

    def entries(self) -> list[tuple[float, str, str]]:
        """A copy, oldest first; safe to call from another thread (list() of a deque is one step)."""
        return list(self._entries)

    def __len__(self) -> int:
        return len(self._entries)


class Decoder(ABC):
    """Turns bytes, however they are cut, into SAMPLE rows. Never raises on bad input: it counts and logs."""

    def __init__(self) -> None:
        self.counts = Counts()
        self.log = LinkLog()
        self.has_time = False  # True when rows["t"] is the board's own clock
        self.seen = ""  # one phrase about what was decided
        self.rate_hz = 100.0  # nominal rate of what was seen, for files without time

    @abstractmethod
    def feed(self, chunk: bytes, t: float) -> Rows:
        """The SAMPLE rows, shape (n,), that ``chunk`` completes; t is its host arrival time, s."""

    @abstractmethod
    def flush(self, t: float) -> Rows:
        """The rows still held back at the end of a file: a last line without a line end counts."""

    @abstractmethod
    def resync(self) -> None:
        """Forget the half line: the port was opened (again) in the middle of a stream. Counts stay."""


class Encoder(ABC):
    """Turns SAMPLE rows into exactly what a board would send."""

    def preamble(self) -> bytes:
        """What the board prints before its data."""
        return b""

    @abstractmethod
    def encode(self, rows: Rows) -> bytes:
        """The bytes of SAMPLE rows, shape (n,), with the board's own units, axes and rounding."""


@dataclass(frozen=True)
class Format:
    """One entry of FORMATS."""

    name: str
    title: str
    hint: str  # which board speaks it, one sentence for the user
    bauds: tuple[int, ...]  # none when it never comes over a serial port
    rate_hz: float  # nominal, for files that carry no time
    decoder: Callable[[Options], Decoder]
    encoder: Callable[[], Encoder]
    message_bytes: int = 0  # length of the messages of a framed format; 0: messages find their own ends in a stream

    @property
    def framed(self) -> bool:
        """Whether a message comes as one piece, as in Bluetooth LE: then a chunk is one message, and only that."""
        return self.message_bytes > 0
