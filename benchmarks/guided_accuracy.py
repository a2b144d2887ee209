"""What a guided reading is worth: captured axis error against the simulator's truth, and the sigma it was given.

A simulated person with a trembling hand is guided through random plans by what the target shows, and registers again
when asked. Prints one JSON line for each way of registering, over all boards.

    python3 run.py bench guided_accuracy [--boards 10] [--plans 30] [--steepest 45] [--filter vqf] [--no-thermometer]
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable
from datetime import UTC, datetime

import numpy as np

from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.trust_profile import profile_facts
from imugui.simulation.errors import PRESETS
from imugui.simulation.tool_user import ToolUser, random_plans

ERRORS = "mpu9250-calibrated"
WARM_UP_S = 120.0


def board_facts(filter_name: str, thermometer: bool) -> Callable[[float], Facts]:
    """What the page would say of a calibrated board that warms up; ``now`` in s."""
    worth = profile_facts(None, datetime.now(UTC), use_mag=False, factory=True)

    def facts(now: float) -> Facts:
        warm = PRESETS[ERRORS].temp_c + PRESETS[ERRORS].warm_up_c * -math.expm1(-now / WARM_UP_S)
        said = {**worth, "temp_c": warm if thermometer else math.nan}
        return Facts(now=now, streaming=True, filter=filter_name, **said)

    return facts


def measure(method: str, args: argparse.Namespace) -> dict[str, object]:
    """All boards registered one way; degrees."""
    facts = board_facts(args.filter, not args.no_thermometer)
    errors, sigmas, means, registrations, seconds = [], [], [], 0, 0.0
    for seed in range(args.boards):
        user = ToolUser(Guide(), facts, seed, method, PRESETS[ERRORS], filter_name=args.filter)
        taken = list(user.run(random_plans(args.plans, args.steepest, seed)))
        own = [one.true_error_deg for one in taken]
        errors += own
        sigmas += [one.reading.sigma_deg for one in taken]
        means.append(float(np.mean(own)))
        registrations, seconds = registrations + user.registrations, seconds + user.now
    return {
        "registration": method,
        "filter": args.filter,
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
    parser.add_argument("--filter", default="vqf")
    parser.add_argument("--no-thermometer", action="store_true")
    args = parser.parse_args()
    for method in ("axes", "mark"):
        print(json.dumps(measure(method, args)), flush=True)


if __name__ == "__main__":
    main()
