"""A recording: a folder that is only ever appended to.

    about.json     what was recorded: program version, source, format, filter and parameters, units, start (UTC)
    samples.csv    SAMPLE rows, with all digits; opens in a spreadsheet, MATLAB and pandas
    attitude.csv   the attitudes that were shown, with all digits
    events.jsonl   connections, filter changes, origins, markers
    raw.bin        the bytes as they arrived, with their arrival times (not for the virtual board and files)

A folder, not one file: each part is a plain stream that needs no index, so that a killed program or a full disk
leaves everything but the last second readable, and the CSV files open without imugui. ``about.json`` says
``"ended"`` only after an orderly end.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from imugui.formats import FORMATS, Options
from imugui.formats.csv_line import CsvLineEncoder
from imugui.recording.attitude_csv import attitude_lines, bounded_lines, read_attitude
from imugui.recording.base import UnreadableError
from imugui.recording.csv_files import ATTITUDE_COLUMNS, Watch, chunks_of
from imugui.recording.events import Event, from_lines, to_line
from imugui.recording.raw import Chunk, pack
from imugui.samples import Rows
from imugui.texts import from_json

VERSION = 1
ABOUT, SAMPLES, ATTITUDE, EVENTS, RAW = "about.json", "samples.csv", "attitude.csv", "events.jsonl", "raw.bin"
LARGEST_JSON = 1 << 24
LONGEST_COMMENT = 2000


class FolderWriter:
    """Appends to a new recording. Every method raises OSError when the disk does."""

    def __init__(self, folder: Path, about: dict[str, Any]) -> None:
        """Make the folder; FileExistsError when it is there already."""
        folder.mkdir(parents=True)
        self.folder = folder
        self.about = {"imugui_recording": VERSION, **about}
        self._write_about()
        self._encoder = CsvLineEncoder(with_position=True)  # always: a table whose columns change opens nowhere
        self._streams = {name: (folder / name).open("ab", buffering=1 << 16) for name in (SAMPLES, ATTITUDE, EVENTS)}
        texts = {key: " ".join(value.split()) for key, value in self.about.items() if isinstance(value, str)}
        comments = "".join(f"# {key}: {text[:LONGEST_COMMENT]}\n" for key, text in texts.items())
        self._streams[SAMPLES].write(comments.encode() + self._encoder.preamble())
        self._streams[ATTITUDE].write(f"{comments}{ATTITUDE_COLUMNS}\n".encode())

    def samples(self, rows: Rows) -> None:
        """Append SAMPLE rows, shape (n,)."""
        self._streams[SAMPLES].write(self._encoder.encode(rows))

    def attitude(self, rows: Rows) -> None:
        """Append ATTITUDE rows, shape (n,)."""
        self._streams[ATTITUDE].write(attitude_lines(rows).encode())

    def events(self, events: Iterable[Event]) -> None:
        """Append events."""
        self._streams[EVENTS].write("".join(map(to_line, events)).encode())

    def raw(self, chunks: Iterable[Chunk]) -> None:
        """Append bytes as they arrived."""
        if RAW not in self._streams:
            self._streams[RAW] = (self.folder / RAW).open("ab", buffering=1 << 16)
        self._streams[RAW].write(b"".join(map(pack, chunks)))

    def flush(self) -> None:
        """Hand everything to the system: a killed program loses nothing that was flushed."""
        for stream in self._streams.values():
            stream.flush()

    def close(self, ended: dict[str, Any]) -> None:
        """End in order, noting how it went; what can still be saved is saved before an OSError is raised."""
        problem: OSError | None = None
        for stream in self._streams.values():
            try:
                stream.close()
            except OSError as error:
                problem = error
        if problem is not None:
            raise problem
        self.about["ended"] = ended
        self._write_about()

    def size(self) -> int:
        """Bytes on disk so far."""
        return sum(path.stat().st_size for path in self.folder.iterdir())

    def free(self) -> int:
        """Bytes left on that disk."""
        return shutil.disk_usage(self.folder).free

    def _write_about(self) -> None:
        temporary = self.folder / "about.tmp"
        temporary.write_text(json.dumps(self.about, indent=1) + "\n", encoding="utf-8")
        temporary.replace(self.folder / ABOUT)


@dataclass(frozen=True)
class Recording:
    """A recording that was read. ``warnings`` are sentences for the user."""

    folder: Path
    about: dict[str, Any]
    samples: Rows
    attitude: Rows
    events: list[Event] = field(default_factory=list)
    warnings: tuple[str, ...] = ()

    @property
    def has_raw(self) -> bool:
        return (self.folder / RAW).is_file()


def is_recording(path: Path) -> bool:
    """Whether the path is a recording's folder, or a file in one."""
    return (path / ABOUT).is_file() or path.name == ABOUT


def samples_file(path: Path) -> Path:
    """The file that holds the samples: of a recording its table, else the path itself."""
    if not is_recording(path):
        return path
    return (path if path.is_dir() else path.parent) / SAMPLES


def read_recording(path: Path, watch: Watch | None = None) -> Recording:
    """Read a recording, as far as it goes; UnreadableError says in one line why it cannot be read.

    ``watch`` is told the share of the samples that was read.
    """
    folder = path if path.is_dir() else path.parent
    about = read_about(path)
    warnings = [] if "ended" in about else ["The recording was cut off: the program or the disk stopped in the middle."]
    samples, bad = _read_samples(folder / SAMPLES, watch)
    attitude, bad_attitude = read_attitude(folder / ATTITUDE)
    events, bad_events = _read_events(folder / EVENTS)
    if len(samples) == 0:
        raise UnreadableError(f"{folder}: the recording holds no samples")
    damaged = bad + bad_attitude + bad_events
    if damaged:
        warnings.append(f"{damaged} damaged line(s) were left out.")
    return Recording(folder, about, samples, attitude, events, tuple(warnings))


def read_about(recording: Path) -> dict[str, Any]:
    """What a recording (its folder, or a file in it) says of itself; UnreadableError says why it cannot be read."""
    path = (recording if recording.is_dir() else recording.parent) / ABOUT
    try:
        if path.stat().st_size > LARGEST_JSON:
            raise UnreadableError(f"{path}: too large to be a recording's description")
        about = from_json(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise UnreadableError(f"{path.parent}: not a recording (it has no {ABOUT})") from None
    except (OSError, ValueError, RecursionError) as error:
        raise UnreadableError(f"{path}: {error}") from None
    version = about.get("imugui_recording") if isinstance(about, dict) else None
    if not isinstance(version, int):
        raise UnreadableError(f"{path}: not a recording of imugui")
    if version > VERSION:
        raise UnreadableError(f"{path}: made by a newer imugui (format {version}); update this program")
    return dict(about)


def _read_samples(path: Path, watch: Watch | None) -> tuple[Rows, int]:
    decoder = FORMATS["csv-line"].decoder(Options(family="aligned"))
    try:
        blocks = [decoder.feed(chunk, np.nan) for chunk in chunks_of(path, watch)]
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror}") from None
    # a last line without its end was cut: it is damage, not data
    rows = np.concatenate(blocks) if blocks else decoder.flush(np.nan)
    rows["t_arrival"] = np.nan
    return rows, decoder.counts.bad_messages + decoder.counts.overlong


def _read_events(path: Path) -> tuple[list[Event], int]:
    try:
        return from_lines(bounded_lines(path, LARGEST_JSON))
    except OSError:
        return [], 1
