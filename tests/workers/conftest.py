"""The Bluetooth lab for tests of the workers: emulated boards behind a real stack, reached through unmodified bleak."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from imugui.samples import Rows
from imugui.simulation.ble import missing
from imugui.workers.session import Session

if TYPE_CHECKING:
    from imugui.simulation.ble.lab import BleLab
    from imugui.simulation.ble.peripheral import Peripheral


@pytest.fixture
def gaps_without_cause() -> Callable[[Rows, int, float], list[int]]:
    """Tell where a clock left a gap though no row was kept waiting by a busy machine."""

    def find(rows: Rows, told: int, rate_hz: float) -> list[int]:
        """``told``: how many gaps were counted, each of which is a step in time."""
        steps = np.flatnonzero(np.diff(rows["t"]) > 2.5 / rate_hz)
        assert told <= len(steps)
        waited = np.diff(rows["t_arrival"]) > 2.0 / rate_hz
        return [int(at) for at in steps if not waited[max(0, at - 50) : at + 1].any()]

    return find


@pytest.fixture
def ble_lab() -> Iterator[BleLab]:
    """The lab, whose bus is this process's system bus."""
    if lacking := missing():
        pytest.skip(lacking)
    from imugui.simulation.ble.lab import BleLab

    with BleLab() as lab:
        yield lab


@pytest.fixture
def card(ble_lab: BleLab) -> Peripheral:
    """A motion card that is switched on."""
    return ble_lab.add_board("motion-card")


@pytest.fixture
def ble_session(ble_lab: BleLab, qtbot: Any) -> Iterator[Session]:
    """A session that must leave neither thread nor loop behind."""
    session = Session()
    yield session
    session.close()
    assert not session.radio.started
    assert "bluetooth" not in {thread.name for thread in threading.enumerate()}
