"""Nothing from outside is run, nothing listens, and no text from outside becomes markup in a report."""

from __future__ import annotations

import dataclasses
import sys
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.calibration.certificate import certificate_html
from imugui.calibration.parts import AccelerometerPart, GyroscopePart, MagnetometerPart
from imugui.calibration.profile import Board, Profile
from imugui.guidance.aiming import axis_error
from imugui.guidance.plan import Plan, direction
from imugui.guidance.reading import Reading
from imugui.guidance.registration import from_axes
from imugui.guidance.report import report_html as guidance_html
from imugui.targeting.questionnaires import Answer
from imugui.targeting.results import results
from imugui.targeting.results_report import report_html as study_html
from imugui.targeting.trials import Trial
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source

NOW = datetime(2026, 11, 1, tzinfo=UTC)
DATE = "2026-11-01T12:00:00+00:00"
MARK = "Zq7"
"""Stands in every text from outside: where it is found in a page, the text must be plain text."""
PLACES = Path("/proc/net")
LISTENING = {"tcp": "0A", "tcp6": "0A", "udp": "07", "udp6": "07"}
"""State in which a socket takes what comes from outside; 07 of UDP: bound, and connected to nobody."""

outside = st.one_of(
    st.sampled_from(
        ["<script>alert(1)</script>", "</title><img src=x>", "\"' onload='x", "</style><b>", "&lt;b&gt;",
         "]]>", "--><svg onload=x>", "<!--", "&#60;", "javascript:x", "{}%s", "\x00<b>", "\u202e<b>"]
    ),
    st.text(max_size=30),
).map(lambda text: f"{MARK}{text}{MARK}")  # fmt: skip


class Page(HTMLParser):
    """What a browser would see: tags, attributes with our mark, and the text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.words = ""
        self.odd: list[str] = []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]

    def handle_data(self, data: str) -> None:
        self.words += data

    def handle_comment(self, data: str) -> None:
        self.odd.append(data)

    def unknown_decl(self, data: str) -> None:
        self.odd.append(data)


def reading_of(text: str) -> Reading:
    registration = dataclasses.replace(from_axes((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), 1.0), words=text, id=text)
    plan = Plan(name=text, side="left", axial_deg=20.0, sagittal_deg=10.0, depth_mm=40.0, reference=text)
    way = direction(dataclasses.replace(plan, name="L4", axial_deg=21.2))
    wanted = direction(dataclasses.replace(plan, name="L4"))
    error = float(axis_error(way, wanted)) * 57.29577951308232
    texts = dict.fromkeys(("profile", "filter", "version", "utc"), text)
    return Reading(
        1, plan, tuple(way), tuple(wanted), error, 1.2, 0.1, 0.5, 2.0, (1, 9), registration, (1.0, 0.0, 0.0), **texts
    )


def certificate(text: str) -> str:
    parts: dict[str, Any] = {"method": text, "date": DATE, "verdict": text}
    profile = Profile(
        Board(text, text, text),
        GyroscopePart(**parts, matrix_method=text),
        AccelerometerPart(**parts, positions=((0.0, 0.0, 1.0),)),
        MagnetometerPart(**parts, axes=text, cells=(1, 2)),
        made_with=text,
    )
    return certificate_html(profile, NOW)


def guidance(text: str) -> str:
    return guidance_html([reading_of(text)], [Plan(name=text, side="right")], {text: text}, NOW)


def study(text: str) -> str:
    trials = [
        Trial(text, f"{person}{text}", f"{condition}{text}", block, run=1, index=index, movement_time_s=2.0 + index)
        for person in "ab"
        for condition in "xy"
        for block in (1, 2)
        for index in range(3)
    ]
    answers = [Answer(f"a{text}", f"x{text}", "preference", ())]
    found = results(trials, [f"x{text}", f"y{text}"], None, answers)
    return study_html(dataclasses.replace(found, study=text, notes=(*found.notes, text)), NOW)


REPORTS = {"certificate": certificate, "guidance": guidance, "study": study}


@pytest.mark.parametrize("name", REPORTS)
@settings(max_examples=30)
@given(text=outside)
def test_every_report_shows_outside_text_as_text(name: str, text: str) -> None:
    page, plain = Page(REPORTS[name](text)), Page(REPORTS[name](f"{MARK}plain{MARK}"))
    assert page.tags == plain.tags
    assert page.odd == plain.odd == []
    assert [key for key, _ in page.attributes] == [key for key, _ in plain.attributes]
    assert all(not key.startswith("on") and key not in ("src", "href") for key, _ in page.attributes)
    assert page.words.count(MARK) >= 2


def sockets(kind: str, state: str) -> set[str]:
    """The inodes of all sockets of this kind in this state."""
    path = PLACES / kind
    lines = path.read_text().splitlines()[1:] if path.exists() else []
    rows = [line.split() for line in lines]
    return {row[9] for row in rows if row[3] == state}


def own_listeners() -> set[str]:
    """What of this process takes connections or messages from other machines."""
    links = [entry for entry in Path("/proc/self/fd").iterdir() if entry.is_symlink()]
    own = {str(entry.readlink()).removeprefix("socket:[").rstrip("]") for entry in links if entry.is_symlink()}
    return own & set().union(*(sockets(kind, state) for kind, state in LISTENING.items()))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_nothing_listens_while_the_window_streams_and_records(session: Session, qtbot: Any, tmp_path: Path) -> None:
    before = own_listeners()
    window = MainWindow(session, SettingsStore())
    window.show()
    session.connect_to(Source("simulator", "free"))
    qtbot.waitUntil(lambda: session.attitude.count > 20)
    assert session.record(tmp_path / "on.imugui")
    for name in window.pages:
        window.show_page(name)
    found = own_listeners()
    window.close()
    window.deleteLater()
    assert found <= before


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_listener_would_be_seen() -> None:
    import socket

    before = own_listeners()
    with socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        assert len(own_listeners() - before) == 2
