"""What people say after a condition: work load (NASA TLX), usability (SUS) and which condition they prefer.

TLX: S. G. Hart, L. E. Staveland, Human Mental Workload (1988) 139; unweighted ("raw") form: S. G. Hart, HFES 50 (2006)
904. SUS: J. Brooke, Usability Evaluation in Industry (1996) 189; about 68 is average, and it is no percentage.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations


@dataclass(frozen=True)
class Scale:
    """One question with the words at its two ends."""

    title: str
    question: str
    low: str
    high: str


TLX: dict[str, Scale] = {
    "mental": Scale("Mental demand", "How much thinking, deciding and looking was needed?", "very little", "very much"),
    "physical": Scale("Physical demand", "How much effort of the body was needed?", "very little", "very much"),
    "temporal": Scale("Time pressure", "How hurried was the pace?", "not at all", "very"),
    "performance": Scale("Performance", "How well did you do what was asked?", "perfectly", "I failed"),
    "effort": Scale("Effort", "How hard did you have to work for it?", "not at all", "very hard"),
    "frustration": Scale("Frustration", "How insecure, annoyed or stressed were you?", "not at all", "very"),
}
TLX_STEP = 5
TLX_PAIRS: tuple[tuple[str, str], ...] = tuple(combinations(TLX, 2))
"""The 15 questions "which of the two counted more?" of the weighted form."""

SUS: tuple[str, ...] = (
    "I think that I would like to use this system frequently.",
    "I found the system unnecessarily complex.",
    "I thought the system was easy to use.",
    "I think that I would need the support of a technical person to be able to use this system.",
    "I found the various functions in this system were well integrated.",
    "I thought there was too much inconsistency in this system.",
    "I would imagine that most people would learn to use this system very quickly.",
    "I found the system very cumbersome to use.",
    "I felt very confident using the system.",
    "I needed to learn a lot of things before I could get going with this system.",
)
SUS_ENDS = ("strongly disagree", "strongly agree")


@dataclass(frozen=True)
class Answer:
    """What one person said: of ``condition``, or for "preference" which condition (empty: no preference)."""

    participant: str
    condition: str
    kind: str  # "tlx", "sus" or "preference"
    values: tuple[float, ...] = ()

    @property
    def score(self) -> float:
        """Raw TLX 0 to 100 (less is better), SUS 0 to 100 (more is better); NaN when it has none."""
        scorer = {"tlx": raw_tlx, "sus": sus}.get(self.kind)
        try:
            return scorer(self.values) if scorer else math.nan
        except ValueError:
            return math.nan


def raw_tlx(ratings: Sequence[float]) -> float:
    """Mean of the six ratings, 0 to 100 in steps of 5, in the order of TLX; raises ValueError for others."""
    _check_ratings(ratings)
    return sum(ratings) / len(TLX)


def weighted_tlx(ratings: Sequence[float], chosen: Sequence[str]) -> float:
    """Ratings weighted by how often each scale was chosen in the 15 pairs; raises ValueError for other choices."""
    _check_ratings(ratings)
    if len(chosen) != len(TLX_PAIRS) or any(one not in pair for one, pair in zip(chosen, TLX_PAIRS, strict=False)):
        raise ValueError(f"it needs one of each of the {len(TLX_PAIRS)} pairs")
    return sum(rating * chosen.count(name) for name, rating in zip(TLX, ratings, strict=True)) / len(TLX_PAIRS)


def sus(answers: Sequence[float]) -> float:
    """System usability 0 to 100 from ten answers 1 to 5, in the order of SUS; raises ValueError for others."""
    if len(answers) != len(SUS) or any(answer not in (1, 2, 3, 4, 5) for answer in answers):
        raise ValueError(f"SUS needs {len(SUS)} answers from 1 to 5")
    return 2.5 * sum(answer - 1 if k % 2 == 0 else 5 - answer for k, answer in enumerate(answers))


def preference_p(for_one: int, for_other: int) -> float:
    """Two-sided sign test that two conditions are liked alike; people without a preference are left out."""
    n, least = for_one + for_other, min(for_one, for_other)
    return min(1.0, 2 * sum(math.comb(n, k) for k in range(least + 1)) / 2.0**n)


def _check_ratings(ratings: Sequence[float]) -> None:
    if len(ratings) != len(TLX) or any(not 0 <= one <= 100 or one % TLX_STEP for one in ratings):
        raise ValueError(f"TLX needs {len(TLX)} ratings from 0 to 100 in steps of {TLX_STEP}")
