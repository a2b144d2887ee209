"""Many samples at once give what one by one gives, to the last digit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from imugui.fusion import quaternion as qt
from imugui.fusion.pipeline import Pipeline
from imugui.samples import Rows

pytest.importorskip("vqf")
from imugui.fusion.vqf_block import field_ages
from imugui.fusion.vqf_filter import Vqf
from imugui.fusion.vqf_spacing import Spacing

IdealRows = Callable[..., tuple[Rows, qt.Floats]]
Change = Callable[[Rows], None]


class OneByOne(Vqf):
    """The same filter without the offer to take many."""

    update_block: Any = None


def noisy(ideal_rows: IdealRows, n: int = 9000) -> Rows:
    """45 s at 200 Hz: still at first, then tumbling."""
    half = np.maximum(np.arange(n) / 200.0 - 8.0, 0.0)
    rows, _ = ideal_rows(
        np.arange(n) / 200.0,
        motion=lambda t: qt.from_rotation_vector(np.stack((np.sin(half), 0.5 * half, np.cos(half) - 1.0), axis=-1)),
    )
    random = np.random.default_rng(5)
    for name, sigma in (("gyr", 0.01), ("acc", 0.1), ("mag", 0.5)):
        rows[name] += random.normal(0.0, sigma, (n, 3))
    return rows


def as_it_is(rows: Rows) -> None:
    pass


def held_field(rows: Rows) -> None:
    rows["mag"] = rows["mag"][np.arange(len(rows)) // 3 * 3]


def no_field(rows: Rows) -> None:
    rows["mag"] = np.nan


def jittered(rows: Rows) -> None:
    rows["t"] += np.random.default_rng(1).uniform(-1e-3, 1e-3, len(rows))


def gap_and_slower(rows: Rows) -> None:
    rows["t"][3000:] += 5.0
    rows["t"][6000:] = rows["t"][6000] + np.arange(len(rows) - 6000) / 150.0


def damaged(rows: Rows) -> None:
    rows["acc"][4000:4010] = np.nan
    rows["mag"][5000:5100] *= 3.0
    rows["mag"][5200] = 1e300
    rows["gyr"][7000] = 1e6


@pytest.mark.parametrize("change", [as_it_is, held_field, no_field, jittered, gap_and_slower, damaged])
def test_many_at_once_are_as_one_by_one(ideal_rows: IdealRows, change: Change) -> None:
    rows = noisy(ideal_rows)
    change(rows)
    quick, slow = Pipeline("vqf"), Pipeline("vqf")
    slow.filter = OneByOne()
    for piece in (slice(0, 10), slice(10, 2500), slice(2500, 9000)):
        a, b = quick.step(rows[piece]), slow.step(rows[piece])
        assert a.tobytes() == b.tobytes()
    assert str(quick.state()) == str(slow.state())


def test_an_even_stream_is_taken_in_blocks(ideal_rows: IdealRows, monkeypatch: pytest.MonkeyPatch) -> None:
    alone = 0
    update = Vqf.update

    def count(self: Vqf, *sample: Any) -> None:
        nonlocal alone
        alone += 1
        update(self, *sample)

    monkeypatch.setattr(Vqf, "update", count)
    Pipeline("vqf").step(noisy(ideal_rows))
    assert alone < 100


def test_pieces_give_the_whole(ideal_rows: IdealRows) -> None:
    rows = noisy(ideal_rows)
    whole = Pipeline("vqf").step(rows)
    assert np.concatenate(list(Pipeline("vqf").steps(rows))).tobytes() == whole.tobytes()


def test_field_ages_are_added_one_after_the_other() -> None:
    random = np.random.default_rng(2)
    dts, new = random.uniform(0.001, 0.01, 300), random.random(300) < 0.2
    age, ages = 0.25, []
    for dt, fresh in zip(dts.tolist(), new.tolist(), strict=True):
        age += dt
        if fresh:
            ages.append(age)
            age = 0.0
    found, left = field_ages(dts, new, 0.25)
    assert found.tolist() == ages
    assert left == age


def test_spacings_walked_are_spacings_taken() -> None:
    dts = np.random.default_rng(3).uniform(0.0049, 0.0051, 2000)
    one, many = Spacing(), Spacing()
    assert not any(one.departed(dt, 0.005) for dt in dts.tolist())
    after = many.walked(dts, 0.005)
    assert after == one.state()
    assert Spacing().walked(1.1 * dts, 0.005) is None
