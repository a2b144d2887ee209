"""ColumnMap: what the columns of a foreign table mean and how it is written; kept as plain JSON."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from imugui.fields import field, from_mapping
from imugui.formats.columns import table_from
from imugui.formats.families import ALIGNED

DELIMITERS = (",", ";", "\t", "|", " ")
NOT_USED = "-"
"""The name of a column that nothing is read from."""
MOST_COLUMNS = 500
LONGEST_NAME = 100
WIDEST_RATE = 100_000.0  # Hz


@dataclass(frozen=True)
class ColumnMap:
    """One table. ``columns`` are names with units as csv-line reads them, such as "t_ms", "ax_g/16384", "gx_dps"."""

    columns: tuple[str, ...] = field((), "Columns")
    delimiter: str = field(",", "Between the columns", choices=DELIMITERS)
    decimal: str = field(".", "Decimal sign", choices=(".", ","))
    skip_lines: int = field(0, "Lines before the numbers", low=0, high=10_000)
    keep_column: int = field(-1, "Only lines whose column number ...", low=-1, high=MOST_COLUMNS - 1)
    keep_value: float = field(0.0, "... reads")
    rate_hz: float = field(0.0, "Rate of a table without times", unit="Hz", low=0.0, high=WIDEST_RATE)
    file: str = field("", "File name beside the opened file")

    @property
    def problem(self) -> str:
        """Why no sample can be made of this table, in words; "" when it can."""
        return table_from(self.columns, self.delimiter.encode(), ALIGNED, partial=True).problem

    def to_json(self) -> dict[str, Any]:
        """Plain values for a settings file."""
        return dataclasses.asdict(self) | {"columns": list(self.columns)}


def from_json(values: object) -> ColumnMap | None:
    """The map that ``to_json`` wrote; None for anything else, however odd."""
    if not isinstance(values, Mapping) or not _is_names(values.get("columns")):
        return None
    column_map, problems = from_mapping(ColumnMap, {**values, "columns": tuple(values["columns"])})
    assert isinstance(column_map, ColumnMap)  # noqa: S101
    plain_file = Path(column_map.file).name == column_map.file
    inside = column_map.keep_column < len(column_map.columns)
    return column_map if plain_file and inside and not problems and not column_map.problem else None


def _is_names(names: object) -> bool:
    return (
        isinstance(names, Sequence)
        and not isinstance(names, str)
        and 0 < len(names) <= MOST_COLUMNS
        and all(isinstance(name, str) and len(name) <= LONGEST_NAME for name in names)
    )
