"""The table of states, read as a whole."""

from __future__ import annotations

import pytest

from imugui.targeting.states import ACTIVE, TABLE, Machine, State, Transition

EVENTS = sorted({event for row in TABLE.values() for event in row})


def after(*events: str) -> Machine:
    machine = Machine()
    for k, event in enumerate(events):
        machine.fire(event, 0.5 * k, f"because of {event}", "pan")
    return machine


def test_every_state_has_a_row_and_can_be_reached() -> None:
    assert set(TABLE) == set(State)
    assert {target for row in TABLE.values() for target in row.values()} == set(State)


def test_words_tell_the_states_apart() -> None:
    assert len({state.word for state in State}) == len(State)
    assert {state.tone for state in State} <= {"neutral", "good", "warn", "bad"}
    assert all(state.sentence.endswith(".") for state in State)


def test_only_alignment_leads_to_steering() -> None:
    ways = [(source, event) for source, row in TABLE.items() for event, to in row.items() if to is State.ENGAGED]
    assert ways == [(State.ALIGNING, "aligned")]


@pytest.mark.parametrize("state", State)
def test_the_emergency_stop_works_everywhere(state: State) -> None:
    assert TABLE[state].get("stop", state) is State.FAULT


@pytest.mark.parametrize("state", sorted(ACTIVE, key=lambda each: each.word))
def test_every_activation_can_end(state: State) -> None:
    ends = {event: TABLE[state][event] for event in ("release", "lost", "disarm")}
    assert ends == {"release": State.READY, "lost": State.HOLD, "disarm": State.DISARMED}


def test_a_fault_is_latched_and_takes_two_steps() -> None:
    machine = after("confirm", "press", "aligned", "stop")
    for event in EVENTS:
        if event != "reset":
            assert not machine.fire(event, 9.0, "", "")
    assert machine.state is State.FAULT
    assert machine.fire("reset", 9.0, "reset", "")
    for event in EVENTS:
        if event not in ("confirm", "stop"):
            assert not machine.fire(event, 9.0, "", "")
    assert machine.fire("confirm", 9.0, "confirmed", "")
    assert machine.state is State.READY


def test_from_hold_only_a_new_press_leads_on() -> None:
    machine = after("confirm", "press", "aligned", "lost")
    assert machine.state is State.HOLD
    assert not any(machine.fire(event, 9.0, "", "") for event in ("aligned", "clutch", "unclutch", "lost", "confirm"))
    assert machine.fire("press", 9.0, "pressed again", "zoom")


def test_every_transition_is_logged_with_its_cause() -> None:
    machine = after("confirm", "confirm", "press", "aligned")
    machine.note(2.0, machine.state, "refused", "zoom")
    assert machine.log == [
        Transition(0.0, State.DISARMED, State.READY, "because of confirm", "pan"),
        Transition(1.0, State.READY, State.ALIGNING, "because of press", "pan"),
        Transition(1.5, State.ALIGNING, State.ENGAGED, "because of aligned", "pan"),
        Transition(2.0, State.ENGAGED, State.ENGAGED, "refused", "zoom"),
    ]


def test_unknown_events_do_nothing() -> None:
    machine = after("confirm")
    assert not machine.fire("dance", 1.0, "", "")
    assert (machine.state, len(machine.log)) == (State.READY, 1)
