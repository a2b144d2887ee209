"""The report of a study as one self-contained page: effect and uncertainty first, then all it rests on."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from datetime import datetime
from html import escape

from imugui import __version__
from imugui.calibration.certificate import NOTE, STYLE
from imugui.targeting.crossover import Estimate
from imugui.targeting.measures import MEASURES, Run
from imugui.targeting.questionnaires import Answer, preference_p
from imugui.targeting.results import PRIMARY, Comparison, Results, group_mean, p_text, sentence
from imugui.targeting.results_plots import learning_svg, paired_svg, ratios_svg
from imugui.targeting.sequences import known, mean_known
from imugui.targeting.statistics import exponential

MORE_STYLE = """
body { max-width: 56em; } .first { font-size: 13pt; font-weight: bold; } .plots { display: flex; flex-wrap: wrap; }
svg { max-width: 100%; height: auto; } .plots svg { flex: 0 1 auto; }
.many { font-size: 8.5pt; margin: .5em 0; } .many td { white-space: nowrap; } .grid th { width: auto; }
.wide { overflow-x: auto; }
.grid td, .grid th + th { text-align: right; } thead th { border-bottom: 1px solid #999; vertical-align: bottom; }
@media print { .wide { overflow: visible; } .many { font-size: 6pt; } tr, svg { break-inside: avoid; } }
"""
EXACT = (
    "p: two-sided sign-flip permutation test on each person's difference of logarithms (of plain differences where "
    "there is no ratio), corrected after Holm for the pairs of conditions, not for the number of measures. Only "
    "the first measure is a test; read the others as descriptions."
)
SYMBOLS = (
    "dz: mean difference / its standard deviation; gz: the same, corrected for few people. Throughput: effective, "
    "ISO 9241-411, one figure for each sequence, then their mean; nominal: sum of log2(A/W + 1) / sum of times."
)


def report_html(results: Results, now: datetime) -> str:
    """The page; every text from outside is escaped. ``now`` with its time zone."""
    title = f"Study results: {results.study}" if results.study else "Study results"
    body = "".join(part(results) for part in SECTIONS)
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f"<style>{STYLE}{MORE_STYLE}</style></head>\n<body><h1>{escape(title)}</h1>\n{body}"
        f"<footer>Made {now:%Y-%m-%d %H:%M} with imugui {escape(__version__)}. {EXACT} {SYMBOLS} {NOTE}"
        f"</footer></body></html>\n"
    )


def effect_section(results: Results) -> str:
    """The primary comparison of every pair in a sentence, and all ratios as a picture."""
    first = [one for one in results.comparisons if one.measure == PRIMARY]
    said = "".join(f'<p class="first">{escape(sentence(one))}</p>' for one in first if one.people)
    if not said:
        return section("Effect", _paragraphs(["Nobody has met two conditions yet: there is nothing to compare."]))
    picture = ratios_svg(results.comparisons)
    pairs = dict.fromkeys((one.b, one.a) for one in first)
    words = "; ".join(f"{b} against {a}" for b, a in pairs)
    return section("Effect", f"{said}{picture}<p>Ratios of geometric means, {escape(words)}, with 95 % limits.</p>")


def people_section(results: Results) -> str:
    """The primary measure person by person."""
    kind = results.conditions.index
    first = [one for one in results.comparisons if one.measure == PRIMARY]
    plots = "".join(paired_svg(one, (kind(one.a), kind(one.b))) for one in first)
    if not plots:
        return ""
    text = "<p>One line for each person; the bar is the geometric mean.</p>"
    return section("Person by person", f'<div class="plots">{plots}</div>{text}')


def notes_section(results: Results) -> str:
    """What the study can show and what was left out."""
    return section("How far to trust it", _paragraphs(results.notes))


def measures_section(results: Results) -> str:
    """All measures of every pair in a table."""
    head = ("ratio (95 %)", "difference (95 %)", "p", "Wilcoxon p", "dz (95 %)", "gz")
    found = []
    for a, b in dict.fromkeys((one.a, one.b) for one in results.comparisons):
        rows = [_measure_row(one) for one in results.comparisons if (one.a, one.b) == (a, b) and one.people]
        found.append(grid((f"{b} against {a}", f"{a}, mean", f"{b}, mean", *head), rows, "grid many"))
    return section("All measures", "".join(found)) if found else ""


def learning_section(results: Results) -> str:
    """Blocks of each condition with the fitted curve, and the comparison after learning."""
    what = MEASURES[PRIMARY]
    picture = learning_svg(results.learning, what.title, what.unit)
    head = ("", "block 1, fitted", "exponent r", "left when blocks double", "last improvement over 5 %", "settled")
    rows = [
        (
            one.condition,
            number(one.curve.first, what.digits, what.unit),
            number(one.curve.exponent, 3),
            number(100.0 * one.curve.rate, 0, "%"),
            f"in block {one.curve.plateau + 1}" if one.curve.plateau else "none",
            "yes" if one.curve.settled else "no",
        )
        for one in results.learning
        if math.isfinite(one.curve.first)
    ]
    if not rows:
        return ""
    words = [f"From block {results.settled_from + 1} on: {sentence(one)}" for one in results.settled if one.people]
    again = _paragraphs(words) if results.settled_from else ""
    return section("Learning", f"{picture}{grid(head, rows)}{again}<p>Dashed: T = T1 b^-r. Thin: one person.</p>")


def order_section(results: Results) -> str:
    """What the order of the conditions did, where people met them in both orders."""
    rows = []
    for one in (one for one in results.comparisons if one.measure == PRIMARY and one.geometric):
        found = one.crossover
        if found.word:
            continue
        name = f"{one.b} / {one.a} ({found.n_ab} + {found.n_ba} people)"
        carried = f"p = {p_text(found.carry_over.p)}{', look at it' if found.carry_over_seen else ''}"
        effect, period = _later_ratio(found.effect), _later_ratio(found.period)
        rows.append((name, effect, p_text(found.effect.p), period, p_text(found.period.p), carried))
    head = ("", "ratio freed of the order (95 %)", "p", "second period / first (95 %)", "p", "carry-over")
    return section("Order", grid(head, rows)) if rows else ""


def answers_section(results: Results) -> str:
    """Work load, usability and preference."""
    if not results.answers:
        return ""
    names = {"tlx": "Work load (raw TLX, 0 to 100, less is better)", "sus": "Usability (SUS, about 68 is average)"}
    rows = [
        (title, *(_scores(results.answers, kind, condition) for condition in results.conditions))
        for kind, title in names.items()
        if any(answer.kind == kind for answer in results.answers)
    ]
    liked = [answer.condition for answer in results.answers if answer.kind == "preference"]
    if liked:
        rows.append(("Preferred by", *(str(liked.count(condition)) for condition in results.conditions)))
    return section("What people said", grid(("", *results.conditions), rows) + _preference_words(results, liked))


def runs_section(results: Results) -> str:
    """Every run with the measures of the thesis and ours."""
    shown = [name for name in MEASURES if any(len(known([getattr(run, name)])) for run in results.runs)]
    halves = {"measures of the thesis": True, "our measures": False}
    return "".join(
        section(
            f"Runs: {title}", _runs_table(results.runs, [name for name in shown if MEASURES[name].thesis == thesis])
        )
        for title, thesis in halves.items()
        if results.runs
    )


SECTIONS = (
    effect_section,
    people_section,
    notes_section,
    measures_section,
    learning_section,
    order_section,
    answers_section,
    runs_section,
)


def section(title: str, body: str) -> str:
    """A heading with what belongs under it; ``body`` is markup."""
    return f"<h2>{escape(title)}</h2>{body}\n"


def grid(head: Sequence[str], rows: Iterable[Sequence[str]], kind: str = "grid") -> str:
    """A table; every cell is escaped."""
    top = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    body = "".join(
        f"<tr><th>{escape(row[0])}</th>{''.join(f'<td>{escape(cell)}</td>' for cell in row[1:])}</tr>" for row in rows
    )
    return f'<table class="{kind}"><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>'


def number(value: float, digits: int, unit: str = "") -> str:
    """A figure with its unit, or n/a."""
    # adding 0 turns the -0 of a rounded figure into 0
    return f"{round(value, digits) + 0.0:.{digits}f} {unit}".rstrip() if math.isfinite(value) else "n/a"


def _measure_row(one: Comparison) -> tuple[str, ...]:
    what, found = MEASURES[one.measure], one.paired
    means = (group_mean(values, one.geometric) for values in (one.values_a, one.values_b))
    return (
        _with_unit(one.measure),
        *(number(mean, what.digits) for mean in means),
        _limits(one.ratio.ratio, one.ratio.low, one.ratio.high) if one.geometric else "",
        _limits(found.mean, found.low, found.high, what.digits),
        p_text(one.adjusted_p),
        p_text(one.wilcoxon.p),
        _limits(found.dz, found.dz_low, found.dz_high),
        number(found.gz, 2),
    )


def _limits(value: float, low: float, high: float, digits: int = 2) -> str:
    if not math.isfinite(value):
        return "n/a"
    limits = f" ({number(low, digits)} to {number(high, digits)})" if math.isfinite(low + high) else ""
    return number(value, digits) + limits


def _later_ratio(estimate: Estimate) -> str:
    """The second against the first, from the difference of logarithms first - second."""
    value, low, high = (exponential(-one) for one in (estimate.value, estimate.high, estimate.low))
    return _limits(value, low, high)


def _scores(answers: Iterable[Answer], kind: str, condition: str) -> str:
    found = known([one.score for one in answers if (one.kind, one.condition) == (kind, condition)])
    return f"{mean_known(found):.0f} (n = {len(found)})" if len(found) else "n/a"


def _preference_words(results: Results, liked: Sequence[str]) -> str:
    if not liked or len(results.conditions) != 2:
        return ""
    counts = [liked.count(condition) for condition in results.conditions]
    return _paragraphs([f"Sign test of the preference: p = {p_text(preference_p(*counts))}."])


def _runs_table(runs: Sequence[Run], shown: Sequence[str]) -> str:
    head = ("person", "condition", "block", "run", *(_with_unit(name) for name in shown), "outliers")
    return f'<div class="wide">{grid(head, (_run_row(run, shown) for run in runs), "grid many")}</div>'


def _run_row(run: Run, shown: Sequence[str]) -> tuple[str, ...]:
    block = f"{run.block}{' (practice)' if run.practice else ''}"
    values = ((getattr(run, name), MEASURES[name].digits) for name in shown)
    figures = (str(value) if isinstance(value, int) else number(value, digits) for value, digits in values)
    outliers = ", ".join(map(str, run.outliers)) or "none"
    return (run.participant, run.condition, block, str(run.run), *figures, outliers)


def _with_unit(name: str) -> str:
    what = MEASURES[name]
    return f"{what.title}, {what.unit}" if what.unit else what.title


def _paragraphs(words: Iterable[str]) -> str:
    return "".join(f"<p>{escape(one)}</p>" for one in words)
