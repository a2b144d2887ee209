"""Pages at work: what a page does in earnest, so that not its empty state is measured."""

from __future__ import annotations

from collections.abc import Callable

from imugui.guidance.plan import Plan
from imugui.guidance.registration import from_origin
from imugui.targeting.view_pose import PAN
from imugui.views.calibrate_view import CalibrateView
from imugui.views.guide_view import GuideView
from imugui.views.main_window import MainWindow
from imugui.views.target_view import TargetView
from imugui.workers.session import Session


def calibrate(page: CalibrateView) -> None:
    """Points are collected on the sphere of the magnetometer."""
    page.begin("mag")


def guide(page: GuideView) -> None:
    """The target is in front, the cross moves with the board."""
    page.desk.set_plans([Plan("Ahead", "plain", "")])
    attitude = page.session.attitude
    page.desk.register(from_origin(attitude.last(1)["quat"], rows=((attitude.count - 1, attitude.count),)))
    page.go("aim")


def target(page: TargetView) -> None:
    """A run of the game, steered by the board."""
    page.start()
    page.desk.press(PAN)


WORK: dict[str, Callable[..., None]] = {"calibrate": calibrate, "guide": guide, "target": target}


def put_to_work(window: MainWindow, session: Session, name: str) -> None:
    """Open a page and have it do what it is for, with the board that is connected."""
    window.show_page(name)
    if name in WORK and session.attitude.count:
        WORK[name](window.page())
