"""The plain-float steps agree with the numpy functions."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import quaternion as qt
from imugui.fusion import scalar

parts = st.floats(-1.0, 1.0)
quats = (
    st.tuples(parts, parts, parts, parts)
    .filter(lambda q: sum(x * x for x in q) > 1e-4)
    .map(lambda q: tuple(qt.normalise(q).tolist()))
)
turns = st.tuples(parts, parts, parts)


@given(quats)
def test_rows_are_the_matrix(q: scalar.Quat) -> None:
    assert np.allclose(scalar.rotation_rows(q), qt.to_matrix(q), atol=1e-15)


@given(quats, turns)
def test_turned_in_sensor_is_a_product_from_the_right(q: scalar.Quat, v: tuple[float, float, float]) -> None:
    expected = qt.multiply(q, qt.from_rotation_vector(v))
    assert np.allclose(scalar.turned_in_sensor(q, *v), expected, atol=1e-11)


@given(quats, turns)
def test_turned_in_earth_is_a_product_from_the_left(q: scalar.Quat, v: tuple[float, float, float]) -> None:
    small = [0.2 * part for part in v]
    exact = qt.multiply(qt.from_rotation_vector(small), q)
    turned = scalar.turned_in_earth(q, *small)
    assert abs(qt.length(turned) - 1.0) < 1e-15
    assert qt.angle_between(turned, exact) <= 0.01 * qt.length(small) + 1e-12


def test_a_direction_needs_a_length() -> None:
    assert scalar.direction((0.0, 3.0, 4.0), 1.0) == (0.0, 0.6, 0.8)
    for nothing in ((0.0, 0.0, 0.0), (0.0, 0.5, 0.0), (np.nan, 0.0, 9.0), (1e300, 0.0, 0.0), (np.inf, 0.0, 0.0)):
        assert scalar.direction(nothing, 1.0) is None


def test_time_is_bounded() -> None:
    assert [scalar.bounded(dt) for dt in (-1.0, 0.0, 0.01, 5.0, np.inf, np.nan)] == [0.0, 0.0, 0.01, 1.0, 1.0, 0.0]


def test_what_no_sensor_reads_counts_as_nothing() -> None:
    assert scalar.sane((1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
    for nonsense in ((1e300, 0.0, 0.0), (np.nan, 0.0, 0.0), (np.inf, 0.0, 0.0)):
        assert scalar.sane(nonsense) == scalar.NOTHING
