"""Run the benchmarks, all but the long ones, and write docs/figures.md with its plots from their JSON lines.

python3 run.py bench                       run them all, then write the page
python3 run.py bench figures [NAME ...]    run these, write the page from these and what was kept of the others
python3 run.py bench figures --kept        write the page from what was kept
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from _measure import machine
from _plots import bars, curves

DOCS = Path(__file__).resolve().parent.parent / "docs"
KEPT = DOCS / "figures"
PAGE = DOCS / "figures.md"
LONG = ("endurance",)
LONGEST_S = 600

Line = dict[str, Any]

SECTIONS = {
    "decode": (
        "Decoding",
        "Rows a second of each text format against `bytes.split` and `float` on the same lines, which checks nothing "
        "and makes no rows. Wanted: at least 0.5.",
        ("ratio", "rows_per_s"),
        ("Rows a second against the baseline's", "ratio"),
    ),
    "fuse": (
        "Replay, file to file",
        "One hour at 200 Hz: `imugui replay` against a script with `numpy.loadtxt`, the library's batch call and "
        "`numpy.savetxt`. Wanted: at least 0.8. The two differ, as the board measures the field in every second row "
        "and holds it between: the script feeds each measurement twice, imugui once. The last column is imugui's "
        "difference from the library when that is fed as imugui feeds it.",
        ("ratio", "imugui_s", "bare_s", "largest_difference_deg", "fed_alike_difference_deg"),
        ("Seconds of the script against imugui's", "ratio"),
    ),
    "live": (
        "Live",
        "Age in ms of a sample when its attitude is published, and of the newest attitude when it is painted, with "
        "each page at work (collecting the sphere, aiming, playing); the ratio is that of the 99th percentiles to the "
        "empty window's on the same stream. A page on which nothing moves is not painted: it has a dash. Wanted: 5 ms "
        "at 1000 Hz with the Live page, 15 with imugui's own filter, no row missed.",
        ("ratio", "age_ms", "paint_age_ms", "missed_rows", "cpu", "frames_per_s"),
        ("Age at publish, 99th percentile, ms", "age_ms.p99"),
    ),
    "paint": (
        "Painting",
        "Processor time of the main thread for one frame of a page at work, at 1280 x 800, against 30 plain polygons. "
        "Wanted: 12 ms for any page, 4 ms for the cube.",
        ("ratio", "ms", "p95_ms", "limit_ms"),
        ("Median frame, ms", "ms"),
    ),
    "start": (
        "Start",
        "A fresh process until its first painted frame, against a bare QMainWindow with one pyqtgraph plot; both from "
        "compiled modules, as from the second start on. Wanted: at most 1.3.",
        ("ratio", "s", "bare_s"),
        ("Start against the bare window's", "ratio"),
    ),
    "accuracy": (
        "Accuracy",
        "BROAD development trials: mean root-mean-square error in degrees; the ratio is that of the totals to the vqf "
        "library's. Wanted: our VQF within 0.05 degrees of the library.",
        ("ratio", "total_deg", "heading_deg", "inclination_deg", "us_per_sample"),
        ("Total error, mean of the trials, degrees", "total_deg"),
    ),
    "endurance": (
        "Endurance",
        "Twenty minutes with the window, its pages in front in turn, and twelve hours of samples, 40 times as fast, "
        "both over a pseudo-terminal, decoded, fused and recorded. Growth is of memory, from the first tenth of the "
        "run to the most held later; lost samples are those that the board counts and the recording has not. Wanted: "
        "memory grows by less than 1 % and 2 %, nothing missed or lost, the recording whole.",
        ("growth", "memory_mb", "missed_rows", "lost_samples", "samples", "rate_hz", "took_s", "recording_mb", "whole"),
        ("Memory over each run, MB", "held_mb"),
    ),
}
"""By benchmark: title, what it is, which keys its table shows, and its plot's title and key."""


def run(name: str) -> None:
    """Run a benchmark and keep its lines; what it says beside them goes to the terminal."""
    script = Path(__file__).with_name(f"{name}.py")
    begin = time.monotonic()
    limit = None if name in LONG else LONGEST_S
    done = subprocess.run([sys.executable, str(script)], stdout=subprocess.PIPE, text=True, timeout=limit, check=False)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if not any("case" in json.loads(line) for line in lines):
        done.check_returncode()
        print("\n".join((f"{name}: no figures; what was kept stays", *lines)), flush=True)
        return
    KEPT.mkdir(parents=True, exist_ok=True)
    text = "".join(f"{line}\n" for line in (json.dumps({"machine": machine()}), *lines))
    (KEPT / f"{name}.jsonl").write_text(text, encoding="utf-8")
    print(f"{name}: {len(lines)} figures in {time.monotonic() - begin:.0f} s", flush=True)
    done.check_returncode()  # a figure that is not as wanted is kept, and said


def read(name: str) -> list[Line]:
    """The lines that were kept of a benchmark; none when it never ran."""
    path = KEPT / f"{name}.jsonl"
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.is_file() else []


def value_of(line: Line, key: str) -> Any:
    """A value, or one inside another: "age_ms.p99"."""
    for part in key.split("."):
        line = line.get(part, {})
    return line


def cell(value: Any) -> str:
    """A value as the table shows it."""
    if isinstance(value, dict):
        return " / ".join(f"{part:g}" for part in value.values()) or "-"
    if isinstance(value, list):
        return " to ".join(map(str, value))
    if isinstance(value, bool):
        return "yes" if value else "**no**"
    return "-" if value is None else f"{value:,}" if isinstance(value, int) else str(value)


def plot(title: str, key: str, figures: list[Line]) -> str:
    """The chart of one key: bars of numbers, curves of lists."""
    values = {line["case"]: value_of(line, key) for line in figures}
    if any(isinstance(value, list) for value in values.values()):
        return curves(title, values)
    limit = "wanted" if key == "ratio" else "limit_ms"
    return bars(title, [(line["case"], values[line["case"]], line.get(limit)) for line in figures])


def section(name: str) -> list[str]:
    """One benchmark's part of the page, and its plot beside the page."""
    title, words, keys, plotted = SECTIONS[name]
    lines = read(name)
    figures = [line for line in lines if "case" in line]
    if not figures:
        return [f"## {title}", "", words, "", f"Not run yet: `python3 run.py bench figures {name}`.", ""]
    (KEPT / f"{name}.svg").write_text(plot(*plotted, figures), encoding="utf-8")
    text = [f"## {title}", "", words, "", f"![{plotted[0]}](figures/{name}.svg)", ""]
    text += [f"| case | {' | '.join(keys)} | reached |", "|---" * (len(keys) + 2) + "|"]
    for line in figures:
        cells = " | ".join(cell(line.get(key)) for key in keys)
        text.append(f"| {line['case']} | {cells} | {'yes' if line['ok'] else '**no**'} |")
    text += [""] + [f"Note: {line['note']}." for line in lines if "note" in line]
    where = lines[0].get("machine", {})
    return [*text, f"*{', '.join(f'{key} {value}' for key, value in where.items())}*", ""]


def write_page() -> None:
    """The page, from what was kept."""
    head = [
        "# Figures",
        "",
        "Made by `python3 run.py bench`; nothing here is written by hand. Every ratio is against a baseline measured "
        "in the same run, in turn with it, and is a median, so that a busy machine slows both. Triples are the 50th, "
        "95th and 99th percentile.",
        "",
    ]
    body = [text for name in SECTIONS for text in section(name)]
    PAGE.write_text("\n".join([*head, *body]).rstrip() + "\n", encoding="utf-8")


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SECTIONS)}")
    arguments.add_argument("--kept", action="store_true", help="run nothing")
    chosen = arguments.parse_args()
    if unknown := set(chosen.names) - set(SECTIONS):
        arguments.error(f"there is no benchmark {', '.join(sorted(unknown))}")
    names = chosen.names or [name for name in SECTIONS if name not in LONG]
    failed = []
    for name in () if chosen.kept else names:
        try:
            run(name)
        except subprocess.SubprocessError as error:
            failed.append(name)
            print(f"{name}: {error}", file=sys.stderr)
    write_page()
    print(PAGE)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
