"""Every situation of Bluetooth has its own sentence and next step, on each system."""

from __future__ import annotations

import math
import sys
from dataclasses import replace

import pytest

pytest.importorskip("bleak")
from bleak.exc import BleakBluetoothNotAvailableError as NotAvailableError
from bleak.exc import BleakBluetoothNotAvailableReason as Reason
from bleak.exc import (
    BleakCharacteristicNotFoundError,
    BleakDBusError,
    BleakDeviceNotFoundError,
    BleakError,
    BleakGATTProtocolError,
)

from imugui.workers.ble_errors import REMEDIES, RULES, SENTENCES, TIMEOUTS, explain_ble, kind_of, lost, problem
from imugui.workers.ble_loop import BoardInUseError
from imugui.workers.verdict import Facts, State, Verdict, judge

D = "org.freedesktop.DBus.Error."
B = "org.bluez.Error."
SYSTEMS = ("linux", "win32", "darwin")


@pytest.mark.parametrize(
    ("error", "kind"),
    [
        (FileNotFoundError(2, "No such file or directory"), "no_bus"),
        (ConnectionRefusedError(111, "Connection refused"), "no_service"),
        (EOFError(), "no_service"),
        (
            BleakDBusError(D + "ServiceUnknown", ["The name org.bluez was not provided by any .service files"]),
            "no_service",
        ),
        (BleakDBusError(D + "Spawn.ChildExited", ["Process org.bluez exited with status 1"]), "no_service"),
        (BleakDBusError(D + "NoReply", ["Remote peer disconnected"]), "no_service"),
        (NotAvailableError("No Bluetooth adapters found.", Reason.NO_BLUETOOTH), "no_adapter"),
        (NotAvailableError("No adapters with BLE 'central' role", Reason.NO_BLE_CENTRAL_ROLE), "classic"),
        (NotAvailableError("No powered Bluetooth adapters found.", Reason.POWERED_OFF), "off"),
        (BleakDBusError(B + "NotReady", ["Resource Not Ready"]), "off"),
        (BleakDBusError(B + "Failed", ["Input/output error"]), "off"),
        (BleakDBusError(D + "AccessDenied", ["Rejected send message, 2 matched rules"]), "denied"),
        (NotAvailableError("REJECTED", Reason.DENIED_BY_SYSTEM), "denied"),
        (NotAvailableError("The user said no", Reason.DENIED_BY_USER), "denied"),
        (PermissionError(13, "Permission denied"), "denied"),
        (BleakDeviceNotFoundError("AA", "Device with address AA was not found."), "forgotten"),
        (BleakError("device 'dev_F0_F1' not found"), "forgotten"),
        (BleakDBusError(D + "UnknownObject", ['Method "Connect" with signature ""']), "forgotten"),
        (BleakDBusError(B + "Failed", ["le-connection-abort-by-local"]), "away"),
        (BleakDBusError(B + "AlreadyConnected", ["Already Connected"]), "refused"),
        (BleakError("failed to discover services, device disconnected"), "dropped"),
        (BleakError("Service Discovery has not been performed yet"), "dropped"),
        (BleakError("Could not get GATT services: Unreachable"), "dropped"),
        (BleakGATTProtocolError(14), "dropped"),
        (BleakGATTProtocolError(5), "pairing"),
        (BleakError("Could not get GATT services: Access Denied"), "pairing"),
        (BleakDBusError(B + "NotPermitted", ["Not paired"]), "pairing"),
        (BleakCharacteristicNotFoundError("bf470002"), "wrong_board"),
        (BleakDBusError(B + "NotSupported", ["Operation is not supported"]), "wrong_board"),
        (BleakDBusError(B + "InProgress", ["Operation already in progress"]), "stuck"),
        (BleakError("Bleak requires BlueZ >= 5.55."), "old_service"),
        (BleakError("Thread is configured for Windows GUI but callbacks are not working."), "thread"),
        (ModuleNotFoundError("No module named 'bleak'"), "no_library"),
        (BoardInUseError("AA"), "ours"),
        (OSError(-2147020577, "The device is not ready for use"), "no_adapter"),
        (OSError(24, "Too many open files"), "other"),
        (BleakError("something new"), "other"),
        (TimeoutError(), "timeout"),
    ],
)
def test_what_is_raised_is_known(error: Exception, kind: str) -> None:
    assert kind_of(error) == kind


@pytest.mark.parametrize(("stage", "kind"), TIMEOUTS.items())
def test_a_time_limit_means_what_was_being_done(stage: str, kind: str) -> None:
    assert explain_ble(TimeoutError(), "CARD", stage).kind == kind


@pytest.mark.parametrize("system", SYSTEMS)
def test_each_kind_has_a_sentence_of_its_own_with_a_next_step(system: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", system)
    said = {kind: problem(kind, "CARD", "F0:F1", "a detail").sentence for kind in SENTENCES}
    assert len(set(said.values())) == len(SENTENCES)
    for kind, sentence in said.items():
        assert "{" not in sentence, kind
        assert "  " not in sentence.replace("bleak  and", ""), kind
        assert sentence.endswith("."), kind


def test_systems_differ_where_their_remedies_do(monkeypatch: pytest.MonkeyPatch) -> None:
    for kind, remedies in REMEDIES.items():
        said = set()
        for system in SYSTEMS:
            monkeypatch.setattr(sys, "platform", system)
            sentence = problem(kind, "CARD", "F0:F1").sentence
            assert remedies.get(system, "").format(address="F0:F1").strip() in sentence
            said.add(sentence)
        assert len(said) >= len(remedies)


def test_every_rule_names_a_sentence() -> None:
    kinds = {kind for _, _, kind in RULES} - {"timeout", "forgotten"} | set(TIMEOUTS.values())
    assert kinds <= set(SENTENCES)
    assert set(REMEDIES) <= set(SENTENCES)


def test_a_command_names_the_board(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    assert "bluetoothctl disconnect F0:F1." in problem("elsewhere", "CARD", "F0:F1").sentence


@pytest.mark.parametrize(
    ("rssi_dbm", "battery_percent", "words"),
    [
        (-50.0, 87.0, "out of reach or was switched off (its battery was at 87 %)"),
        (-50.0, math.nan, "out of reach or was switched off. "),
        (-93.0, 87.0, "its signal was weak (-93 dBm)"),
        (math.nan, 4.0, "its battery was at 4 %"),
    ],
)
def test_a_loss_gives_the_probable_reason(rssi_dbm: float, battery_percent: float, words: str) -> None:
    assert words in lost("CARD", rssi_dbm, battery_percent).sentence


@pytest.mark.parametrize(
    ("kind", "state"),
    [
        ("away", State.AWAY),
        ("dropped", State.AWAY),
        ("elsewhere", State.TAKEN),
        ("ours", State.TAKEN),
        ("off", State.NO_BLUETOOTH),
        ("no_service", State.NO_BLUETOOTH),
        ("denied", State.DENIED),
        ("wrong_board", State.FAILED),
    ],
)
def test_a_board_that_was_never_connected_has_a_state_of_its_own(kind: str, state: State) -> None:
    said = problem(kind, "CARD")
    facts = Facts(5.0, "lost", "CARD", said.sentence, problem_kind=kind, wireless=True)
    assert judge(facts) == Verdict(state, said.sentence)
    assert judge(replace(facts, opened=1.0)).state is State.LOST


def test_a_wireless_board_is_not_said_to_have_a_cable() -> None:
    silent = Facts(9.0, "open", "CARD", opened=1.0, wireless=True)
    stalled = replace(silent, byte_t=2.0, sample_t=2.0)
    for facts, state in ((silent, State.SILENT), (stalled, State.STALLED)):
        verdict = judge(facts)
        assert verdict.state is state
        assert not any(word in verdict.sentence for word in ("cable", "port", "sketch", "byte"))
