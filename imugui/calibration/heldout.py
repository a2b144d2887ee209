"""Old calibration against new one, on blocks of samples that the new one was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from imugui.calibration.ellipsoid import FEWEST, Ellipsoid, Floats, spread
from imugui.calibration.geometric import Prior, with_prior

BLOCKS = 5
GOOD_OLD = 0.03  # an old calibration with a smaller residual is only replaced by a clearly better one
CLEARLY = 0.8  # the new residual over the old one, at most


@dataclass(frozen=True)
class Comparison:
    """Residuals (shares of the field, outliers left out) of old and new on held-out blocks."""

    old: float
    new: float

    @property
    def keep_old(self) -> bool:
        """Whether the old calibration is still the better choice."""
        return self.new > (CLEARLY * self.old if self.old < GOOD_OLD else self.old)

    @property
    def sentence(self) -> str:
        """The comparison in words."""
        choice = "the old one is kept" if self.keep_old else "the new one is better"
        old, new = 100 * self.old, 100 * self.new
        return f"Field even to {old:.1f} % with the old calibration, {new:.1f} % with the new: {choice}."


def compare(old: Ellipsoid, points: Floats, prior: Prior) -> Comparison:
    """Compare on raw points (n, 3), in the order in which they were taken; n >= 2 * FEWEST."""
    blocks = np.array_split(np.arange(len(points)), BLOCKS)
    shares = []
    for block in blocks:
        rest = np.delete(points, block, axis=0)
        if len(rest) >= FEWEST and len(block):
            fit = with_prior(rest, prior)
            shares.append(fit.distances(points[block]) / fit.radius)
    lengths = np.linalg.norm(old.apply(points), axis=1)
    return Comparison(spread(lengths / np.median(lengths) - 1.0), spread(np.concatenate(shares)))
