"""The polar target, by pixels: cross, circle, colours and hatching, in both themes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QSize, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.fusion.attitude import from_euler
from imugui.fusion.quaternion import from_matrix, multiply, rotate
from imugui.guidance.aiming import Aim, aim
from imugui.guidance.aiming import words as aim_words
from imugui.guidance.look import Look
from imugui.guidance.plan import LOCAL_TO_RAS, Plan, direction, target_basis
from imugui.views import theme
from imugui.views.polar_scale import STEPS, PolarScale
from imugui.views.polar_target import PolarTarget
from imugui.views.polar_words import STATES, side_notes, sides

LEFT = Plan("L4", "projected", "left", 12.0, -5.0)
RIGHT = replace(LEFT, side="right")
SIZE = QSize(640, 560)


@pytest.fixture(params=("light", "dark"))
def scheme(request: pytest.FixtureRequest, qapp: QApplication) -> Iterator[str]:
    theme.apply(qapp, request.param)
    yield request.param
    theme.apply(qapp, "light")


@pytest.fixture
def target(qtbot: QtBot, scheme: str) -> PolarTarget:
    widget = PolarTarget()
    qtbot.addWidget(widget)
    widget.resize(SIZE)
    widget.show_plan(LEFT)
    return widget


def look(colour: str, medial_deg: float, cranial_deg: float, **values: Any) -> Look:
    offset = (math.radians(medial_deg), math.radians(cranial_deg))
    seen = Aim(math.hypot(*offset), offset)
    given = {"plan": LEFT, "aim": seen, "aim_words": aim_words(seen, "left"), "age_ms": 5.0} | values
    return Look(colour=colour, **given)


def near(image: QImage, place: QPointF, colour: QColor, reach: int = 19) -> list[tuple[int, int]]:
    """Pixels of about this colour, relative to a place."""
    goal = colour.getRgb()[:3]
    x0, y0 = round(place.x() - 0.5), round(place.y() - 0.5)
    found = []
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            parts = image.pixelColor(x0 + dx, y0 + dy).getRgb()[:3]
            if max(abs(part - want) for part, want in zip(parts, goal, strict=True)) < 30:
                found.append((dx, dy))
    return found


def picture(target: PolarTarget) -> QImage:
    return target.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)


def middle(spots: list[tuple[int, int]]) -> tuple[float, float]:
    return tuple(float(value) for value in np.mean(spots, axis=0))


@pytest.mark.parametrize(("medial_deg", "cranial_deg"), [(10.0, -5.0), (-18.0, 3.0), (0.5, 14.0)])
def test_the_cross_is_drawn_at_the_true_angle(target: PolarTarget, medial_deg: float, cranial_deg: float) -> None:
    target.show_look(look("red", medial_deg, cranial_deg), glide=False)
    assert target.scale.range_deg == 30.0
    per_degree = target.radius() / 30.0
    expected = target.centre() + QPointF(medial_deg, -cranial_deg) * per_degree
    spots = near(picture(target), expected, theme.palette().bad)
    assert len(spots) > 60
    assert middle(spots) == pytest.approx((0.0, 0.0), abs=1.0)


def test_right_of_the_dial_is_the_patients_right(target: PolarTarget) -> None:
    assert (sides(LEFT), sides(RIGHT)) == (
        ("cranial", "medial", "caudal", "lateral"),
        ("cranial", "lateral", "caudal", "medial"),
    )
    assert side_notes(LEFT) == side_notes(RIGHT) == ("patient's right", "patient's left")
    target.show_look(look("red", 10.0, 0.0), glide=False)
    medial_left = target.cross()
    target.show_plan(RIGHT)
    target.show_look(look("red", 10.0, 0.0, plan=RIGHT), glide=False)
    medial_right = target.cross()
    assert medial_left is not None and medial_right is not None
    assert medial_left.x() - target.centre().x() == pytest.approx(target.centre().x() - medial_right.x())
    assert medial_left.x() > target.centre().x()


def test_seed_001s_example_is_drawn_where_geometry_says(target: PolarTarget) -> None:
    plan = Plan("seed", "plain", "", yaw_deg=45.0, pitch_deg=34.0)
    tool = rotate(multiply(from_matrix(LOCAL_TO_RAS), from_euler(*np.radians((28.7, -12.6, 0.0)))), (1.0, 0.0, 0.0))
    way = direction(plan)
    seen = aim(tool, way, target_basis(way, ""))
    # the spherical triangle with the pole: positive yaw is to the left, positive pitch is down
    level, height, wanted = math.radians(28.7 - 45.0), math.radians(12.6), math.radians(-34.0)
    cosine = math.sin(wanted) * math.sin(height) + math.cos(wanted) * math.cos(height) * math.cos(level)
    east = -math.cos(height) * math.sin(level)
    north = math.cos(wanted) * math.sin(height) - math.sin(wanted) * math.cos(height) * math.cos(level)
    error_deg, bearing = math.degrees(math.acos(cosine)), math.atan2(east, north)
    target.show_plan(plan)
    target.show_look(look("red", 0.0, 0.0, plan=plan, aim=seen), glide=False)
    expected = QPointF(math.sin(bearing), -math.cos(bearing)) * (error_deg * target.radius() / target.scale.range_deg)
    cross = target.cross()
    assert cross is not None
    assert cross.x() == pytest.approx((target.centre() + expected).x(), abs=1e-6)
    assert cross.y() == pytest.approx((target.centre() + expected).y(), abs=1e-6)


def test_the_plan_is_a_circle_in_the_middle(target: PolarTarget) -> None:
    target.show_look(look("red", 20.0, 0.0), glide=False)
    spots = near(picture(target), target.centre(), theme.palette().ghost)
    assert len(spots) > 80
    assert middle(spots) == pytest.approx((0.0, 0.0), abs=0.6)
    assert all(8.0 < math.hypot(*spot) < 14.0 for spot in spots)


@pytest.mark.parametrize("state", ["green", "amber", "red"])
def test_colour_shape_and_word_change_together(target: PolarTarget, state: str) -> None:
    target.show_look(look(state, 2.6, 0.0), glide=False)
    tone, word = STATES[state]
    cross = target.cross()
    assert cross is not None
    colour = theme.tone_colour(tone)
    image = picture(target)
    spots = set(near(image, cross, colour))
    upright, slanted = (11, 0) in spots, (8, 8) in spots
    assert (upright, slanted) == ((False, True) if state == "red" else (True, False))
    ring = [spot for spot in spots if 17.0 < math.hypot(*spot) < 19.5]
    assert (len(ring) > 60) == (state == "green")
    assert near(image, QPointF(26.0, 24.0), colour, 14), "the word is in the same colour"
    assert target.spoken().startswith(word)
    assert len({STATES[one] for one in STATES}) == len(STATES)


def test_what_is_not_trusted_is_hatched_and_says_why(target: PolarTarget) -> None:
    target.show_look(look("amber", 3.0, 2.0), glide=False)
    before = picture(target)
    reason = "The heading has aged: register again."
    target.show_look(look("hatched", 3.0, 2.0, reasons=(reason,)), glide=False)
    image = picture(target)
    assert target.spoken() == f"Not trusted. {reason}"
    cross = target.cross()
    assert cross is not None
    for tone in ("good", "warn", "bad"):
        assert not near(image, cross, theme.tone_colour(tone)), tone
    assert near(image, cross, theme.palette().muted)
    free = target.centre() + QPointF(-0.6, 0.6) * (0.8 * target.radius())
    assert flips(image, free) >= 4 > flips(before, free)


def flips(image: QImage, place: QPointF) -> int:
    """How often light and dark change over 60 pixels to the right of a place."""
    row = [image.pixelColor(int(place.x()) + dx, int(place.y())).lightness() for dx in range(60)]
    jumps = np.abs(np.diff(row)) > 12
    return int(jumps.sum())


def test_old_data_blank_the_cross_and_the_numbers(target: PolarTarget) -> None:
    target.show_look(look("green", 1.0, 0.0), glide=False)
    place = target.cross()
    assert place is not None
    gone = Look("blank", LEFT, age_ms=340.0, reasons=("The newest sample is 340 ms old.",))
    target.show_look(gone, glide=False)
    assert target.cross() is None
    image = picture(target)
    assert not near(image, place, theme.palette().good)
    assert target.spoken() == "No fresh data. The newest sample is 340 ms old."


def test_exactly_backwards_has_no_cross_and_says_so(target: PolarTarget) -> None:
    seen = Aim(math.pi, (math.nan, math.nan), backwards=True)
    target.show_look(look("red", 0.0, 0.0, aim=seen, aim_words=aim_words(seen, "left")), glide=False)
    assert target.cross() is None
    assert "backwards" in target.spoken()
    assert target.scale.range_deg == 180.0
    assert not picture(target).isNull()


@pytest.mark.parametrize("share", [0.25, 0.5, 1.0])
def test_the_hold_is_an_arc_that_closes(target: PolarTarget, share: float) -> None:
    target.show_look(look("green", 0.2, 0.1, hold_progress=share, armed=share == 1.0), glide=False)
    image = picture(target)
    radius = target.radius() * 2.0 / target.scale.range_deg
    covered = 0
    for step in range(360):
        turn = math.radians(step + 0.5)
        outside = QPointF(math.sin(turn), -math.cos(turn)) * (radius + 2.5)
        covered += bool(near(image, target.centre() + outside, theme.palette().good, 0))
    assert covered / 360.0 == pytest.approx(share, abs=0.03)
    assert ("Ready" in target.spoken()) == (share == 1.0)


def test_the_trail_and_the_arrow_are_painted(target: PolarTarget) -> None:
    plain = look("red", 15.0, 0.0)
    target.show_look(plain, glide=False)
    before = picture(target)
    per_degree = target.radius() / target.scale.range_deg
    trail = np.radians(np.stack((np.linspace(25.0, 15.0, 40), np.full(40, 5.0)), axis=1))
    target.show_look(replace(plain, trail=trail, arrow=(-1.0, 0.0)), glide=False)
    after = picture(target)
    on_trail = target.centre() + QPointF(17.0, -5.0) * per_degree
    on_arrow = target.centre() + QPointF(15.0, 0.0) * per_degree - QPointF(40.0, 0.0)
    for place in (on_trail, on_arrow):
        spot = (round(place.x()), round(place.y()))
        assert before.pixelColor(*spot) != after.pixelColor(*spot)


def test_the_scale_zooms_in_steps_and_does_not_flicker(qapp: QApplication) -> None:
    scale = PolarScale()
    seen = []
    for error_deg in (120.0, 50.0, 30.0, 15.0, 5.0, 3.0, 1.0):
        scale.follow(error_deg, 2.0, glide=False)
        assert error_deg < scale.range_deg
        seen.append(scale.range_deg)
    assert seen == sorted(seen, reverse=True)
    assert len(set(seen)) == len(STEPS)
    before = []
    for error_deg in (4.0, 4.4, 5.0, 4.4, 4.0, 5.6, 4.1):
        scale.follow(error_deg, 2.0, glide=False)
        before.append(scale.range_deg)
    assert set(before) == {6.0}
    scale.follow(5.9, 2.0, glide=False)
    assert scale.range_deg == 12.0
    scale.follow(4.5, 2.0, glide=False)
    assert scale.range_deg == 12.0, "it zooms in again only well inside"
    scale.follow(math.nan, 2.0, glide=False)
    assert scale.range_deg == 12.0
    scale.follow(0.0, 10.0, glide=False)
    assert scale.range_deg >= 15.0, "the tolerance always has room"


def test_the_scale_glides_to_its_step(qapp: QApplication) -> None:
    scale = PolarScale()
    reached = []
    for _ in range(40):
        scale.follow(1.0, 2.0)
        reached.append(scale.range_deg)
    assert reached[0] > 50.0
    assert all(a >= b for a, b in itertools.pairwise(reached))
    assert reached[-1] == scale.goal_deg == 6.0
    assert not scale.gliding


def test_a_drag_moves_the_tool_as_far_as_the_mouse(
    target: PolarTarget, qtbot: QtBot, shown: Callable[[Any], Any]
) -> None:
    shown(target)
    target.show_look(look("amber", 3.0, 0.0), glide=False)
    moves: list[tuple[float, float]] = []
    target.tool_turned.connect(lambda right, up: moves.append((right, up)))
    start = QPoint(200, 200)
    for hand in (False, True):
        target.set_hand_mode(hand)
        qtbot.mousePress(target, Qt.MouseButton.LeftButton, pos=start)
        qtbot.mouseMove(target, start + QPoint(30, -20))
        qtbot.mouseRelease(target, Qt.MouseButton.LeftButton, pos=start)
        assert bool(moves) == hand
    total = np.degrees(np.sum(moves, axis=0)) * target.radius() / target.scale.range_deg
    assert total == pytest.approx((30.0, 20.0))


def test_keys_turn_the_tool_and_take_the_reading(
    target: PolarTarget, qtbot: QtBot, shown: Callable[[Any], Any]
) -> None:
    shown(target)
    target.show_look(look("amber", 3.0, 0.0), glide=False)
    moves: list[tuple[float, float]] = []
    taken: list[bool] = []
    target.tool_turned.connect(lambda right, up: moves.append((right, up)))
    target.taken.connect(lambda: taken.append(True))
    qtbot.keyClick(target, Qt.Key.Key_Space)
    assert taken == [True]
    qtbot.keyClick(target, Qt.Key.Key_Left)
    assert moves == []
    target.set_hand_mode(True)
    for key in (Qt.Key.Key_Left, Qt.Key.Key_Up, Qt.Key.Key_Right, Qt.Key.Key_Down):
        qtbot.keyClick(target, key)
    assert [tuple(np.sign(move)) for move in moves] == [(-1, 0), (0, 1), (1, 0), (0, -1)]
    assert {round(math.degrees(abs(sum(move))), 6) for move in moves} == {round(6.0 / 40.0, 6)}


@pytest.mark.parametrize("size", [QSize(1, 1), QSize(60, 400), QSize(1200, 90)])
def test_paints_at_any_size(target: PolarTarget, size: QSize) -> None:
    target.setMinimumSize(1, 1)
    target.resize(size)
    for colour in STATES:
        target.show_look(look(colour, 3.0, 2.0, reasons=("Why.",)), glide=False)
        assert target.grab().toImage().size() == size
    target.show_plan(None)
    target.show_look(None)
    assert target.grab().toImage().size() == size
