"""Spoiling a good file: bytes, words, lines, cells and JSON values replaced by odd ones. Seeded, and nothing else."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

LONGEST = 20_000
"""bytes of one input; a longer one is cut."""
ODD_WORDS = (
    b"nan", b"-nan", b"inf", b"-inf", b"1e400", b"-1e308", b"1e-320", b"0", b"-0.0", b"9" * 400, b"1_0", b"0x10",
    b"--1", b"1,5", b"", b" ", b"\0", b"\xff", b"\xed\xa0\x80", b"\xd9\xa1", b"\r", b"\n", b"\r\n", b"\t", b"\"",
    b"'", b";", b",", b":", b"#", b"ACCEL 1 2", b"t,ax,ay,az", b"\xef\xbb\xbf", b"A" * 5000, b"1" * 4200,
)  # fmt: skip
ODD_VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 2**31, 2**64, 10**400, -(10**400), 1e308, -1e308, 1e-320, 0.5, float("inf"),
    float("-inf"), float("nan"), "", "x", "nan", "1", "\ud800", "<script>", "\0", "A" * 1000, "9999-12-31T23:59:59",
    "0001-01-01", [], [[]], [None], [1, 2, 3], [0.0] * 9, [[1.0] * 3] * 3, {}, {"": None}, {"kind": []},
)  # fmt: skip

Mutation = Callable[[bytes, random.Random], bytes]


def mutate(data: bytes, seed: int, other: bytes = b"") -> bytes:
    """``data`` spoiled in one to four ways; ``other``: a file whose pieces may be spliced in."""
    chance = random.Random(seed)  # noqa: S311 (a fuzzer, no secret)
    for _ in range(chance.randint(1, 4)):
        data = chance.choice(MUTATIONS)(data, chance) if chance.random() < 0.9 else _splice(data, other, chance)
    return data[:LONGEST]


def _flip(data: bytes, chance: random.Random) -> bytes:
    spoiled = bytearray(data)
    for _ in range(chance.randint(1, 8) if data else 0):
        spoiled[chance.randrange(len(spoiled))] = chance.randrange(256)
    return bytes(spoiled)


def _cut(data: bytes, chance: random.Random) -> bytes:
    start, end = sorted(chance.randint(0, len(data)) for _ in range(2))
    return data[:start] + data[end:] if chance.random() < 0.7 else data[:end]


def _again(data: bytes, chance: random.Random) -> bytes:
    start, end = sorted(chance.randint(0, len(data)) for _ in range(2))
    return data[:end] + data[start : start + min(end - start, 4000)] * chance.randint(1, 3) + data[end:]


def _insert(data: bytes, chance: random.Random) -> bytes:
    at = chance.randint(0, len(data))
    return data[:at] + chance.choice(ODD_WORDS) + data[at:]


def _word(data: bytes, chance: random.Random) -> bytes:
    """One cell of one line is another."""
    lines = data.split(b"\n")
    at = chance.randrange(len(lines))
    mark = chance.choice((b",", b";", b":", b" ", b"\t", b"="))
    cells = lines[at].split(mark)
    cells[chance.randrange(len(cells))] = chance.choice(ODD_WORDS)
    lines[at] = mark.join(cells)
    return b"\n".join(lines)


def _swap_lines(data: bytes, chance: random.Random) -> bytes:
    lines = data.split(b"\n")
    one, two = (chance.randrange(len(lines)) for _ in range(2))
    lines[one], lines[two] = lines[two], lines[one]
    return b"\n".join(lines)


def _value(data: bytes, chance: random.Random) -> bytes:
    """One value of a JSON text, or of one line of such texts, is another, or is gone."""
    lines = data.split(b"\n") if data[:9].count(b"{") and data.count(b"\n{") else [data]
    at = chance.randrange(len(lines))
    try:
        tree = json.loads(lines[at])
    except (ValueError, RecursionError):
        return _word(data, chance)
    lines[at] = json.dumps(_changed(tree, chance)).encode()
    return b"\n".join(lines)


def _changed(tree: Any, chance: random.Random) -> Any:
    if isinstance(tree, dict) and tree and chance.random() < 0.93:
        key = chance.choice(list(tree))
        return {name: one if name != key else _changed(one, chance) for name, one in tree.items()} | (
            {chance.choice(list(tree)): chance.choice(ODD_VALUES)} if chance.random() < 0.1 else {}
        )
    if isinstance(tree, list) and tree and chance.random() < 0.9:
        at = chance.randrange(len(tree))
        rest = [*tree[:at], _changed(tree[at], chance), *tree[at + 1 :]]
        return rest[:-1] if chance.random() < 0.1 else rest
    return chance.choice(ODD_VALUES)


def _splice(data: bytes, other: bytes, chance: random.Random) -> bytes:
    return data[: chance.randint(0, len(data))] + other[chance.randint(0, len(other)) :]


MUTATIONS: tuple[Mutation, ...] = (_flip, _cut, _again, _insert, _word, _word, _swap_lines, _value, _value, _value)
