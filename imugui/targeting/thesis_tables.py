"""The published runs of C. Erat's thesis (Izmir Institute of Technology 2018, tables 6.1 and 6.2), for comparison.

One expert, gain 8 (px per degree; px/s per degree), five targets a run, tolerance 9 px, five runs for each time
constant of the simulated robot. Elapsed seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

from imugui.targeting.statistics import GroupTest, anova, welch

TAUS_S = (0.25, 0.5, 1.0, 2.0)
Table = dict[float, tuple[float, ...]]
POSITION: Table = {
    0.25: (47.0, 30.0, 42.0, 33.0, 30.0),
    0.5: (46.0, 32.0, 35.0, 42.0, 40.0),
    1.0: (37.0, 36.0, 47.0, 37.0, 31.0),
    2.0: (55.0, 63.0, 51.0, 53.0, 50.0),
}
SPEED: Table = {
    0.25: (52.0, 60.0, 53.0, 50.0, 69.0),
    0.5: (57.0, 65.0, 60.0, 50.0, 58.0),
    1.0: (59.0, 63.0, 62.0, 63.0, 51.0),
    2.0: (72.0, 75.0, 61.0, 64.0, 79.0),
}
TABLES: dict[str, Table] = {"position": POSITION, "speed": SPEED}


@dataclass(frozen=True)
class Line:
    """One time constant: mean seconds with both mappings, their ratio and Welch's test between them."""

    tau_s: float
    position_s: float
    speed_s: float
    ratio: float
    test: GroupTest


def lines(position: Table = POSITION, speed: Table = SPEED) -> tuple[Line, ...]:
    """Both tables side by side; others of the same form, such as a simulated user's, can be given."""
    found = []
    for tau in position:
        a, b = (sum(table[tau]) / len(table[tau]) for table in (position, speed))
        found.append(Line(tau, a, b, b / a, welch(position[tau], speed[tau])))
    return tuple(found)


def lag_test(table: Table, up_to_s: float = TAUS_S[-1]) -> GroupTest:
    """Does the time constant, up to this one, change the elapsed time? One-way analysis of variance of the runs."""
    return anova([runs for tau, runs in table.items() if tau <= up_to_s])
