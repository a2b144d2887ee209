"""Every reader of something from outside on spoiled input: the targets of ``run.py bench fuzz``, for a moment each."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
sys.path.append(str(BENCHMARKS))

from _fuzz_mutate import LONGEST, mutate  # noqa: E402
from _fuzz_targets import TARGETS, home  # noqa: E402

from imugui.formats import FORMATS  # noqa: E402

EXAMPLES = 8


@pytest.fixture(scope="module", autouse=True)
def no_folder_is_left() -> Iterator[None]:
    yield
    shutil.rmtree(home(), ignore_errors=True)
    home.cache_clear()


@pytest.mark.parametrize("name", TARGETS)
@settings(max_examples=EXAMPLES, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(which=st.integers(0, 1000), other=st.integers(0, 1000), seed=st.integers(0, 2**60), noise=st.binary(max_size=60))
def test_spoiled_input_is_read_or_refused_in_words(name: str, which: int, other: int, seed: int, noise: bytes) -> None:
    target = TARGETS[name]
    good = target.seeds()
    target.run(mutate(good[which % len(good)], seed, good[other % len(good)]))
    target.run(noise)


@pytest.mark.parametrize("name", TARGETS)
def test_what_it_begins_with_is_good(name: str) -> None:
    for data in TARGETS[name].seeds():
        assert data
        TARGETS[name].run(data)


def test_every_format_is_fuzzed() -> None:
    assert set(FORMATS) <= set(TARGETS)


def test_the_same_seed_spoils_alike_and_another_one_otherwise() -> None:
    data = b'{"a": 1, "b": [2, 3]}\nx,y\n' * 20
    assert mutate(data, 5, data) == mutate(data, 5, data)
    assert len({mutate(data, seed, data) for seed in range(50)}) > 30
    assert max(len(mutate(data, seed, data * 1000)) for seed in range(200)) <= LONGEST
