"""The plans as a person is writing them: texts that may still be wrong, and the plans that can be used already."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from imugui.guidance.plan import ANGLES, COMMON, FIELDS, LEVELS, Plan, list_problems
from imugui.guidance.plan_text import field_text, parse_field


@dataclass(frozen=True)
class Draft:
    """One plan as texts by field; nothing that was typed is lost, right or wrong."""

    texts: dict[str, str]

    @property
    def kind(self) -> str:
        return "plain" if self.texts.get("kind") == "plain" else "projected"

    def read(self) -> tuple[Plan, dict[str, str]]:
        """The plan, with defaults where a text is wrong, and what is wrong: field -> one sentence."""
        values, wrong = {}, {}
        for name in (*COMMON, *ANGLES[self.kind]):
            try:
                values[name] = parse_field(name, self.texts.get(name, ""))
            except ValueError as error:
                wrong[name] = str(error)
        return Plan(**values), wrong


def draft_of(plan: Plan) -> Draft:
    """A plan as texts."""
    return Draft({name: field_text(plan, name) for name in FIELDS})


class PlanSheet:
    """All drafts, in order, and what is wrong with each."""

    def __init__(self, plans: Iterable[Plan] = ()) -> None:
        self.drafts: list[Draft] = []
        self._plans: list[Plan] = []
        self.problems: list[dict[str, str]] = []
        """For each draft: field -> one sentence."""
        self.load(plans)

    @property
    def plans(self) -> list[Plan]:
        """The plans that can be used."""
        return [plan for plan, wrong in zip(self._plans, self.problems, strict=True) if not wrong]

    def plan(self, row: int) -> Plan:
        """The plan of a row as far as it can be read."""
        return self._plans[row]

    def row_of(self, plan: Plan) -> int:
        """Where a plan is, or -1."""
        return self._plans.index(plan) if plan in self._plans else -1

    def load(self, plans: Iterable[Plan]) -> None:
        """Hold these plans instead."""
        self.drafts = [draft_of(plan) for plan in plans]
        self._check()

    def append(self, plans: Iterable[Plan]) -> None:
        """Put these plans behind the others."""
        self.drafts += [draft_of(plan) for plan in plans]
        self._check()

    def edit(self, row: int, **texts: str) -> None:
        """Take texts by field."""
        draft = self.drafts[row]
        self.drafts[row] = replace(draft, texts={**draft.texts, **texts})
        self._check()

    def add(self) -> int:
        """One more plan, for the other side or the next level; its row."""
        self.append([self._next()])
        return len(self.drafts) - 1

    def remove(self, row: int) -> None:
        """Delete a plan."""
        del self.drafts[row]
        self._check()

    def _next(self) -> Plan:
        """What probably comes: the same level on the other side, then the next level."""
        if not self._plans:
            return Plan(name="L4", side="left")
        last = self._plans[-1]
        if last.kind == "plain":
            return replace(last, name=self._free(last.name))
        known = {(plan.name, plan.side) for plan in self._plans}
        at = LEVELS.index(last.name) if last.name in LEVELS else len(LEVELS)
        for name in (last.name, *LEVELS[at + 1 :], *LEVELS[:at]):
            for side in ("left", "right"):
                if (name, side) not in known:
                    return replace(last, name=name, side=side)
        return replace(last, name=self._free(last.name))

    def _free(self, name: str) -> str:
        """A name that is not there yet: the old one with a number."""
        stem, names = name.rstrip("0123456789 ") or "Target", {plan.name for plan in self._plans}
        return next(text for n in range(1, len(names) + 2) if (text := f"{stem} {n}") not in names)

    def _check(self) -> None:
        read = [draft.read() for draft in self.drafts]
        self._plans = [plan for plan, _ in read]
        found = list_problems(self._plans)
        self.problems = [{**more, **wrong} for more, (_, wrong) in zip(found, read, strict=True)]
