"""Raw bytes with their arrival times: what a decoder can be run over again.

A file is a sequence of records: arrival time (float64, s), length (uint32), both little-endian, then the bytes.
Length 0 marks that the link was opened (again). The first record, with arrival NaN, holds what had come before the
recording began, as far as a decoder needs it (a header line, say); its rows are not part of the recording.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

HEAD = struct.Struct("<dI")
LARGEST = 1 << 24  # bytes; a record that claims more is damage

Chunk = tuple[float, bytes]


def pack(chunk: Chunk) -> bytes:
    """One record."""
    arrival, data = chunk
    return HEAD.pack(arrival, len(data)) + data


def read(path: Path) -> Iterator[Chunk]:
    """The records of a file, up to the first that is cut or damaged; raises OSError."""
    with path.open("rb") as stream:
        while len(head := stream.read(HEAD.size)) == HEAD.size:
            arrival, length = HEAD.unpack(head)
            if length > LARGEST or len(data := stream.read(length)) < length:
                return
            yield arrival, data
