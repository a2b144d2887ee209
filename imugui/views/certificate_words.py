"""The certificate and the comparison of profiles as rich text in the colours of the scheme."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from html import escape

from imugui.calibration.certificate import certificate_rows
from imugui.calibration.compare import compare
from imugui.calibration.coverage_picture import coverage_svg
from imugui.calibration.profile import Profile
from imugui.views import theme

NOTE = "Errors are one standard deviation, at rest, away from iron and magnets. A research tool, not a medical device."


def certificate_text(profile: Profile, now: datetime) -> str:
    """The rows of the certificate as tables for a QTextBrowser."""
    rows = certificate_rows(profile, now)
    parts = []
    for section in dict.fromkeys(row.section for row in rows):
        lines = [(row.label, row.value) for row in rows if row.section == section]
        parts.append(f"<h3>{escape(section)}</h3>{_table(lines, big=section == 'Trust')}")
    return f"{''.join(parts)}<p style='color:{theme.palette().muted.name()}'>{NOTE}</p>"


def coverage_picture(profile: Profile) -> str:
    """Which directions were seen and which positions held, as SVG; empty without any."""
    cells = profile.magnetometer.cells if profile.magnetometer else ()
    positions = profile.accelerometer.positions if profile.accelerometer else ()
    return coverage_svg(cells, positions) if cells or positions else ""


def comparison_text(used: Profile, other: Profile) -> str:
    """What differs between the profile in use and another one."""
    lines = compare(used, other)
    if not lines:
        return "<p>Both calibrate alike.</p>"
    head = ("", used.board.title, other.board.title, "Difference")
    return _table([head, *((line.label, line.before, line.after, line.change) for line in lines)])


def page(title: str, body: str) -> str:
    """A page of its own for the browser."""
    head = f'<head><meta charset="utf-8"><title>{escape(title)}</title></head>'
    return f'<!DOCTYPE html><html lang="en">{head}<body>{body}</body></html>'


def _table(lines: Iterable[tuple[str, ...]], big: bool = False) -> str:
    grey = theme.palette().muted.name()
    size = "font-size:large; font-weight:600;" if big else ""
    body = "".join(
        f"<tr><td width='210' style='color:{grey}'>{escape(label)}</td>"
        + "".join(f"<td style='padding-left:14px; {size}'>{escape(value)}</td>" for value in values)
        + "</tr>"
        for label, *values in lines
    )
    return f"<table cellspacing='3'>{body}</table>"
