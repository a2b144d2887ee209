"""The two row types that travel from port to pixel, with their units.

Every block of n rows is one numpy structured array; ``rows["gyr"]`` is (n, 3).
A value the board does not send is NaN (``status``: -1).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[Any]
"""A structured array of SAMPLE or ATTITUDE rows, shape (n,)."""

GRAVITY = 9.80665
"""Standard gravity, m/s2 per g."""

NO_STATUS = -1

SAMPLE = np.dtype(
    [
        ("t", "f8"),  # s, time the sample was taken: the board's own clock or the rebuilt one (fusion/timing.py)
        ("t_arrival", "f8"),  # s, host monotonic time at which its bytes arrived; NaN in files
        ("gyr", "f8", (3,)),  # rad/s
        ("acc", "f8", (3,)),  # m/s2, specific force: about +9.81 along the axis that points up
        ("mag", "f8", (3,)),  # uT, in the accelerometer's axes
        ("temp_c", "f8"),  # degrees Celsius
        ("status", "i2"),  # the board's status or button byte
        ("lat", "f8"),  # degrees north
        ("lon", "f8"),  # degrees east
        ("alt", "f8"),  # m
        ("speed", "f8"),  # m/s over ground
        ("course_deg", "f8"),  # degrees clockwise from north, over ground
    ]
)

ATTITUDE = np.dtype(
    [
        ("t", "f8"),  # s, the sample's time
        ("t_arrival", "f8"),  # s, host monotonic time at which its bytes arrived
        ("t_publish", "f8"),  # s, host monotonic time at which this row was published; NaN in batch
        ("quat", "f8", (4,)),  # (w, x, y, z), rotation sensor -> earth (east, north, up)
        ("local", "f8", (4,)),  # the shown attitude: q0^-1 * quat with the user's origin q0
        ("gyr", "f8", (3,)),  # rad/s, corrected and without the filter's bias
        ("acc", "f8", (3,)),  # m/s2, corrected
        ("mag", "f8", (3,)),  # uT, corrected; NaN without a magnetometer
        ("bias", "f8", (3,)),  # rad/s, the filter's gyroscope bias
        ("mag_used", "?"),  # this row carried a new magnetometer measurement that was fed to the filter
        ("rest", "?"),
        ("disturbed", "?"),  # the magnetic field is not the earth's alone
        ("sigma_tilt", "f8"),  # rad, 1 sigma; NaN when the filter does not know
        ("sigma_heading", "f8"),  # rad, 1 sigma; NaN when the filter does not know
        ("status", "i2"),
        ("masked", "?"),  # the button moved: acc is that of before, neither it nor mag was fed to the filter
    ]
)


def empty_rows(dtype: np.dtype[Any], n: int) -> Rows:
    """n rows in which every float is NaN, every flag False and every status NO_STATUS."""
    rows = np.zeros(n, dtype)
    for name in dtype.names or ():
        kind = dtype[name].base.kind
        if kind == "f":
            rows[name] = np.nan
        elif kind == "i":
            rows[name] = NO_STATUS
    return rows
