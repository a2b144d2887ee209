"""Make docs/screw-target.md and its picture again: .venv/bin/python docs/seed_rule.py

What seed 001's rule (green when the differences of yaw and of pitch are both below 2 degrees) would have accepted and
refused, against the angle between the tool's axis and the plan.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

from imugui.fusion.attitude import euler, from_euler
from imugui.fusion.quaternion import Floats, from_rotation_vector, multiply, rotate
from imugui.guidance.aiming import aim, aim_many, axis_error, seed001_accepts, words
from imugui.guidance.plan import LOCAL_TO_RAS, Plan, direction, target_basis

DOCS = Path(__file__).resolve().parent
PAGE, PICTURE = DOCS / "screw-target.md", DOCS / "screw-target.svg"
PITCHES = (0, 30, 45, 60, 75, 85, 89)
MOUNTINGS = (0, 1, 5, 10, 30, 90)
SIZE, SCALE = 150, 22.0  # of one target of the picture, and pixels per degree
TEXT = "#1b1b1b"
STATED = """\
## The error that is stated

Beside the aiming error stands the error to expect of it: 9 of 10 readings stay within it. Its parts are the tilt
that the calibration leaves, the registration, the tool's axis in the box, and the heading's error times the sine of
the tool's lean. With imugui's own filter the heading's error is what the filter states, counted from the registration.
All other filters leave drift times age, and a share of all turning. Those count again while VQF has taken over, never
with less than was stated before, and where the gyroscope is calibrated worse than the filter takes it for: without a
magnetometer nothing shows an error of scale about the vertical.

Ten virtual boards with the errors that a good calibration leaves, 30 plans each up to 45°, a trembling hand; degrees:

| filter | registration | mean error | largest | stated, mean | within the stated | registrations of a board |
|---|---|---|---|---|---|---|
| VQF | axes | 0.31 | 0.89 | 0.68 | 98 % | 2.3 |
| VQF | mark | 0.25 | 0.77 | 0.66 | 99.7 % | 2.2 |
| imugui | axes | 0.27 | 0.61 | 0.80 | 100 % | 3.4 |
| imugui | mark | 0.18 | 0.56 | 0.80 | 100 % | 4.6 |

Measured by `python3 run.py bench guided_accuracy --told`: imugui's own filter knows how well the gyroscope is
calibrated (its parameter "at worst"). It errs less here and states more, above all of the tilt of a held tool. Not
told, it allows for an uncalibrated gyroscope, and a tool that is turned much has to be registered often."""


def pointing(yaw_deg: Floats, pitch_deg: Floats) -> Floats:
    """Directions (n, 3) in RAS of the box's x axis at these angles (n,) from the origin."""
    local = rotate(from_euler(np.radians(yaw_deg), np.radians(pitch_deg), 0.0), (1.0, 0.0, 0.0))
    return np.asarray(local @ np.transpose(LOCAL_TO_RAS))


def angles(d: Floats) -> tuple[Floats, Floats]:
    """Yaw and pitch in degrees, (n,) each, of directions (n, 3) in RAS: the inverse of ``pointing``."""
    x, y, z = (d @ np.array(LOCAL_TO_RAS)).T
    return np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(-z, np.hypot(x, y)))


def box(yaw_deg: float, pitch_deg: float, n: int = 100) -> tuple[Floats, Floats]:
    """The edge of what the old rule accepts: yaw and pitch in degrees, (4n,) each; pitch ends at +-90."""
    side = np.linspace(-2.0, 2.0, n)
    one = np.full(n, 2.0)
    yaw = np.concatenate((side, one, side[::-1], -one))
    pitch = np.concatenate((-one, side, one, side[::-1]))
    return yaw_deg + yaw, np.clip(pitch_deg + pitch, -90.0, 90.0)


def disc(p: Floats, n: int = 4000) -> Floats:
    """Directions (n, 3) spread evenly over the circle of 2 degrees about p (3,)."""
    k = np.arange(n) + 0.5
    radius, turn = np.radians(2.0) * np.sqrt(k / n), k * math.pi * (3.0 - math.sqrt(5.0))
    medial, cranial = target_basis(p, "")
    away = np.cos(turn)[:, None] * medial + np.sin(turn)[:, None] * cranial
    return np.asarray(np.cos(radius)[:, None] * p + np.sin(radius)[:, None] * away)


def example() -> list[str]:
    """The seed's own example, on our target."""
    plan = Plan("seed 001", "plain", yaw_deg=45.0, pitch_deg=34.0)
    p = direction(plan)
    seen = aim(pointing(np.array(28.7), np.array(-12.6)), p, target_basis(p, ""))
    right, up = np.degrees(seen.offset)
    return [
        "## The seed's own example",
        "",
        "The screenshot of seed 001 shows yaw 28.7°, pitch -12.6° against a desired 45° and 34°. It states two",
        f"differences, 16.3° and 46.6°. The tool is **{math.degrees(seen.error):.2f}°** off its plan; on our target",
        f"the cross is {right:.2f}° to the right and {up:.2f}° up, and the words are: "
        f"{', '.join(words(seen, '', True))}.",
        "(A positive pitch turns down; with the other sign the picture is the same upside down.)",
    ]


def by_pitch() -> list[str]:
    """How far off the old rule accepts and from where it refuses, for a tool along the box's x axis."""
    lines = [
        "## A tool exactly along the box's x axis",
        "",
        "How far off the plan the old rule still turns green, from which error on it may refuse, and which share of",
        "the aims within 2° of the plan it refuses when the plan's yaw is 0° and when it is 180°, where yaw jumps.",
        "",
        "| planned pitch | green up to | refused from | refused within 2°, yaw 0° | refused within 2°, yaw 180° |",
        "|---|---|---|---|---|",
    ]
    for pitch in PITCHES:
        edge = np.degrees(axis_error(pointing(*box(0.0, pitch)), pointing(np.array(0.0), np.array(float(pitch)))))
        edge = edge[box(0.0, pitch)[1] < 90.0]  # the pole itself has any yaw
        shares = []
        for yaw in (0.0, 180.0):
            plan = pointing(np.array(yaw), np.array(float(pitch)))
            shares.append(f"{100 * (1 - seed001_accepts(*angles(disc(plan)), yaw, pitch).mean()):.0f} %")
        lines.append(f"| {pitch}° | {edge.max():.2f}° | {edge.min():.2f}° | {shares[0]} | {shares[1]} |")
    return lines


def by_mounting() -> list[str]:
    """How far off the old rule accepts when the tool is not the box's x axis and spins."""
    side, roll = np.linspace(-2.0, 2.0, 21), np.arange(0.0, 361.0, 2.0)
    quats = from_euler(*np.radians(np.meshgrid(side, side, roll)))
    lines = [
        "## A tool that spins",
        "",
        "The rule looks at the box's x axis only. When the tool's axis is at an angle to it, a spin of the tool moves",
        "yaw and pitch without changing where the tool points, and a roll of the box moves the tool while yaw and",
        "pitch stand still. How far off the plan the old rule still turns green (plan: yaw 0°, pitch 0°):",
        "",
        "| from box x axis to tool | green up to |",
        "|---|---|",
    ]
    for mounting in MOUNTINGS:
        axis = np.array((math.cos(math.radians(mounting)), 0.0, math.sin(math.radians(mounting))))
        lines.append(f"| {mounting}° | {np.degrees(axis_error(rotate(quats, axis), axis)).max():.2f}° |")
    return [*lines, "", *spin()]


def spin() -> list[str]:
    """A tool along z, spun by a quarter turn."""
    start = from_euler(*np.radians((0.0, 20.0, 15.0)))
    turned = multiply(start, from_rotation_vector((0.0, 0.0, math.pi / 2)))
    yaw, pitch, roll = np.degrees(euler(turned))
    up = (0.0, 0.0, 1.0)
    error = np.degrees(axis_error(rotate(start, up), rotate(turned, up)))
    return [
        "The other way round: a tool along the box's z axis at yaw 0°, pitch 20°, roll 15° is spun by 90° about",
        f"itself. Its angles become {yaw:.2f}°, {pitch:.2f}° and {roll:.2f}°, so the old rule refuses: it sees",
        f"{yaw:.1f}° and {abs(pitch - 20.0):.1f}°. The aiming error is {abs(error):.2f}°.",
    ]


def picture() -> str:
    """What is green: the circle of 2 degrees, and the old rule's area at four pitches, as SVG."""
    shown = (0, 45, 75, 85)
    width = SIZE * len(shown)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {SIZE + 24}" font-family="sans-serif" '
        f'font-size="12" fill="{TEXT}"><rect width="{width}" height="{SIZE + 24}" fill="#ffffff"/>'
    ]
    for number, pitch in enumerate(shown):
        p = pointing(np.array(0.0), np.array(float(pitch)))
        offsets = np.degrees(aim_many(pointing(*box(0.0, pitch)), p, target_basis(p, ""))[1])
        x, y = SIZE * (number + 0.5), SIZE / 2
        points = " ".join(f"{x + SCALE * a:.1f},{y - SCALE * b:.1f}" for a, b in offsets)
        parts += [
            f'<circle cx="{x}" cy="{y}" r="{2 * SCALE}" fill="#009e73" fill-opacity="0.25" stroke="#009e73"/>',
            f'<polygon points="{points}" fill="none" stroke="#d55e00" stroke-width="2" stroke-dasharray="5 3"/>',
            f'<text x="{x}" y="{SIZE + 12}" text-anchor="middle">pitch {pitch}°</text>',
        ]
    return "\n".join([*parts, "</svg>", ""])


def page() -> str:
    """docs/screw-target.md."""
    lines = [
        "# What the old rule would have accepted",
        "",
        "Seed 001 aimed a screwdriver with two differences: desired yaw minus yaw, desired pitch minus pitch, green",
        "when both are below 2°. imugui takes the angle between the tool's axis and the plan, and draws the log map at",
        "the plan, so that every ring is true degrees. Below is the same tool seen by both rules; all figures are",
        "geometry, without a sensor.",
        "",
        *example(),
        "",
        *by_pitch(),
        "",
        "![What is green at four pitches: a circle of 2 degrees, and the shape of the old rule](screw-target.svg)",
        "",
        "Filled circle: within 2° of the plan. Dashed: green by the old rule. Each target is as imugui draws it.",
        "",
        *by_mounting(),
        "",
        *STATED.splitlines(),
        "",
        "Made by `.venv/bin/python docs/seed_rule.py`.",
        "",
    ]
    return "\n".join(lines)


def main() -> int:
    PAGE.write_text(page(), encoding="utf-8")
    PICTURE.write_text(picture(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
