"""Scope: an oscilloscope without a screen. What is held, where the window and the cursors are, what is chosen."""

from __future__ import annotations

import math

from imugui.ring import Ring
from imugui.signals.choice import Choice
from imugui.signals.cursors import Cursors
from imugui.signals.feed import Feed
from imugui.signals.history import History
from imugui.signals.viewport import Viewport


class Scope:
    """Follows both rings until it is held. Places along the window are shares of it, 0 left to 1 right."""

    def __init__(self, samples: Ring, attitude: Ring, convention: str) -> None:
        self.feed = Feed(samples, attitude, convention)
        self.choice = Choice()
        self.viewport = Viewport()
        self.cursors = Cursors()

    @property
    def held(self) -> bool:
        """True while the picture stands still."""
        return self.viewport.held

    @property
    def times(self) -> History:
        """The history whose times all others share."""
        return self.feed.raw if len(self.feed.raw) else self.feed.corrected

    @property
    def last_t(self) -> float:
        """The newest time, s; NaN without data."""
        return self.times.last_t

    @property
    def window(self) -> tuple[float, float]:
        """From when to when is looked at, s; NaN without data."""
        end = self.viewport.end if self.held else self.last_t
        return end - self.viewport.window_s, end

    def refresh(self) -> bool:
        """Take what is new unless held; True when there was any."""
        return not self.held and self.feed.refresh()

    def restart(self, convention: str) -> None:
        """Begin anew with angles in another display convention."""
        self.resume()
        self.feed.restart(convention)

    def hold(self) -> None:
        """Stand still, with both cursors in the window; nothing happens without data."""
        if not self.held and not math.isnan(self.last_t):
            self.viewport.hold(self.last_t)
            self.cursors.put(self.times, *self.window)

    def resume(self) -> None:
        """Follow the newest sample again, without cursors."""
        self.viewport.follow()
        self.cursors.clear()

    def time_at(self, share: float) -> float:
        """The time at a place, s."""
        start, end = self.window
        return start + share * (end - start)

    def pan(self, share: float) -> None:
        """Hold, and move the window by a share of its length, to later times when positive."""
        self.hold()
        self.viewport.pan(share * self.viewport.window_s, self.times.first_t, self.last_t)

    def zoom(self, steps: int, share: float) -> None:
        """Longer (positive) or shorter windows; a held one keeps the time that is at a place."""
        self.viewport.zoom(steps, self.time_at(share), self.times.first_t, self.last_t)

    def set_window(self, window_s: float) -> None:
        """Look at so many seconds; a held window keeps its middle."""
        middle = self.time_at(0.5)
        self.viewport.window_s = window_s
        if self.held:
            self.viewport.end = middle + 0.5 * window_s
            self.viewport.pan(0.0, self.times.first_t, self.last_t)

    def place_cursor(self, share: float) -> None:
        """Set the active cursor to the sample nearest to a place."""
        if self.held:
            self.cursors.move_to(self.times, self.time_at(share))

    def step_cursor(self, samples: int) -> None:
        """Move the active cursor by samples; the window follows it."""
        if not self.held:
            return
        self.cursors.step(self.times, samples)
        start, end = self.window
        t = self.cursors.times[self.cursors.active]
        beyond = min(t - start, 0.0) + max(t - end, 0.0)
        self.viewport.pan(beyond, self.times.first_t, self.last_t)

    def fix_scale(self, key: str, low: float, high: float) -> None:
        """Fix all scales as they are, and one plot's from low to high, in the unit shown."""
        if low < high:
            self.choice.fixed = True
            self.choice.ranges[key] = (low, high)

    def set_fixed(self, fixed: bool) -> None:
        """Fix the scales as they are, or let them follow the data again."""
        self.choice.fixed = fixed
        self.choice.ranges.clear()
