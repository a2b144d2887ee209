"""Plans as CSV: what is written reads back exactly; each bad line is named, and no other line is lost by it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.guidance.plan import REFERENCES, Plan, identity, list_problems, problems
from imugui.guidance.plan_file import LARGEST, load_plans, read_plans, write_plans
from imugui.guidance.plan_text import field_text, parse_field

HEADER = "level,side,axial_deg,sagittal_deg,depth_mm\n"
ANGLE = st.floats(-89.9, 89.9)
NAME = st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "S", "Zs")), min_size=1, max_size=40).filter(
    lambda text: not problems(Plan(text, side="left"))
)
OPEN = st.just(math.nan)
PLANS = st.builds(
    Plan,
    name=NAME,
    kind=st.sampled_from(["projected", "plain"]),
    side=st.sampled_from(["left", "right"]),
    axial_deg=ANGLE,
    sagittal_deg=ANGLE,
    yaw_deg=st.floats(-180, 180),
    pitch_deg=st.floats(-90, 90),
    roll_deg=st.floats(-180, 180) | OPEN,
    depth_mm=st.floats(1, 300) | OPEN,
    tolerance_deg=st.floats(0.1, 5),
    amber_deg=st.floats(5, 90),
    reference=st.sampled_from(REFERENCES),
)


@given(st.lists(PLANS, max_size=6, unique_by=identity))
def test_what_is_written_reads_back_exactly(plans: list[Plan]) -> None:
    again, wrong = read_plans(write_plans(plans))
    assert wrong == []
    assert repr(again) == repr(plans)  # NaN is equal only in writing


def test_the_frame_and_the_convention_are_in_the_file() -> None:
    text = write_plans([Plan("L4", side="left", axial_deg=12.0, sagittal_deg=-5.0)])
    assert text.startswith("# frame: RAS\n# convention: Axial: the angle from the vertebral midline")
    assert text.splitlines()[-1].startswith("L4,left,projected,12,-5,")


@pytest.mark.parametrize(
    "text",
    [
        HEADER + "L4,left,12.5,-5,40\n",
        "\ufeffLevel,SIDE,axial_deg,sagittal_deg,depth_mm\r\n L4 , Left ,12.5,-5,40\r\n",
        "level;side;axial_deg;sagittal_deg;depth_mm\nL4;l;12,5;-5;40\n",
        "side\tdepth_mm\tsagittal_deg\taxial_deg\tlevel\nLEFT\t40 mm\t-5°\t1.25e1\tL4\n",
        HEADER + '"L4",left,"12,5",\N{MINUS SIGN}5,40.0\n',
        "# made by hand\n\n" + HEADER + "\n,,,,\nL4,left,12.5,-5,40",
        "name,side,axial_deg,sagittal_deg,depth_mm\nL4,left,12.5,-5,40",
    ],
)
def test_spellings_of_the_same_plan(text: str) -> None:
    plans, wrong = read_plans(text)
    assert wrong == []
    assert repr(plans) == repr([Plan("L4", "projected", "left", 12.5, -5.0, depth_mm=40.0)])


def test_plain_plans_need_no_kind_when_the_columns_say_it() -> None:
    plans, wrong = read_plans("level,yaw_deg,pitch_deg\ntilt,45,34\n")
    assert wrong == []
    assert repr(plans) == repr([Plan("tilt", "plain", yaw_deg=45.0, pitch_deg=34.0)])
    plans, wrong = read_plans("level,kind,yaw_deg,pitch_deg,roll_deg\ntilt,plain,45,34,any\nother,,1,2,\n")
    assert [plan.kind for plan in plans] == ["plain", "plain"]
    assert wrong == []


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("L5,left,95,0,", "Line 3: axial_deg: Axial is 95°: it must lie between -89.9 and 89.9°."),
        ("L5,left,abc,0,", "Line 3: axial_deg: Axial must be a number, not 'abc'."),
        ("L5,left,1_0,0,", "axial_deg: Axial must be a number"),
        ("L5,left,nan,0,", "axial_deg: Axial must be a number"),
        ("L5,left,1e999,0,", "axial_deg: Axial is inf°"),
        ('L5,left,"1.234,5",0,', "axial_deg: Axial must be a number"),
        ("L5,left,__import__('os'),0,", "axial_deg: Axial must be a number"),
        ("L5,left,,0,", "axial_deg: Axial is missing."),
        ("L5,left,12", "sagittal_deg: Sagittal is missing."),
        ("L5,,12,0,", "side: Side is missing."),
        ("L5,middle,12,0,", "side: Side is 'middle': it must be left, right or empty."),
        (",left,12,0,", "level: Level is empty"),
        ("=cmd(),left,12,0,", "level: Level begins with ="),
        ("L5,left,12,5,0,40", "there are 6 cells for 5 columns; a decimal comma needs quotes."),
        ('"L5,left,12,0,40', "look for a quote that is not closed"),
        ('L5,"left"x,12,0,40', "the line cannot be read"),
        ("l4,LEFT,1,2,", "level: l4 left is already there, in line 2."),
        ("L5,left,12,0,-4", "depth_mm: Depth is -4 mm: it must lie between 1 and 300 mm."),
        ("L5,up,95,0,0", "side: Side is 'up': it must be left, right or empty. axial_deg: Axial is 95°"),
        ("L\x005,left,1,0,", "level: Level must be plain text"),
    ],
)
def test_a_bad_line_is_named_and_loses_no_other(line: str, said: str) -> None:
    plans, wrong = read_plans(f"{HEADER}L4,left,12,-5,\n{line}\nS1,right,20,10,\n")
    assert [plan.name for plan in plans] == ["L4", "S1"]
    assert len(wrong) == 1
    assert wrong[0].startswith("Line 3: ")
    assert said in wrong[0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "The file is empty"),
        ("\n , ;\n# only words\n", "The file is empty"),
        ("L4,left,12,5\n", "there is no column level"),
        ("level,side,side\nL4,left,left\n", "the column side is there twice"),
        ('level,"side\nL4,left\n', "Line 1: the line cannot be read"),
        ("x" * (LARGEST + 1), "is the most"),
    ],
)
def test_a_file_without_a_header_is_refused(text: str, said: str) -> None:
    plans, wrong = read_plans(text)
    assert plans == []
    assert any(said in sentence for sentence in wrong)


def test_an_unknown_column_is_said_and_left_out() -> None:
    plans, wrong = read_plans("level,surgeon,side,axial_deg,sagittal_deg\nL4,X,left,1,2\n")
    assert [plan.axial_deg for plan in plans] == [1.0]
    assert wrong == ["Line 1: the column 'surgeon' is not known and was left out."]


@given(st.text(max_size=300) | st.text('level,side;\t"\n\r01.-', max_size=300).map(lambda tail: HEADER + tail))
def test_any_text_is_read_without_an_exception(text: str) -> None:
    plans, wrong = read_plans(text)
    assert all(found == {} for found in list_problems(plans))
    assert plans or wrong or text.strip(" ,;\t\r\n").startswith(("#", "level"))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_files_of_spreadsheets(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "plans.csv"
    path.write_bytes(f"{HEADER}Größe,left,12°,5,\n".encode(encoding))
    plans, wrong = load_plans(path)
    assert wrong == []
    assert [(plan.name, plan.axial_deg) for plan in plans] == [("Größe", 12.0)]


def test_a_file_that_is_no_table(tmp_path: Path) -> None:
    path = tmp_path / "plans.csv"
    path.write_bytes(bytes(range(256)) * 50)
    assert load_plans(path)[0] == []
    assert load_plans(path)[1]
    path.write_bytes(b"level\n" * LARGEST)
    assert "is the most" in load_plans(path)[1][0]
    with pytest.raises(OSError, match="absent"):
        load_plans(tmp_path / "absent")


@given(PLANS)
def test_cells_read_back_exactly(plan: Plan) -> None:
    for name in vars(plan):
        assert repr(parse_field(name, field_text(plan, name))) == repr(getattr(plan, name))


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [("axial_deg", "12,5 °", 12.5), ("depth_mm", "", math.nan), ("roll_deg", "any", math.nan), ("side", " R", "right"),
     ("axial_deg", "", 0.0), ("amber_deg", "", 5.0), ("reference", "TABLE normal", "table normal"),
     ("name", " L4 ", "L4")],
)  # fmt: skip
def test_cells(name: str, text: str, value: object) -> None:
    assert repr(parse_field(name, text)) == repr(value)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [("axial_deg", "any", "Axial must be a number, not 'any'."), ("side", "both", "Side is 'both'"),
     ("name", "", "Level is empty"), ("tolerance_deg", "50", "Green up to is 50°"), ("axial_deg", "1,2,3", "number")],
)  # fmt: skip
def test_bad_cells_say_what_is_wrong(name: str, text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        parse_field(name, text)
