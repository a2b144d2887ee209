"""Choice: what the user wants to see of which channels, in which units."""

from __future__ import annotations

from dataclasses import dataclass, field

from imugui.signals.channels import CHANNELS, QUANTITIES, UNITS, Channel, Quantity, Unit
from imugui.signals.feed import Feed
from imugui.signals.history import History
from imugui.signals.scale import AutoScale, Range

FIRST_PLOTS = ("acc", "gyr", "mag")


@dataclass
class Choice:
    """``plots`` are keys of QUANTITIES, ``channels`` keys of CHANNELS; ``ranges`` hold the scales that are fixed."""

    plots: set[str] = field(default_factory=lambda: set(FIRST_PLOTS))
    channels: set[str] = field(default_factory=lambda: {key for key, channel in CHANNELS.items() if channel.shown})
    raw: bool = False
    units: dict[str, int] = field(default_factory=dict)
    fixed: bool = False
    ranges: dict[str, Range] = field(default_factory=dict)
    scales: dict[str, AutoScale] = field(default_factory=lambda: {key: AutoScale() for key in QUANTITIES})

    def shown(self) -> dict[str, tuple[Channel, ...]]:
        """The channels to draw by quantity, in the order of the table."""
        return {
            key: tuple(channel for channel in quantity.channels if channel.key in self.channels)
            for key, quantity in QUANTITIES.items()
            if key in self.plots
        }

    def unit(self, quantity: Quantity) -> Unit:
        """The unit in which a quantity is shown."""
        units = UNITS[quantity.kind]
        return units[self.units.get(quantity.kind, 0) % len(units)]

    def next_unit(self, key: str) -> None:
        """Show a quantity, and all others of its kind, in the next unit; their scales begin anew."""
        kind = QUANTITIES[key].kind
        self.units[kind] = self.units.get(kind, 0) + 1
        for other, quantity in QUANTITIES.items():
            if quantity.kind == kind:
                self.fit(other)

    def set_raw(self, raw: bool) -> None:
        """Show what the board sent, or what the filter uses."""
        self.raw = raw

    def show_plot(self, key: str, on: bool) -> None:
        """Show or hide a quantity."""
        (self.plots.add if on else self.plots.discard)(key)

    def show_channel(self, key: str, on: bool) -> None:
        """Show or hide a channel of its plot."""
        (self.channels.add if on else self.channels.discard)(key)

    def history(self, quantity: Quantity, feed: Feed) -> History:
        """Where the quantity's rows are: raw ones or corrected ones."""
        return feed.raw if not quantity.corrected or (quantity.raw and self.raw) else feed.corrected

    def title(self, key: str) -> str:
        """The quantity's name, with what has been done to the values where both kinds exist."""
        quantity = QUANTITIES[key]
        return f"{quantity.title}, {'raw' if self.raw else 'corrected'}" if quantity.raw else quantity.title

    def range_of(self, key: str, low: float, high: float) -> Range:
        """The scale of a plot whose data go from low to high, in the unit shown; a fixed one is that of first sight."""
        if self.fixed and key in self.ranges:
            return self.ranges[key]
        unit = self.unit(QUANTITIES[key])
        found = self.scales[key].follow(low, high, unit.least)
        found = max(found[0], -unit.limit), min(found[1], unit.limit)
        if self.fixed and low <= high:
            self.ranges[key] = found
        return found

    def fit(self, key: str = "") -> None:
        """Take new scales from the data, of one plot or of all."""
        for one in [key] if key else list(QUANTITIES):
            self.ranges.pop(one, None)
            self.scales[one] = AutoScale()
