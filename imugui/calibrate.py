"""The command ``imugui calibrate``: the guided flows, fed from recordings in one go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from imugui.calibration.accelerometer import many
from imugui.calibration.accelerometer_flows import FLOWS
from imugui.calibration.build import accelerometer_part, gyroscope_part, magnetometer_part
from imugui.calibration.certificate import certificate_html
from imugui.calibration.flow import Result
from imugui.calibration.gyroscope import GyroscopeResult, gyroscope_matrix, scale_from_whole_turns, whole_turns
from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.calibration.parts import Part
from imugui.calibration.positions import positions_of, stops_of
from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_file import load, save
from imugui.calibration.rest import RestFlow
from imugui.calibration.stillness import Floats, Gathered, rate_of
from imugui.calibration.turns import turns_of
from imugui.formats import Options
from imugui.fusion.correction import Correction
from imugui.recording import read_samples, samples_file
from imugui.samples import Rows


class RefusedError(Exception):
    """The data do not bear a calibration; the message says why."""


@dataclass(frozen=True)
class Order:
    """What the command line asked for; ``field_ut`` 0 means not known, ``rate_hz`` 0 that of the format."""

    what: str
    files: tuple[Path, ...]
    out: Path
    profile: Path | None = None
    certificate: Path | None = None
    name: str = ""
    method: str = "many"
    whole_turns: bool = False
    field_ut: float = 0.0
    format: str = "auto"
    columns: Options = field(default_factory=Options)
    rate_hz: float = 0.0


def calibrate(order: Order) -> str:
    """Do it and write the profile; returns the verdict in words.

    Raises RefusedError, ProfileError, UnreadableError and OSError; then no file has been touched.
    """
    old = load(order.profile) if order.profile else Profile(Board("file", order.files[0].name))
    gathered = Gathered()
    blocks = []
    for path in order.files:
        rows = read_samples(samples_file(path), order.format, order.columns, order.rate_hz).rows
        gathered.feed(rows)
        blocks.append(rows)
    part, verdict = STEPS[order.what](order, old, gathered, blocks)
    rate = rate_of(gathered.rows)
    profile = replace(old.with_part(part), rate_hz=rate if rate > 0.0 else old.rate_hz)
    if order.name:
        profile = profile.renamed(order.name)
    save(order.out, profile)
    if order.certificate:
        order.certificate.write_text(certificate_html(profile, datetime.now(UTC)), encoding="utf-8")
    return verdict


def _gyr(order: Order, old: Profile, gathered: Gathered, blocks: list[Rows]) -> tuple[Part, str]:
    flow = RestFlow()
    for rows in blocks:
        flow.feed(rows)
    rest = flow.result()
    _need(rest)
    matrix = _gyr_matrix(order, old, gathered.rows)
    return gyroscope_part(rest, matrix), f"{rest.reason}\n{matrix.reason}"


def _gyr_matrix(order: Order, old: Profile, rows: Rows) -> GyroscopeResult:
    """Scale and cross-axis terms, if the recording holds the turns for them."""
    rows = rows[np.isfinite(rows["gyr"]).all(axis=1)]
    stops = stops_of(rows)
    turns = turns_of(rows, stops)
    if order.whole_turns:
        scale = scale_from_whole_turns(whole_turns(turns))
        _need(scale)
        return scale
    acc = old.correction()
    if old.accelerometer is None:
        found = many(positions_of(stops))
        acc = Correction(acc_bias=found.bias, acc_matrix=found.matrix) if found.accepted else acc
    return gyroscope_matrix(turns, acc)


def _acc(order: Order, old: Profile, gathered: Gathered, blocks: list[Rows]) -> tuple[Part, str]:
    flow = FLOWS[order.method]()
    for rows in blocks:
        flow.feed(rows)
    found = flow.result()
    _need(found, flow.missing)
    return accelerometer_part(found), found.reason


def _mag(order: Order, old: Profile, gathered: Gathered, blocks: list[Rows]) -> tuple[Part, str]:
    flow = MagnetometerFlow(order.field_ut or None, before=old.correction())
    for rows in blocks:
        flow.feed(rows)
    found = flow.result()
    _need(found)
    known = gathered.rows["temp_c"][np.isfinite(gathered.rows["temp_c"])]
    temp_c = float(known.mean()) if len(known) else float("nan")
    return magnetometer_part(found, _fields(blocks), temp_c), found.reason


def _fields(blocks: list[Rows]) -> Floats:
    """All raw fields (n, 3), uT, that are numbers."""
    fields = np.concatenate([rows["mag"] for rows in blocks])
    return np.asarray(fields[np.isfinite(fields).all(axis=1)])


STEPS: dict[str, Callable[[Order, Profile, Gathered, list[Rows]], tuple[Part, str]]] = {
    "gyr": _gyr,
    "acc": _acc,
    "mag": _mag,
}


def order_of(arguments: Any) -> Order:
    """The order in parsed arguments."""
    return Order(
        arguments.what,
        tuple(arguments.files),
        arguments.out,
        arguments.profile,
        arguments.certificate,
        arguments.name or "",
        arguments.method.replace("-", " "),
        arguments.whole_turns,
        arguments.field or 0.0,
        arguments.format,
        arguments.columns,
        arguments.rate or 0.0,
    )


def _need(result: Result, missing: tuple[str, ...] = ()) -> None:
    if not result.accepted:
        more = f" Still missing: {'; '.join(missing[:3])}." if missing else ""
        raise RefusedError(result.reason + more)
