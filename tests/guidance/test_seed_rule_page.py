"""docs/screw-target.md says what docs/seed_rule.py computes today."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("seed_rule", DOCS / "seed_rule.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_up_to_date(script: ModuleType) -> None:
    assert (DOCS / "screw-target.md").read_text(encoding="utf-8") == script.page()


def test_the_picture_is_up_to_date(script: ModuleType) -> None:
    assert (DOCS / "screw-target.svg").read_text(encoding="utf-8") == script.picture()
    shapes = [item.tag.rpartition("}")[2] for item in ElementTree.fromstring(script.picture())]  # noqa: S314, our own
    assert (shapes.count("circle"), shapes.count("polygon")) == (4, 4)


def test_the_figures_that_are_known_otherwise(script: ModuleType) -> None:
    page = script.page()
    assert "| 0° | 2.83° | 2.00° | 0 % | 50 % |" in page  # TV-B: 2.83 degrees at zero tilt
    assert "| 90° | 180.00° |" in page
    assert "84.76°, -14.08° and 20.65°" in page  # decision 4 of guidance-teleop.md
    assert "aiming error is 0.00°" in page
