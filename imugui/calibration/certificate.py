"""Certificate: one page that says what was calibrated, when, how well, and until when to trust it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from html import escape
from typing import Any

from imugui import __version__
from imugui.calibration.coverage_picture import coverage_svg
from imugui.calibration.parts import Part
from imugui.calibration.profile import Profile
from imugui.samples import GRAVITY

NOTE = "A research tool, not a medical device."
UNKNOWN = "not known"
NAMES = {
    "gyroscope": "Gyroscope",
    "accelerometer": "Accelerometer",
    "magnetometer": "Magnetometer",
    "mounting": "Mounting",
    "temperature": "Temperature",
    "noise": "Noise",
}
STYLE = """
body { font: 11pt/1.4 system-ui, sans-serif; color: #111; background: #fff; max-width: 46em; margin: 2em auto; }
h1 { font-size: 16pt; margin: 0; } h2 { font-size: 12pt; margin: 1em 0 .2em; border-bottom: 1px solid #999; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: normal; color: #444; width: 15em; }
th, td { padding: .1em .5em .1em 0; vertical-align: top; } td { font-variant-numeric: tabular-nums; }
.key td { font-size: 14pt; font-weight: bold; } .warn { border-left: 4px solid #d55e00; padding-left: .6em; }
footer { margin-top: 1.5em; color: #444; font-size: 9pt; } svg { display: block; margin: .5em 0; }
@page { size: A4; margin: 15mm; } @media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } }
"""


@dataclass(frozen=True)
class Row:
    """One line of the certificate: under which heading, what, and its value in words."""

    section: str
    label: str
    value: str


def certificate_rows(profile: Profile, now: datetime, temp_c: float = math.nan) -> list[Row]:
    """The certificate as plain rows, for a window; ``now`` with its time zone, ``temp_c`` degrees C if known."""
    until = profile.good_until
    late = until is not None and now > until
    ends = f"{until:%Y-%m-%d}{' (over)' if late else ''}" if until else UNKNOWN
    rows = [
        Row("Trust", "Expected tilt error", _figure(profile.tilt_error_deg, "deg", 2)),
        Row("Trust", "Expected heading error", _figure(profile.heading_error_deg, "deg", 1)),
        Row("Trust", "Good until", ends),
        *(Row("Trust", "Warning", warning) for warning in profile.warnings(now, temp_c)),
        Row("Board", "Name", profile.board.title),
        Row("Board", "Connection", f"{profile.board.transport} {profile.board.address}".strip() or UNKNOWN),
        Row("Board", "Sample rate", _figure(profile.rate_hz, "Hz", 1)),
        *(Row("Board", label, value) for label, value in _delays(profile.delays_ms)),
    ]
    for name, title in NAMES.items():
        part = profile.parts.get(name)
        lines = [("", "not calibrated")] if part is None else [*_common(part), *_VALUES[name](part)]
        rows += [Row(title, label, value) for label, value in lines]
    return rows


def certificate_html(profile: Profile, now: datetime, temp_c: float = math.nan) -> str:
    """The certificate as one self-contained page; every text from outside is escaped."""
    rows = certificate_rows(profile, now, temp_c)
    title = escape(f"Calibration certificate: {profile.board.title}")
    sections = "".join(_section(name, rows) for name in dict.fromkeys(row.section for row in rows))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f"<style>{STYLE}</style></head>\n<body><h1>{title}</h1>\n{sections}{_picture(profile)}"
        f"<footer>Made {now:%Y-%m-%d %H:%M} with imugui {escape(__version__)}. Errors are one standard deviation, "
        f"at rest, away from iron and magnets. {NOTE}</footer></body></html>\n"
    )


def _section(name: str, rows: list[Row]) -> str:
    lines = [row for row in rows if row.section == name]
    kind = ' class="key"' if name == "Trust" else ""
    body = "".join(_line(row) for row in lines if row.label != "Warning")
    warnings = "".join(f'<p class="warn">Warning: {escape(row.value)}</p>' for row in lines if row.label == "Warning")
    return f"<h2>{escape(name)}</h2>{warnings}<table{kind}>{body}</table>\n"


def _line(row: Row) -> str:
    return f"<tr><th>{escape(row.label)}</th><td>{escape(row.value)}</td></tr>"


def _picture(profile: Profile) -> str:
    cells = profile.magnetometer.cells if profile.magnetometer else ()
    positions = profile.accelerometer.positions if profile.accelerometer else ()
    if not cells and not positions:
        return ""
    text = "Dots: directions of the field, filled where it was measured. Squares: attitudes held still, by what was up."
    return f"<h2>Coverage</h2>{coverage_svg(cells, positions)}<p>{text}</p>\n"


def _common(part: Part) -> list[tuple[str, str]]:
    return [
        ("Quality", part.quality),
        ("Calibrated", _when(part.when(), part.temp_c)),
        ("Method", f"{part.method}, {part.samples} samples"),
    ]


def _when(date: datetime, temp_c: float) -> str:
    temperature = f", at {temp_c:.1f} °C" if not math.isnan(temp_c) else ""
    return f"{date:%Y-%m-%d %H:%M} UTC{temperature}"


def _gyroscope(part: Any) -> list[tuple[str, str]]:
    worst = 2 * max(part.sigma)
    lines = [
        ("Bias", _vector(part.bias, 180 / math.pi, 3, "deg/s")),
        ("Known to", f"{math.degrees(worst):.3f} deg/s (2 sigma)"),
    ]
    if part.matrix_method:
        learnt = not math.isnan(part.matrix_sigma)
        method = part.matrix_method if learnt else f"from {part.matrix_method}"
        lines.append(("Scale and cross-axis", f"{method}, {_matrix(part.matrix)}"))
        known = ("Scale known to", f"{100 * part.matrix_sigma:.2f} % (1 sigma of the worst known element)")
        lines.append(known if learnt else ("Error of a turn", _figure(part.turn_error_deg, "deg", 2)))
    if part.matrix_date:
        lines.append(("Scale calibrated", _when(part.matrix_when(), part.matrix_temp_c)))
    return lines


def _delays(delays_ms: tuple[float, float] | None) -> list[tuple[str, str]]:
    if delays_ms is None:
        return []
    return [("Delays", f"gyroscope {delays_ms[0]:g} ms, magnetometer {delays_ms[1]:g} ms later (set by hand)")]


def _accelerometer(part: Any) -> list[tuple[str, str]]:
    left_out = f", {part.loo_mg:.2f} mg on positions left out" if not math.isnan(part.loo_mg) else ""
    return [
        ("Bias", _vector(part.bias, 1000 / GRAVITY, 1, "mg")),
        ("Scale and cross-axis", _matrix(part.matrix)),
        ("Residual", f"{_figure(part.residual_mg, 'mg', 2)}{left_out}"),
        ("Positions", str(len(part.positions))),
        ("Tilt error", _figure(part.tilt_deg, "deg", 2)),
    ]


def _magnetometer(part: Any) -> list[tuple[str, str]]:
    share = f"{100 * part.coverage:.0f} % of all directions" if not math.isnan(part.coverage) else UNKNOWN
    lines = [
        ("Hard iron", _vector(part.hard_iron, 1.0, 1, "µT")),
        ("Soft iron", _matrix(part.soft_iron)),
        ("Field, dip", f"{_figure(part.field_ut, 'µT', 1)}, {_figure(part.dip_deg, 'deg', 1)}"),
        ("Direction error", _figure(part.predicted_deg, "deg", 2)),
        ("Residual", _figure(part.residual_percent, "%", 2)),
        ("Coverage", f"{share}, largest gap {_figure(part.gap_deg, 'deg', 0)}"),
    ]
    return [*lines, ("Axes", part.axes)] if part.axes else lines


def _mounting(part: Any) -> list[tuple[str, str]]:
    turned = math.degrees(2 * math.acos(min(1.0, abs(part.quat[0]))))
    return [("Turned by", f"{turned:.1f} deg"), ("Direction ahead", f"to {_figure(part.error_deg, 'deg', 1)}")]


def _temperature(part: Any) -> list[tuple[str, str]]:
    span = f"{part.low_c:.1f} to {part.high_c:.1f} °C"
    return [("Range", span), ("Error", _figure(part.error_dps, "deg/s", 3))]


def _noise(part: Any) -> list[tuple[str, str]]:
    return [
        ("Gyroscope N", _known(part.gyr_white, 4, "deg/s/√Hz")),
        ("Gyroscope bias instability", _known(part.gyr_instability, 4, "deg/s")),
        ("Accelerometer N", _known(part.acc_white, 2, "mg/√Hz")),
        ("Accelerometer bias instability", _known(part.acc_instability, 3, "mg")),
    ]


_VALUES: dict[str, Callable[[Any], list[tuple[str, str]]]] = {
    "gyroscope": _gyroscope,
    "accelerometer": _accelerometer,
    "magnetometer": _magnetometer,
    "mounting": _mounting,
    "temperature": _temperature,
    "noise": _noise,
}


def _figure(value: float, unit: str, decimals: int) -> str:
    return UNKNOWN if math.isnan(value) else f"{value:.{decimals}f} {unit}"


def _vector(values: Any, factor: float, decimals: int, unit: str) -> str:
    return f"{', '.join(f'{factor * value:+.{decimals}f}' for value in values)} {unit}"


def _known(values: Any, decimals: int, unit: str) -> str:
    texts = ["?" if math.isnan(value) else f"{value:.{decimals}f}" for value in values]
    return UNKNOWN if set(texts) == {"?"} else f"{', '.join(texts)} {unit}"


def _matrix(matrix: Any) -> str:
    own = [100 * (matrix[k][k] - 1) for k in range(3)]
    crossed = max(abs(matrix[j][k]) for j in range(3) for k in range(3) if j != k)
    return f"scale {', '.join(f'{value:+.2f}' for value in own)} %, cross-axis up to {100 * crossed:.2f} %"
