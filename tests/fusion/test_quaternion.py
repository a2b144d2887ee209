"""Quaternion functions: algebra, round trips, and the same numbers for one row and for many."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.fusion import quaternion as qt

parts = st.floats(-1.0, 1.0, allow_subnormal=False)
quats = (
    st.tuples(parts, parts, parts, parts)
    .filter(lambda q: sum(x * x for x in q) > 1e-4)
    .map(lambda q: qt.normalise(q).tolist())
)
vectors = st.tuples(*[st.floats(-1e3, 1e3)] * 3)
turns = st.tuples(parts, parts, parts).map(lambda v: 3.1 * np.array(v) / np.sqrt(3.0))  # at most 3.1 rad long


def same_rotation(p: object, q: object, tolerance: float = 1e-12) -> bool:
    return bool(qt.angle_between(p, q) < tolerance)  # type: ignore[arg-type]


@given(quats, quats, quats)
def test_product_is_associative_and_keeps_length(p: list[float], q: list[float], r: list[float]) -> None:
    left, right = qt.multiply(qt.multiply(p, q), r), qt.multiply(p, qt.multiply(q, r))
    assert np.allclose(left, right, atol=1e-14)
    assert abs(qt.length(left) - 1.0) < 1e-14


def test_product_follows_hamilton() -> None:
    i, j, k = (0.0, 1, 0, 0), (0.0, 0, 1, 0), (0.0, 0, 0, 1)
    assert qt.multiply(i, j).tolist() == list(k)
    assert qt.multiply(j, i).tolist() == [-x for x in k]
    assert qt.multiply(k, k).tolist() == [-1.0, 0, 0, 0]


@given(quats, vectors)
def test_rotate_is_the_sandwich_and_the_matrix(q: list[float], v: tuple[float, ...]) -> None:
    sandwich = qt.multiply(qt.multiply(q, (0.0, *v)), qt.conjugate(q))
    assert np.allclose(qt.rotate(q, v), sandwich[1:], atol=1e-10)
    assert np.allclose(qt.rotate(q, v), qt.to_matrix(q) @ v, atol=1e-10)
    assert np.allclose(qt.rotate(qt.conjugate(q), qt.rotate(q, v)), v, atol=1e-10)


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    quarter = qt.from_rotation_vector((0.0, 0.0, np.pi / 2))
    assert np.allclose(qt.rotate(quarter, (1.0, 0.0, 0.0)), (0.0, 1.0, 0.0))


@given(turns)
def test_rotation_vector_round_trip(v: np.ndarray) -> None:
    assert np.allclose(qt.to_rotation_vector(qt.from_rotation_vector(v)), v, atol=1e-13)


@given(quats)
def test_rotation_vector_takes_the_short_way(q: list[float]) -> None:
    v = qt.to_rotation_vector(q)
    assert qt.length(v) <= np.pi + 1e-12
    assert same_rotation(qt.from_rotation_vector(v), q)


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-160, 1e-9, 1e-4])
def test_tiny_rotation_vectors_keep_their_digits(size: float) -> None:
    v = np.array((size, -2 * size, 0.5 * size))
    assert np.allclose(qt.to_rotation_vector(qt.from_rotation_vector(v)), v, rtol=1e-12, atol=0.0)


@given(quats)
def test_matrix_round_trip(q: list[float]) -> None:
    matrix = qt.to_matrix(q)
    back = qt.from_matrix(matrix)
    assert np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-13)
    assert np.linalg.det(matrix) > 0.999
    assert back[0] >= 0.0
    assert same_rotation(back, q)


@pytest.mark.parametrize("axis", [(1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0), (0.6, 0.8, 0), (0.6, 0, -0.8)])
def test_matrix_of_half_turns(axis: tuple[float, ...]) -> None:
    half = (0.0, *axis)
    assert same_rotation(qt.from_matrix(qt.to_matrix(half)), half)


@given(quats, turns)
def test_angle_between_is_the_length_of_the_turn(q: list[float], v: np.ndarray) -> None:
    turned = qt.multiply(q, qt.from_rotation_vector(v))
    assert abs(qt.angle_between(q, turned) - qt.length(v)) < 1e-12
    assert abs(qt.angle_between(q, -turned) - qt.length(v)) < 1e-12


@pytest.mark.parametrize(
    ("given_quat", "expected"),
    [
        ((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
        ((np.nan, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0)),
        ((np.inf, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0)),
        ((1e300, 0.0, 0.0, 1e300), (0.5**0.5, 0.0, 0.0, 0.5**0.5)),
        ((0.0, 5e-324, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)),
    ],
)
def test_normalise_takes_anything(given_quat: tuple[float, ...], expected: tuple[float, ...]) -> None:
    assert np.allclose(qt.normalise(given_quat), expected, atol=1e-15)


def test_one_row_and_many_rows_give_the_same_bits() -> None:
    rng = np.random.default_rng(7)
    p, q, v = rng.normal(size=(50, 4)), qt.normalise(rng.normal(size=(50, 4))), rng.normal(size=(50, 3))
    cases = [
        (qt.multiply, (p, q)),
        (qt.rotate, (q, v)),
        (qt.normalise, (p,)),
        (qt.from_rotation_vector, (v,)),
        (qt.to_rotation_vector, (q,)),
        (qt.to_matrix, (q,)),
        (qt.from_matrix, (qt.to_matrix(q),)),
        (qt.angle_between, (qt.normalise(p), q)),
    ]
    for function, arguments in cases:
        at_once = function(*arguments)
        one_by_one = np.array([function(*row) for row in zip(*arguments, strict=True)])
        assert at_once.tobytes() == one_by_one.tobytes(), function.__name__


def test_leading_axes_broadcast() -> None:
    quarter = qt.from_rotation_vector((0.0, 0.0, np.pi / 2))
    stack = np.broadcast_to(quarter, (2, 5, 4))
    assert qt.multiply(stack, quarter).shape == (2, 5, 4)
    assert qt.rotate(stack, (1.0, 0.0, 0.0)).shape == (2, 5, 3)
    assert qt.from_matrix(qt.to_matrix(stack)).shape == (2, 5, 4)
