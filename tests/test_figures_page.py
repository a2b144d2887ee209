"""docs/figures.md is made from what the benchmarks print: also from figures that fail, and never from none."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

import figures as figures_module
from _plots import bars, curves

LINE = {"benchmark": "decode", "case": "triplets, lines", "ratio": 0.4, "wanted": 0.5, "ok": False, "rows_per_s": 9000}


@pytest.fixture
def figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The module, with a folder of its own for scripts and pages."""
    monkeypatch.setattr(figures_module, "__file__", str(tmp_path / "figures.py"))
    monkeypatch.setattr(figures_module, "KEPT", tmp_path / "figures")
    monkeypatch.setattr(figures_module, "PAGE", tmp_path / "figures.md")
    return figures_module


def script(figures: ModuleType, name: str, *lines: dict[str, object], code: int = 0) -> None:
    text = "\n".join(json.dumps(line) for line in lines)
    figures.KEPT.with_name(f"{name}.py").write_text(f"print({text!r})\nraise SystemExit({code})\n")


def test_a_figure_that_is_not_as_wanted_is_on_the_page_and_said(figures: ModuleType) -> None:
    script(figures, "decode", LINE, LINE | {"case": "csv-line, lines", "ratio": 0.6, "ok": True}, code=1)
    with pytest.raises(subprocess.CalledProcessError):
        figures.run("decode")
    figures.write_page()
    page = figures.PAGE.read_text()
    assert "| triplets, lines | 0.4 | 9,000 | **no** |" in page
    assert "| csv-line, lines | 0.6 | 9,000 | yes |" in page
    assert "python3 run.py bench figures endurance" in page


def test_a_benchmark_without_figures_leaves_what_was_kept(
    figures: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    script(figures, "decode", LINE)
    figures.run("decode")
    kept = (figures.KEPT / "decode.jsonl").read_text()
    script(figures, "decode", {"benchmark": "decode", "note": "no data here"})
    figures.run("decode")
    assert (figures.KEPT / "decode.jsonl").read_text() == kept
    assert "no data here" in capsys.readouterr().out


def test_a_figure_that_is_not_known_is_a_dash(figures: ModuleType) -> None:
    script(figures, "decode", LINE | {"ratio": None})
    figures.run("decode")
    assert "| triplets, lines | - | 9,000 | **no** |" in figures.section("decode")


def test_a_run_over_time_is_plotted_as_curves(figures: ModuleType) -> None:
    runs = [{"case": case, "ok": True, "held_mb": [200.0, 201.0]} for case in ("window", "accelerated")]
    script(figures, "endurance", *runs)
    figures.run("endurance")
    assert "| window | " in "\n".join(figures.section("endurance"))
    assert (figures.KEPT / "endurance.svg").read_text().count("<polyline") == 2


def test_bars_are_as_long_as_their_values_and_carry_what_is_wanted() -> None:
    chart = bars("Speed <1>", [("a & b", 2.0, 4.0), ("c", 1.0, None), ("d", float("nan"), 1.0)])
    assert re.findall(r'<rect x="\d+" y="\d+" width="([\d.]+)"', chart) == ["230.0", "115.0"]  # 4 takes all there is
    assert chart.count("<path") == 1
    assert "Speed &lt;1&gt;" in chart
    assert "a &amp; b" in chart


def test_a_curve_that_stays_is_level() -> None:
    (points,) = re.findall(r'points="([^"]+)"', curves("Memory", {"run": [300.0] * 5}))
    assert len(points.split()) == 5
    assert len({point.split(",")[1] for point in points.split()}) == 1
