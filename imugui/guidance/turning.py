"""Turning: how far a gyroscope's scale and cross-axis errors may have turned the heading."""

from __future__ import annotations

import numpy as np

from imugui.fusion.quaternion import Floats, conjugate, multiply, rotate, to_rotation_vector

UP = (0.0, 0.0, 1.0)


class Turning:
    """Integrates T = sum of up * step^T over the turns between attitudes, with up the earth's vertical in the box.

    A gyroscope that reads (1 + S) times the true rate turns the heading wrongly by sum over i, j of S_ij T_ij (to
    first order: the error of a step is S step, of which the heading takes the part about the vertical; the rest is
    tilt, which the accelerometer takes back). If the nine S_ij are independent with 1 sigma s, the heading's 1 sigma
    is s |T|. So turning to and fro about one axis costs nothing in the end, and turning on and on costs s times all.
    """

    def __init__(self) -> None:
        self._sum: Floats = np.zeros((3, 3))
        self._last: Floats = np.zeros((0, 4))

    def step(self, quats: Floats) -> None:
        """Go on through unit attitudes (n, 4), box -> earth, in order."""
        chain = np.concatenate((self._last, quats))
        if len(chain) > 1:
            steps = to_rotation_vector(multiply(conjugate(chain[:-1]), chain[1:]))
            up = rotate(conjugate(chain), UP)
            self._sum += 0.5 * (up[:-1] + up[1:]).T @ steps
        self._last = chain[-1:]

    def reset(self) -> None:
        """From here on: the heading has just been registered."""
        self._sum = np.zeros((3, 3))

    @property
    def size(self) -> float:
        """|T| (Frobenius) in rad."""
        return float(np.linalg.norm(self._sum))
