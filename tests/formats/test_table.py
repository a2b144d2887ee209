"""Reading tables through column maps: units, filters, damage, holes, and files that are too long."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.formats.column_map import ColumnMap
from imugui.formats.layout import TableError
from imugui.formats.table import MOST_ROWS, decode, read_table, refuse_too_long
from imugui.samples import GRAVITY

NAMES = ("t_ms", "ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps")
LINE = "{},0.01,-0.02,1.00,1.5,-0.25,90\n"


def write(path: Path, lines: int, header: str = "a,b,c,d,e,f,g\n", end: str = "") -> Path:
    path.write_text(header + "".join(LINE.format(10 * k) for k in range(lines)) + end)
    return path


def test_rows_are_in_si(tmp_path: Path) -> None:
    rows, decoder = read_table(write(tmp_path / "a.csv", 50), [ColumnMap(NAMES, skip_lines=1)])
    assert len(rows) == 50
    assert rows["t"][:3] == pytest.approx([0.0, 0.01, 0.02])
    assert rows["acc"][0] == pytest.approx(np.array((0.01, -0.02, 1.0)) * GRAVITY)
    assert rows["gyr"][0] == pytest.approx(np.radians((1.5, -0.25, 90.0)))
    assert np.isnan(rows["t_arrival"]).all()
    assert np.isnan(rows["mag"]).all()
    assert (decoder.counts.samples, decoder.counts.bad_messages) == (50, 0)
    assert decoder.has_time


def test_decimal_commas_between_tabs(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text((LINE * 20).format(*range(20)).replace(",", "\t").replace(".", ","))
    rows, decoder = read_table(path, [ColumnMap(NAMES, "\t", ",")])
    assert rows["acc"][5] == pytest.approx(np.array((0.01, -0.02, 1.0)) * GRAVITY)
    assert decoder.counts.bad_messages == 0


def test_an_axis_can_be_turned_round(tmp_path: Path) -> None:
    columns = ("t_ms", "ax_g*-1", "ay_g*-1", "az_g*-1", "gx_dps/-1", "gy_dps", "gz_dps")
    rows, _ = read_table(write(tmp_path / "a.csv", 5), [ColumnMap(columns, skip_lines=1)])
    assert rows["acc"][0, 2] == pytest.approx(-GRAVITY)
    assert rows["gyr"][0, 0] == pytest.approx(-np.radians(1.5))


def test_only_lines_of_one_kind_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("1 20 1 2\n2 500 500 500\n" * 30)
    rows, decoder = read_table(path, [ColumnMap(("-", "mx_uT", "my_uT", "mz_uT"), " ", keep_column=0, keep_value=1.0)])
    assert rows["mag"].tolist() == [[20.0, 1.0, 2.0]] * 30
    assert decoder.counts.bad_messages == 0


def test_a_table_without_times_gets_its_rate(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", 5)
    column_map = ColumnMap(("-", *NAMES[1:]), skip_lines=1, rate_hz=50.0)
    assert read_table(path, [column_map])[0]["t"] == pytest.approx([0.0, 0.02, 0.04, 0.06, 0.08])
    assert read_table(path, [column_map], rate_hz=10.0)[0]["t"][1] == pytest.approx(0.1)


def test_damaged_lines_are_counted_and_the_rest_is_read(tmp_path: Path) -> None:
    path = write(
        tmp_path / "a.csv", 20, end="200,0.01,,,1.5,0,0\n210,1,2\nnan,0,0,1,0,0,0\n220,0,0,1e9,0,0,0\n230,a,0,1,0,0,0\n"
    )
    rows, decoder = read_table(path, [ColumnMap(NAMES, skip_lines=1)])
    assert len(rows) == decoder.counts.samples == 20
    assert decoder.counts.bad_messages == 5


def test_linear_acceleration_alone_is_refused(tmp_path: Path) -> None:
    names = ("t_ms", "linx_g", "liny_g", "linz_g", "gx_dps", "gy_dps", "gz_dps")
    with pytest.raises(TableError, match="without gravity"):
        read_table(write(tmp_path / "a.csv", 20), [ColumnMap(names, skip_lines=1)])


def test_acceleration_can_be_the_sum_of_two_columns(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("0,1,2,3,0,0,9.8\n1,1,2,3,0,0,9.8\n")
    columns = ("t_s", "linx", "liny", "linz", "gravx", "gravy", "gravz")
    assert read_table(path, [ColumnMap(columns)])[0]["acc"].tolist() == [[1.0, 2.0, pytest.approx(12.8)]] * 2


def test_tables_that_cannot_be_joined_are_refused(tmp_path: Path) -> None:
    write(tmp_path / "a.csv", 20)
    maps = [ColumnMap(("t_ms", *NAMES[1:4], "-", "-", "-"), skip_lines=1, file="a.csv"),
            ColumnMap(("-", "-", "-", "-", *NAMES[4:]), skip_lines=1, file="a.csv")]  # fmt: skip
    with pytest.raises(TableError, match="no column with times"):
        read_table(tmp_path, maps)


def test_nothing_readable_is_said_with_an_example(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"no sample found.*impossible acceleration"):
        read_table(write(tmp_path / "a.csv", 20), [ColumnMap((NAMES[0], "ax_g*9999", *NAMES[2:]), skip_lines=1)])


def test_a_hole_in_a_file_ends_it(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", 400)
    with path.open("r+b") as stream:
        stream.truncate(30_000_000)
    rows, decoder = read_table(path, [ColumnMap(NAMES, skip_lines=1)])
    assert len(rows) == 400
    assert any("binary data" in text for _, kind, text in decoder.log.entries() if kind == "bad")


def test_a_file_that_is_too_long_is_refused_from_its_beginning(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", 3000)
    refuse_too_long(path)
    with path.open("r+b") as stream:
        stream.truncate(2 << 30)  # sparse: takes no room on the disk
    with pytest.raises(TableError, match=f"more than the {MOST_ROWS // 1_000_000} million"):
        read_table(path, [ColumnMap(NAMES, skip_lines=1)])


def test_reading_can_be_watched_and_given_up(tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", 40_000)
    shares: list[float] = []
    read_table(path, [ColumnMap(NAMES, skip_lines=1)], watch=shares.append)
    assert len(shares) > 2
    assert shares == sorted(shares)
    assert shares[-1] == 1.0

    def give_up(share: float) -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError):
        read_table(path, [ColumnMap(NAMES, skip_lines=1)], watch=give_up)


@pytest.mark.parametrize("size", [1, 7, 100, 10_000])
def test_no_row_depends_on_how_the_bytes_are_cut(size: int) -> None:
    data = ("a,b\n" + "".join(LINE.format(k) for k in range(40))).encode()
    decoder, rows = decode(ColumnMap(NAMES, skip_lines=1), [data[k : k + size] for k in range(0, len(data), size)])
    assert len(rows) == 40
    assert decoder.counts.bad_messages == 0
