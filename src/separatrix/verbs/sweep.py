"""`sweep`: chain and, if asked, verdict of many cases of a study."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from separatrix.ground.plain_data import Part
from separatrix.present import quantity_text as q
from separatrix.present.blocks import Column, Heading, Note, Page, Picture, Table, facts, grouped, text_column
from separatrix.present.figure import CYCLE, GREY, MARKERS, Across, Axis, Figure, Mark, Panel
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.parts.verdict_blocks import evidence_column
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Runner
    from separatrix.verdict.swept_cases import Sweep

ETA = "restitution_factor"
WORST = {ETA: "highest", **dict.fromkeys(("safety_factor", "margin", "probability_stable"), "lowest")}
TIMES = ("below_margin", "stable", "unstable", "undecided", "refused")
SOLVED = ("time_share", ETA, "race_damping", "load_inner", "contact_angle_inner", "max_pressure_inner")
EVIDENCE = ("largest_offset", "largest_contact_force")
JUDGED = (
    *("time_share", ETA, "restitution_threshold", "margin", "own_critical_friction", "safety_factor"),
    *("probability_stable", *EVIDENCE),
)
"""Columns of a table of cases: of the chain alone, and with verdicts or margins."""

CASES = "CSV: parameters in its first row, then a case a row; with time_share a duty cycle."
SHOWN = 16
"""Cases of the table: of more, the worst."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Cases of a sweep, and what is computed of each."""

    vary: Annotated[tuple[str, ...], Option("PARAM=LOW..HIGH[unit][:N][:log]; may be repeated.", "AXIS")] = ()
    cases: Annotated[Path | Sequence[Mapping[str, float]] | None, Option(CASES, "FILE")] = None
    verdicts: Annotated[bool, Option("Run the ensemble of every case, too.")] = False
    margins: Annotated[bool, Option("Compute safety factor or margin of every case, too.")] = False

    def __post_init__(self) -> None:
        """Read a table of cases: an answer has the cases themselves."""
        if isinstance(self.cases, Path):
            from separatrix.verdict.parameter_axes import asked_cases

            object.__setattr__(self, "cases", tuple(asked_cases(self.vary, self.cases)))


def compute(study: Study, options: Options, runner: Runner) -> Sweep:
    """Chain and, if asked, verdict of many cases of a study."""
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import SeparatrixError
    from separatrix.verdict.long_jobs import made_into
    from separatrix.verdict.parameter_axes import asked_cases
    from separatrix.verdict.swept_cases import sweep

    solution = solve(study)
    with contextlib.suppress(SeparatrixError):
        _ = solution.clearances  # for their notes
    cases = asked_cases(options.vary, options.cases)
    how: Any = {"runner": runner, "verdicts": options.verdicts, "margins": options.margins}
    return made_into(lambda found: replace(found, notes=solution.notes), lambda: sweep(study, cases, **how))


def page(answer: Part) -> Page:
    """Return the page of `sweep`."""
    refused, duty = [one for one in answer.cases if is_refused(one)], answer.get("duty")
    counts = Counter(one.verdict for one in answer.cases if one.verdict)
    return page_of(
        answer,
        Note(worst_words(answer), "lead"),
        *(Note(f"Case {one.case} was refused: {one.reason}") for one in refused[:1]),
        facts(
            ("Varied", ", ".join(q.quantity(one.name).label for one in answer.parameters)),
            ("Cases", f"{len(answer.cases)}, of which {len(refused)} refused"),
            ("Verdicts", ", ".join(f"{count} {word}" for word, count in sorted(counts.items()))),
            *((f"Time {q.quantity(one).label}", q.cell(duty, one)) for one in TIMES if duty and one in duty),
        ),
        *([Picture("envelope", lambda: envelope_figure(answer), ENVELOPE)] * has(answer, "cage_speed")),
        Heading("Cases"),
        case_table(answer),
        q.all_numbers("cases", (), ((one,) for one in answer.cases)),
    )


def is_refused(case: Part) -> bool:
    """Whether the program refused a case, and says why."""
    return bool(case.reason) and case.verdict is None


def has(answer: Part, name: str) -> bool:
    """Whether any case has a number of this name."""
    return any(name in one for one in answer.cases)


def case_words(answer: Part, case: Part) -> str:
    """Return the number of a case with its values."""
    return f"case {case.case}: {values_words(answer.parameters, case)}"


def values_words(parameters: Sequence[Part], case: Part) -> str:
    """Return parameters with their values in a case."""
    return ", ".join(q.at(one, one.name, case.get(one.name)) for one in parameters)


def worst_case(answer: Part) -> Part | None:
    """Return the worst case; None where none has an answer, or all are alike."""
    worst = answer.get("worst")
    if worst is None or worst.alike == worst.compared > 1:
        return None
    found: Part = next(one for one in answer.cases if one.case == worst.case)
    return found


def worst_words(answer: Part) -> str:
    """Return the worst case with its values, and the number that makes it so."""
    worst = answer.get("worst")
    if worst is None:
        lacks = "The bearing alone was swept: no case has a restitution factor."
        return lacks if has(answer, "cage_speed") else "No case has an answer."
    name = worst.quantity
    first = next(one for one in answer.cases if one.case == worst.case)
    number = f"{q.quantity(name).label}, {q.show(first, name)}"
    more = "; --margins or --verdicts compare the stability" if name == ETA else ""
    if worst_case(answer) is None:
        return f"No case is the worst: all {worst.alike} with an answer have the same {number}{more}."
    others = f" ({worst.alike - 1} more are alike)" if worst.alike > 1 else ""
    lead = f"The worst of {worst.compared} cases is {case_words(answer, first)}{others}."
    return f"{lead} It has the {WORST[name]} {number}{more}."


# The cases.


def case_table(answer: Part) -> Table:
    """Return parameters and answers of the worst cases; the workbook has all, with reasons."""
    cases, worst = answer.cases, answer.get("worst")
    caption, name = "", worst.quantity if worst else ETA
    if len(cases) > SHOWN:
        sign = -1.0 if name == ETA else 1.0
        cases = sorted(cases, key=lambda one: sign * one.get(name) if name in one else float("inf"))[:SHOWN]
        caption = f"The worst {SHOWN} of {len(answer.cases)} cases; sweep.json and the workbook have all."

    def of(one: Part) -> Column:
        return Column(q.head_of(one.name), lambda case: q.value_of(one, one.name, case.get(one.name)))

    names = [one for one in (JUDGED if answer.margins or answer.verdicts else SOLVED) if has(answer, one)]
    columns = [text_column("case", lambda case: case.case), *map(of, answer.parameters)]
    columns += [evidence_column(name) if name in EVIDENCE else q.column(name) for name in names]
    if answer.verdicts or any(map(is_refused, answer.cases)):
        words = text_column("verdict", lambda case: "refused" if is_refused(case) else case.verdict or "-")
        columns.append(words)
    return Table("worst cases", tuple(columns), tuple(cases), caption)


# The picture.

ENVELOPE = (
    "Stability over the cases and, over one input, frequencies; orders are those of shaft, cage and balls."
)
FREQUENCIES = "Frequencies on the housing"
PANELS = {
    "Restitution factor": (ETA, "restitution_threshold"),
    "Probability that the cage is stable": ("probability_stable",),
    "Safety factor": ("safety_factor",),
    FREQUENCIES: (
        *("linear_whirl_frequency", "inner_pass_frequency", "outer_pass_frequency"),
        *("shaft_frequency", "cage_frequency", "orbit_frequency"),
    ),
}
"""Numbers of each panel."""

BOUNDS = {"probability_stable": (0.5, 0.9), "safety_factor": (1.0,)}
ENDS = {ETA: (-0.03, 1.05), "probability_stable": (-0.06, 1.06)}
LINES = ("-", "--", "-.", ":", "-", "")


def envelope_figure(answer: Part) -> Figure:
    """Return what decides, and the frequencies, over the first parameter; a curve for values of the others.

    Over the numbers of the cases where the first parameter makes no curve, as in a duty cycle.
    """
    first, *others = answer.parameters
    curves = grouped((values_words(others, case), case) for case in answer.cases)
    ways = [[case.get(first.name) for case in each] for each in curves.values()]
    name, is_line = first.name, all(way[1:] and all(a < b for a, b in pairwise(way)) for way in ways)
    if len(curves) > len(CYCLE) or not is_line or has(answer, "time_share"):
        name, curves, is_line = "case", {"": answer.cases}, False
        x = Axis(label="case [-]", low=-0.6, high=len(answer.cases) - 0.4)
    else:
        x = q.parameter_axis(name, first.get("unit") or "-", sorted({one for way in ways for one in way}))
    panels = []
    for title, names in PANELS.items():
        known = [one for one in names if has(answer, one)]
        if not known or (title == FREQUENCIES and len(curves) > 1):
            continue
        low, high = ENDS.get(known[0], (None, None))
        y = q.axis(known[0], "-", [], low=low, high=high, is_log=low is None)
        y = q.axis(known[0], "Hz", [], label="frequency", is_log=True) if title == FREQUENCIES else y
        found = (*_curves(answer, curves, known, name, is_line=is_line), *_upright(answer, name))
        title += "; dashed: its threshold" * ("restitution_threshold" in known)
        panels.append(Panel(title=title, x=x, y=y, marks=found))
    rows = (tuple(panels[i : i + 2]) for i in range(0, len(panels), 2))
    return figure(answer, *rows, height=2.4, varied=[one.name for one in answer.parameters])


def _curves(
    answer: Part, curves: Mapping[str, Sequence[Part]], names: Sequence[str], x: str, *, is_line: bool
) -> Iterator[Mark]:
    """Yield some numbers of the cases with their intervals: a colour a curve, or of one curve a number."""
    for (i, (key, cases)), (j, name) in product(enumerate(curves.items()), enumerate(names)):
        rows = cases
        if name == "orbit_frequency":  # its sign is the direction
            rows = [Part({**one.values, name: abs(one.get(name) or 0.0) or None}, one.units) for one in cases]
        label = q.quantity(name).label if names[1:] else ""
        look: dict[str, Any] = {"colour": CYCLE[i if key else j], "name": "" if key and j else key or label}
        look |= {"line": LINES[j]} if is_line else {}
        look |= {} if is_line and LINES[j] and len(cases) > SHOWN else {"marker": MARKERS[j]}

        def hover(case: Part, name: str = name) -> str:
            return f"{case_words(answer, case)}: {q.quantity(name).label} {q.show(case, name)}"

        yield q.marks(rows, x, name, hover=hover, size=3.0, **look)
    yield from (Across(at=one, axis="y", line=":", colour=GREY) for one in BOUNDS.get(names[0], ()))


def _upright(answer: Part, x: str) -> Iterator[Mark]:
    """Yield the places of refused cases, and of the worst."""
    worst = worst_case(answer)
    for one in answer.cases:
        if is_refused(one):
            yield Across(at=one.get(x), colour=GREY, line=":", name="refused")
        if worst is not None and one.case == worst.case:
            yield Across(at=one.get(x), line="-.", name=f"worst, {case_words(answer, worst)}")


VERB = Verb(
    name="sweep",
    compute=compute,
    page=page,
    options=Options,
    moves_a_cage=True,
    epilog="Every value of one --vary goes with every value of the others. A case that is refused is a row "
    "with its reason. The table is sweep.xlsx and sweep.nc in the folder of the answer: "
    '--vary "film.thickness=0.2..2um:10:log" --vary bearing.contact_angle=15..25deg:11.',
    keeps_runs=True,
)
