"""Rows a second of every text format against `bytes.split` and `float` on the same lines, in the same run.

The baseline knows nothing but where the numbers are: no check, no unit, no row. Each format is fed in blocks of 64 kB,
as from a file, and line by line, as from a port.

    python3 run.py bench decode [--rows 4000]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable

from _measure import interleaved, line

from imugui.formats import FORMATS, STREAM_FORMATS, Options
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

WANTED = 0.5
BLOCK = 1 << 16
ROUNDS = 15


def words_and_floats(text: bytes) -> list[float]:
    """ACCEL 0.01 0.02 1.00"""
    return [float(word) for word in text.split()[1:]]


def groups(text: bytes) -> list[float]:
    """0.01,0.02,1.00;0.1,0.2,0.3;10.0,20.0,30.0;"""
    return [float(word) for group in text.rstrip(b";\r\n").split(b";") for word in group.split(b",")]


def colons(text: bytes) -> list[float]:
    """#:1:2:3:4:5:6:7:8:"""
    return [float(word) for word in text.split(b":")[1:9]]


def commas(text: bytes) -> list[float]:
    """0.01,0.02,,1.00"""
    return [float(word) if word else math.nan for word in text.rstrip(b"\r\n").split(b",")]


BASELINES: dict[str, Callable[[bytes], list[float]]] = {
    "accel-lines": words_and_floats,
    "triplets": groups,
    "colon-line": colons,
    "csv-line": commas,
}


def fed(name: str, preamble: bytes, pieces: list[bytes], wanted: int) -> Callable[[], None]:
    """A run of a fresh decoder over the pieces; it must give all rows."""

    def run() -> None:
        decoder = FORMATS[name].decoder(Options())
        decoder.feed(preamble, 0.0)
        for piece in pieces:
            decoder.feed(piece, 1.0)
        decoder.flush(1.0)
        if decoder.counts.samples != wanted or decoder.counts.bad_messages:
            raise RuntimeError(f"{name}: {decoder.counts}")

    return run


def measure(name: str, n: int) -> None:
    """Print the figures of one format."""
    encoder = FORMATS[name].encoder()
    data = encoder.encode(VirtualBoard("free", 200.0, PRESETS["mpu9250-calibrated"], 1).rows(n))
    lines = data.splitlines(keepends=True)
    bare = BASELINES[name]

    def baseline() -> None:
        for text in lines:
            bare(text)

    blocks = [data[start : start + BLOCK] for start in range(0, len(data), BLOCK)]
    preamble = encoder.preamble()
    jobs = {"bare": baseline, "blocks": fed(name, preamble, blocks, n), "lines": fed(name, preamble, lines, n)}
    seconds = interleaved(jobs, ROUNDS)
    for case in ("blocks", "lines"):
        rates = {"rows_per_s": round(n / seconds[case]), "bare_rows_per_s": round(n / seconds["bare"])}
        line("decode", f"{name}, {case}", seconds["bare"] / seconds[case], WANTED, True, **rates)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rows", type=int, default=4000)
    rows = arguments.parse_args().rows
    for name in STREAM_FORMATS:
        measure(name, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
