"""Report: what was planned and what was reached, as one page that needs nothing else, and as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from html import escape

from imugui import __version__
from imugui.guidance.plan import CONVENTION, FRAME, Plan, identity, plan_words, title
from imugui.guidance.reading import Reading
from imugui.guidance.report_numbers import Spread, achieved_words, component_words, miss_mm, summary, values
from imugui.guidance.report_pictures import target_svg

NOTE = (
    "For research and teaching only. Not a medical device: not for diagnosis, and not for guiding the treatment of a "
    "patient."
)
EXPECTED = (
    "± is the error to expect of a reading: 9 of 10 lie within it, by a model of the board's calibration, the "
    "registration and the age of the heading."
)
PICTURES = (
    "One looks along the tool, cranial up. Circle: the plan. Cross: the tool, with its expected error as a dashed "
    "ring. Rings are true degrees from the plan: green to the tolerance, amber to the wider one, grey as written."
)
OPEN = "–"
NBSP = "\N{NO-BREAK SPACE}"
STYLE = """
body { font: 11pt/1.4 system-ui, sans-serif; color: #111; background: #fff; max-width: 62em; margin: 2em auto;
  padding: 0 1em; }
h1 { font-size: 16pt; margin: 0; } h2 { font-size: 12pt; margin: 1.2em 0 .2em; border-bottom: 1px solid #999; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: normal; color: #444; } thead th { vertical-align: bottom; font-size: 9pt; }
th, td { padding: .2em .7em .2em 0; vertical-align: top; } td { font-variant-numeric: tabular-nums; }
tbody tr { border-top: 1px solid #ddd; } .about th { width: 15em; } .number { text-align: right; }
.number, .tight, thead th { white-space: nowrap; } .text, figcaption { overflow-wrap: anywhere; }
.about td { overflow-wrap: break-word; }
.error { font-weight: bold; } .in { color: #00664a; } .near { color: #8a5a00; } .out { color: #b03a00; }
.note { border-left: 4px solid #d55e00; padding-left: .6em; }
.pictures { display: flex; flex-wrap: wrap; gap: 1em; } figure { margin: 0; width: 172px; break-inside: avoid; }
figcaption { font-size: 9pt; text-align: center; } footer { margin-top: 1.5em; color: #444; font-size: 9pt; }
@page { size: A4 landscape; margin: 15mm; } @media print { body { margin: 0; max-width: none; } }
"""
HEADS = ("No.", "Trajectory", "Plan", "Reached", "Error", "±", "Parts", "Miss at depth", "First green", "Overshoots")


def report_html(
    readings: Sequence[Reading],
    plans: Sequence[Plan],
    about: Mapping[str, str] | None = None,
    now: datetime | None = None,
) -> str:
    """The report as one self-contained page; every text from outside is escaped.

    ``about``: further lines for its head, such as who, what on, which recording; ``now``: with its time zone.
    """
    now = now or datetime.now(UTC)
    heading = "Screw target report"
    pictures = "".join(_figure(reading) for reading in readings)
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{heading}</title><style>{STYLE}</style>'
        f'</head>\n<body><h1>{heading}</h1>\n<p class="note">{NOTE}</p>\n'
        f'<table class="about">{_pairs({**(about or {}), **_head(readings, plans)})}</table>\n'
        f"<h2>Errors</h2>{_summary(readings)}\n<h2>Trajectories</h2>{_table(readings, plans)}<p>{EXPECTED}</p>\n"
        f'<h2>Targets</h2><div class="pictures">{pictures}</div><p>{PICTURES}</p>\n'
        f"<h2>Where it comes from</h2>{_origins(readings)}\n"
        f"<p>{escape(CONVENTION)} Vectors are in the frame {FRAME}.</p>"
        f"<footer>Made {now:%Y-%m-%d %H:%M %Z} with imugui {escape(__version__)}. {NOTE}</footer></body></html>\n"
    )


def report_csv(
    readings: Sequence[Reading],
    plans: Sequence[Plan],
    about: Mapping[str, str] | None = None,
    now: datetime | None = None,
) -> str:
    """One row for each reading after ``# key: value`` lines; plans without one are named there."""
    made = f"{now or datetime.now(UTC):%Y-%m-%d %H:%M %Z} with imugui {__version__}"
    head = {"made": made, "note": NOTE, **(about or {})}
    untaken = ", ".join(title(plan) for plan in not_taken(readings, plans))
    lines = [f"# {_line(key)}: {_line(text)}\n" for key, text in {**head, "not taken": untaken or "none"}.items()]
    out = io.StringIO()
    out.writelines(lines)
    rows = [values(reading) for reading in readings]
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(rows[0] if rows else ("number", "level", "side"))
    writer.writerows([_cell(value) for value in row.values()] for row in rows)
    return out.getvalue()


def not_taken(readings: Iterable[Reading], plans: Iterable[Plan]) -> list[Plan]:
    """The plans that no reading was taken of."""
    taken = {identity(reading.plan) for reading in readings}
    return [plan for plan in plans if identity(plan) not in taken]


def _head(readings: Sequence[Reading], plans: Sequence[Plan]) -> dict[str, str]:
    inside = sum(reading.error_deg <= reading.plan.tolerance_deg for reading in readings)
    return {
        "Readings": f"{len(readings)}, of which {inside} inside their tolerance",
        "Plans": f"{len(plans)}, of which {len(not_taken(readings, plans))} not taken",
    }


def _summary(readings: Sequence[Reading]) -> str:
    body = "".join(
        f"<tr><th>{name.capitalize()}</th>{_numbers(found)}<td class='number'>{found.n}</td></tr>"
        for name, found in summary(readings).items()
    )
    heads = "".join(f'<th class="number">{name}</th>' for name in ("Mean", "SD", "RMS", "Largest", "Readings"))
    return f"<table><thead><tr><th></th>{heads}</tr></thead><tbody>{body}</tbody></table>"


def _numbers(found: Spread) -> str:
    figures = (found.mean, found.sd, found.rms, found.worst)
    return "".join(f"<td class='number'>{_deg(figure, 2)}</td>" for figure in figures)


def _table(readings: Sequence[Reading], plans: Sequence[Plan]) -> str:
    rows = [_row(reading) for reading in readings]
    for plan in not_taken(readings, plans):
        cells = (OPEN, title(plan), plan_words(plan), "not taken")
        rows.append(_cells(cells) + "<td></td>" * (len(HEADS) - len(cells)))
    heads = "".join(f"<th>{name}</th>" for name in HEADS)
    body = "".join(f"<tr>{row}</tr>\n" for row in rows)
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>"


def _row(reading: Reading) -> str:
    plan, error = reading.plan, reading.error_deg
    word, kind, limit = "beyond", "out", plan.amber_deg
    if error <= plan.amber_deg:
        inside = error <= plan.tolerance_deg
        word, kind, limit = ("inside", "in", plan.tolerance_deg) if inside else ("within", "near", plan.amber_deg)
    miss = miss_mm(reading)
    aside = OPEN if math.isnan(miss) else f"{miss:.1f}{NBSP}mm at {plan.depth_mm:g}{NBSP}mm"
    green = OPEN if math.isnan(reading.time_to_green_s) else f"{reading.time_to_green_s:.1f} s"
    return (
        _cells((str(reading.number), reading.title, plan_words(plan), achieved_words(reading)))
        + f'<td class="tight error {kind}">{_deg(error, 1)}<br>{word} {limit:g}°</td>'
        + f'<td class="tight">{_deg(reading.sigma_deg, 1)}</td>'
        + _cells((component_words(reading), aside, green, str(reading.overshoots)))
    )


def _cells(texts: Iterable[str]) -> str:
    """Cells of outside text, in words that may be broken and numbers that may not."""
    return "".join(
        f'<td class="{"tight" if len(text) < len("not taken") else "text"}">{escape(text)}</td>' for text in texts
    )


def _figure(reading: Reading) -> str:
    caption = escape(f"{reading.number}. {reading.title}")
    return f"<figure>{target_svg(reading)}<figcaption>{caption}: {_deg(reading.error_deg, 1)}</figcaption></figure>"


def _origins(readings: Sequence[Reading]) -> str:
    """Registrations, profiles, filters and versions that the readings were taken with, each with its readings."""
    found: dict[tuple[str, str], list[int]] = {}
    for reading in readings:
        registration = reading.registration
        magnetometer = "used" if reading.use_mag else "not used"
        lines = {
            "Registration": f"{registration.id}: {registration.words} Residual {registration.residual_deg:.1f}°.",
            "Calibration": reading.profile or "none",
            "Measured": "against a reference board" if reading.relative else "against the earth",
            "Filter": f"{reading.filter or 'not known'}, magnetometer {magnetometer}",
            "Tool axis in the box": ", ".join(f"{part:+.4f}" for part in reading.tool_axis),
            "Version": f"imugui {reading.version}",
        }
        for line in lines.items():
            found.setdefault(line, []).append(reading.number)
    kinds = dict.fromkeys(kind for kind, _ in found)
    body = "".join(
        f"<tr><th>{kind}</th><td>{escape(text)}</td><td>{_which(numbers, len(readings))}</td></tr>"
        for wanted in kinds
        for (kind, text), numbers in found.items()
        if kind == wanted
    )
    return f'<table class="about">{body}</table>'


def _which(numbers: Sequence[int], count: int) -> str:
    return f"all{NBSP}readings" if len(numbers) == count else f"readings {', '.join(map(str, numbers))}"


def _pairs(lines: Mapping[str, str]) -> str:
    return "".join(f"<tr><th>{escape(key)}</th><td>{escape(text)}</td></tr>" for key, text in lines.items())


def _deg(value: float, decimals: int) -> str:
    return OPEN if math.isnan(value) else f"{value:.{decimals}f}°"


def _line(text: str) -> str:
    return " ".join(str(text).split())


def _cell(value: str | int | float) -> str | int:
    """A value for a spreadsheet: nothing for NaN, and no text that it would take for a formula."""
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return f"'{value}"
    return value
