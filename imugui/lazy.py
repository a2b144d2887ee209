"""Lazy: a table whose entries are imported when they are first asked for, so that the window need not wait for them."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from typing import TypeVar

T = TypeVar("T")


class Lazy(Mapping[str, T]):
    """Names as in any dict, in their order; looking at an entry imports it."""

    def __init__(self, places: Mapping[str, str]) -> None:
        """``places``: the module and the name in it of every entry, as in "imugui.fusion.mahony:Mahony"."""
        self._places = dict(places)

    def __getitem__(self, name: str) -> T:
        module, kept = self._places[name].split(":")
        entry: T = getattr(importlib.import_module(module), kept)
        return entry

    def __contains__(self, name: object) -> bool:
        return name in self._places  # Mapping's own would import the entry

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)
