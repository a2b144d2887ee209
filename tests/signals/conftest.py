"""Rows of a made-up board, in both rings."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from imugui.ring import Ring
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, Rows, empty_rows

Push = Callable[..., tuple[Rows, Rows]]


@pytest.fixture
def rings() -> tuple[Ring, Ring]:
    return Ring(SAMPLE, 4096), Ring(ATTITUDE, 4096)


@pytest.fixture
def push(rings: tuple[Ring, Ring]) -> Push:
    """Put rows at the times ``t`` into both rings: a level board at rest, other fields by name."""

    def put(t: Any, **values: Any) -> tuple[Rows, Rows]:
        both = empty_rows(SAMPLE, len(t)), empty_rows(ATTITUDE, len(t))
        for rows, ring in zip(both, rings, strict=True):
            rows["t"], rows["gyr"], rows["acc"] = t, 0.0, (0.0, 0.0, GRAVITY)
            for name in ("quat", "local"):
                if name in (rows.dtype.names or ()):
                    rows[name] = (1.0, 0.0, 0.0, 0.0)
            for name, value in values.items():
                if name in (rows.dtype.names or ()):
                    rows[name] = value
            ring.push(rows)
        return both

    return put
