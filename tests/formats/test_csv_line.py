"""csv-line: headers in many spellings, four delimiters, named columns, and refusals that say why."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.formats import FORMATS, Options
from imugui.formats.csv_line import CsvLineDecoder, CsvLineEncoder
from imugui.samples import GRAVITY, SAMPLE, Rows, empty_rows

HEADER = "t_s,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,mx_G,my_G,mz_G"
LINE = "0.25,0.01,-0.02,1.00,1.5,-0.25,90,0.21,0.03,-0.44"


def read(text: str | bytes, options: Options | None = None) -> tuple[CsvLineDecoder, Rows]:
    decoder = CsvLineDecoder(options or Options())
    data = text.encode() if isinstance(text, str) else text
    return decoder, np.concatenate([decoder.feed(data, 3.0), decoder.flush(3.0)])


def check(row: Rows) -> None:
    """The values of LINE in SI."""
    assert row["t"] == 0.25
    assert row["t_arrival"] == 3.0
    assert row["acc"] == pytest.approx(np.array((0.01, -0.02, 1.0)) * GRAVITY)
    assert row["gyr"] == pytest.approx(np.radians((1.5, -0.25, 90.0)))
    assert row["mag"] == pytest.approx((21.0, 3.0, -44.0))
    assert row["status"] == -1


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", ", ", "   "])
def test_delimiters_are_found(delimiter: str) -> None:
    decoder, (row,) = read(f"{HEADER}\r\n{LINE}\r\n".replace(",", delimiter))
    check(row)
    assert decoder.has_time
    assert decoder.seen == "columns t ax ay az gx gy gz mx my mz in s, g, dps, G"


@pytest.mark.parametrize(
    "header",
    [
        HEADER,
        "\ufeff" + HEADER,
        "# " + HEADER,
        "time (s),accX (g),accY (g),accZ (g),gyrX (dps),gyrY (dps),gyrZ (dps),magX (G),magY (G),magZ (G)",
        '"Time (s)","Accelerometer X (g)","Accelerometer Y (g)","Accelerometer Z (g)","Gyroscope X (deg/s)",'
        '"Gyroscope Y (deg/s)","Gyroscope Z (deg/s)","Magnetometer X (gauss)","Magnetometer Y (gauss)",'
        '"Magnetometer Z (gauss)"',
        "t[s],acc_x[g],acc_y[g],acc_z[g],gyro_x[°/s],gyro_y[°/s],gyro_z[°/s],mag_x[G],mag_y[G],mag_z[G]",
        "timestamp_s,accel.x_g,accel.y_g,accel.z_g,wx(deg/s),wy(deg/s),wz(deg/s),hx(G),hy(G),hz(G)",
        "seconds,x_acc_g,y_acc_g,z_acc_g,x_gyro_dps,y_gyro_dps,z_gyro_dps,x_mag_gauss,y_mag_gauss,z_mag_gauss",
    ],
)
def test_headers_are_understood(header: str) -> None:
    check(read(f"{header}\n{LINE}\n")[1][0])


def test_a_header_in_another_encoding_is_understood() -> None:
    header = "t[s],acc_x[g],acc_y[g],acc_z[g],gyro_x[°/s],gyro_y[°/s],gyro_z[°/s],mag_x[G],mag_y[G],mag_z[G]"
    check(read(f"{header}\n{LINE}\n".encode("latin-1"))[1][0])


def test_our_own_table_with_comments_and_gaps() -> None:
    text = (
        "# format: imugui samples 1\n# board: car\n"
        "t,ax,ay,az,gx,gy,gz,mx,my,mz,temp_c,status,lat,lon,alt,speed,course_deg\n"
        "0.0,0.1,0.2,9.8,0.01,0.02,0.03,,,,,,,,,,\n"
        "0.1,0.1,0.2,9.8,0.01,0.02,0.03,20,5,-40,25.5,2,50.8,12.9,353,1.5,27.1\n"
    )
    decoder, rows = read(text)
    assert rows["acc"][0].tolist() == [0.1, 0.2, 9.8]
    assert np.isnan(rows["mag"][0]).all()
    assert rows["status"].tolist() == [-1, 2]
    assert rows["temp_c"][1] == 25.5
    assert [rows[name][1] for name in ("lat", "lon", "alt", "speed", "course_deg")] == [50.8, 12.9, 353, 1.5, 27.1]
    assert (decoder.counts.chatter, decoder.counts.bad_messages) == (3, 0)
    assert "(not said)" in decoder.seen


def test_without_a_time_column_the_arrival_is_the_time() -> None:
    decoder, rows = read("ax,ay,az,gx,gy,gz\n0,0,9.8,0,0,0.1\n")
    assert not decoder.has_time
    assert rows["t"].tolist() == [3.0]


@pytest.mark.parametrize(("unit", "factor"), [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)])
def test_units_of_time(unit: str, factor: float) -> None:
    _, rows = read(f"time ({unit}),ax,ay,az,gx,gy,gz\n1500,0,0,9.8,0,0,0.1\n")
    assert rows["t"][0] == pytest.approx(1500 * factor)


def test_a_column_with_a_unit_wins_over_one_without() -> None:
    _, rows = read("time,millis,ax,ay,az,gx,gy,gz\n123825300,1395837505119.146,0,0,9.8,0,0,0.1\n")
    assert rows["t"][0] == pytest.approx(1395837505.119146)


def test_a_time_column_of_dates_gives_way_to_the_arrival() -> None:
    text = "timestamp,ax,ay,az,gx,gy,gz\n2024-05-01 12:00:03.5,0,0,9.8,0,0,0.1\n2024-05-01 12:00:03.6,0,0,9.8,0,0,0.1\n"
    decoder, rows = read(text)
    assert rows["t"].tolist() == [3.0, 3.0]
    assert not decoder.has_time
    assert "time not used" in decoder.seen
    assert any("dates" in text for _, _, text in decoder.log.entries())


def test_columns_named_by_the_user_with_raw_counts() -> None:
    options = Options(columns=("-", "ax_g/16384", "ay_g/16384", "az_g/16384", "gx_dps/131", "gy_dps/131", "gz_dps/131"))
    _, (row,) = read("7;-12;-812;15032;-447;156;-86\n", options)
    assert row["acc"] == pytest.approx(np.array((-12, -812, 15032)) / 16384 * GRAVITY)
    assert row["gyr"] == pytest.approx(np.radians((-447, 156, -86)) / 131)


def test_named_columns_win_over_a_header() -> None:
    columns = ("ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps")
    _, (row,) = read("ax,ay,az,gx,gy,gz\n0,0,1,0,0,90\n", Options(columns=columns))
    assert row["acc"][2] == pytest.approx(GRAVITY)


def test_named_columns_of_another_number_are_refused_in_words() -> None:
    decoder, rows = read("1,2,3,4\n", Options(columns=("ax", "ay", "az", "gx", "gy", "gz")))
    assert len(rows) == 0
    assert decoder.counts.bad_messages == 1
    assert decoder.seen == "6 columns are named, the lines have another number"


def test_a_family_turns_the_field() -> None:
    _, (row,) = read(f"{HEADER}\n{LINE}\n", Options(family="mpu9250"))
    assert row["mag"] == pytest.approx((3.0, 21.0, 44.0))


def test_an_incomplete_field_is_left_out() -> None:
    _, (row,) = read("ax,ay,az,gx,gy,gz,mx,my\n0,0,9.8,0,0,0.1,20,5\n")
    assert np.isnan(row["mag"]).all()


def test_a_header_without_gyroscope_says_what_is_missing() -> None:
    decoder, rows = read("t_s,ax_g,ay_g,az_g\n0,0,0,1\n0.1,0,0,1\n")
    assert len(rows) == 0
    assert decoder.seen.endswith("no column for gx, gy, gz")
    assert decoder.counts.bad_messages == 2
    assert any("no column for gx, gy, gz" in text for _, kind, text in decoder.log.entries() if kind == "bad")


def test_an_unknown_unit_is_refused_in_words() -> None:
    decoder, rows = read("ax (counts),ay (counts),az (counts),gx,gy,gz\n0,0,1,0,0,1\n")
    assert len(rows) == 0
    assert "unknown unit: ax in 'counts'" in decoder.seen


def test_numbers_without_a_header_are_refused_in_words(data_dir: Path) -> None:
    decoder, rows = read((data_dir / "boards/lines-magnetometer-raw-and-calibrated.txt").read_bytes()[:5000])
    assert len(rows) == 0
    assert decoder.seen == "numbers without a header line: name the columns and units once"


def test_decimal_commas_between_semicolons_are_read() -> None:
    check(read(HEADER.replace(",", ";") + "\n" + LINE.replace(",", ";").replace(".", ",") + "\n")[1][0])


def test_thousands_separators_are_no_decimal_commas() -> None:
    decoder, rows = read("t;ax;ay;az;gx;gy;gz\n1,234.5;0;0;9.8;0;0;0.1\n")
    assert len(rows) == 0
    assert decoder.counts.bad_messages == 1


@pytest.mark.parametrize(
    "text",
    [
        "ax,ay,az,gx,gy,gz\n0,01,0,02,9,81,0,5,0,5,0,5\n",
        "ax\tay\taz\tgx\tgy\tgz\n0,01\t0,02\t9,81\t0,5\t0,5\t0,5\n",
        "ax ay az gx gy gz\n0,01 0,02 9,81 0,5 0,5 0,5\n",
    ],
)
def test_other_decimal_commas_are_refused_in_words(text: str) -> None:
    decoder, rows = read(text)
    assert len(rows) == 0
    assert decoder.counts.bad_messages == 1
    assert any("decimal commas?" in text for _, _, text in decoder.log.entries())


def test_a_repeated_header_is_chatter_and_another_one_is_taken() -> None:
    decoder, rows = read(f"{HEADER}\n{LINE}\n{HEADER}\n{LINE}\nax,ay,az,gx,gy,gz\n1,2,9.5,0,0,0.1\n")
    assert len(rows) == 3
    assert rows["acc"][2].tolist() == [1.0, 2.0, 9.5]
    assert not decoder.has_time
    assert decoder.counts.bad_messages == 0
    assert sum("columns changed" in text for _, _, text in decoder.log.entries()) == 1


@pytest.mark.parametrize(
    "line", [LINE.replace("1.00", "nan"), LINE + ",5", LINE[:-6], LINE.replace("1.00", "abc"), "nan" + LINE[4:]]
)
def test_damaged_lines_are_bad(line: str) -> None:
    decoder, rows = read(f"{HEADER}\n{line}\n{LINE}\n")
    assert len(rows) == 1
    assert decoder.counts.bad_messages == 1


def test_nan_words_and_a_last_delimiter_are_read() -> None:
    _, rows = read(f"{HEADER}\n" + LINE.replace("0.21,0.03,-0.44", "NaN,nan,nan") + f"\n{LINE},\n")
    assert len(rows) == 2
    assert np.isnan(rows["mag"][0]).all()


def test_text_in_a_column_that_is_not_used_does_not_matter() -> None:
    _, rows = read("device,ax,ay,az,gx,gy,gz\nleft hand,0,0,9.8,0,0,0.1\n")
    assert len(rows) == 1


def test_an_impossible_status_is_bad() -> None:
    decoder, rows = read("ax,ay,az,gx,gy,gz,status\n0,0,9.8,0,0,0.1,70000\n0,0,9.8,0,0,0.1,7\n")
    assert rows["status"].tolist() == [7]
    assert decoder.counts.impossible == 1


def test_a_wrong_unit_is_doubted() -> None:
    decoder, rows = read("ax,ay,az,gx,gy,gz\n" + "0.01,0.02,1.0,0.1,0.1,0.1\n" * 200)
    assert len(rows) == 200
    assert "mostly 0.102 g: is its unit right?" in decoder.seen


def test_prose_with_a_name_or_two_is_no_header() -> None:
    decoder, _ = read(
        "the columns ax, ay and lat of this long sentence, time permitting, are not a header, or are they?\n"
    )
    assert decoder.seen == "no header line yet"
    assert decoder.counts.chatter == 1


def test_encoder_loses_no_digit() -> None:
    random = np.random.default_rng(2)
    rows = empty_rows(SAMPLE, 50)
    rows["t"] = np.cumsum(random.random(50))
    for field in ("gyr", "acc", "mag"):
        rows[field] = random.normal(1.0, 3.0, (50, 3))
    rows["mag"][::3] = np.nan
    rows["lat"], rows["lon"], rows["speed"] = 50 + random.random(50), 12 + random.random(50), random.random(50)
    encoder = CsvLineEncoder(with_position=True)
    _, back = read(encoder.preamble() + encoder.encode(rows))
    rows["t_arrival"] = 3.0
    assert all(np.array_equal(back[name], rows[name], equal_nan=True) for name in SAMPLE.names)


def test_encoder_names_the_position_once_there_is_one() -> None:
    rows = empty_rows(SAMPLE, 2)
    rows["t"], rows["acc"], rows["gyr"] = (0.0, 0.1), 9.0, 0.5
    encoder = FORMATS["csv-line"].encoder()
    text = encoder.preamble() + encoder.encode(rows)
    assert text.startswith(b"t,ax,ay,az,gx,gy,gz,mx,my,mz,temp_c,status\r\n0.0,9.0,9.0,9.0,0.5,0.5,0.5,,,,,\r\n")
    rows["lat"], rows["lon"] = 50.0, 12.0
    text += encoder.encode(rows)
    assert text.count(b"lat,lon") == 1
    decoder, back = read(text)
    assert back["lat"][2:].tolist() == [50.0, 50.0]
    assert decoder.counts.bad_messages == 0


@pytest.mark.parametrize(
    ("file", "samples", "rate_hz"),
    [
        ("boards/xio-known-turns.csv", 6959, 256.0),
        ("boards/triplets-startup1-moving.csv", 142, None),
        ("boards/triplets-startup3-quiet.csv", 140, None),
        ("calibration/broad11_slow_translation_30s.csv", 2857, 95.2),
        ("gnss/vn100_circles_imu.csv", 2530, 40.0),
    ],
)
def test_recorded_tables(data_dir: Path, file: str, samples: int, rate_hz: float | None) -> None:
    decoder, rows = read((data_dir / file).read_bytes())
    assert decoder.counts.samples == len(rows) == samples
    assert decoder.counts.bad_messages == 0
    assert np.median(np.linalg.norm(rows["acc"], axis=1)) == pytest.approx(GRAVITY, rel=0.1)
    assert decoder.has_time == (rate_hz is not None)
    if rate_hz:
        assert (samples - 1) / (rows["t"][-1] - rows["t"][0]) == pytest.approx(rate_hz, rel=0.02)


def test_raw_counts_in_a_table_are_impossible_until_their_scale_is_named(data_dir: Path) -> None:
    data = (data_dir / "calibration/mpu6050_multiposition.csv").read_bytes()[:50_000]
    decoder, rows = read(data)
    assert len(rows) == 0
    assert decoder.counts.impossible > 1000
    columns = tuple(f"a{axis}_g/16384" for axis in "xyz") + tuple(f"g{axis}_dps/131" for axis in "xyz")
    decoder, rows = read(data, Options(columns=columns))
    assert np.median(np.linalg.norm(rows["acc"], axis=1)) == pytest.approx(GRAVITY, rel=0.1)
    assert decoder.counts.impossible == 0


def test_a_table_with_another_naming_is_refused_in_words(data_dir: Path) -> None:
    decoder, rows = read((data_dir / "gnss/car_50hz_gnss10hz.csv").read_bytes()[:20_000])
    assert len(rows) == 0
    assert decoder.seen.endswith("no column for gx, gy, gz")
