"""VQF behind our ``update``: the library's own numbers where it can be, and any spacing where it cannot."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pytest

from imugui.fusion import quaternion as qt
from imugui.fusion.attitude import from_acc_mag
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.vqf_params import VqfParams, library_arguments
from imugui.fusion.vqf_spacing import Spacing, carried_over
from imugui.samples import Rows

vqf = pytest.importorskip("vqf")
IdealRows = Callable[..., tuple[Rows, qt.Floats]]

NO_VQF = """
import sys
sys.modules["vqf"] = None
import numpy as np
from imugui import fusion
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.vqf_params import VqfParams
from imugui.samples import SAMPLE, empty_rows
assert list(fusion.FILTERS) == ["imugui", "madgwick", "mahony", "complementary"], fusion.FILTERS
assert fusion.DEFAULT_FILTER == "madgwick"
rows = empty_rows(SAMPLE, 3)
rows["t"], rows["gyr"], rows["acc"] = np.arange(3.0), 0.0, (0.0, 0.0, 9.8)
assert np.allclose(Pipeline().step(rows)["quat"], (1.0, 0.0, 0.0, 0.0))
print(fusion.VQF_MISSING)
"""


@pytest.fixture
def noisy_rows(ideal_rows: IdealRows) -> Rows:
    """A minute at 200 Hz with noise and bias: rest, then tumbling, so that all of the library has work."""
    rows, _ = ideal_rows(np.arange(12000) / 200.0, motion=lambda t: tumbling_after(t, 5.0))
    rng = np.random.default_rng(11)
    rows["gyr"] += rng.normal((0.01, -0.006, 0.004), 0.004, size=(12000, 3))
    rows["acc"] += rng.normal(0.0, 0.1, size=(12000, 3))
    rows["mag"] += rng.normal(0.0, 0.5, size=(12000, 3))
    return rows


def tumbling_after(t: qt.Floats, still_s: float) -> qt.Floats:
    s = np.maximum(t - still_s, 0.0)
    s = np.where(s < 2.0, 0.25 * s * s, s - 1.0)  # no jump of the rate
    return qt.from_rotation_vector(
        np.stack((0.5 + 0.8 * np.sin(0.5 * s), 0.6 * np.sin(0.9 * s), 1.0 - np.cos(0.3 * s)), axis=-1)
    )


def library_run(
    rows: Rows, rate_hz: float, use_mag: bool = True, placed: bool = True, **arguments: object
) -> dict[str, np.ndarray]:
    """The bare library over the rows; ``placed`` at the tilt of the first sample, or at the identity."""
    library = vqf.VQF(1.0 / rate_hz, **arguments)
    if placed:
        before = qt.multiply(from_acc_mag(rows["acc"][0]), qt.from_rotation_vector(-rows["gyr"][0] / rate_hz))
        library.state = {**library.state, "gyrQuat": before.tolist()}
    sensors = [np.ascontiguousarray(rows[name]) for name in ("gyr", "acc", "mag")[: 3 if use_mag else 2]]
    return library.updateBatch(*sensors)  # type: ignore[no-any-return]


def test_with_even_times_and_every_field_the_numbers_are_the_librarys(noisy_rows: Rows) -> None:
    out = Pipeline("vqf").step(noisy_rows)
    library = library_run(noisy_rows, 200.0)
    assert qt.angle_between(out["quat"], library["quat9D"]).max() < 1e-9
    assert np.abs(out["bias"] - library["bias"]).max() < 1e-9
    assert out["rest"].tolist() == library["restDetected"].tolist()
    known = library["magDistDetected"] & (np.cumsum(~library["magDistDetected"]) > 0)
    assert out["disturbed"].tolist() == known.tolist()
    assert 500 < out["rest"].sum() < 1100


def test_the_start_from_the_accelerometer_changes_little_else(noisy_rows: Rows) -> None:
    out = Pipeline("vqf").step(noisy_rows)
    library = library_run(noisy_rows, 200.0, placed=False)
    assert np.degrees(qt.angle_between(out["quat"], library["quat9D"])).max() < 0.01
    assert np.degrees(qt.angle_between(out["quat"], library["quat9D"]))[-2000:].max() < 0.001


def test_without_a_field_the_numbers_are_the_librarys_too(noisy_rows: Rows) -> None:
    out = Pipeline("vqf", use_mag=False).step(noisy_rows)
    library = library_run(noisy_rows, 200.0, use_mag=False)
    assert qt.angle_between(out["quat"], library["quat6D"]).max() < 1e-9
    assert np.abs(out["bias"] - library["bias"]).max() < 1e-9


def test_parameters_reach_the_library(noisy_rows: Rows) -> None:
    params = VqfParams(tau_acc=1.0, tau_mag=2.0, rest_th_gyr_dps=5.0, mag_dist_rejection_enabled=False)
    out = Pipeline("vqf", params).step(noisy_rows)
    library = library_run(noisy_rows, 200.0, tauAcc=1.0, tauMag=2.0, restThGyr=5.0, magDistRejectionEnabled=False)
    assert qt.angle_between(out["quat"], library["quat9D"]).max() < 1e-9


def test_our_parameters_are_all_of_the_librarys_with_its_defaults() -> None:
    assert library_arguments(VqfParams()) == vqf.VQF(0.01).params
    assert all(item.metadata["tip"] for item in dataclasses.fields(VqfParams))


@pytest.mark.parametrize("noise_s", [0.0, 0.002])
def test_uneven_times_change_little(noisy_rows: Rows, noise_s: float) -> None:
    """Every sample with its own dt: the same motion sampled at uneven times gives the same attitude and bias."""
    rows = noisy_rows.copy()
    shift = np.random.default_rng(3).uniform(-noise_s, noise_s, len(rows))
    shift[0] = 0.0
    rows["t"] += shift
    scale = np.diff(noisy_rows["t"], prepend=-0.005) / np.diff(rows["t"], prepend=-0.005)
    bias = np.array((0.01, -0.006, 0.004))
    rows["gyr"] = (rows["gyr"] - bias) * scale[:, None] + bias  # the same turn within another dt
    even, uneven = Pipeline("vqf").step(noisy_rows), Pipeline("vqf").step(rows)
    assert np.degrees(qt.angle_between(even["quat"], uneven["quat"])).max() < 0.2
    # it is learnt in the rest from 1.5 s on, which is seen a few samples earlier or later
    assert np.degrees(np.abs(even["bias"] - uneven["bias"]))[400:].max() < 0.02
    assert abs(int(even["rest"].sum()) - int(uneven["rest"].sum())) < 100


def test_another_rate_is_taken_up_without_a_jump(noisy_rows: Rows) -> None:
    """Half way the rate falls from 200 to 66.7 Hz: time constants and bias stay, nothing jumps."""
    slower = np.concatenate((noisy_rows[:6000], noisy_rows[6000::3]))
    slower["gyr"][6000:] = [noisy_rows["gyr"][max(i - 2, 0) : i + 1].mean(axis=0) for i in range(6000, 12000, 3)]
    fast, slow = Pipeline("vqf").step(noisy_rows), Pipeline("vqf").step(slower)
    there = np.concatenate((fast["quat"][:6000], fast["quat"][6000::3]))
    assert np.degrees(qt.angle_between(slow["quat"], there)).max() < 0.7
    assert np.degrees(np.abs(slow["bias"][-1] - fast["bias"][-1])).max() < 0.05


def test_a_slow_magnetometer_keeps_the_time_constant_of_the_heading(ideal_rows: IdealRows) -> None:
    """A heading 20 degrees off comes back as fast with a field every 0.125 s as with one every 0.005 s."""
    left = []
    params = VqfParams(mag_dist_rejection_enabled=False)
    for every in (1, 25):
        rows, _ = ideal_rows(np.arange(4000) / 200.0, motion=lambda t: np.tile((1.0, 0.0, 0.0, 0.0), (len(t), 1)))
        rows["mag"][::2] += 1e-6  # a field that repeats exactly would count as held
        rows["mag"][np.arange(4000) % every != 0] = np.nan
        pipeline = Pipeline("vqf", params)
        pipeline.step(rows[:200])
        pipeline.filter.start(qt.from_rotation_vector((0.0, 0.0, np.radians(20.0))))
        left.append(float(np.degrees(qt.angle_between(pipeline.step(rows[200:2000])["quat"][-1], (1.0, 0, 0, 0)))))
    assert left[0] == pytest.approx(20.0 * np.exp(-1.0), rel=0.03)  # 9 s, the time constant
    assert left[1] == pytest.approx(left[0], rel=0.03)


def test_spacing_speaks_up_only_for_a_lasting_departure() -> None:
    spacing = Spacing()
    assert [spacing.departed(0.01, 0.01) for _ in range(500)] == [None] * 500
    rng = np.random.default_rng(0)
    jittering = np.diff(0.01 * np.arange(2001) + rng.uniform(-0.004, 0.004, 2001))
    assert [spacing.departed(dt, 0.01) for dt in jittering] == [None] * 2000
    means = [mean for mean in (spacing.departed(0.02, 0.01) for _ in range(150)) if mean is not None]
    assert len(means) == 3
    assert means[-1] == pytest.approx(0.02)


def test_spacing_corrects_a_bad_first_guess_early() -> None:
    spacing, assumed, corrected = Spacing(), 0.003, []
    for k in range(200):
        mean = spacing.departed(0.01, assumed)
        if mean is not None:
            assumed = mean
            corrected.append(k)
    assert corrected == [0]
    assert assumed == pytest.approx(0.01)


def test_spacing_takes_bursts_together() -> None:
    """Ten samples that arrive at once, every 100 ms, are 100 per second."""
    spacing = Spacing()
    bursts = ([0.0] * 9 + [0.1]) * 60
    said = [mean for mean in (spacing.departed(dt, 0.01) for dt in bursts) if mean is not None]
    assert said == []


@pytest.mark.parametrize("factor", [0.3, 0.9, 1.1, 4.0])
def test_a_resting_low_pass_gives_the_same_after_a_change_of_spacing(factor: float) -> None:
    """The library's outputs at rest before and after being carried over are equal."""
    old, new = vqf.VQF(0.01), vqf.VQF(0.01 * factor)
    gyr, acc, mag = np.array((0.01, -0.02, 0.03)), np.array((1.0, 2.0, 9.4)), np.array((3.0, 20.0, -40.0))
    for _ in range(4000):
        old.updateGyr(np.zeros(3))
        old.updateAcc(acc)
        old.updateMag(mag)
    for _ in range(500):
        old.update(gyr, acc, mag)
    new.state = carried_over(old.state, old.coeffs, new.coeffs)
    before = old.state
    new.updateAcc(acc)
    new.updateMag(mag)
    after = new.state
    for name in ("lastAccLp", "restLastAccLp", "magNormDip"):
        assert np.allclose(after[name], before[name], atol=2e-3), name
    assert new.getBiasEstimate()[0] == pytest.approx(old.getBiasEstimate()[0], abs=1e-3)


def test_carried_over_to_the_same_coefficients_is_the_same_state() -> None:
    library = vqf.VQF(0.01)
    for _ in range(1000):
        library.update(np.array((0.1, 0.2, 0.3)), np.array((1.0, 2.0, 9.4)), np.array((3.0, 20.0, -40.0)))
    assert carried_over(library.state, library.coeffs, library.coeffs) == library.state


def test_without_the_library_the_rest_works_and_says_so() -> None:
    done = subprocess.run([sys.executable, "-c", NO_VQF], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("The VQF filter is not available because its library cannot be loaded")
    assert "Madgwick" in done.stdout
