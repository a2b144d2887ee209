"""What the starter finds missing in the system, and what it says to do. Nothing is installed."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent


@pytest.fixture
def system(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(REPOSITORY)
    return importlib.import_module("run_system")


def lacking(*names: str) -> dict[str, Callable[[str], bool]]:
    """Checks of a system that has everything but these."""
    return dict.fromkeys(("library", "module", "program", "font"), lambda name: name not in names)


def test_every_need_is_whole_and_named_once(system: ModuleType) -> None:
    rows = [line.split() for line in system.NEEDS.strip().splitlines()]
    assert {len(row) for row in rows} == {6}
    assert len({row[0] for row in rows}) == len(rows)
    assert {row[1] for row in rows} <= set(system.CHECKS)


def test_only_the_groups_of_the_run_are_looked_at(system: ModuleType) -> None:
    checks = lacking("libxcb-cursor.so.0", "libEGL.so.1")
    assert [need.name for need in system.missing(("core",), checks)] == ["libEGL.so.1"]
    assert [need.name for need in system.missing(("core", "x11"), checks)] == ["libEGL.so.1", "libxcb-cursor.so.0"]


def test_a_library_is_looked_for_as_the_linker_does(system: ModuleType) -> None:
    assert not system.loads("libno-such-library.so.0")
    assert system.CHECKS["module"]("json")
    assert not system.CHECKS["module"]("no_such_module")
    assert not system.CHECKS["program"]("no-such-program")


@pytest.mark.parametrize(
    ("release", "family"),
    [
        ({"ID": "debian"}, "debian"),
        ({"ID": "ubuntu", "ID_LIKE": "debian"}, "debian"),
        ({"ID": "linuxmint", "ID_LIKE": "ubuntu debian"}, "debian"),
        ({"ID": "rocky", "ID_LIKE": "rhel centos fedora"}, "fedora"),
        ({"ID": "manjaro", "ID_LIKE": "arch"}, "arch"),
        ({"ID": "nixos"}, ""),
        ({}, ""),
    ],
)
def test_the_distribution_is_found(system: ModuleType, release: dict[str, str], family: str) -> None:
    assert system.family_of(release) == family


@pytest.mark.parametrize(
    ("family", "sudo", "said"),
    [
        (
            "debian",
            True,
            "sudo apt-get update && sudo apt-get install -y --no-install-recommends libxcb-randr0 libxcb-shm0",
        ),
        (
            "debian",
            False,
            "apt-get update && apt-get install -y --no-install-recommends libxcb-randr0 libxcb-shm0",
        ),
        ("fedora", True, "sudo dnf install -y libxcb"),
        ("arch", True, "sudo pacman -S --needed libxcb"),
        ("", True, "install the packages that hold libxcb-randr.so.0, libxcb-shm.so.0"),
    ],
)
def test_the_command_to_type_is_exact(system: ModuleType, family: str, sudo: bool, said: str) -> None:
    needs = system.missing(("x11",), lacking("libxcb-randr.so.0", "libxcb-shm.so.0"))
    assert system.advice(needs, family, sudo) == said


@pytest.mark.parametrize(
    ("name", "groups", "fatal"),
    [
        ("libEGL.so.1", ("core", "look"), True),
        ("libxcb-cursor.so.0", ("core", "look", "x11"), True),
        ("libxcb-cursor.so.0", ("core", "look", "wayland", "x11"), False),
        ("fonts", ("core", "look", "x11"), False),
    ],
)
def test_only_what_keeps_qt_from_starting_stops_the_run(
    system: ModuleType, name: str, groups: tuple[str, ...], fatal: bool
) -> None:
    needs = system.missing(groups, lacking(name))
    assert [need.name for need in needs] == [name]
    assert system.is_fatal(needs, groups) is fatal
