"""What every page must do; runs over VIEWS."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QAbstractButton, QAbstractSpinBox, QApplication, QComboBox, QLineEdit, QWidget

from imugui import paths
from imugui.views import PAGES, VIEWS, theme
from imugui.views.settings_store import SettingsStore
from imugui.views.view import View
from imugui.workers.session import Session

SIZES = (QSize(940, 566), QSize(1196, 686))
CONTROLS = (QAbstractButton, QComboBox, QAbstractSpinBox, QLineEdit)


@pytest.fixture(params=VIEWS)
def view(request: pytest.FixtureRequest, session: Session, settings_store: SettingsStore, shown: Any) -> Iterator[View]:
    yield shown(VIEWS[request.param](session, settings_store))


def colours(image: QImage) -> set[int]:
    """Every 16th pixel of a picture."""
    return {image.pixel(x, y) for x in range(0, image.width(), 4) for y in range(0, image.height(), 4)}


def controls(widget: QWidget) -> list[QWidget]:
    """What a person can press or change, without the inner parts of Qt's own widgets."""
    found = [child for child in widget.findChildren(QWidget) if isinstance(child, CONTROLS)]
    return [one for one in found if not isinstance(one.parent(), CONTROLS)]


def test_pages_have_a_name_an_icon_and_a_tip() -> None:
    for page in VIEWS.values():
        assert page.title
        assert page.tip
        assert (paths.resources() / "icons" / f"{page.icon}.svg").is_file()
    assert len({page.title for page in VIEWS.values()}) == len(VIEWS)


def test_the_table_of_pages_says_what_the_pages_say() -> None:
    for name, page in PAGES.items():
        view = VIEWS[name]
        assert (page.title, page.icon, page.tip, page.at_foot) == (view.title, view.icon, view.tip, view.at_foot)


def test_the_live_page_is_first() -> None:
    assert next(iter(VIEWS)) == "live"


def test_refresh_without_data(view: View) -> None:
    view.refresh()
    view.slow_refresh()
    assert len(colours(view.grab().toImage())) > 3


def test_refresh_with_data(view: View, push_attitude: Callable[..., Any]) -> None:
    push_attitude()
    view.slow_refresh()
    view.refresh()
    assert len(colours(view.grab().toImage())) > 3


@pytest.mark.parametrize("size", SIZES)
def test_fits_the_window(view: View, size: QSize) -> None:
    view.resize(size)
    assert view.minimumSizeHint().width() <= size.width()
    assert view.minimumSizeHint().height() <= size.height()


def test_every_control_has_a_name_and_a_tip(view: View) -> None:
    view.slow_refresh()
    nameless = [one for one in controls(view) if not (one.accessibleName() and one.toolTip())]
    assert [f"{type(one).__name__} {one.objectName()}" for one in nameless] == []


def test_follows_the_scheme(view: View, qapp: QApplication) -> None:
    pictures = {}
    for scheme in ("light", "dark"):
        theme.apply(qapp, scheme)
        view.slow_refresh()
        pictures[scheme] = view.grab().toImage()
    assert pictures["light"].pixelColor(3, 3).lightness() > 128 > pictures["dark"].pixelColor(3, 3).lightness()
