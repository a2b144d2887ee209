"""How a table is written: delimiters, decimal signs, header lines, and what is no table at all."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.formats.layout import Layout, TableError, read_layout

NAMES = ("t (s)", "ax (g)", "ay (g)", "az (g)")
ROWS = (("0.00", "0.01", "-0.02", "1.00"), ("0.01", "0.02", "-0.03", "0.99"), ("0.02", "-1.5e-2", "-0.01", "1.01"))


def read(text: str | bytes) -> Layout:
    return read_layout(text.encode() if isinstance(text, str) else text, whole=True)


def table(delimiter: str, decimal: str = ".", above: str = "") -> str:
    lines = [delimiter.join(NAMES) if delimiter != " " else "t_s ax_g ay_g az_g"]
    lines += [delimiter.join(row).replace(".", decimal) for row in ROWS]
    return above + "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("delimiter", "decimal"),
    [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), ("|", "."), (" ", "."), (" ", ",")],
)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_signs_are_found(delimiter: str, decimal: str, end: str) -> None:
    layout = read(table(delimiter, decimal).replace("\n", end))
    assert (layout.delimiter, layout.decimal, layout.skip_lines) == (delimiter, decimal, 1)
    assert layout.numbers.shape == (3, 4)
    assert layout.numbers[2].tolist() == [0.02, -0.015, -0.01, 1.01]


@pytest.mark.parametrize(
    "above",
    [
        "",
        "# made by: a logger\n# Fs=100\n",
        "GYROFLOW IMU LOG\nversion,1.3\nid,custom\ntscale,0.001\n",
        "\n\n",
        "sep=,\n",
    ],
)
def test_lines_above_the_header_do_not_matter(above: str) -> None:
    layout = read(table(",", above=above))
    assert layout.names == NAMES
    assert len(layout.numbers) == 3


def test_units_may_stand_in_a_line_of_their_own() -> None:
    layout = read("time;ax;ay;az\ns;m/s^2;m/s^2;m/s^2\n0;0;0;9.8\n1;0;0;9.8\n")
    assert layout.names == ("time (s)", "ax (m/s^2)", "ay (m/s^2)", "az (m/s^2)")
    assert layout.skip_lines == 2


def test_a_header_may_be_a_comment_and_quoted() -> None:
    assert read("# t_s,ax_g,ay_g,az_g\n0,0,0,1\n1,0,0,1\n").names == ("t_s", "ax_g", "ay_g", "az_g")
    assert read('"a, b","c"\n0,1\n1,2\n').names == ("a, b", "c")


def test_without_a_header_there_are_no_names() -> None:
    layout = read("1 -22.4 -22.2 -51.9\n2 -499.9 -500.0 166.7\n")
    assert not layout.has_header
    assert layout.signature == ""
    assert layout.delimiter == " "


def test_missing_cells_and_text_are_no_numbers() -> None:
    layout = read("t,ax,ay,who\n0,,1,left hand\n1,2.5,1,left hand\n2,nan,1,right\n")
    assert np.isnan(layout.numbers[:, 3]).all()
    assert layout.numbers[1].tolist()[:3] == [1.0, 2.5, 1.0]
    assert np.isnan(layout.numbers[[0, 2], 1]).all()


def test_times_with_their_unit_are_numbers() -> None:
    assert read("Time,x\n0 sec,1\n0.02 sec,2\n").numbers[:, 0].tolist() == [0.0, 0.02]


def test_the_same_header_gives_the_same_signature_and_others_another() -> None:
    one, other = read(table(",")), read(table(",").replace("-0.02", "-0.5"))
    assert one.signature == other.signature
    assert len({one.signature, read(table(";")).signature, read(table(",").replace("ax", "bx")).signature}) == 3


def test_a_cut_last_line_and_a_cut_character_are_left_out() -> None:
    data = ("t (µs),x\n" + "1,2\n" * 10 + "1,2µ").encode()
    layout = read_layout(data[:-1])
    assert layout.names[0] == "t (µs)"
    assert len(layout.numbers) == 10


def test_other_encodings_are_read() -> None:
    assert read("t,temp (°C)\n0,1\n1,2\n".encode("latin-1")).names[1] == "temp (°C)"
    assert read(b"\xef\xbb\xbft,x\n0,1\n1,2\n").names == ("t", "x")


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"  \n \n", "empty"),
        (b"PK\x03\x04 sheet", "ZIP archive or an Excel workbook"),
        (b"\x1f\x8b\x08", "gzip"),
        ("t,x\n0,1\n".encode("utf-16"), "UTF-16"),
        (b"MATLAB 5.0 MAT-file", "writetable"),
        (b"0,1\n\0\0\0\0", "binary"),
        (b"hello\nworld\n", "no lines of numbers"),
        (b"1\n2\n3\n", "no lines of numbers"),
        (b"a,b\n1,2\n", "no lines of numbers"),
    ],
)
def test_what_is_no_table_is_said_in_one_line(data: bytes, said: str) -> None:
    with pytest.raises(TableError) as error:
        read(data)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@given(st.binary(max_size=300) | st.text(alphabet='0123456789.,;\t -+eE\n"#axyz()/', max_size=300).map(str.encode))
def test_nothing_but_a_table_error_is_raised(data: bytes) -> None:
    try:
        layout = read_layout(data)
    except TableError:
        return
    assert layout.numbers.shape == (len(layout.cells), layout.width)
    assert layout.width >= 2
