"""T3: engaging moves nothing, exactly, whatever the hand did before; and what follows is a function of rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from imugui.fusion.quaternion import normalise
from imugui.fusion.scalar import Quat
from imugui.targeting.activation import Input
from imugui.targeting.controller import Controller
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.states import State
from imugui.targeting.view_pose import View

STILL = (0.0, 0.0, 0.0)
DT = 0.01

parts = st.floats(-1.0, 1.0)
quats = (
    st.tuples(parts, parts, parts, parts)
    .filter(lambda q: sum(x * x for x in q) > 1e-3)
    .map(lambda q: tuple(normalise(q).tolist()))
)
broken = st.just((float("nan"), 0.0, 0.0, 0.0))
near = st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)).map(
    lambda v: tuple(normalise((1.0, *v)).tolist())
)
inputs = st.lists(
    st.builds(
        Input,
        st.sampled_from(("press", "release", "confirm", "stop", "reset", "disarm", "stale")),
        st.sampled_from(("", "pan", "zoom", "clutch")),
    ),
    max_size=2,
).map(tuple)
rows = st.tuples(
    st.one_of(near, near, quats, broken),
    st.sampled_from((DT, DT, DT, 0.0, 0.013, 0.3, -5.0)),
    st.sampled_from((-1, 0, 1, 2)),
    inputs,
)
controls = st.builds(
    replace,
    st.sampled_from(list(PRESETS.values())),
    lag_s=st.sampled_from((0.0, 0.25, 10.0)),
    dead_time_s=st.sampled_from((0.0, 0.2)),
    smoothing=st.booleans(),
    mask_s=st.sampled_from((0.0, 0.02)),
    latch=st.sampled_from(("hold", "toggle")),
    roll_corrected=st.booleans(),
)
views = st.builds(View, st.floats(-700, 700), st.floats(-700, 700), st.floats(1, 2000))


def played(controller: Controller, history: list[tuple[Any, ...]]) -> float:
    """Arm, engage, and step through a history of rows; the time at its end."""
    t = engage(controller, 50.0, (1.0, 0.0, 0.0, 0.0), "pan")
    for quat, dt, status, given_inputs in history:
        t += dt
        controller.step(t, quat, (0.3, -0.2, 0.1), status, given_inputs)
    return t


def engage(controller: Controller, t: float, quat: Quat, button: str) -> float:
    """From any state: let go of everything, out of a fault, arm, press, and wait for the mask; the time then."""
    released = [Input("release", each) for each in ("", "pan", "zoom", "clutch")]
    armed = [Input(kind) for kind in ("disarm", "reset", "confirm")]
    for some in ((), (*released, *armed), (Input("press", button),), (), (), ()):
        t += DT
        controller.step(t, quat, STILL, -1, some)
    return t


@settings(max_examples=150)
@given(controls, views, st.lists(rows, max_size=25), quats, st.sampled_from(("pan", "zoom")))
def test_engaging_moves_nothing_at_all(
    control: Control, view: View, history: list[tuple[Any, ...]], quat: Quat, button: str
) -> None:
    controller = Controller(control, view)
    t = played(controller, history)
    before = controller.step(t + 1.0, quat, STILL, -1, (Input("disarm"),))
    t = engage(controller, t + 1.0, quat, button)
    assert (controller.state, controller.mode) == (State.ENGAGED, button)
    w, x, y, z = quat
    for same in (quat, (-w, -x, -y, -z)) * 30:  # through the ramp, and either sign of a quaternion
        t += DT
        assert controller.step(t, same, STILL, -1) == before


@settings(max_examples=100)
@given(controls, st.lists(rows, max_size=40))
def test_outside_an_engagement_nothing_moves(control: Control, history: list[tuple[Any, ...]]) -> None:
    controller = Controller(control, View(0.0, 0.0, 200.0))
    t, last = engage(controller, 50.0, (1.0, 0.0, 0.0, 0.0), "pan"), controller.view
    for quat, dt, status, given_inputs in history:
        t += dt
        view = controller.step(t, quat, (0.3, -0.2, 0.1), status, given_inputs)
        if controller.state is not State.ENGAGED or controller.log[-1].t == t:
            assert view == last
        assert (controller.mode == "") == (controller.state.name not in ("ALIGNING", "ENGAGED", "CLUTCHED"))
        last = view


@settings(max_examples=100)
@given(controls, st.lists(rows, max_size=40))
def test_the_same_rows_and_inputs_give_the_same_again(control: Control, history: list[tuple[Any, ...]]) -> None:
    def run() -> list[Any]:
        controller = Controller(control, View(0.0, 0.0, 200.0))
        t, seen = engage(controller, 50.0, (1.0, 0.0, 0.0, 0.0), "pan"), []
        for quat, dt, status, given_inputs in history:
            t += dt
            view = controller.step(t, quat, (0.3, -0.2, 0.1), status, given_inputs)
            seen.append((view, controller.state, controller.displacement_deg, controller.stages))
        return [seen, controller.log]

    assert run() == run()


def test_an_old_attitude_is_not_in_the_filters(new_hand: Callable[..., Any]) -> None:
    """The fault of the thesis' equations: a filter that still holds an attitude 10 degrees away, K = 8, 80 px."""
    for name, preset in PRESETS.items():
        hand = new_hand(replace(preset, latch="hold", lag_s=0.25))
        hand.engage()
        hand.turn(x=10.0)
        hand.row(Input("release", "pan"))
        view = hand.turn(x=-10.0, y=5.0)
        hand.row(Input("press", "pan"))
        assert hand.wait(1.0) == view, name
        assert hand.controller.state is State.ENGAGED
