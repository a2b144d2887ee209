"""Serial ports of every kind that pyserial opens: USB, pty, loop://, socket://, rfc2217://."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import Any

from imugui.workers.port_errors import PORT_ERRORS
from imugui.workers.transport import Source, Transport

READ_TIMEOUT_S = 0.1
NETWORK_TIMEOUT_S = 0.01  # in_waiting says only 0 or 1 on a socket, so a bounded block is read instead
NETWORK_BLOCK = 4096


@dataclass(frozen=True)
class Port:
    """One entry of the list of ports."""

    device: str
    description: str
    hint: str  # what the USB chip tells of the board, or ""


KNOWN_CHIPS = {
    (0x1A86, 0x7523): "CH340, on many Arduino Nano copies",
    (0x1A86, 0x55D4): "CH9102",
    (0x0403, 0x6001): "FTDI FT232",
    (0x0403, 0x6015): "FTDI FT231X",
    (0x10C4, 0xEA60): "CP210x, as on the motion card's scanner",
    (0x2341, 0x0043): "Arduino Uno",
    (0x2341, 0x0001): "Arduino Uno",
    (0x2341, 0x0042): "Arduino Mega",
    (0x2341, 0x8036): "Arduino Leonardo",
    (0x239A, 0x800B): "Adafruit Feather",
    (0x303A, 0x1001): "ESP32 with native USB",
    (0x2E8A, 0x000A): "Raspberry Pi Pico",
}


def list_ports() -> list[Port]:
    """Serial ports of this computer, those that can be a board first."""
    from serial.tools.list_ports import comports  # imported when used: start-up time

    ports = [_port(info) for info in comports() if "Bluetooth-Incoming" not in info.device]
    return sorted(ports, key=lambda port: (not port.hint, port.device))


def serial_number(device: str) -> str:
    """The USB serial number of the board on a port, by which it is known again; "" when it has none."""
    from serial.tools.list_ports import comports

    return next((str(info.serial_number) for info in comports() if info.device == device and info.serial_number), "")


UsbBoard = tuple[int, int, str]
"""What tells one board from all others: kind of chip, and its serial number or, without one, the socket it is in."""


def usb_boards() -> dict[str, UsbBoard]:
    """The USB boards that can be told apart, by port."""
    from serial.tools.list_ports import comports

    found = ((info, info.serial_number or info.location) for info in comports() if info.vid is not None)
    return {info.device: (info.vid, info.pid, str(mark)) for info, mark in found if mark}


def _port(info: Any) -> Port:
    hint = KNOWN_CHIPS.get((info.vid, info.pid), "USB" if info.vid is not None else "")
    description = info.description if info.description not in (None, "n/a") else ""
    return Port(info.device, description, hint)


class SerialTransport(Transport):
    """One serial port."""

    retries = True

    def __init__(self, source: Source) -> None:
        self.address = source.address
        self.baud = source.baud
        self.title = source.address  # what it is called now: a board may come back under another name
        self._board: UsbBoard | None = None
        self._port: Any = None
        self._network = source.address.startswith(("socket://", "rfc2217://"))

    def open(self) -> None:
        from serial import serial_for_url

        if not self._network:
            self._look_for_it()
        timeout = NETWORK_TIMEOUT_S if self._network else READ_TIMEOUT_S
        port = serial_for_url(self.title, do_not_open=True, timeout=timeout, baudrate=self.baud or 115200)
        with contextlib.suppress(AttributeError, ValueError, NotImplementedError):
            port.exclusive = True  # two programs on one port would each get half of the bytes
        port.open()
        self._port = port

    def _look_for_it(self) -> None:
        """Find the board again where it came back under another name, as /dev/ttyUSB1 instead of /dev/ttyUSB0."""
        boards = usb_boards()
        if self._board is None:
            self._board = boards.get(self.address)
        elif boards.get(self.title) != self._board:
            self.title = next((device for device, board in boards.items() if board == self._board), self.address)

    def set_baud(self, baud: int) -> None:
        """Listen at another rate; raises one of PORT_ERRORS."""
        self.baud = baud
        if self._port is not None:
            self._port.baudrate = baud
            self._port.reset_input_buffer()

    def read(self) -> bytes:
        wanted = NETWORK_BLOCK if self._network else self._port.in_waiting or 1
        return bytes(self._port.read(wanted))

    def close(self) -> None:
        port, self._port = self._port, None
        if port is not None:
            with contextlib.suppress(*PORT_ERRORS):
                port.close()
