"""Settings survive everything a disk can hold."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.settings import Settings, Store, load, save


def test_round_trip(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "settings.json"
    store = Store(Settings(theme="dark", baud=250000), {"mahony": {"kp": 1.4}}, {"usb:1": {"family": "mpu9250"}})
    save(path, store)
    assert load(path) == (store, [])
    assert list(path.parent.iterdir()) == [path]


def test_no_file_is_no_problem(tmp_path: Path) -> None:
    assert load(tmp_path / "settings.json") == (Store(), [])


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe\x00", b"[1, 2]", b"[" * 100_000, b'"text"', b"null"])
def test_a_broken_file_is_set_aside_and_named(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "settings.json"
    path.write_bytes(content)
    store, problems = load(path)
    assert store == Store()
    assert "settings" in problems[0]
    assert (tmp_path / "settings.broken.json").read_bytes() == content


def test_each_bad_value_falls_back_alone(tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    values = {"settings": {"theme": "pink", "baud": 9600, "unknown": 1}, "boards": {"a": 3, "b": {}}, "filters": 7}
    path.write_text(json.dumps(values))
    store, problems = load(path)
    assert store.settings == Settings(baud=9600)
    assert store.boards == {"b": {}}
    assert store.filters == {}
    assert len(problems) == 1
    assert "theme" in problems[0]


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=12,
)


@given(st.dictionaries(st.sampled_from(["settings", "boards", "filters", "theme"]), json_values))
def test_any_json_loads(tmp_path_factory: pytest.TempPathFactory, values: dict) -> None:
    path = tmp_path_factory.mktemp("settings") / "settings.json"
    path.write_text(json.dumps(values))
    store, _ = load(path)
    save(path, store)
    assert load(path)[0] == store
