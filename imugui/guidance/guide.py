"""Guide: from attitudes, a plan and a registration to what a person sees, and to the readings that are taken.

It has no window and no thread: the page, the tests and the demo share it. What takes trust away counts for
``capture`` at once, what gives it from the next ``step`` on.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from imugui import __version__
from imugui.calibration.profile import now_utc
from imugui.fusion.quaternion import Floats
from imugui.guidance.aiming import axis_error
from imugui.guidance.facts import Facts
from imugui.guidance.hold import HOLD_S, STEADY, Hold
from imugui.guidance.look import Look, looked
from imugui.guidance.plan import Plan, identity, list_problems
from imugui.guidance.progress import Progress
from imugui.guidance.reading import LONGEST_TEXT, Reading, Vector, mean_direction
from imugui.guidance.registration import Registration
from imugui.guidance.session_file import Kept
from imugui.guidance.sigma import seconds_left
from imugui.guidance.stream import Stream
from imugui.guidance.target import Target, from_vertical, target_of
from imugui.guidance.trust import LIMITS, Limits, Trust, judge
from imugui.samples import Rows

TRAIL_S = 1.5
TRAIL_POINTS = 60
NO_PLAN = "There is no plan. Enter a trajectory, or read a file of them."
CHANGED = "Filter, magnetometer or calibration were changed since the registration. Register again."


class Guide:
    """The engine of the screw target: see ``step`` and ``capture``. ``look`` is the newest picture."""

    def __init__(self, limits: Limits = LIMITS) -> None:
        self.limits = limits
        self.plans: tuple[Plan, ...] = ()
        self.index = -1
        self.registration: Registration | None = None
        self.old_registration: Registration | None = None  # of an earlier run: a record, no zero
        self.tool_axis: Vector = (1.0, 0.0, 0.0)
        self.tool_axis_quality_deg = 0.0
        self.confirmed_side = ""
        self.readings: list[Reading] = []
        self.look = Look()
        self.progress = Progress()
        self._registered_at = math.nan
        self._basis: tuple[str, bool, str] | None = None  # filter, magnetometer and profile it was registered with
        self._target: Target | None = None
        self._problem = NO_PLAN
        self._hold = Hold()
        self._stream = Stream(self.tool_axis)
        self._facts = Facts()

    @property
    def plan(self) -> Plan | None:
        """The plan in use."""
        return self.plans[self.index] if 0 <= self.index < len(self.plans) else None

    @property
    def kept(self) -> Kept:
        """What the session file keeps."""
        registration = self.registration or self.old_registration
        return Kept(self.plans, registration, self.tool_axis, self.tool_axis_quality_deg, tuple(self.readings))

    def restore(self, kept: Kept) -> None:
        """Go on with what was kept; the registration is a record only, because its heading ended with its stream."""
        self.set_tool_axis(kept.tool_axis, kept.tool_axis_quality_deg)
        self.clear_registration()
        self.old_registration, self.readings = kept.registration, list(kept.readings)
        self.set_plans(kept.plans)

    def set_plans(self, plans: Sequence[Plan]) -> None:
        """Take a list of plans; the one in use stays in use as long as its name and side are there."""
        old = self.plan
        self.plans = tuple(plans)
        names = [identity(plan) for plan in self.plans]
        place = names.index(identity(old)) if old is not None and identity(old) in names else 0
        self._aim_at(place if self.plans else -1, old)

    def select(self, index: int) -> None:
        """Use the plan of this number; IndexError when there is none."""
        if not 0 <= index < len(self.plans):
            raise IndexError(f"there is no plan number {index}")
        self._aim_at(index, self.plan)

    def _aim_at(self, index: int, old: Plan | None) -> None:
        self.index = index
        plan, self._target, self._problem = self.plan, None, NO_PLAN
        if plan is not None:
            self._problem = " ".join(list_problems(self.plans)[index].values())
            self._target = None if self._problem else target_of(plan, self.tool_axis)
        if plan is None or plan != old:
            self._hold.reset()
            self.progress = Progress()

    def confirm_side(self, side: str) -> None:
        """The person has looked at the patient and says which side it is: "left" or "right"; "" takes it back."""
        self.confirmed_side = side

    def set_tool_axis(self, axis: ArrayLike, quality_deg: float = 0.0) -> None:
        """Where the tool points, (3,) in the box's axes, and how well that is known; a new axis ends the registration.

        ValueError: not a direction.
        """
        size = float(np.linalg.norm(axis))
        if not 1e-9 < size < math.inf:
            raise ValueError("The tool's axis has no direction.")
        x, y, z = (np.asarray(axis, float) / size).tolist()
        self.tool_axis_quality_deg = quality_deg
        if (x, y, z) != self.tool_axis:
            self.tool_axis = (x, y, z)
            self._stream.set_tool_axis(self.tool_axis)
            self.clear_registration()
            self._aim_at(self.index, None)

    def register(self, registration: Registration) -> None:
        """Say where the patient lies, measured just now."""
        self.registration, self.old_registration = registration, None
        self._registered_at, self._basis = self._facts.now, None
        self._stream.mark()
        self._hold.reset()

    def clear_registration(self) -> None:
        """There is no zero any more."""
        self.registration = self.old_registration = None
        self._hold.reset()

    def recent(self, seconds: float) -> Rows:
        """ATTITUDE rows of the last so many seconds (at most 2), unbroken: for registering with a held tool."""
        return self._stream.recent(seconds)

    def recent_numbers(self, seconds: float) -> tuple[int, int]:
        """First and last attitude number of ``recent``; (0, -1) when it is empty."""
        count, end = len(self.recent(seconds)), self._stream.first + len(self._stream.rows)
        return (end - count, end - 1) if count else (0, -1)

    def step(self, rows: Rows, first_number: int, facts: Facts) -> Look:
        """Take the ATTITUDE rows (n,) that are new, the first having this number, and say what is to be seen now.

        Call it often, also without rows: only so does the target leave green in time when the stream stands still.
        """
        fresh, broken = self._stream.push(rows, first_number)
        if broken:
            self._hold.reset()
        self._facts = facts
        if self.registration is not None and self._basis is None:
            self._basis = _basis(facts)
            # registered before the first step: its time is now
            self._registered_at = facts.now if math.isnan(self._registered_at) else self._registered_at
        filled = self._filled(facts.now)
        trust = judge(filled, self.limits)
        self._follow(fresh, trust.ok)
        self.look = self._look(filled, trust)
        return self.look

    def capture(self, now: float) -> Reading | str:
        """Take a reading of the hold that has just been; a sentence says why not. ``now``: host monotonic time, s."""
        filled = self._filled(now)
        trust = judge(filled, self.limits)
        target, registration = self._target, self.registration
        if not trust.ok or target is None or registration is None:
            self._hold.reset()
            return trust.reasons[0]
        if not self._hold.armed:
            return (
                f"Hold the tool within {target.plan.tolerance_deg:g}° of the plan and slower than "
                f"{math.degrees(STEADY):g}°/s for {HOLD_S:g} s first."
            )
        reading = self._read(target, registration, trust)
        self.readings.append(reading)
        self._hold.reset()
        return reading

    def discard(self, number: int) -> None:
        """Take the reading of this number out of the list."""
        self.readings = [reading for reading in self.readings if reading.number != number]

    def _read(self, target: Target, registration: Registration, trust: Trust) -> Reading:
        rows, facts, progress = self._stream.recent(HOLD_S), self._facts, self.progress
        way = mean_direction(registration, rows["quat"], self.tool_axis)
        earth = np.asarray(registration.matrix) @ way
        aim = target.seen(earth, rows["quat"][-1], registration)
        x, y, z = way.tolist()
        px, py, pz = target.way.tolist()
        return Reading(
            number=1 + max((reading.number for reading in self.readings), default=0),
            plan=target.plan,
            direction=(x, y, z),
            plan_direction=(px, py, pz),
            error_deg=math.degrees(float(axis_error(way, target.way))),
            medial_deg=math.degrees(aim.offset[0]),
            cranial_deg=math.degrees(aim.offset[1]),
            sigma_deg=math.degrees(trust.sigma),
            t=float(rows["t"][-1]),
            rows=self.recent_numbers(HOLD_S),
            registration=registration,
            tool_axis=self.tool_axis,
            twist_deg=math.degrees(aim.twist),
            steadiness_deg_s=math.degrees(float(self._stream.rates(1)[0])),
            heading_age_s=trust.heading_age_s,
            heading_sigma_deg=math.degrees(trust.heading_sigma),
            heading_from=trust.heading_from,
            time_to_green_s=progress.time_to_green,
            time_in_green_s=progress.in_green,
            duration_s=progress.duration,
            overshoots=progress.overshoots,
            profile=facts.profile_words[:LONGEST_TEXT],
            filter=facts.filter,
            use_mag=facts.use_mag,
            relative=facts.relative,
            version=__version__,
            utc=now_utc(),
        )

    def _filled(self, now: float) -> Facts:
        """The facts with what the plan, the registration and the attitudes say."""
        facts, plan = self._stream.fill(replace(self._facts, now=now)), self.plan
        changed = self._basis is not None and self._basis != _basis(facts)
        return replace(
            facts,
            registration=self.registration,
            registered_at=self._registered_at,
            epoch_words=facts.epoch_words or (CHANGED if changed else ""),
            side_confirmed=plan is not None and plan.side in ("", self.confirmed_side),
            plan_problem=self._problem,
            axis_error=math.radians(self.tool_axis_quality_deg),
            tilt_from_vertical=self._lean(facts, self._stream.way) if len(self._stream.rows) else math.nan,
        )

    @staticmethod
    def _lean(facts: Facts, way: Floats) -> float:
        """The angle of a direction (3,) from the vertical, rad; NaN, the worst case, in a frame that has none."""
        return math.nan if facts.relative else from_vertical(way)

    def _follow(self, fresh: int, trusted: bool) -> None:
        """Take the newest rows through hold and progress."""
        target, registration, stream = self._target, self.registration, self._stream
        if not trusted or target is None or registration is None:
            self._hold.reset()
            return
        if fresh == 0:
            return
        ways = stream.directions[-fresh:] @ np.asarray(registration.matrix)
        steps = (stream.rows["t"][-fresh:], axis_error(ways, target.way), stream.rates(fresh))
        for t, error, rate in zip(*(values.tolist() for values in steps), strict=True):
            self._hold.step(t, error <= target.tolerance, rate, trusted)
            self.progress.step(t, error, target.tolerance)

    def _look(self, facts: Facts, trust: Trust) -> Look:
        target, registration, stream = self._target, self.registration, self._stream
        look = Look(plan=self.plan, armed=self._hold.armed, hold_progress=self._hold.progress)
        if target is None or registration is None or len(stream.rows) == 0:
            return looked(look, trust, None)
        # the tool lies anywhere between two aims: how long the registration lasts is asked at the plan
        planned = replace(facts, tilt_from_vertical=self._lean(facts, np.asarray(registration.matrix) @ target.way))
        ways = stream.directions[-len(stream.recent(TRAIL_S)) :]
        look = replace(
            look,
            trail=target.offsets(_thinned(ways), registration),
            rate_deg_s=math.degrees(float(stream.rates(1)[0])),
        )
        seen = target.seen(stream.way, stream.rows["quat"][-1], registration)
        return looked(look, replace(trust, reference_due_s=seconds_left(planned, self.limits.sigma)), seen)


def _thinned(ways: Floats) -> Floats:
    """At most TRAIL_POINTS of n directions, evenly, the newest among them."""
    every = -(-len(ways) // TRAIL_POINTS)
    return ways[(len(ways) - 1) % every :: every]


def _basis(facts: Facts) -> tuple[str, bool, str]:
    """What the heading of a registration stands on."""
    return facts.filter, facts.use_mag, facts.profile_words
