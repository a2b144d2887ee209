"""Files of rows: the sample CSV and the attitude CSV of imugui.

Both begin with ``# key: value`` lines, then a header; missing values are empty. They open in a spreadsheet, in MATLAB
and in pandas (``comment="#"``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from imugui.formats import FORMATS, Decoder, Options
from imugui.formats.layout import TableError
from imugui.fusion.attitude import euler
from imugui.recording.base import UnreadableError
from imugui.recording.fixed_point import table
from imugui.samples import Rows

ATTITUDE_COLUMNS = "t,qw,qx,qy,qz,roll_deg,pitch_deg,yaw_deg,rest,disturbed"
ATTITUDE_DECIMALS = (6, 9, 9, 9, 9, 4, 4, 4, 0, 0)
BLOCK = 1 << 17
LARGEST = 4 << 30
"""bytes; a day at 200 Hz has 3 GB."""

Watch = Callable[[float], None]
"""Is told the share (0 to 1) that is done; raises UnreadableError to give up."""


@dataclass(frozen=True)
class Capture:
    """What a file holds: SAMPLE rows, shape (n,), with their times in s, and how they were found."""

    rows: Rows
    format: str
    decoder: Decoder


def read_samples(
    path: Path,
    name: str = "auto",
    options: Options | None = None,
    rate_hz: float = 0.0,
    watch: Watch | None = None,
) -> Capture:
    """All samples of a raw capture or a table, in the named format or in the one found; foreign tables as guessed.

    A file without times gets ``t`` = k / rate_hz (0: the usual rate of its format). ``watch`` is told the share that
    was read. Raises UnreadableError and OSError.
    """
    from imugui.formats.plan import read_foreign  # start-up time

    options = options or Options()
    try:
        found = read_foreign(path, options, rate_hz, watch) if name == "auto" or options.tables else name
    except TableError as error:
        raise UnreadableError(f"{path}: {error}") from error
    if not isinstance(found, str):
        return Capture(found[0], "csv-line", found[1])
    name = found
    decoder = FORMATS[name].decoder(options)
    blocks = [decoder.feed(chunk, 0.0) for chunk in chunks_of(path, watch)]
    blocks.append(decoder.flush(0.0))
    rows = np.concatenate(blocks)
    if len(rows) == 0:
        raise UnreadableError(f"{path}: no sample found as {name}. {decoder.seen}")
    if not decoder.has_time:
        rows["t"] = np.arange(len(rows)) / (rate_hz or decoder.rate_hz)
    rows["t_arrival"] = np.nan
    return Capture(rows, name, decoder)


def chunks_of(path: Path, watch: Watch | None = None) -> Iterator[bytes]:
    """The bytes of a file in blocks, telling ``watch`` the share that was read; raises OSError, and what it raises.

    UnreadableError: more than fits in memory.
    """
    size = max(1, path.stat().st_size)
    if size > LARGEST:
        raise UnreadableError(f"{path}: larger than {LARGEST >> 30} GB, too much to open at once: cut it into pieces")
    with path.open("rb") as stream:
        while chunk := stream.read(BLOCK):
            yield chunk
            if watch is not None:
                watch(stream.tell() / size)


def write_attitude(path: Path, blocks: Iterable[Rows], metadata: Mapping[str, object]) -> None:
    """Write blocks of ATTITUDE rows, shape (n,), as the attitude CSV; raises OSError, and what making one raises."""
    with path.open("wb") as stream:
        stream.write("".join((*_comments(metadata), ATTITUDE_COLUMNS, "\n")).encode())
        for rows in blocks:
            yaw, pitch, roll = np.rad2deg(euler(rows["quat"])).reshape(-1, 3).T
            columns = rows["t"], *rows["quat"].T, roll, pitch, yaw, rows["rest"] + 0.0, rows["disturbed"] + 0.0
            stream.write(table(columns, ATTITUDE_DECIMALS))


def write_samples(path: Path, rows: Rows, metadata: Mapping[str, object]) -> None:
    """Write SAMPLE rows, shape (n,), as the sample CSV; raises OSError."""
    encoder = FORMATS["csv-line"].encoder()
    header, body = encoder.preamble().decode("ascii"), encoder.encode(rows).decode("ascii")
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.writelines(_comments(metadata))
        stream.write(header + body)


def _comments(metadata: Mapping[str, object]) -> Iterable[str]:
    for key, value in metadata.items():
        text = " ".join(str(value).split())
        yield f"# {key}: {text}\n"
