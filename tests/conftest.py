"""Fixtures shared by all tests; offscreen is chosen before Qt is imported."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hypothesis
import pytest
from pytestqt.qtbot import QtBot

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

# No test judges by the clock: a busy machine is not a failure.
hypothesis.settings.register_profile(
    "imugui",
    deadline=None,
    derandomize=bool(os.environ.get("CI")),
    suppress_health_check=[hypothesis.HealthCheck.too_slow],
)
hypothesis.settings.load_profile("imugui")

REPOSITORY = Path(__file__).resolve().parent.parent
DATA = REPOSITORY.parent / "shared" / "data"


class PatientBot(QtBot):
    """Waits as long as a machine may need that is busy with other things; no wait outlasts its condition."""

    WAIT_MS = 30_000

    def waitUntil(self, callback: Any, *, timeout: int = WAIT_MS) -> None:
        """Wait for a condition."""
        super().waitUntil(callback, timeout=timeout)

    def waitSignal(self, signal: Any, *, timeout: int = WAIT_MS, **options: Any) -> Any:
        """Wait for a signal of what is done inside the block."""
        return super().waitSignal(signal, timeout=timeout, **options)

    def waitSignals(self, signals: Any, *, timeout: int = WAIT_MS, **options: Any) -> Any:
        """Wait for all of some signals."""
        return super().waitSignals(signals, timeout=timeout, **options)

    def waitExposed(self, widget: Any, *, timeout: int = WAIT_MS) -> Any:
        """Wait for a window to be shown."""
        return super().waitExposed(widget, timeout=timeout)


@pytest.fixture
def qtbot(qapp: object, request: pytest.FixtureRequest) -> PatientBot:
    """In place of pytest-qt's, which waits 5 s."""
    return PatientBot(request)


@pytest.fixture(autouse=True)
def no_garbage_in_threads(request: pytest.FixtureRequest) -> Iterator[None]:
    """As in the program: widgets are never freed by a worker's thread. Tests of Qt collect in between."""
    if not {"views", "workers"} & set(request.path.parts):
        yield
        return
    gc.disable()
    yield
    gc.enable()


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of real recordings, which carry no licence of ours and are not shipped."""
    if not DATA.is_dir():
        pytest.skip(f"the real recordings are not here: {DATA} is missing")
    return DATA
