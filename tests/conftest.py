"""Fixtures shared by all tests; offscreen is chosen before Qt is imported."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

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
