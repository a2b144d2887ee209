"""What is to be hit: the settings of a task, and its list of targets from a seed.

Every list of the game has the same bits of pan and the same bits of zoom, whatever the seed: only their order and the
directions differ. So conditions may be given the same list or different ones and stay equally difficult.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from imugui.fields import field as editable
from imugui.targeting.design import laid, shuffled
from imugui.targeting.throughput import chord, pan_difficulty, ring, zoom_difficulty
from imugui.targeting.view_pose import FIELD_PX, View

FOV, RING = "fov", "ring"
AUTO, BUTTON, DWELL = "auto", "button", "dwell"
ATTEMPTS, WAYS = 200, 30
"""Draws of a list, and of a direction, before the ranges are said not to fit into the field."""
HALVINGS = 60


class Target(NamedTuple):
    """One target: its centre, and the side of its square (game) or its diameter (ring), px.

    ``start``: selecting it only starts the clock of a sequence. ``amplitude`` is the nominal way to it.
    """

    x: float
    y: float
    size: float
    amplitude: float = math.nan
    start: bool = False
    sequence: int = 0


@dataclass(frozen=True)
class Task:
    """What a run asks for; lengths in px of the 600 px field."""

    kind: str = editable(
        FOV, "Task", choices=(FOV, RING),
        tip="fov: match place and size of a square, as in seed 004. ring: jump across a ring (ISO 9241-411).",
    )  # fmt: skip
    selection: str = editable(
        AUTO, "Selection", choices=(AUTO, BUTTON, DWELL),
        tip="auto: as soon as it matches, no error is possible. button: you say when. dwell: after it has matched.",
    )  # fmt: skip
    dwell_s: float = editable(0.5, "Dwell", unit="s", low=0.05, high=5.0, step=0.05, tip="How long it must match.")
    targets: int = editable(5, "Targets in a run", low=1, high=100, step=1, tip="Of the game.")
    tolerance_px: float = editable(
        9.0, "Tolerance", unit="px", low=0.5, high=100.0, step=0.5,
        tip="Of the game: how far place (x and y) and size may be off. The field is 600 px wide.",
    )  # fmt: skip
    pan_low_px: float = editable(
        90.0, "Shortest pan", unit="px", low=1.0, high=600.0, step=10.0, tip="From target to target."
    )  # fmt: skip
    pan_high_px: float = editable(
        250.0, "Longest pan", unit="px", low=1.0, high=600.0, step=10.0, tip="From target to target."
    )  # fmt: skip
    zoom_low: float = editable(
        1.25, "Smallest zoom", unit="times", low=1.01, high=10.0, step=0.05,
        tip="The next target is about so many times larger or smaller.",
    )  # fmt: skip
    zoom_high: float = editable(1.8, "Largest zoom", unit="times", low=1.01, high=10.0, step=0.05)
    size_low_px: float = editable(60.0, "Smallest target", unit="px", low=10.0, high=600.0, step=5.0)
    size_high_px: float = editable(240.0, "Largest target", unit="px", low=10.0, high=600.0, step=5.0)
    ring_targets: int = editable(
        11, "Targets on the ring", low=3, high=25, step=2, tip="An odd number: then all jumps are equally long."
    )  # fmt: skip
    ring_levels: int = editable(
        2, "Distances and widths", low=1, high=3, step=1, tip="So many of each; every pair is a sequence."
    )  # fmt: skip
    amplitude_low_px: float = editable(200.0, "Shortest jump", unit="px", low=10.0, high=560.0, step=10.0)
    amplitude_high_px: float = editable(400.0, "Longest jump", unit="px", low=10.0, high=560.0, step=10.0)
    width_low_px: float = editable(30.0, "Smallest width", unit="px", low=2.0, high=200.0, step=5.0)
    width_high_px: float = editable(60.0, "Largest width", unit="px", low=2.0, high=200.0, step=5.0)

    @property
    def start_view(self) -> View:
        """Where the view stands before a run: the middle of the field, and of the sizes."""
        return View(0.0, 0.0, math.sqrt(self.size_low_px * self.size_high_px))

    @property
    def sized(self) -> bool:
        """Whether the size must match too."""
        return self.kind == FOV

    @property
    def selection_word(self) -> str:
        """The selection as trials name it."""
        return "first-entry" if self.kind == RING and self.selection == AUTO else self.selection

    def width(self, target: Target) -> float:
        """What is accepted of the way to a target, px: twice the tolerance, or the diameter."""
        return 2.0 * self.tolerance_px if self.sized else target.size


PRESETS: dict[str, Task] = {
    "thesis": Task(),
    "confirmed by hand": Task(selection=BUTTON, targets=8),
    "ring, button": Task(kind=RING, selection=BUTTON),
    "ring, dwell": Task(kind=RING, selection=DWELL),
    "ring, first entry": Task(kind=RING),
}


def matches(task: Task, target: Target, view: View) -> tuple[bool, bool]:
    """Whether the place of the view matches, and its size; a ring asks for no size."""
    across, up = abs(view.x - target.x), abs(view.y - target.y)
    if not task.sized:
        return math.hypot(across, up) <= 0.5 * target.size, True
    return max(across, up) <= task.tolerance_px, abs(view.size - target.size) <= task.tolerance_px


def target_list(task: Task, seed: int, variant: int = 0) -> tuple[Target, ...]:
    """The targets of a run in their order; ``variant`` mirrors or turns the list (``design.SYMMETRIES``).

    Raises ValueError, with words for the person, when the ranges do not fit into the field.
    """
    targets = _ring_list(task, seed) if task.kind == RING else _game_list(task, seed)
    places = laid([(one.x, one.y) for one in targets], variant).tolist()
    return tuple(one._replace(x=x + 0.0, y=y + 0.0) for one, (x, y) in zip(targets, places, strict=True))


def problems(task: Task) -> list[str]:
    """What is wrong with these settings, one sentence each."""
    try:
        target_list(task, 0)
    except ValueError as error:
        return [str(error)]
    return []


def pan_bits(task: Task) -> tuple[float, ...]:
    """Bits of the pans of a run of the game, from the easiest to the most difficult."""
    low, high = sorted((task.pan_low_px, task.pan_high_px))
    return _ladder(pan_difficulty(low, task.tolerance_px), pan_difficulty(high, task.tolerance_px), task.targets)


def zoom_bits(task: Task) -> tuple[float, ...]:
    """Bits of the zooms of a run of the game, from the easiest to the most difficult.

    Those of growing by the ratios of the task about the middle of its sizes.
    """
    middle, tolerance = task.start_view.size, task.tolerance_px
    low, high = (
        zoom_difficulty(middle / math.sqrt(ratio), middle * math.sqrt(ratio), tolerance)
        for ratio in sorted((task.zoom_low, task.zoom_high))
    )
    return _ladder(low, high, task.targets)


def sequences(task: Task) -> tuple[tuple[float, float], ...]:
    """The amplitudes and widths of a ring task, each with each."""
    far = _ladder(math.log(task.amplitude_low_px), math.log(task.amplitude_high_px), task.ring_levels)
    wide = _ladder(math.log(task.width_low_px), math.log(task.width_high_px), task.ring_levels)
    return tuple((math.exp(a), math.exp(w)) for a in far for w in wide)


def _ring_list(task: Task, seed: int) -> list[Target]:
    """Ring after ring, in an order of chance; each begins with the target that starts its clock."""
    n, pairs = task.ring_targets, sequences(task)
    reach = max(0.5 * a / chord(n, 1.0) + 0.5 * w for a, w in pairs) if n % 2 else 0.0
    if reach > 0.5 * FIELD_PX:
        raise ValueError(f"the ring does not fit into the field: it needs {2.0 * reach:.0f} of {FIELD_PX:.0f} px")
    targets = []
    for number, place in enumerate(shuffled(len(pairs), seed, 1)):
        amplitude, width = pairs[place]
        for k, (x, y) in enumerate(ring(n, amplitude / chord(n, 1.0)).tolist()):
            targets.append(Target(x, y, width, math.nan if k == 0 else amplitude, k == 0, number))
    return targets


def _game_list(task: Task, seed: int) -> list[Target]:
    """The first list that fits into the field, of those that the seed draws."""
    random = np.random.default_rng((seed, 0))
    for _ in range(ATTEMPTS):
        targets = _draw(task, random)
        if len(targets) == task.targets:
            return targets
    raise ValueError("no targets with these distances and sizes fit into the field: make pans or zooms smaller")


def _draw(task: Task, random: np.random.Generator) -> list[Target]:
    """A list in which every step has its own difficulty; cut short where no step that is left fits into the field."""
    pans, zooms = (random.permutation(bits).tolist() for bits in (pan_bits(task), zoom_bits(task)))
    (x, y, size), targets = task.start_view, []
    while pans:
        pan = next(((bits, found) for bits in pans if (found := _moved(task, x, y, bits, random))), None)
        zoom = next(((bits, resized) for bits in zooms if (resized := _resized(task, size, bits, random))), None)
        if pan is None or zoom is None:
            break
        pans.remove(pan[0])
        zooms.remove(zoom[0])
        x, y, distance = pan[1]
        size = zoom[1]
        targets.append(Target(x, y, size, distance))
    return targets


def _moved(
    task: Task, x: float, y: float, bits: float, random: np.random.Generator
) -> tuple[float, float, float] | None:
    """A place inside the field that is a pan of so many bits away, and the way to it; None without one."""
    reach = 0.5 * (FIELD_PX - max(task.size_low_px, task.size_high_px))
    distance = 2.0 * task.tolerance_px * (2.0**bits - 1.0)
    for way in random.uniform(0.0, 2.0 * math.pi, WAYS).tolist():
        a, b = x + distance * math.cos(way), y + distance * math.sin(way)
        if max(abs(a), abs(b)) <= reach:
            return a, b, distance
    return None


def _resized(task: Task, size: float, bits: float, random: np.random.Generator) -> float:
    """A size within the task's range that is a zoom of so many bits away; 0 without one."""
    low, high = sorted((task.size_low_px, task.size_high_px))
    ends = [end for end in (low, high) if end != size and zoom_difficulty(size, end, task.tolerance_px) >= bits]
    if not ends:
        return 0.0
    near, far = size, ends[int(random.integers(len(ends)))]
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if zoom_difficulty(size, middle, task.tolerance_px) < bits:
            near = middle
        else:
            far = middle
    return far


def _ladder(low: float, high: float, n: int) -> tuple[float, ...]:
    """n values, evenly from the lowest to the highest; the middle for one."""
    return tuple(np.linspace(low, high, n).tolist()) if n > 1 else (0.5 * (low + high),)
