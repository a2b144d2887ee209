"""Tasks, mappings and targets in words, as the cards of the Target page say them."""

from __future__ import annotations

from imugui.targeting.settings import POSITION, PRESETS, TOGGLE, Control
from imugui.targeting.tasks import AUTO, BUTTON, DWELL, Task, sequences
from imugui.targeting.trials import Trial

CUSTOM = "custom"

SELECTIONS = {
    AUTO: "Selected as soon as it matches: no error is possible, so throughput is nominal.",
    BUTTON: "You select with Enter: errors count, throughput is effective.",
    DWELL: "Selected after it has matched for {dwell:g} s: no error is possible, so throughput is nominal.",
}


def task_words(task: Task) -> str:
    """What a task asks for."""
    if task.sized:
        what = f"{task.targets} squares to match in place and size within {task.tolerance_px:g} px of a 600 px field."
    else:
        count = len(sequences(task))
        rings = "one ring" if count == 1 else f"{count} rings"
        what = f"Jumps across {rings} of {task.ring_targets} circles (ISO 9241-411)."
    return f"{what} {SELECTIONS[task.selection].format(dwell=task.dwell_s)}"


def control_words(control: Control) -> str:
    """How the hand steers."""
    position = control.mapping == POSITION
    what = "An angle is a place" if position else "An angle is a speed"
    unit = "px" if position else "px/s"
    parts = [f"{what}: {control.gain:g} {unit} per degree"]
    if control.dead_zone_deg > 0.0:
        parts.append(f"dead zone {control.dead_zone_deg:g}°")
    if control.lag_s > 0.0:
        parts.append(f"lag {control.lag_s:g} s")
    if control.dead_time_s > 0.0:
        parts.append(f"dead time {control.dead_time_s:g} s")
    parts.append("a press latches" if control.latch == TOGGLE else "hold to run")
    return ", ".join(parts) + "."


def control_name(control: Control) -> str:
    """The name of the preset, or that it is none."""
    return next((name for name, preset in PRESETS.items() if preset == control), CUSTOM)


def trial_words(trial: Trial) -> tuple[str, str]:
    """Tone of a target that was done, and how it went."""
    parts = ["missed" if trial.error else "hit", f"{trial.movement_time_s:.1f} s", count(trial.activations, "press")]
    if trial.overshoots:
        parts.append(count(trial.overshoots, "overshoot"))
    return "bad" if trial.error else "good", ", ".join(parts)


def count(number: int, what: str) -> str:
    """A number of things."""
    many = f"{what}es" if what.endswith("s") else f"{what}s"
    return f"{number} {what if number == 1 else many}"
