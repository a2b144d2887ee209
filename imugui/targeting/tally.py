"""What is counted on the way to one target, row by row, in plain floats."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import hypot, inf, log, nan

from imugui.fusion.scalar import Vector
from imugui.targeting.path_measures import BAND
from imugui.targeting.tasks import Target, Task, matches
from imugui.targeting.trials import UNKNOWN, Trial
from imugui.targeting.view_pose import PAN, ZOOM, View


@dataclass(frozen=True)
class Labels:
    """Whose run this is, as its trials say."""

    study: str = ""
    participant: str = ""
    condition: str = ""
    block: int = 0
    practice: bool = False
    run: int = 0


class FarSide:
    """Counts how often a place went past the far edge of its target."""

    def __init__(self, half: float) -> None:
        self._half = half
        self._beyond = False
        self.count = 0

    def look(self, past: float) -> None:
        """``past``: how far beyond the target's centre, px; it has come back when it is within the edge again."""
        if past > self._half + BAND:
            self.count += not self._beyond
            self._beyond = True
        elif past <= self._half:
            self._beyond = False


class Tally:
    """One target from its appearance at ``t_start`` (s) with the view at ``view``; ``mode`` is steered already."""

    def __init__(self, task: Task, target: Target, view: View, t_start: float, mode: str = "") -> None:
        self.t_start = t_start
        self.times = {PAN: 0.0, ZOOM: 0.0, "": 0.0}  # s
        self.activations = 0
        self.clutches = 0
        self.rotations: list[float] = []  # deg, the largest of each activation that has ended
        self.path_px = 0.0
        self.zoom_path = 0.0
        self._last_mode = mode
        self._low = self._high = UNKNOWN  # deg, about x, y, z
        self._task, self._target, self._sized = task, target, task.sized
        way = target.x - view.x, target.y - view.y
        length = hypot(*way) or inf
        self._way = way[0] / length, way[1] / length
        self._grows = 1.0 if target.size > view.size else -1.0
        self._place, self._size = FarSide(0.5 * task.width(target)), FarSide(task.tolerance_px)

    @property
    def overshoots(self) -> int:
        """How often place or size went past the target."""
        return self._place.count + self._size.count

    @property
    def min_deg(self) -> Vector:
        """The smallest angle about x, y and z since the activation; NaN without one."""
        return self._low

    @property
    def max_deg(self) -> Vector:
        """The largest."""
        return self._high

    def press(self, mode: str) -> None:
        """An activation begins. One more of the same mode is a clutch: the hand had to go back."""
        self.activations += 1
        self.clutches += mode == self._last_mode
        self._last_mode = mode

    def moved(self, before: View, view: View) -> None:
        """The view went from one place to another."""
        target = self._target
        self.path_px += hypot(view.x - before.x, view.y - before.y)
        self._place.look((view.x - target.x) * self._way[0] + (view.y - target.y) * self._way[1])
        if self._sized:
            if view.size != before.size:
                self.zoom_path += abs(log(view.size / before.size)) if min(view.size, before.size) > 0.0 else nan
            self._size.look(self._grows * (view.size - target.size))

    def turned(self, turn: Vector) -> None:
        """The hand is turned by the rotation vector ``turn``, deg, since engaging."""
        (a, b, c), low, high = turn, self._low, self._high
        if low[0] != low[0]:  # NaN: nothing yet
            self._low = self._high = turn
        elif a < low[0] or b < low[1] or c < low[2] or a > high[0] or b > high[1] or c > high[2]:
            self._low = min(a, low[0]), min(b, low[1]), min(c, low[2])
            self._high = max(a, high[0]), max(b, high[1]), max(c, high[2])

    def trial(self, labels: Labels, index: int, start: View | Target, view: View, t_end: float) -> Trial:
        """The target as a row: ``start`` is the one before, ``view`` where this one was selected at t_end in s."""
        task, target, time = self._task, self._target, t_end - self.t_start
        sizes = (start.size, target.size, view.size) if task.sized else (nan, nan, nan)
        return Trial(
            **asdict(labels),
            index=index,
            task=task.kind,
            selection=task.selection_word,
            from_x=start.x,
            from_y=start.y,
            from_size=sizes[0],
            to_x=target.x,
            to_y=target.y,
            to_size=sizes[1],
            tolerance_px=task.tolerance_px if task.sized else nan,
            width_px=nan if task.sized else target.size,
            amplitude_px=target.amplitude,
            sel_x=view.x,
            sel_y=view.y,
            sel_size=sizes[2],
            t_start=self.t_start,
            t_end=t_end,
            movement_time_s=time,
            pan_time_s=self.times[PAN],
            zoom_time_s=self.times[ZOOM],
            idle_time_s=self.times[""],
            activations=self.activations,
            clutches=self.clutches,
            overshoots=self.overshoots,
            path_px=self.path_px,
            zoom_path=self.zoom_path if task.sized else nan,
            min_deg=self.min_deg,
            max_deg=self.max_deg,
            max_rotation_deg=tuple(self.rotations),
            error=not all(matches(task, target, view)),
        )
