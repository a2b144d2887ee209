"""Viewport: which stretch of time is looked at, following the newest sample or held."""

from __future__ import annotations

import math

from imugui.signals.columns import Grid

WINDOWS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0)
"""Lengths of the window, s."""
FIRST_WINDOW_S = 10.0


def edge_after(t: float, step: float) -> float:
    """The first multiple of step that is greater than t, by more than rounding."""
    return (math.floor(t / step + 1e-4) + 1) * step


class Viewport:
    """``end`` is the time at the right edge while held, NaN while the newest sample is followed."""

    def __init__(self) -> None:
        self.window_s = FIRST_WINDOW_S
        self.end = math.nan

    @property
    def held(self) -> bool:
        return not math.isnan(self.end)

    def hold(self, last_t: float) -> None:
        """Stand still with last_t (s) at the right edge; nothing happens without data."""
        self.end = last_t

    def follow(self) -> None:
        """Follow the newest sample."""
        self.end = math.nan

    def grid(self, last_t: float, count: int) -> Grid:
        """The columns to draw. Their edges are multiples of their width, so that rows keep their column while it moves.

        ``last_t`` is the newest time, s, NaN where there is none yet.
        """
        end = self.end if self.held else last_t
        step = self.window_s / count
        right = edge_after(0.0 if math.isnan(end) else end, step)
        return Grid(right - count * step, step, count)

    def pan(self, seconds: float, first_t: float, last_t: float) -> None:
        """Move the held window by seconds, within the data from first_t to last_t."""
        if self.held:
            self.end = min(max(self.end + seconds, min(first_t + 0.5 * self.window_s, last_t)), last_t)

    def zoom(self, steps: int, about_t: float, first_t: float, last_t: float) -> None:
        """Go so many window lengths up or down; a held window keeps about_t (s) where it is on screen."""
        nearest = min(range(len(WINDOWS)), key=lambda i: abs(math.log(WINDOWS[i] / self.window_s)))
        new = WINDOWS[min(max(nearest + steps, 0), len(WINDOWS) - 1)]
        share = (self.end - about_t) / self.window_s
        self.window_s = new
        if self.held:
            self.end = about_t + share * new
            self.pan(0.0, first_t, last_t)
