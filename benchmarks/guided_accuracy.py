"""What a guided reading is worth: captured axis error against the simulator's truth, and the sigma it was given.

A simulated person with a trembling hand is guided through random plans by what the target shows, and registers again
when asked. Prints one JSON line for each filter and way of registering, over all boards. ``within_sigma`` is the share
of errors within the error that was stated: 0.9 and more by its meaning.

    python3 run.py bench guided_accuracy [--boards 10] [--plans 30] [--steepest 45] [--filter vqf imugui]
                                         [--no-thermometer] [--raw-gyroscope] [--preset Vehicle] [--told]
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import numpy as np

from imugui.fusion import FILTERS
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.trust_profile import RAW_TURN_SHARE, TURN_SHARE, prior_holds, profile_facts
from imugui.simulation.errors import PRESETS
from imugui.simulation.tool_user import ToolUser, random_plans

CALIBRATED = PRESETS["mpu9250-calibrated"]
RAW_GYROSCOPE = replace(CALIBRATED, gyr_scale_percent=3.0, gyr_cross_percent=1.75)
WARM_UP_S = 120.0


def board_facts(filter_name: str, params: Any, thermometer: bool, raw_gyroscope: bool) -> Callable[[float], Facts]:
    """What the page would say of a calibrated board that warms up; ``now`` in s."""
    worth = profile_facts(None, datetime.now(UTC), use_mag=False, factory=True)
    if raw_gyroscope:
        worth["turn_share"] = RAW_TURN_SHARE
    worth["prior_holds"] = prior_holds(worth["turn_share"], params)

    def facts(now: float) -> Facts:
        warm = CALIBRATED.temp_c + CALIBRATED.warm_up_c * -math.expm1(-now / WARM_UP_S)
        said = {**worth, "temp_c": warm if thermometer else math.nan}
        return Facts(now=now, streaming=True, filter=filter_name, **said)

    return facts


def measure(filter_name: str, method: str, args: argparse.Namespace) -> dict[str, object]:
    """All boards with one filter, registered one way; degrees."""
    params = FILTERS[filter_name].PRESETS.get(args.preset, FILTERS[filter_name].Params())
    if args.told and hasattr(params, "matrix_worst"):
        params = replace(params, matrix_worst=RAW_TURN_SHARE if args.raw_gyroscope else TURN_SHARE)
    facts = board_facts(filter_name, params, not args.no_thermometer, args.raw_gyroscope)
    board_errors = RAW_GYROSCOPE if args.raw_gyroscope else CALIBRATED
    errors, sigmas, means, registrations, seconds = [], [], [], 0, 0.0
    for seed in range(args.boards):
        user = ToolUser(Guide(), facts, seed, method, board_errors, 100.0, filter_name, params)
        taken = list(user.run(random_plans(args.plans, args.steepest, seed)))
        own = [one.true_error_deg for one in taken]
        errors += own
        sigmas += [one.reading.sigma_deg for one in taken]
        means.append(float(np.mean(own)))
        registrations, seconds = registrations + user.registrations, seconds + user.now
    return {
        "registration": method,
        "preset": args.preset,
        "told": args.told,
        "filter": filter_name,
        "boards": args.boards,
        "readings": f"{len(errors)} of {args.boards * args.plans}",
        "mean_deg": round(float(np.mean(errors)), 3),
        "p95_deg": round(float(np.percentile(errors, 95)), 3),
        "max_deg": round(float(np.max(errors)), 3),
        "worst_board_mean_deg": round(max(means), 3),
        "mean_sigma_deg": round(float(np.mean(sigmas)), 3),
        "within_sigma": round(float(np.mean(np.array(errors) <= np.array(sigmas))), 3),
        "registrations_per_board": round(registrations / args.boards, 1),
        "seconds_per_board": round(seconds / args.boards, 1),
    }


def main() -> None:
    """Read the arguments and measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boards", type=int, default=10)
    parser.add_argument("--plans", type=int, default=30)
    parser.add_argument("--steepest", type=float, default=45.0, help="total tilt, degrees")
    parser.add_argument("--filter", nargs="+", choices=tuple(FILTERS), default=("vqf", "imugui"))
    parser.add_argument("--no-thermometer", action="store_true")
    parser.add_argument("--preset", default="Default", help="of the filter, where it has one of that name")
    parser.add_argument("--told", action="store_true", help="the filter knows how well the gyroscope is calibrated")
    parser.add_argument("--raw-gyroscope", action="store_true", help="off by up to 3 % and 1 degree")
    args = parser.parse_args()
    for filter_name, method in itertools.product(args.filter, ("axes", "mark")):
        print(json.dumps(measure(filter_name, method, args)), flush=True)


if __name__ == "__main__":
    main()
