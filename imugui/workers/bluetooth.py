"""Bluetooth of a session: its own, or another session's. Nothing of it is imported before it is used: start-up time."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from imugui.workers.ble_loop import Radio
    from imugui.workers.ble_scan import Scan


class Bluetooth:
    """Makes the radio when it is first asked for, and stops it if it made it."""

    def __init__(self, shared: Radio | None) -> None:
        """``shared``: a radio that its owner stops."""
        self._radio, self._shared = shared, shared is not None
        self._stopped = False

    @property
    def radio(self) -> Radio:
        """Bluetooth's thread."""
        if self._radio is None:
            from imugui.workers.ble_loop import Radio

            self._radio = Radio()
            if self._stopped:
                self._radio.stop()
        return self._radio

    def scan(self) -> Scan:
        """A search for boards, to be started."""
        from imugui.workers.ble_scan import Scan

        return Scan(self.radio)

    def stop(self) -> None:
        """Leave all boards; a shared radio goes on."""
        self._stopped = not self._shared
        if self._radio is not None and not self._shared:
            self._radio.stop()
