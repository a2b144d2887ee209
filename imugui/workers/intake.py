"""What a link gives becomes SAMPLE rows with sample time: format found, bytes decoded, clock rebuilt."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from imugui.formats import FORMATS, STREAM_FORMATS, Counts, Decoder, LinkLog
from imugui.formats.detect import BaudSearch, candidate_bauds
from imugui.fusion.timing import ArrivalClock, DeviceClock
from imugui.samples import SAMPLE, Rows
from imugui.workers.transport import Arrivals, Source

NO_BAUD = (0,)
HEAD = 1 << 13
"""Bytes kept from the start of a connection: a decoder that reads them decides as this one did."""


class Intake:
    """One connection's decoder, counts, link log and clock. Told the time; knows no thread and no port of its own."""

    def __init__(self, source: Source) -> None:
        self.format = ""
        self.counts = Counts()
        self.clock: ArrivalClock | DeviceClock = ArrivalClock()
        self.baud = source.baud
        self._source = source
        self._log = LinkLog()
        self._decoder: Decoder | None = None
        self._search: BaudSearch | None = None
        self._findings = ""
        self.head = b""
        self._timed = False  # rows come with their own time
        self._kept = False  # the times of a file are kept as they are
        self._clock_chosen = False

    @property
    def seen(self) -> str:
        """One phrase about what was decided or, before that, about what came."""
        return self._decoder.seen if self._decoder and self._decoder.seen else self._findings

    def log_entries(self) -> list[tuple[float, str, str]]:
        """(host time s, kind, text) of what was not data, oldest first."""
        entries = self._log.entries()
        if self._log.dropped:
            entries.insert(0, (entries[0][0], "note", f"{self._log.dropped} older entries are no longer kept"))
        return entries

    def note(self, t: float, text: str) -> None:
        """Put what happened to the link at host time t (s) into the log."""
        self._log.add(t, "note", text)

    def opened(self, transport: Any, t: float) -> None:
        """The link was opened, or opened again, at host time t (s)."""
        capture = getattr(transport, "capture", None)
        recording = getattr(transport, "recording", None)
        if capture is not None:
            self._play(capture)
        elif recording is not None:
            self.format, self._timed, self._kept = "recording", True, True
            self._findings = " ".join((str(recording.about.get("found", "")), *recording.warnings)).strip()
        elif self._decoder is not None:
            self._decoder.resync()
        elif hasattr(transport, "set_baud"):
            self._begin_search(transport, t)
        elif (name := self._spoken(transport)) in FORMATS:
            self._decode_as(name)

    def feed(self, data: bytes | Arrivals | Rows, t: float) -> Rows:
        """The rows that arrived with ``data`` at host time t (s), with their sample time."""
        if isinstance(data, list):
            rows = self._messages(data)
        elif not isinstance(data, bytes):
            rows = self._finished(data, t)
        elif self._decoder is not None:
            self.head += data[: HEAD - len(self.head)]
            rows = self._decoder.feed(data, t)
        elif self._search is not None:
            self.head += data[: HEAD - len(self.head)]
            self._search.feed(data, t)
            rows = self._found(self._search)
        else:
            rows = np.empty(0, SAMPLE)
        self._stamp(rows)
        return rows

    def restart_clock(self) -> None:
        """What comes next does not follow in time what came before."""
        self._clock_chosen = False

    def tick(self, transport: Any, t: float) -> None:
        """Time has passed: follow the search to its next baud rate, and begin it again when it found nothing."""
        if self._search is None:
            return
        self._search.feed(b"", t)
        self._findings = self._search.verdict.sentence
        if self._search.done and not self._search.verdict.format:
            self._keep_log(self._search)
            self._search = BaudSearch(self._bauds(), t, self._source.options, formats=self._names())
        if self._search.baud not in (transport.baud, 0):
            transport.set_baud(self._search.baud)
            self.head = b""

    def _begin_search(self, transport: Any, t: float) -> None:
        self._search = BaudSearch(self._bauds(), t, self._source.options, formats=self._names())
        if self._search.baud:
            transport.set_baud(self._search.baud)

    def _bauds(self) -> tuple[int, ...]:
        if self._source.baud:
            return (self._source.baud,)
        if self._source.address.startswith(("socket://", "loop://")):
            return NO_BAUD
        return candidate_bauds()

    def _names(self) -> tuple[str, ...]:
        return (self._source.format,) if self._source.format in FORMATS else STREAM_FORMATS

    def _spoken(self, transport: Any) -> str:
        """What the user says the board speaks, else what the transport knows of it."""
        return self._source.format if self._source.format in FORMATS else getattr(transport, "format", "")

    def _found(self, search: BaudSearch) -> Rows:
        if not search.verdict.format:
            return np.empty(0, SAMPLE)
        self.baud = search.baud
        decoder, rows = search.detector.take()
        self._adopt(search.verdict.format, decoder)
        self._log.add(float(rows["t_arrival"][-1]) if len(rows) else 0.0, "note", f"found {search.verdict.sentence}")
        self._search = None
        return rows

    def _keep_log(self, search: BaudSearch) -> None:
        """What was heard while searching stays readable."""
        for entry in search.detector.log_entries():
            self._log.add(*entry)

    def _decode_as(self, name: str) -> None:
        self._adopt(name, FORMATS[name].decoder(self._source.options))

    def _adopt(self, name: str, decoder: Decoder) -> None:
        for entry in self._log.entries():
            decoder.log.add(*entry)
        self._decoder, self.format = decoder, name
        self.counts, self._log = decoder.counts, decoder.log

    def _messages(self, messages: Arrivals) -> Rows:
        """What came one by one keeps its own arrival times."""
        if self._decoder is None or not messages:
            return np.empty(0, SAMPLE)
        return np.concatenate([self._decoder.feed(data, t) for t, data in messages])

    def _play(self, capture: Any) -> None:
        """A file that was decoded when it was opened: its rows carry time."""
        self._adopt(capture.format, capture.decoder)
        self._timed = self._kept = True

    def _finished(self, rows: Rows, t: float) -> Rows:
        """Rows from a file or from the virtual board: stamped with their arrival, with their own clock."""
        if not self.format:
            self.format, self._timed = "virtual board", True
        if self._decoder is None:
            self.counts.messages += len(rows)
            self.counts.samples += len(rows)
        rows["t_arrival"] = t
        return rows

    def _stamp(self, rows: Rows) -> None:
        if len(rows) and not self._clock_chosen:
            timed = self._timed or (self._decoder is not None and self._decoder.has_time)
            self.clock = DeviceClock(anchored=not self._kept) if timed else ArrivalClock()
            self._clock_chosen = True
        for block in arrivals(rows):
            self.clock.stamp(block)


def arrivals(rows: Rows) -> Iterator[Rows]:
    """Views of rows, shape (n,), cut where the arrival changes: what one chunk of bytes completed stays together."""
    if len(rows) == 0:
        return
    cuts = np.flatnonzero(np.diff(rows["t_arrival"]) != 0.0) + 1
    start = 0
    for end in (*cuts.tolist(), len(rows)):
        yield rows[start:end]
        start = end
