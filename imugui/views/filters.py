"""The filter as the user set it: from the settings to the session and back."""

from __future__ import annotations

import dataclasses
from typing import Any

from imugui.fields import from_mapping
from imugui.fusion import FILTERS
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session


def kept_params(settings_store: SettingsStore, name: str) -> Any:
    """The parameters the user last gave to a filter, else its own."""
    params, _ = from_mapping(FILTERS[name].Params, settings_store.store.filters.get(name, {}))
    return params


def use_filter(session: Session, settings_store: SettingsStore, name: str) -> None:
    """Swap the filter, with the parameters the user last gave it."""
    settings_store.update(filter=name)
    session.set_filter(name, kept_params(settings_store, name), session.use_mag)


def use_params(session: Session, settings_store: SettingsStore, params: Any) -> None:
    """Give the present filter other parameters; the delays of the connected board are kept with its profile."""
    if session.set_params(params):
        settings_store.keep_filter(session.filter_name, dataclasses.asdict(session.general_params(params)))


def use_spike_mask(session: Session, settings_store: SettingsStore, on: bool) -> None:
    """Leave the accelerometer out while the board's button moves, or not."""
    settings_store.update(spike_mask=on)
    session.set_spike_mask(on)


def use_magnetometer(session: Session, settings_store: SettingsStore, on: bool) -> None:
    """Let the magnetometer correct the heading, or not."""
    settings_store.update(use_mag=on)
    session.set_filter(session.filter_name, session.filter_params, on)
