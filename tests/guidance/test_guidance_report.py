"""The report: right numbers, every outside text escaped, nothing fetched from outside."""

from __future__ import annotations

import csv
import dataclasses
import io
import math
import re
from datetime import UTC, datetime
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest

from imugui import __version__
from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading
from imugui.guidance.report import NOTE, not_taken, report_csv, report_html
from imugui.guidance.report_numbers import achieved_words, component_words, miss_mm, spread, summary
from imugui.guidance.report_pictures import RIM, SIZE, place, scale_deg, target_svg

NOW = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)
EVIL = "<script>alert(1)</script>\"'&"
PLANS = (Plan(name="L4", side="left"), Plan(name="S1", side="right", axial_deg=25.0))


class Page(HTMLParser):
    """Collects tags, attributes and text, and checks that tags are closed."""

    VOID = ("meta", "br")

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.open: list[str] = []
        self.words = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words += data


def with_evil(reading: Reading) -> Reading:
    plan = dataclasses.replace(reading.plan, name=EVIL, reference=EVIL)
    registration = dataclasses.replace(reading.registration, words=EVIL, id=EVIL)
    texts = dict.fromkeys(("profile", "filter", "version", "utc"), EVIL)
    return dataclasses.replace(reading, plan=plan, registration=registration, **texts)


def test_every_outside_text_is_escaped(reading: Reading) -> None:
    plans = [Plan(name=EVIL, side="right")]
    text = report_html([with_evil(reading)], plans, {EVIL: EVIL}, NOW)
    page = Page(text)
    assert "script" not in page.tags
    assert "<script" not in text
    assert page.words.count(EVIL) >= 7
    assert all("alert" not in value for _, value in page.attributes)


def test_it_needs_nothing_from_outside(reading: Reading) -> None:
    page = Page(report_html([reading], PLANS, None, NOW))
    assert not {"link", "script", "img", "iframe", "object"} & set(page.tags)
    assert not [name for name, _ in page.attributes if name in ("src", "href") or name.startswith("on")]
    assert "url(" not in page.words


def test_it_says_what_was_reached_and_where_that_comes_from(reading: Reading) -> None:
    words = Page(report_html([reading], PLANS, {"Operator": "A. B."}, NOW)).words
    for text in (
        "A. B.",
        "20° medial, 10° cranial",
        "21.2° medial",
        "inside",
        "0.8\N{NO-BREAK SPACE}mm at 40\N{NO-BREAK SPACE}mm",
        reading.registration.id,
    ):
        assert text in words
    for text in ("test board", "vqf", "not used", __version__, "S1 right", "not taken", "RAS", "vertebral midline"):
        assert text in words
    assert words.count(NOTE) == 2


def test_an_empty_report_is_a_report() -> None:
    assert "0, of which 0" in Page(report_html([], [], None, NOW)).words
    assert "not taken: none" in report_csv([], [], None, NOW)


def test_the_csv_holds_every_number(reading: Reading) -> None:
    text = report_csv([reading, dataclasses.replace(reading, number=2)], PLANS, {"Operator": "A\nB"}, NOW)
    head = [line for line in text.splitlines() if line.startswith("# ")]
    assert any(NOTE in line for line in head)
    assert "# Operator: A B" in head
    assert "# not taken: S1 right" in head
    rows = list(csv.DictReader(io.StringIO("\n".join(line for line in text.splitlines() if line not in head))))
    assert [row["number"] for row in rows] == ["1", "2"]
    row = rows[0]
    assert float(row["error_deg"]) == reading.error_deg
    assert [float(row[f"direction_{axis}"]) for axis in "ras"] == list(reading.direction)
    assert (row["level"], row["side"], row["twist_deg"], row["frame"]) == ("L4", "left", "", "RAS")
    assert (int(row["first_attitude"]), int(row["last_attitude"])) == reading.rows
    assert float(row["axial_deg"]) == pytest.approx(21.2)
    assert row["registration"] == reading.registration.id


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t"])
def test_no_text_becomes_a_formula_in_a_spreadsheet(reading: Reading, start: str) -> None:
    evil = dataclasses.replace(reading, profile=f"{start}HYPERLINK(1)")
    row = next(csv.DictReader(io.StringIO(report_csv([evil], [], None, NOW).split("not taken: none\n")[1])))
    assert row["profile"] == f"'{start}HYPERLINK(1)"


def test_plans_are_taken_by_name_and_side(reading: Reading) -> None:
    assert not_taken([reading], PLANS) == [PLANS[1]]


# numbers


def test_mean_sd_rms_and_largest() -> None:
    found = spread([1.0, 2.0, -4.0, math.nan])
    assert (found.n, found.worst) == (3, 4.0)
    assert found.mean == pytest.approx(-1 / 3)
    assert found.sd == pytest.approx(np.std([1.0, 2.0, -4.0], ddof=1))
    assert found.rms == pytest.approx(math.sqrt(7.0))
    assert spread([]).n == 0
    assert math.isnan(spread([1.0]).sd)


def test_the_summary_keeps_the_sides_apart(reading: Reading) -> None:
    other = dataclasses.replace(reading, error_deg=3.0, medial_deg=-3.0, cranial_deg=0.0)
    found = summary([reading, other])
    assert found["error of the axis"].mean == pytest.approx((reading.error_deg + 3.0) / 2)
    assert found["medial (+) or lateral (-)"].worst == 3.0
    plain = dataclasses.replace(reading, plan=Plan(name="box", kind="plain"))
    assert list(summary([plain]))[1:] == ["right (+) or left (-)", "up (+) or down (-)"]
    assert list(summary([reading, plain]))[1] == "medial, right (+) or lateral, left (-)"


def test_words_carry_the_sign(reading: Reading) -> None:
    assert achieved_words(reading) == "21.2° medial, 10.0° cranial"
    assert component_words(reading) == "1.2° medial, 0.1° caudal"
    other = dataclasses.replace(reading, medial_deg=-0.8, cranial_deg=-0.3)
    assert component_words(other) == "0.8° lateral, 0.3° caudal"
    plain = dataclasses.replace(reading, plan=Plan(name="box", kind="plain"), direction=(-0.6, 0.8, 0.0))
    assert achieved_words(plain) == "points 36.9° left, 0.0° up"
    assert miss_mm(reading) == pytest.approx(40.0 * math.sin(math.radians(reading.error_deg)))


# pictures


def test_the_cross_is_where_the_tool_was(reading: Reading) -> None:
    moved = dataclasses.replace(reading, medial_deg=1.0, cranial_deg=-0.5)
    assert place(moved, 10.0) == (SIZE / 2 + 10.0, SIZE / 2 + 5.0)
    right = dataclasses.replace(moved, plan=dataclasses.replace(moved.plan, side="right"))
    assert place(right, 10.0) == (SIZE / 2 - 10.0, SIZE / 2 + 5.0)


@pytest.mark.parametrize(("error_deg", "scale"), [(0.0, 2.5), (2.2, 2.5), (2.4, 5.0), (30.0, 45.0), (179.0, 180.0)])
def test_the_scale_holds_cross_and_tolerance(reading: Reading, error_deg: float, scale: float) -> None:
    assert scale_deg(dataclasses.replace(reading, error_deg=error_deg)) == scale


def test_the_picture_is_well_formed_and_its_rings_are_true(reading: Reading) -> None:
    root = ElementTree.fromstring(target_svg(reading))  # noqa: S314 (our own text)
    names = [node.tag.rpartition("}")[2] for node in root]
    assert names.count("path") == 1
    words = [node.text for node in root if node.tag.endswith("text")]
    assert {"medial", "lateral", "cranial", "caudal", "2.5°"} <= set(words)
    rings = [float(node.attrib["r"]) for node in root if node.attrib.get("stroke") == "#009e73"]
    assert rings == [pytest.approx(2.0 / 2.5 * RIM, abs=0.1)]


def test_for_the_right_side_medial_is_on_the_left(reading: Reading) -> None:
    right = dataclasses.replace(reading, plan=dataclasses.replace(reading.plan, side="right"))
    found = [re.search(r'<text x="(\d+)"[^>]*>medial<', target_svg(one)) for one in (reading, right)]
    left_side, right_side = (float(match[1]) for match in found if match)
    assert left_side > SIZE / 2 > right_side


def test_a_backwards_tool_has_no_cross(reading: Reading) -> None:
    lost = dataclasses.replace(reading, error_deg=180.0, medial_deg=math.nan, cranial_deg=math.nan)
    assert "<path" not in target_svg(lost)
    assert "not known" in component_words(lost)
