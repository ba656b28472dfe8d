"""Sentences from records: report, JSON and workbook share them."""

from __future__ import annotations

from collections.abc import Sequence

from separatrix.distribution import COVERAGE
from separatrix.sensitivity.inverse import percent
from separatrix.sensitivity.records import (
    AllowedFriction,
    CaseSobol,
    Estimate,
    Measurement,
    NextTest,
    RegionRow,
    SobolIndex,
    Span,
    StableRegion,
    TestGain,
)
from separatrix.units import format_quantity

LEAST_WORTH = 0.5
"""A test that is expected to settle fewer cases than this settles none worth the name."""

NAMED = 3
"""Factors or tests named in a sentence."""

LISTED = 6
"""Tests that have a sentence of their own."""

LEAST_SHARE = 0.005
"""Smaller shares are not named."""

NOTHING_UNDECIDED = (
    "Nothing is undecided: every probability of STABLE is at most 5 % or at least 95 %. "
    "No test is needed for the verdicts."
)
ONLY_BORDERLINE = "Nothing else is undecided: no test can be told to settle anything."


_WORDS = {
    "film.race_friction": "the friction between ball and race",
    "cage.ball_cage_stiffness": "the pocket's stiffness",
    "cage.ball_cage_friction": "the pocket friction",
    "stability.duration": "the length of a run",
    "stability.ball_scatter": "the scatter of the balls at the start of a run",
}


def input_words(name: str) -> str:
    """Name of a study's number as it stands in a sentence.

    Examples
    --------
    >>> input_words("film.thickness"), input_words("operation.axial_load")
    ("the film's thickness", 'the axial load')
    >>> input_words("ranking.PEEK 450.material.elastic_modulus")
    'the elastic modulus of PEEK 450'
    """
    if name in _WORDS:
        return _WORDS[name]
    material, candidate, quantity = name.rpartition(".material.")
    if candidate:
        return f"the {_spaced(quantity)} of {material.removeprefix('ranking.')}"
    section, *rest = name.split(".")
    if len(rest) > 1:
        return f"the {_spaced(rest[1])} of the {_spaced(rest[0])}"
    owner = "the" if section == "operation" else f"the {section}'s"
    return f"{owner} {_spaced(rest[0])}"


def _spaced(key: str) -> str:
    return "Poisson's ratio" if key == "poisson_ratio" else key.replace("_", " ")


def case_name(candidate: str, environment: str) -> str:
    """Candidate and environment as they stand in a sentence."""
    return f"{candidate} in {environment}" if environment else candidate


def sobol_sentence(case: CaseSobol) -> str:
    """What drives margin and verdict of one case."""
    name = case_name(case.candidate, case.environment)
    margin = _drivers("The margin", name, case.margin, case.margin_reason)
    return f"{margin} {_drivers('The verdict', name, case.verdict, case.verdict_reason)}"


def _drivers(what: str, name: str, indices: Sequence[SobolIndex], reason: str) -> str:
    if not indices:
        return f"{what} of {name} has no doubt to share out: {reason}."
    named = [one for one in indices if one.total.low > 0.0 and one.total.value >= LEAST_SHARE][:NAMED]
    if not named:
        return f"{what} of {name}: no input's share can be told from 0 with these samples."
    parts = [f"{one.words} ({_share(one.total)}, alone {_share(one.first)})" for one in named]
    return f"{what} of {name} is driven by {_and(parts)}."


def _share(one: Estimate) -> str:
    return f"{100 * one.value:.0f} % [{100 * one.low:.0f}-{100 * one.high:.0f}]"


def _and(parts: Sequence[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def _or(parts: Sequence[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} or {parts[-1]}"


def next_test_sentences(answer: NextTest) -> tuple[str, ...]:
    """Ranked list in words, the best test first; one sentence if nothing is undecided or no test helps."""
    border = _border(answer)
    if not answer.undecided:
        return (*border, ONLY_BORDERLINE) if border else (NOTHING_UNDECIDED,)
    if not answer.tests:
        return ("No test was asked about.", *border)
    best, told = answer.tests[0], [one for one in answer.tests if _is_worth_telling(one)]
    first = test_sentence if best.settled.value >= LEAST_WORTH else _none_settles
    others = (test_sentence(one, answer) for one in told[:LISTED] if one is not best)
    return (first(best, answer), *others, *_less(told[LISTED:], answer), *_rest(answer, told), *border)


def _is_worth_telling(test: TestGain) -> bool:
    return test.settled.low > 0.0 and _number(test.settled.value) != "0"


def _less(tests: Sequence[TestGain], answer: NextTest) -> tuple[str, ...]:
    """Say of how many tests more something could be told."""
    if not tests:
        return ()
    what = "One more test" if len(tests) == 1 else f"Each of {len(tests)} more tests"
    return (f"{what} would settle less: {_expected(tests[0].settled, answer)} at most.",)


def _rest(answer: NextTest, told: Sequence[TestGain]) -> tuple[str, ...]:
    """Say of which tests nothing can be said, or that they settle nothing."""
    rest = [one.words for one in answer.tests if one not in told]
    if not rest or not told:
        return ()
    named = _or(rest) if len(rest) <= NAMED else f"any of the other {len(rest)} inputs"
    return (f"Measuring {named} would decide almost nothing.",)


def _border(answer: NextTest) -> tuple[str, ...]:
    if not answer.borderline:
        return ()
    names = [case_name(*one) for one in answer.borderline]
    verb = "stands" if len(names) == 1 else "stand"
    return (
        f"{_and(names)} {verb} so near 5 or 95 % that {answer.samples} samples do not tell whether "
        f"{'it is' if len(names) == 1 else 'they are'} undecided.",
    )


def _none_settles(best: TestGain, answer: NextTest) -> str:
    count = len(answer.undecided)
    of_them = f"any of {count}" if count > 1 else "the one"
    first = f"No single measurement settles {of_them} undecided {_noun(answer, count)}"
    if _number(best.settled.value) == "0":
        return f"{first}."
    name = act(best.measurement, best.words)
    verb = "would settle" if count > 1 else "would do so"
    expected = f"{_expected(best.settled, answer)} on average" if count > 1 else _chance(best.settled)
    return f"{first}; the best, {name[0].lower()}{name[1:]}, {verb} {expected}."


def _the_one(settled: Estimate, answer: NextTest) -> str:
    name = case_name(*answer.undecided[0])
    return f"the one undecided {_noun(answer, 1)}, {name}, {_chance(settled)}"


def _chance(settled: Estimate) -> str:
    """Probability of settling the only one."""
    low, high = percent(settled.low), percent(settled.high)
    return f"with a probability of {percent(settled.value)} (95 % interval {low} to {high})"


def test_sentence(test: TestGain, answer: NextTest) -> str:
    """What one test is expected to settle."""
    if len(answer.undecided) == 1:
        return f"{act(test.measurement, test.words)} would settle {_the_one(test.settled, answer)}."
    text = f"{act(test.measurement, test.words)} would settle {_expected(test.settled, answer)} on average"
    likely = [one for one in test.cases if one.settles >= 0.05][:NAMED]
    parts = [f"{case_name(one.candidate, one.environment)} ({percent(one.settles)})" for one in likely]
    return f"{text}: {'; '.join(parts)}." if parts else f"{text}."


test_sentence.__test__ = False  # type: ignore[attr-defined]  # pytest must not collect it


def _expected(settled: Estimate, answer: NextTest) -> str:
    count = len(answer.undecided)
    low, high = _number(settled.low), _number(settled.high)
    between = "" if low == high else f" (95 % interval {low} to {high})"
    return f"{_number(settled.value)} of {count} undecided {_noun(answer, count)}{between}"


def _number(value: float) -> str:
    """To a tenth, whole numbers without it."""
    return f"{value:.1f}".removesuffix(".0")


def _noun(answer: NextTest, count: int) -> str:
    one, more = ("material", "materials") if answer.environments == 1 else ("case", "cases")
    return one if count == 1 else more


def act(test: Measurement, words: str) -> str:
    """What a person would do: the test as the subject of a sentence."""
    if test.repeats > 1:
        return f"{test.repeats} more tests of {words}"
    return f"Measuring {words} to {100 * COVERAGE * test.error:.3g} %"


def allowed_sentence(answer: AllowedFriction) -> str:
    """Which friction a new material may have at most."""
    who = "A new material" if answer.all_alike else f"A new material with the pockets of {_and(answer.like)}"
    if answer.most is None or answer.spans[-1].to_edge:
        return f"{who}: {answer.reason}"
    most = f"{answer.most.value:.3f} ({answer.most.low:.3f} to {answer.most.high:.3f})"
    scatter = f" if it scatters by {percent(answer.scatter)} of itself" if answer.scatter > 0.0 else ""
    text = (
        f"{who} may have a pocket friction of at most {most}{scatter}, to be stable with a probability "
        f"of {percent(answer.probability)}; {_nominally(answer)}."
    )
    return f"{text} {answer.reason}".rstrip()


def _nominally(answer: AllowedFriction) -> str:
    at_means = "with every input at its mean and no scatter"
    return f"{'none' if answer.most_nominal is None else f'{answer.most_nominal:.3f}'} {at_means}"


def region_sentences(region: StableRegion) -> tuple[str, ...]:
    """Which film thickness keeps a case stable, one sentence for each value of the other quantity."""
    name = case_name(region.candidate, region.environment)
    return tuple(f"{name}: {_row(region, row)}" for row in region.rows)


def _row(region: StableRegion, row: RegionRow) -> str:
    x, y = region.grid.x, region.grid.y
    at = f"with a {y.words} of {format_quantity(row.y, y.unit, 3)}"
    if not row.probable:
        nominal = f"; nominally {_stretches(row.nominal, x.unit)} would do" if row.nominal else ""
        return f"{at} no {x.words} is stable with a probability of {percent(region.probability)}{nominal}."
    if len(row.probable) == 1 and row.probable[0].from_edge and row.probable[0].to_edge:
        return f"{at} every {x.words} up to {format_quantity(row.probable[0].high, x.unit, 3)} is stable."
    nominal = f" (nominally {_stretches(row.nominal, x.unit)})" if row.nominal else ""
    return f"{at} stable at a {x.words} of {_stretches(row.probable, x.unit)}{nominal}."


def _stretches(spans: Sequence[Span], unit: str) -> str:
    return " or ".join(_stretch(span, unit) for span in spans)


def _stretch(span: Span, unit: str) -> str:
    low, high = (format_quantity(one, unit, 3) for one in (span.low, span.high))
    if span.from_edge and span.to_edge:
        return "any"
    if span.to_edge:
        return f"at least {low}"
    return f"at most {high}" if span.from_edge else f"{low} to {high}"
