"""Filter: what every entry of FILTERS can do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Protocol

from imugui.fusion.scalar import Quat, Vector


class Filter(Protocol):
    """Turns angular rate, specific force and field into an attitude, one sample at a time."""

    title: ClassVar[str]
    Params: ClassVar[type[Any]]
    PRESETS: ClassVar[dict[str, Any]]

    params: Any
    quat: Quat
    """Rotation sensor -> earth (ENU), unit length; the identity until the first usable accelerometer value."""
    bias: Vector
    """rad/s, what the filter believes the gyroscope reads at rest."""
    rest: bool
    disturbed: bool

    def __init__(self, params: Any = None) -> None: ...

    def update(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float) -> None:
        """Take one sample: rad/s, m/s2, uT in the same sensor axes, ``dt`` s after the sample before.

        ``mag`` is None when there is no new measurement: the heading is then left to the gyroscope. The first
        usable ``acc`` sets the attitude (yaw 0), the first ``mag`` the heading; both at once, without settling.
        """

    def start(self, quat: Sequence[float], heading_known: bool = True) -> None:
        """Begin again at this attitude and bias; unless ``heading_known`` the next ``mag`` sets the heading."""

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on, as plain numbers, lists and dicts."""

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from the ``state`` of a filter of the same class, with this one's own parameters."""
