"""Who meets which condition when, with which targets; and what such a study can show.

Orders: E. J. Williams, Aust. J. Sci. Res. A 2 (1949) 149: each condition stands equally often at each place and after
each other one. For two conditions that is AB and BA.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from imugui.fusion.quaternion import Floats
from imugui.targeting.power import ALPHA, dz_needed, smallest_p

SYMMETRIES: tuple[tuple[tuple[int, int], tuple[int, int]], ...] = (
    ((1, 0), (0, 1)),
    ((-1, 0), (0, 1)),
    ((1, 0), (0, -1)),
    ((-1, 0), (0, -1)),
    ((0, 1), (1, 0)),
    ((0, -1), (1, 0)),
    ((0, 1), (-1, 0)),
    ((0, -1), (-1, 0)),
)
"""The ways to lay a square field on itself: a target list mirrored or turned by one has the same difficulty."""


@dataclass(frozen=True)
class Turn:
    """One person meets one condition."""

    participant: str
    place: int  # 0 is the first condition this person meets
    condition: int
    targets: int  # which variant of the target list: a place in SYMMETRIES


def williams(k: int) -> tuple[tuple[int, ...], ...]:
    """The balanced orders of k conditions: k rows for an even k, 2 k for an odd one. Raises ValueError below 1."""
    if k < 1:
        raise ValueError("a study needs a condition")
    first = [0, *((j + 1) // 2 if j % 2 else k - j // 2 for j in range(1, k))]
    rows = [tuple((one + shift) % k for one in first) for shift in range(k)]
    if k % 2 and k > 1:
        rows += [row[::-1] for row in rows]
    return tuple(rows)


def plan(participants: Sequence[str], conditions: int, same_targets: bool = False) -> tuple[Turn, ...]:
    """Every turn of a study, by person and place.

    Orders go round with the participants. Without ``same_targets`` each condition gets a list of its own, of equal
    difficulty, and after each full round of orders the lists move on to the next condition, so that neither a
    condition nor an order keeps the list that suits it.
    """
    orders = williams(conditions)
    turns = []
    for k, participant in enumerate(participants):
        shift = k // len(orders)
        for place, condition in enumerate(orders[k % len(orders)]):
            targets = 0 if same_targets else (condition + shift) % conditions % len(SYMMETRIES)
            turns.append(Turn(participant, place, condition, targets))
    return tuple(turns)


def people_for_balance(conditions: int, same_targets: bool = False) -> int:
    """The number of people (or a multiple of it) that uses every order with every list equally often."""
    return len(williams(conditions)) * (1 if same_targets else min(conditions, len(SYMMETRIES)))


def laid(xy: ArrayLike, variant: int) -> Floats:
    """The centres (n, 2) of a target list as its variant shows them; origin at the field's centre."""
    x, y = np.asarray(xy, float).reshape(-1, 2).T
    (a, b), (c, d) = SYMMETRIES[variant % len(SYMMETRIES)]
    return np.column_stack((a * x + b * y, c * x + d * y))


def shuffled(count: int, seed: int, *place: int) -> tuple[int, ...]:
    """0 to count - 1 in an order of chance fixed by the seed and the place (person, block, ...), for sequences."""
    return tuple(np.random.default_rng((seed, *place)).permutation(count).tolist())


def honesty(people: int, conditions: int, same_targets: bool = False) -> tuple[str, ...]:
    """What this number of people can and cannot show, one sentence each."""
    if people < 2 or conditions < 2:
        return ("One person or one condition compares nothing: the figures describe, they do not test.",)
    p, pairs = smallest_p(people), math.comb(conditions, 2)
    sentences = [f"With {people} people the smallest possible p of the exact test is {p:.2g}."]
    if p * pairs > ALPHA:
        bound = "" if pairs == 1 else f" after Holm's correction for {pairs} comparisons"
        sentences.append(f"So no result can fall below {ALPHA}{bound}, even if everybody does better with one.")
    sentences.append(
        f"A difference is found in 4 of 5 such studies (80 % power) only if it is {dz_needed(people):.2f} times as "
        "large as its spread between people (dz), or larger."
    )
    step = people_for_balance(conditions, same_targets)
    if people % step:
        sentences.append(
            f"Orders{'' if same_targets else ' and target lists'} are balanced for {step} people or a multiple; "
            f"{people % step} of the {people} are over."
        )
    return tuple(sentences)
