"""Half characters in JSON from outside."""

from __future__ import annotations

import json

import pytest

from imugui.texts import from_json


def test_half_a_character_is_replaced_and_whole_ones_stay() -> None:
    values = from_json(r'{"na\ud800me": ["\udc00", "\ud83d\ude00", "ü", 1.5, null], "n": {"x": "a\uD83Db"}}')
    assert values == {"na\ufffdme": ["\ufffd", "\U0001f600", "ü", 1.5, None], "n": {"x": "a\ufffdb"}}
    assert json.dumps(values, ensure_ascii=False).encode("utf-8")


def test_other_texts_are_as_json_reads_them() -> None:
    assert from_json('{"a": [1, "\\\\ud"]}') == {"a": [1, "\\ud"]}
    assert from_json("NaN", parse_constant=lambda _: None) is None
    with pytest.raises(ValueError, match="Expecting"):
        from_json("{")
