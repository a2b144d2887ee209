"""Good inputs of every kind, made by the program itself: what a fuzzer spoils."""

from __future__ import annotations

import dataclasses
import json
import shutil
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np

from imugui.calibration import profile_file
from imugui.calibration.parts import (
    AccelerometerPart,
    GyroscopePart,
    MagnetometerPart,
    MountingPart,
    NoisePart,
    TemperaturePart,
)
from imugui.calibration.profile import Board, Profile
from imugui.formats import FORMATS, STREAM_FORMATS
from imugui.fusion import FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.guidance import plan_file, session_file
from imugui.guidance.aiming import axis_error
from imugui.guidance.plan import Plan, direction
from imugui.guidance.reading import Reading
from imugui.guidance.registration import from_axes
from imugui.recording.events import Event, to_line
from imugui.recording.folder import ABOUT, ATTITUDE, EVENTS, RAW, SAMPLES, FolderWriter
from imugui.samples import Rows
from imugui.settings import Settings, Store, save
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS
from imugui.targeting import study_store
from imugui.targeting.questionnaires import Answer
from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan, as_mapping, codes
from imugui.targeting.trials import Trial, trials_csv

FILES = Path(__file__).resolve().parent.parent / "tests" / "data"
RECORDED = (ABOUT, SAMPLES, ATTITUDE, EVENTS, RAW)
DATE = "2026-11-01T12:00:00+00:00"
CLOCK = {"raw": 0.0, "t": 0.0, "offset": 0.0, "period": 0.01}
LEAST_STUDY = StudyPlan(codes(2), name="pilot", blocks=2, runs=1, practice_runs=0, preference=False)


@cache
def rows(n: int = 120) -> Rows:
    """A board in the hand."""
    return VirtualBoard("free", 100.0, PRESETS["mpu9250"], 3).rows(n)


def stream(name: str) -> list[bytes]:
    """What a board of this format sends."""
    encoder = FORMATS[name].encoder()
    data = encoder.encode(rows(40))
    size = FORMATS[name].message_bytes
    return [data[:size], data[size : 3 * size]] if size else [encoder.preamble() + data, data[:500], b"\r\n" + data]


def streams() -> list[bytes]:
    """What the boards of all formats send, and banners."""
    return [one for name in STREAM_FORMATS for one in stream(name)] + [b"MPU9250 device error\r\n" * 40, b"\xff" * 99]


def tables() -> list[bytes]:
    """Tables of other programs, and streams as files."""
    foreign = [path.read_bytes()[:4000] for path in sorted(FILES.rglob("*.csv"))]
    return [*foreign, *(stream(name)[0] for name in STREAM_FORMATS)]


@cache
def recording(home: Path) -> Path:
    """A recording with everything in it, made from a virtual board."""
    folder = home / "one.imugui"
    shutil.rmtree(folder, ignore_errors=True)
    writer = FolderWriter(folder, {"label": "walk", "source": {}, "format": "csv-line", "started_utc": DATE})
    pipeline = Pipeline("complementary")
    state = {"pipeline": pipeline.state(), "format": "csv-line", "clock": CLOCK}
    encoder = FORMATS["csv-line"].encoder()
    writer.samples(rows())
    writer.attitude(pipeline.step(rows().copy()))
    writer.events([Event("start", 0.0, 0, "", state), *changes()])
    writer.raw([(0.0, b""), (0.1, encoder.preamble()), (1.2, encoder.encode(rows()))])
    writer.close({"rows": len(rows()), "missed_rows": 0})
    return folder


def changes() -> list[Event]:
    """What a user did while it was recorded."""
    settings = {"carry_on": True, "pipeline": Pipeline("mahony").settings()}
    quat = {"quat": [1.0, 0.0, 0.0, 0.0]}
    return [
        Event("filter", 0.2, 20, "mahony", settings),
        Event("origin", 0.3, 30, "set", quat),
        Event("restart", 0.4, 40),
        Event("marker", 0.5, 50, "here"),
        Event("guidance", 0.5, 50, "reading", {"first_attitude": 0, "reading": reading().to_dict()}),
        Event("game", 0.6, 55, "begin", {"first_attitude": 0, "settings": {}, "inputs": []}),
    ]


def recorded_files() -> list[bytes]:
    """Every file of that recording, after a byte that says which it is."""
    import _fuzz_targets as targets  # it needs this module first

    folder = recording(targets.home())
    return [bytes([number]) + (folder / name).read_bytes() for number, name in enumerate(RECORDED)]


def events() -> list[bytes]:
    """The events of a recording, with the state of every filter."""
    found = []
    for name in FILTERS:
        pipeline = Pipeline(name)
        pipeline.step(rows(120)[:60].copy())
        start = Event("start", 0.0, 0, "", {"pipeline": pipeline.state(), "format": "csv-line", "clock": {}})
        found.append("".join(map(to_line, (start, *changes()))).encode())
    return found


def settings_files() -> list[bytes]:
    """Settings with a board's columns and a filter's parameters."""
    import _fuzz_targets as targets

    table = {"columns": ["t_ms", "ax_g", "ay_g", "az_g", "gx_dps", "gy_dps", "gz_dps"], "delimiter": ",", "file": "a"}
    filters = {name: dataclasses.asdict(kind.Params()) for name, kind in FILTERS.items()}
    save(targets.home() / "seed.json", Store(Settings(), filters, {"usb": {"family": "mpu9250", "tables": [table]}}))
    return [(targets.home() / "seed.json").read_bytes(), b"{}"]


def profiles() -> list[bytes]:
    """Profiles with every part and with none."""
    full = Profile(
        Board("serial", "ABC/123", "Müllers probe"),
        GyroscopePart("at rest", DATE, 25.0, 500, "good", "fine", bias=(0.01, -0.02, 0.03), matrix_method="turns"),
        AccelerometerPart("many", DATE, positions=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), tilt_deg=0.02),
        MagnetometerPart("tukey", DATE, hard_iron=(1.0, 2.0, 3.0), cells=(0, 5, 99), predicted_deg=0.5, dip_deg=65.0),
        MountingPart("level, nose up", DATE),
        TemperaturePart("linear", DATE, coefficients=((0.0, 0.0, 0.0), (0.1, 0.0, 0.0))),
        NoisePart("Allan deviation", DATE, rate_hz=99.3),
        rate_hz=100.0,
    )
    return [profile_file.to_text(one).encode() for one in (full, Profile(Board("ble", "x")))]


PLANS = (
    Plan(name="L4", side="left", axial_deg=20.0, sagittal_deg=10.0, depth_mm=40.0),
    Plan(name="box", kind="plain", yaw_deg=30.0),
)


def plans() -> list[bytes]:
    """Tables of plans, one with semicolons."""
    text = plan_file.write_plans(PLANS)
    return [text.encode(), text.replace(",", ";").encode("utf-16"), b"level;side;axial_deg;sagittal_deg\nL4;left;1;2\n"]


@cache
def reading() -> Reading:
    """A reading 1.2 degrees off its plan."""
    registration = from_axes((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), 1.0, ((0, 5), (6, 9)))
    plan, off = PLANS[0], dataclasses.replace(PLANS[0], axial_deg=21.2)
    way, wanted = (tuple(direction(one).tolist()) for one in (off, plan))
    error = float(np.degrees(axis_error(way, wanted)))
    return Reading(1, plan, way, wanted, error, 1.2, 0.1, 0.5, 2.0, (10, 90), registration, (1.0, 0.0, 0.0))


def guidance_sessions() -> list[bytes]:
    """A session with plans, a registration and a reading."""
    kept = session_file.Kept(PLANS, reading().registration, (0.6, 0.0, 0.8), 0.25, (reading(),))
    return [session_file.to_text(kept).encode()]


def study_plans() -> list[bytes]:
    """The plans of studies."""
    many = dataclasses.replace(LEAST_STUDY, conditions=MappingProxyType({**LEAST_STUDY.conditions}), order="same")
    return [json.dumps(as_mapping(plan)).encode() for plan in (LEAST_STUDY, many)]


def played() -> list[Trial]:
    """Every target of the study, as quick as it was meant to be."""
    return [
        Trial(
            "pilot", person, condition, block, run=1, index=index, from_x=0.0, from_y=0.0, from_size=100.0, to_x=50.0,
            to_y=9.0 * index, to_size=60.0, tolerance_px=9.0, amplitude_px=51.0, sel_x=51.0, sel_y=9.0 * index,
            sel_size=61.0, t_start=1.0, t_end=3.0, movement_time_s=2.0 + 0.1 * index + 0.3 * (condition == "speed"),
            pan_time_s=1.0, zoom_time_s=0.5, idle_time_s=0.2, activations=2, path_px=70.0, zoom_path=0.4,
            min_deg=(-1.0, -2.0, -3.0), max_deg=(4.0, 5.0, 6.0), max_rotation_deg=(7.0, 8.0),
        )
        for person in codes(2) for condition in LEAST_STUDY.conditions for block in (1, 2) for index in range(5)
    ]  # fmt: skip


@cache
def study(home: Path) -> Path:
    """The folder of a study that everybody has played."""
    folder = home / "study"
    shutil.rmtree(folder, ignore_errors=True)
    Study.create(folder, LEAST_STUDY)
    study_store.add_trials(folder, LEAST_STUDY, played())
    study_store.add_answer(folder, LEAST_STUDY, Answer("P01", "speed", "preference", ()))
    return folder


def study_files() -> list[bytes]:
    """Every file of that folder, after a byte that says which it is."""
    import _fuzz_targets as targets

    folder = study(targets.home())
    return [bytes([number]) + (folder / name).read_bytes() for number, name in enumerate(targets.STUDY_FILES)]


def trial_tables() -> list[bytes]:
    """Tables of targets, one of the ring task."""
    ring = [dataclasses.replace(one, task="ring", selection="button", width_px=20.0, from_size=1.0) for one in played()]
    return [trials_csv(one, {"study": "pilot"}).encode() for one in (played(), ring, played()[:3])]
