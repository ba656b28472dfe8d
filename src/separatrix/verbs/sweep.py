"""`sweep`: chain and, if asked, verdict of many cases of a study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from separatrix.ground.document import Part
from separatrix.present.blocks import (
    Cell,
    Column,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    facts,
    text_column,
)
from separatrix.present.figure import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    VERMILION,
    Across,
    Axis,
    Figure,
    Mark,
    Panel,
    Trace,
)
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.quantity_text import (
    all_numbers,
    axis,
    cell,
    column,
    marks,
    parameter_axis,
    quantity,
    show,
    value_of,
)
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Runner
    from separatrix.verdict.swept_cases import Sweep

ETA = "restitution_factor"
WORST = {ETA: "highest", **dict.fromkeys(("safety_factor", "margin", "probability_stable"), "lowest")}
TIMES = ("below_margin", "stable", "unstable", "undecided", "refused")
SOLVED = ("time_share", ETA, "race_damping", "load_inner", "contact_angle_inner", "max_pressure_inner")
JUDGED = (
    *("time_share", ETA, "restitution_threshold", "margin", "own_critical_friction", "safety_factor"),
    *("probability_stable", "largest_offset", "largest_contact_force"),
)
"""Columns of a table of cases: of the chain alone, and with verdicts or margins."""

FEW, SOME = 12, 40
"""Cases on a screen and in a report: of more, the worst."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Cases of a sweep, and what is computed of each."""

    vary: Annotated[tuple[str, ...], Option("PARAM=LOW..HIGH[unit][:N][:log]; may be repeated.", "AXIS")] = ()
    cases: Annotated[
        Path | Sequence[Mapping[str, float]] | None,
        Option("CSV: parameters in its first row, then a case a row; with time_share a duty cycle.", "FILE"),
    ] = None
    verdicts: Annotated[bool, Option("Run the ensemble of every case, too.")] = False
    margins: Annotated[bool, Option("Compute safety factor or margin of every case, too.")] = False

    def __post_init__(self) -> None:
        """Read a table of cases: an answer has the cases themselves."""
        if isinstance(self.cases, Path):
            from separatrix.verdict.parameter_axes import asked_cases

            object.__setattr__(self, "cases", tuple(asked_cases(self.vary, self.cases)))


def compute(study: Study, options: Options, runner: Runner) -> Sweep:
    """Chain and, if asked, verdict of many cases of a study."""
    import contextlib
    from dataclasses import replace

    from separatrix.chain.solution import solve
    from separatrix.ground.errors import SeparatrixError
    from separatrix.verdict.long_jobs import made_into
    from separatrix.verdict.parameter_axes import asked_cases
    from separatrix.verdict.swept_cases import sweep

    asked = asked_cases(options.vary, options.cases)
    solution = solve(study)
    with contextlib.suppress(SeparatrixError):
        _ = solution.clearances  # for their notes
    chosen = {"verdicts": options.verdicts, "margins": options.margins}
    return made_into(
        lambda found: replace(found, notes=solution.notes),
        lambda: sweep(study, asked, **chosen, runner=runner),
    )


def page(answer: Part) -> Page:
    """Return the page of `sweep`."""
    refused = [one for one in answer.cases if is_refused(one)]
    duty = answer.get("duty")
    counts = Counter(one.verdict for one in answer.cases if one.verdict)
    return page_of(
        answer,
        Note(worst_words(answer), "lead"),
        *(Note(f"Case {one.case} was refused: {one.reason}") for one in refused[:1]),
        facts(
            ("Varied", ", ".join(quantity(one.name).label for one in answer.parameters)),
            ("Cases", f"{len(answer.cases)}, of which {len(refused)} refused"),
            ("Verdicts", ", ".join(f"{count} {word}" for word, count in sorted(counts.items()))),
            *((f"Time {quantity(name).label}", cell(duty, name)) for name in TIMES if duty and name in duty),
        ),
        *([Picture("envelope", lambda: envelope_figure(answer), ENVELOPE)] * has(answer, "cage_speed")),
        Heading("Cases"),
        *case_tables(answer),
    )


def is_refused(case: Part) -> bool:
    """Whether the program refused a case, and says why."""
    return bool(case.reason) and case.verdict is None


def has(answer: Part, name: str) -> bool:
    """Whether any case has a number of this name."""
    return any(name in one for one in answer.cases)


def case_words(answer: Part, case: Part) -> str:
    """Return the number of a case with its values."""
    each = (
        f"{quantity(one.name).label} {value_of(one, one.name, case.get(one.name)).text}"
        for one in answer.parameters
    )
    return f"case {case.case}: {', '.join(each)}"


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
    number = f"{quantity(name).label}, {show(first, name)}"
    more = "; --margins or --verdicts compare the stability" if name == ETA else ""
    if worst_case(answer) is None:
        return f"No case is the worst: all {worst.alike} with an answer have the same {number}{more}."
    others = f" ({worst.alike - 1} more are alike)" if worst.alike > 1 else ""
    lead = f"The worst of {worst.compared} cases is {case_words(answer, first)}{others}."
    return f"{lead} It has the {WORST[name]} {number}{more}."


# The tables of cases.


def case_tables(answer: Part) -> Iterator[Table]:
    """Yield the worst cases, so many as a screen and a report have room for; a workbook has every number."""
    cases, worst = answer.cases, answer.get("worst")
    name = worst.quantity if worst else ETA
    sign = -1.0 if name == ETA else 1.0
    ordered = sorted(cases, key=lambda one: sign * one.get(name) if name in one else float("inf"))
    for most, level in ((FEW, Level.BRIEF), (SOME, Level.LONG)):
        part = f"The worst {most} of {len(cases)} cases; sweep.csv and sweep.json have all."
        few = (cases, "") if len(cases) <= most else (ordered[:most], part)
        yield Table("worst cases", shown_columns(answer), tuple(few[0]), few[1], level)
    yield all_numbers("cases", (), ((one,) for one in cases))


def shown_columns(answer: Part) -> tuple[Column, ...]:
    """Return parameters and answer of a case; a workbook and sweep.csv have why it was refused."""

    def of(one: Part) -> Column:
        known = quantity(one.name)
        return Column(known.head or known.label, lambda case: value_of(one, one.name, case.get(one.name)))

    names = JUDGED if answer.margins or answer.verdicts else SOLVED
    words = text_column("verdict", lambda case: "refused" if is_refused(case) else case.verdict or "-")
    has_words = answer.verdicts or any(map(is_refused, answer.cases))
    number = Column("case", lambda case: Cell(str(case.case)))
    known = (column(name) for name in names if has(answer, name))
    return (number, *map(of, answer.parameters), *known, *([words] if has_words else []))


def csv_text(answer: Part) -> str:
    """Return the table of all cases for spreadsheets and other programs, in SI units."""
    import csv
    import io

    from separatrix.ground.sheet import text_for_cell

    cases = answer.cases
    names = list(cases[0].values)
    units = answer.units.get("cases") or {}
    stream = io.StringIO(newline="")
    writer = csv.writer(stream)
    writer.writerow([f"{name} [{units[name]}]" if units.get(name) else name for name in names])
    for case in cases:
        row = (case.values[name] for name in names)
        writer.writerow([text_for_cell(one) if isinstance(one, str) else one for one in row])
    return stream.getvalue()


def files(answer: Part) -> Iterator[tuple[str, bytes]]:
    """Yield the table of all cases as CSV."""
    yield "sweep.csv", csv_text(answer).encode()


# The picture.

ENVELOPE = "Stability and frequencies over the cases; orders are those of shaft, cage and balls."
MOST_PANELS = 3
"""Parameters that have a panel."""

LOOKS = {
    "restitution_factor": (ORANGE, "-", "o"),
    "restitution_threshold": (BLUE, "-", "s"),
    "linear_whirl_frequency": (BLACK, "-", "_"),
    "inner_pass_frequency": (PURPLE, ":", "v"),
    "outer_pass_frequency": (ORANGE, "-.", "^"),
    "shaft_frequency": (BLUE, "--", "s"),
    "cage_frequency": (GREEN, "--", "o"),
}
"""Lines of the picture, two factors and the frequencies: colour, line, and marker where it has no meaning."""


class Way(NamedTuple):
    """How cases are laid out: an axis, the name of their places there, and whether lines mean something."""

    axis: Axis
    name: str
    is_line: bool


def ways(answer: Part) -> list[Way]:
    """Return the axes of the picture: the only parameter, several, or the cases of a duty cycle."""
    values = {one.name: [case.get(one.name) for case in answer.cases] for one in answer.parameters}
    units = {one.name: one.get("unit") or "-" for one in answer.parameters}
    is_line = len(values) == 1 and all(a < b for each in values.values() for a, b in pairwise(each))
    if not is_line and (len(values) == 1 or has(answer, "time_share")):
        count = len(answer.cases)
        names = tuple(map(str, range(count))) if count <= SOME else ()
        return [Way(Axis(label="case [-]", low=-0.6, high=count - 0.4, names=names), "case", False)]
    chosen = [*values.items()][:MOST_PANELS]
    return [Way(parameter_axis(name, units[name], sorted({*known})), name, is_line) for name, known in chosen]


def envelope_figure(answer: Part) -> Figure:
    """Return restitution factor, its threshold, P(stable) and the frequencies over the parameters."""
    columns = [[*_panels(answer, way)] for way in ways(answer)]
    return Figure(
        rows=tuple(zip(*columns, strict=True)),
        heading=figure_heading(answer, varied=[one.name.rpartition(".")[2] for one in answer.parameters]),
        alt="Stability and frequencies over the cases of the sweep; the table has the numbers.",
        height=2.2,
    )


def _panels(answer: Part, way: Way) -> Iterator[Panel]:
    upright = [*_upright(answer, way)]

    def panel(title: str, y: Axis, found: Sequence[Mark]) -> Panel:
        return Panel(title=title, x=way.axis, y=y, marks=(*found, *upright))

    factors: list[Mark] = []
    frequencies: list[Mark] = []
    for name, (colour, line, marker) in LOOKS.items():
        if has(answer, name):
            among = frequencies if "frequency" in name else factors
            look = {"colour": colour, "line": line} if way.is_line else {"colour": colour, "marker": marker}
            among.append(_over(answer, answer.cases, way, name, size=3.0, **look))
    if factors:
        title = "Restitution factor" + " and its threshold" * len(factors[1:])
        yield panel(title, axis(ETA, "-", [], low=-0.03, high=1.05), factors)
    if has(answer, "probability_stable"):
        chances = []
        for word, colour in VERDICT_COLOURS.items():
            those = [one for one in answer.cases if one.verdict == word]
            look = {"colour": colour, "marker": VERDICT_MARKERS[word], "name": word}
            chances += [_over(answer, those, way, "probability_stable", **look)] if those else []
        y = axis("probability_stable", "-", [], low=-0.06, high=1.06)
        yield panel("Probability that the cage is stable", y, chances)
    safe = [one for one in answer.cases if "safety_factor" in one]
    if safe:
        found = _over(answer, safe, way, "safety_factor", marker="D", size=4.0, colour=BLUE)
        bound = Across(at=1.0, axis="y", line=":")
        yield panel("Safety factor", axis("safety_factor", "-", [], is_log=True), (found, bound))
    whirling = [one for one in answer.cases if one.get("orbit_frequency")]
    if whirling:
        x, speed = [one.get(way.name) for one in whirling], [abs(one.orbit_frequency) for one in whirling]
        more: dict[str, Any] = {"line": "", "marker": "^", "size": 5.0, "colour": VERMILION}
        frequencies.append(Trace(x=x, y=speed, name=quantity("orbit_frequency").label, **more))
    y = axis("shaft_frequency", "Hz", [], label="frequency", is_log=True)
    yield panel("Frequencies on the housing", y, frequencies)


def _over(answer: Part, cases: Sequence[Part], way: Way, what: str, **look: Any) -> Trace:
    """Return a number of the cases with its interval."""
    label = quantity(what).label

    def hover(case: Part) -> str:
        return f"{case_words(answer, case)}: {label} {show(case, what)}"

    return marks(cases, way.name, what, hover=hover, **({"name": label} | look))


def _upright(answer: Part, way: Way) -> Iterator[Mark]:
    """Yield the places of refused cases, and of the worst."""
    worst = worst_case(answer)
    for one in answer.cases:
        if is_refused(one):
            yield Across(at=one.get(way.name), colour=GREY, line=":", name="refused")
        if worst is not None and one.case == worst.case:
            name = f"worst, {case_words(answer, worst)}"
            yield Across(at=one.get(way.name), colour=VERMILION, line="--", name=name)


VERB = Verb(
    name="sweep",
    options=Options,
    compute=compute,
    page=page,
    files=files,
    moves_a_cage=True,
    epilog="Every value of one --vary goes with every value of the others. A case that is refused is a row "
    "with its reason. The table is sweep.csv, sweep.xlsx and sweep.nc in the folder of the answer: "
    '--vary "film.thickness=0.2..2um:10:log" --vary bearing.contact_angle=15..25deg:11.',
    keeps_runs=True,
)
