"""What Qt needs of the system: find what is missing, install it or say how. Used by run.py; standard library only."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import platform
import shutil
import subprocess
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple


class Need(NamedTuple):
    """One thing the system must have: ``kind`` is a key of CHECKS, ``group`` tells which runs need it."""

    name: str
    kind: str
    group: str
    debian: str
    fedora: str
    arch: str


# Read off the libQt6*.so.6 of PySide6 6.11 and its platform plugins offscreen ("core"), xcb ("x11") and wayland.
NEEDS = """
ensurepip               module   core     python3-venv         python3-libs         python
libEGL.so.1             library  core     libegl1              libglvnd-egl         libglvnd
libGL.so.1              library  core     libgl1               libglvnd-glx         libglvnd
libX11.so.6             library  core     libx11-6             libX11               libx11
libbrotlidec.so.1       library  core     libbrotli1           libbrotli            brotli
libdbus-1.so.3          library  core     libdbus-1-3          dbus-libs            dbus
libfontconfig.so.1      library  core     libfontconfig1       fontconfig           fontconfig
libfreetype.so.6        library  core     libfreetype6         freetype             freetype2
libgssapi_krb5.so.2     library  core     libgssapi-krb5-2     krb5-libs            krb5
libgthread-2.0.so.0     library  core     libglib2.0-0         glib2                glib2
libxkbcommon.so.0       library  core     libxkbcommon0        libxkbcommon         libxkbcommon
libzstd.so.1            library  core     libzstd1             libzstd              zstd
fonts                   font     look     fonts-dejavu-core    dejavu-sans-fonts    ttf-dejavu
libX11-xcb.so.1         library  x11      libx11-xcb1          libX11-xcb           libx11
libxcb-cursor.so.0      library  x11      libxcb-cursor0       xcb-util-cursor      xcb-util-cursor
libxcb-glx.so.0         library  x11      libxcb-glx0          libxcb               libxcb
libxcb-icccm.so.4       library  x11      libxcb-icccm4        xcb-util-wm          xcb-util-wm
libxcb-image.so.0       library  x11      libxcb-image0        xcb-util-image       xcb-util-image
libxcb-keysyms.so.1     library  x11      libxcb-keysyms1      xcb-util-keysyms     xcb-util-keysyms
libxcb-randr.so.0       library  x11      libxcb-randr0        libxcb               libxcb
libxcb-render-util.so.0 library  x11      libxcb-render-util0  xcb-util-renderutil  xcb-util-renderutil
libxcb-render.so.0      library  x11      libxcb-render0       libxcb               libxcb
libxcb-shape.so.0       library  x11      libxcb-shape0        libxcb               libxcb
libxcb-shm.so.0         library  x11      libxcb-shm0          libxcb               libxcb
libxcb-sync.so.1        library  x11      libxcb-sync1         libxcb               libxcb
libxcb-util.so.1        library  x11      libxcb-util1         xcb-util             xcb-util
libxcb-xfixes.so.0      library  x11      libxcb-xfixes0       libxcb               libxcb
libxcb-xkb.so.1         library  x11      libxcb-xkb1          libxcb               libxcb
libxkbcommon-x11.so.0   library  x11      libxkbcommon-x11-0   libxkbcommon-x11     libxkbcommon-x11
dbus-daemon             program  test     dbus-daemon          dbus-daemon          dbus
libwayland-client.so.0  library  wayland  libwayland-client0   libwayland-client    wayland
libwayland-cursor.so.0  library  wayland  libwayland-cursor0   libwayland-cursor    wayland
"""
LIKE = {"debian": "debian", "ubuntu": "debian", "fedora": "fedora", "rhel": "fedora", "arch": "arch"}
APT = "apt-get install -y --no-install-recommends"
INSTALL = {"debian": f"apt-get update && {APT}", "fedora": "dnf install -y", "arch": "pacman -S --needed"}
FONTS = ("/usr/share/fonts", "/usr/local/share/fonts", "~/.fonts", "~/.local/share/fonts")


def loads(name: str) -> bool:
    """Whether the dynamic linker finds this shared library, as it must for Qt."""
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def has_font(_name: str) -> bool:
    """Whether any font file is where fontconfig looks; folders that cannot be read count as empty."""
    walks = (os.walk(os.path.expanduser(place)) for place in FONTS)  # noqa: PTH111 (never raises)
    return any(
        name.lower().endswith((".ttf", ".otf", ".ttc")) for walk in walks for *_, names in walk for name in names
    )


CHECKS: dict[str, Callable[[str], bool]] = {
    "library": loads,
    "module": lambda name: importlib.util.find_spec(name) is not None,
    "program": lambda name: shutil.which(name) is not None,
    "font": has_font,
}


def missing(groups: Iterable[str], checks: Mapping[str, Callable[[str], bool]] = CHECKS) -> list[Need]:
    """The needs of these groups that the system does not have."""
    needs = (Need(*line.split()) for line in NEEDS.strip().splitlines())
    return [need for need in needs if need.group in groups and not checks[need.kind](need.name)]


def family_of(release: Mapping[str, str]) -> str:
    """The key of INSTALL for an os-release file; empty when it is another kind of Linux."""
    words = [release.get("ID", ""), *release.get("ID_LIKE", "").split()]
    return next((LIKE[word] for word in words if word in LIKE), "")


def packages(needs: Iterable[Need], family: str) -> list[str]:
    """The packages of one family of distributions that hold these needs, each once."""
    return list(dict.fromkeys(getattr(need, family) for need in needs))


def advice(needs: Sequence[Need], family: str, sudo: bool) -> str:
    """What to type to get these needs."""
    if not family:
        return f"install the packages that hold {', '.join(need.name for need in needs)}"
    start = "sudo " if sudo else ""
    return f"{start}{INSTALL[family].replace('&& ', '&& ' + start)} {' '.join(packages(needs, family))}"


def is_fatal(needs: Iterable[Need], groups: Iterable[str]) -> bool:
    """Whether nothing can start: Qt itself lacks a library, or every window system that could be used does."""
    hurt = {need.group for need in needs}
    windows = {"x11", "wayland"} & set(groups)
    return "core" in hurt or (bool(windows) and windows <= hurt)


def apt_install(names: Sequence[str]) -> str:
    """Install Debian packages as root; what went wrong, in words, or nothing.

    The package lists are fetched only when the first try shows that they are old or not there.
    """
    environ = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    install = [*APT.split(), *names]
    output = ""
    for command in (install, ["apt-get", "update"], install):
        done = subprocess.run(  # noqa: S603 (the names are those of NEEDS)
            command, env=environ, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        if command is install and done.returncode == 0:
            return ""
        output = done.stdout
    return "apt-get could not install them: " + " / ".join(output.splitlines()[-3:])


def os_release() -> Mapping[str, str]:
    """What this Linux says of itself; nothing where it does not."""
    try:
        return platform.freedesktop_os_release()
    except OSError:
        return {}


def check_system(groups: Sequence[str], say: Callable[[str], None]) -> bool:
    """Install what is missing when root on Debian or Ubuntu, else say how; whether the program can start."""
    needs = missing(groups)
    if not needs:
        return True
    family, is_root = family_of(os_release()), os.geteuid() == 0
    if family == "debian" and is_root:
        say(f"installing system packages: {' '.join(packages(needs, family))}")
        trouble = apt_install(packages(needs, family))
        if trouble:
            say(trouble)
        needs = missing(groups)
    if needs:
        say(f"this system lacks {', '.join(need.name for need in needs)}; to get what is missing:")
        say(f"  {advice(needs, family, not is_root)}")
    return not is_fatal(needs, groups)
