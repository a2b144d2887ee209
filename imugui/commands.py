"""The commands that need no window: what each is told, and what it does. TASKS has them under their names."""

from __future__ import annotations

import argparse
import json
import math
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from imugui import __version__
from imugui.calibration.profile_file import ProfileError, load
from imugui.cli import OK, REFUSED, fail, write_report
from imugui.fields import from_words
from imugui.formats import FORMATS, Options
from imugui.formats.ble_profiles import BLE_PROFILES
from imugui.formats.column_map import NOT_USED
from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.recording import UnreadableError, read_samples, samples_file, write_attitude
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.simulation.motions import MOTIONS

# ports


def _add_ports(one: argparse.ArgumentParser) -> None:
    one.add_argument("--seconds", type=float, default=3.0, help="how long to listen for Bluetooth boards; 0: do not")
    one.add_argument("--all", action="store_true", help="list Bluetooth devices that are no known boards, too")


def _ports(arguments: argparse.Namespace) -> int:
    from imugui.workers.serial_transport import list_ports

    ports = list_ports()
    for port in ports:
        print(port.device, port.description, port.hint, sep="\t", flush=True)
    if not ports:
        print("No serial port found: plug a board in (some cables only charge).", file=sys.stderr)
    if arguments.seconds > 0.0:
        _list_bluetooth(arguments.seconds, arguments.all)
    return OK


def _list_bluetooth(seconds: float, everything: bool) -> None:
    from imugui.workers.ble_list import found_boards

    lines, remark = found_boards(seconds, everything)
    for line in lines:
        print(line)
    if remark:
        print(remark, file=sys.stderr)


# simulate


def _add_simulate(one: argparse.ArgumentParser) -> None:
    one.add_argument("--format", choices=list(FORMATS), default="accel-lines")
    one.add_argument("--motion", choices=[name for name in MOTIONS if name != "hand"], default="free")
    one.add_argument("--errors", choices=list(PRESETS), default="mpu9250")
    one.add_argument("--seed", type=int, default=1)
    one.add_argument("--port-link", type=Path, help="a steady name for the port")
    one.add_argument("--ble", action="store_true", help="an emulated Bluetooth board on a private bus instead (Linux)")


def _simulate(arguments: argparse.Namespace) -> int:
    if arguments.ble or FORMATS[arguments.format].framed:
        return _simulate_ble(arguments)
    from imugui.simulation.pty_board import PtyBoard
    from imugui.simulation.pty_port import PtyPort
    from imugui.simulation.wire import real_board

    port = PtyPort(arguments.port_link)
    try:
        port.open()
    except OSError as error:
        return fail(str(error))
    wire = real_board(arguments.format, arguments.motion, PRESETS[arguments.errors], arguments.seed)
    print(f"{arguments.format} at {wire.board.rate_hz:g} Hz on {port.path}  (Ctrl-C stops)", flush=True)
    PtyBoard(wire, port, time.monotonic()).run_until(_stop_signal())
    port.close()
    return OK


def _stop_signal() -> threading.Event:
    """Set by Ctrl-C, or when the process is asked to end."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    return stop


def _simulate_ble(arguments: argparse.Namespace) -> int:
    from imugui.simulation.ble import missing

    kinds = {profile.format: kind for kind, profile in BLE_PROFILES.items()}
    if not arguments.ble:
        return fail(f"{arguments.format} is spoken over Bluetooth only: add --ble.")
    if arguments.format not in kinds:
        return fail(f"{arguments.format} is not spoken over Bluetooth. There are {', '.join(kinds)}.")
    if lacking := missing():
        return fail(lacking)
    from imugui.simulation.ble.lab import BleLab

    rate_hz = FORMATS[arguments.format].rate_hz
    board = VirtualBoard(arguments.motion, rate_hz, PRESETS[arguments.errors], arguments.seed)
    try:
        with BleLab(exported=False) as lab:
            card = lab.add_board(kinds[arguments.format], board=board)
            print(f"{card.name} ({card.address}), {arguments.format} at {rate_hz:g} Hz  (Ctrl-C stops). Reach it with:")
            print(f"DBUS_SYSTEM_BUS_ADDRESS={lab.address} imugui live --ble {card.name}", flush=True)
            _stop_signal().wait()
    except OSError as error:
        return fail(str(error))
    return OK


# replay


def _add_fusion(one: argparse.ArgumentParser) -> None:
    one.add_argument("--format", default="auto", choices=["auto", *FORMATS])
    one.add_argument("--filter", choices=list(FILTERS), help=f"default {DEFAULT_FILTER}, or the recorded one")
    text = "one of the filter's parameters, such as gyr_latency_ms=2.4; any number of times"
    one.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="chosen", help=text)
    one.add_argument("--no-mag", action="store_true", help="do not use the magnetometer")
    text = "leave force and field out while the board's button moves"
    one.add_argument("--spike-mask", action="store_true", help=text)
    text = "a table's columns with units, such as t_ms,ax_g,ay_g,az_g,,gx_dps,gy_dps,gz_dps; an empty name skips one"
    one.add_argument("--columns", type=_columns, default=Options(), metavar="NAMES", help=text)


def _columns(text: str) -> Options:
    return Options(columns=tuple(name.strip() or NOT_USED for name in text.split(",")))


def _filter_params(arguments: argparse.Namespace) -> Any:
    """The chosen filter's parameters; ValueError in words when what was set is none of them."""
    name = arguments.filter or DEFAULT_FILTER
    try:
        return from_words(FILTERS[name].Params, arguments.chosen)
    except ValueError as error:
        raise ValueError(f"--set for the filter {name}: {error}") from None


def _add_replay(one: argparse.ArgumentParser) -> None:
    one.add_argument("file", type=Path)
    _add_fusion(one)
    one.add_argument("--rate", type=float, help="samples per second of a capture without times, Hz")
    one.add_argument("--profile", type=Path, help="apply this board's calibration")
    one.add_argument("--out", type=Path, required=True, help="the attitude CSV to write")


def _replay(arguments: argparse.Namespace) -> int:
    try:
        params = _filter_params(arguments)
    except ValueError as error:
        return fail(str(error))
    try:
        name = arguments.filter or DEFAULT_FILTER
        path = samples_file(arguments.file)
        capture = read_samples(path, arguments.format, arguments.columns, arguments.rate or 0.0)
        if missing := missing_sensors(capture.rows):
            return fail(f"{path}: no attitude without {missing}. Found: {capture.decoder.seen}")
        correction = _correction(arguments.profile, capture.rows) if arguments.profile else None
        pipeline = Pipeline(name, params, correction, not arguments.no_mag, spike_mask=arguments.spike_mask)
        metadata = {"imugui": __version__, "source": arguments.file.name, "format": capture.format}
        metadata |= {"filter": name, "frame": "ENU, sensor to earth", "found": capture.decoder.seen}
        metadata |= {"profile": arguments.profile.name} if arguments.profile else {}
        write_attitude(arguments.out, pipeline.steps(capture.rows), metadata)
    except OSError as error:
        return fail(f"{error.filename or arguments.file}: {error.strerror or error}")
    except (UnreadableError, ProfileError) as error:
        return fail(str(error))
    counts = capture.decoder.counts
    print(f"{counts.samples} samples, {counts.bad_messages} bad messages, {capture.format}: {capture.decoder.seen}")
    print(f"{name}: {pipeline.mag_updates} magnetometer measurements, {pipeline.restarts} restarts")
    return OK


def missing_sensors(rows: Rows) -> str:
    """Which sensor that an attitude needs is in none of the SAMPLE rows, in words; "" when none is missing."""
    needed = {"acc": "an accelerometer", "gyr": "a gyroscope"}
    return " and ".join(words for name, words in needed.items() if not np.isfinite(rows[name]).any())


def _correction(path: Path, rows: Rows) -> Correction:
    """What a profile makes of these SAMPLE rows, at their own temperature; raises ProfileError and OSError."""
    known = rows["temp_c"][np.isfinite(rows["temp_c"])]
    return load(path).correction(float(np.median(known)) if len(known) else math.nan)


# calibrate


def _add_calibrate(one: argparse.ArgumentParser) -> None:
    one.add_argument("what", choices=["gyr", "acc", "mag"])
    one.add_argument("files", type=Path, nargs="+", metavar="FILE", help="recordings, sample CSVs or captures")
    one.add_argument("--out", type=Path, required=True, help="the profile to write, JSON")
    one.add_argument("--profile", type=Path, help="a profile whose other parts are kept")
    one.add_argument("--certificate", type=Path, help="also write the certificate here, HTML")
    one.add_argument("--name", help="what to call the board")
    one.add_argument("--method", choices=["many", "six", "flat", "free-fall"], default="many", help="acc: which way")
    one.add_argument("--whole-turns", action="store_true", help="gyr: the file holds turns of exactly 360 degrees")
    one.add_argument("--field", type=float, metavar="UT", help="mag: the field expected at the place, microtesla")
    one.add_argument("--format", default="auto", choices=["auto", *FORMATS])
    one.add_argument("--columns", type=_columns, default=Options(), metavar="NAMES", help="as in replay")
    one.add_argument("--rate", type=float, help="samples per second of a capture without times, Hz")


def _calibrate(arguments: argparse.Namespace) -> int:
    from imugui.calibrate import RefusedError, calibrate, order_of

    try:
        print(calibrate(order_of(arguments)))
    except RefusedError as refusal:
        fail(f"refused: {refusal}")
        return REFUSED
    except (UnreadableError, ProfileError) as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"{error.filename or arguments.out}: {error.strerror or error}")
    return OK


# verify


def _add_verify(one: argparse.ArgumentParser) -> None:
    one.add_argument("recording", type=Path)


def _verify(arguments: argparse.Namespace) -> int:
    from imugui.workers.verify import verify

    try:
        result = verify(arguments.recording)
    except (UnreadableError, OSError) as error:
        return fail(str(error))
    print(result.sentence)
    return OK


# live


def _add_live(one: argparse.ArgumentParser) -> None:
    where = one.add_mutually_exclusive_group(required=True)
    where.add_argument("--port", help="a serial port, or any URL that pyserial takes")
    where.add_argument("--ble", metavar="NAME", help="a Bluetooth board, by its name or its address")
    where.add_argument("--recording", type=Path, help="a file, at the speed it was made")
    where.add_argument("--simulate", choices=list(MOTIONS), help="the virtual board, without a port")
    _add_fusion(one)
    one.add_argument("--baud", type=int, default=0, help="0 finds it")
    one.add_argument("--rate", type=float, default=0.0, help="samples per second of the virtual board, Hz")
    one.add_argument("--seconds", type=float, default=math.inf, help="how long; without it until Ctrl-C")
    one.add_argument("--report", type=Path, help="write the figures here, as JSON")
    one.add_argument("--record", type=Path, help="record into this new folder (NAME.imugui)")


def _live(arguments: argparse.Namespace) -> int:
    from imugui.workers.headless import run_session
    from imugui.workers.session import Source

    places = {"serial": arguments.port, "ble": arguments.ble, "replay": arguments.recording}
    places["simulator"] = arguments.simulate
    kind, address = next((kind, str(place)) for kind, place in places.items() if place)
    follow = arguments.filter is None and not arguments.chosen
    try:
        params = _filter_params(arguments)
    except ValueError as error:
        return fail(str(error))
    source = Source(
        kind, address, arguments.format, arguments.baud, arguments.columns, rate_hz=arguments.rate, follow=follow
    )
    fusion = {"filter_name": arguments.filter or DEFAULT_FILTER, "params": params, "use_mag": not arguments.no_mag}
    result = run_session(source, fusion, arguments.spike_mask, arguments.seconds, arguments.record)
    if arguments.report:
        try:
            write_report(arguments.report, result.report)
        except OSError as error:
            return fail(f"{arguments.report}: {error.strerror}")
    print(json.dumps(result.report))
    return OK if result.report["samples"] else fail(result.sentence)


# demo


def _add_demo(one: argparse.ArgumentParser) -> None:
    one.add_argument("--out", type=Path, default=Path("demo-out"), help="folder for report.json and screenshots")
    one.add_argument("--seconds", type=float, default=6.0)


def _demo(arguments: argparse.Namespace) -> int:
    from imugui.demo import run_demo

    return run_demo(arguments.out, arguments.seconds)


# study


def _add_study(one: argparse.ArgumentParser) -> None:
    what = one.add_subparsers(dest="what", required=True, metavar="simulate|report")
    text = "simulated people play position against speed, and the report is written"
    made = what.add_parser("simulate", help=text, description=text)
    made.add_argument("--out", type=Path, required=True, metavar="DIR", help="a new or an empty folder")
    made.add_argument("--participants", type=int, default=6)
    made.add_argument("--blocks", type=int, default=3, help="of each condition, after a practice run")
    made.add_argument("--runs", type=int, default=1, help="in a block")
    made.add_argument("--seed", type=int, default=1, help="the same seed gives the same targets and people")
    made.add_argument("--resume", action="store_true", help="go on with the one in DIR, as it was planned")
    told = what.add_parser("report", help="write report.html and runs.csv of a study into its folder")
    told.add_argument("folder", type=Path, metavar="DIR")


def _study(arguments: argparse.Namespace) -> int:
    from imugui import study
    from imugui.targeting.study_store import StudyError

    one, folder = arguments, arguments.folder if arguments.what == "report" else arguments.out
    try:
        if one.what == "report":
            print(study.report(folder))
        else:
            order = (folder, one.participants, one.blocks, one.runs, one.seed, one.resume)
            print(study.simulate(*order, lambda line: print(line, file=sys.stderr, flush=True)))
    except StudyError as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"{error.filename or folder}: {error.strerror or error}")
    return OK


Add = Callable[[argparse.ArgumentParser], None]
Run = Callable[[argparse.Namespace], int]

TASKS: dict[str, tuple[Add, Run]] = {
    "demo": (_add_demo, _demo),
    "ports": (_add_ports, _ports),
    "simulate": (_add_simulate, _simulate),
    "live": (_add_live, _live),
    "verify": (_add_verify, _verify),
    "calibrate": (_add_calibrate, _calibrate),
    "study": (_add_study, _study),
    "replay": (_add_replay, _replay),
}
