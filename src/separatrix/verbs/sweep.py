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
    SKY,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    VERMILION,
    Across,
    Axis,
    Band,
    Figure,
    Mark,
    Panel,
    Trace,
)
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.telling import axis, cell, column, quantity, told
from separatrix.verbs.parts.varied import parameter_axis, value_of
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Runner
    from separatrix.verdict.swept_cases import Sweep

ETA = "restitution_factor"
WORST = {"margin": "lowest", "probability_stable": "lowest", ETA: "highest"}
TIMES = ("below_margin", "stable", "unstable", "undecided", "refused")
RANGES = (
    ETA,
    "race_damping",
    "max_pressure_inner",
    "max_pressure_outer",
    "spin_roll_ratio_inner",
    "ball_cage_friction",
    "pocket_clearance",
    "land_clearance",
    "linear_whirl_frequency",
    "orbit_frequency",
    "restitution_threshold",
    "margin",
    "probability_stable",
    "largest_offset",
    "largest_contact_force",
)
WORDS = ("verdict", "cage_motion", "reason")
"""What a case has in words."""

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
    margins: Annotated[bool, Option("Compute threshold and margin of every case, too.")] = False

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
    first = f"Case {refused[0].case} was refused: {refused[0].reason}" if refused else ""
    return page_of(
        answer,
        Note(worst_words(answer), "lead"),
        *([Note(first)] if first else []),
        facts(
            ("Varied", ", ".join(quantity(name).label for name in names_of(answer))),
            ("Cases", f"{len(answer.cases)}, of which {len(refused)} refused"),
            ("Verdicts", _verdicts(answer)),
            *time_facts(answer),
        ),
        *([envelope_picture(answer)] if is_drawn(answer) else []),
        Heading("Cases"),
        *case_tables(answer),
        Heading("Ranges over the cases", Level.LONG),
        ranges(answer),
    )


def names_of(answer: Part) -> list[str]:
    """Return the names of the parameters."""
    return [one.name for one in answer.parameters]


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
    if worst is None and has(answer, "cage_speed"):
        return "The bearing alone was swept: no case has a restitution factor."
    if worst is None:
        return "No case has an answer."
    name = worst.quantity
    first = next(one for one in answer.cases if one.case == worst.case)
    why = f"{WORST[name]} {quantity(name).label}, {told(first, name)}"
    more = "; --margins or --verdicts compare the stability" if name == ETA else ""
    if worst_case(answer) is None:
        same = f"the same {quantity(name).label}, {told(first, name)}"
        return f"No case is the worst: all {worst.alike} with an answer have {same}{more}."
    others = f" ({worst.alike - 1} more are alike)" if worst.alike > 1 else ""
    return (
        f"The worst of {worst.compared} cases is {case_words(answer, first)}{others}. It has the {why}{more}."
    )


def _verdicts(answer: Part) -> str:
    counts = Counter(one.verdict for one in answer.cases if one.verdict)
    return ", ".join(f"{count} {word}" for word, count in sorted(counts.items()))


def time_facts(answer: Part) -> list[tuple[str, Cell | str]]:
    """Return the shares of the time of a duty cycle that are known."""
    duty = answer.get("duty")
    if duty is None:
        return []
    known = [name for name in TIMES if name in duty and (name != "refused" or duty.refused)]
    if not known:
        return [("Time", "`--margins` or `--verdicts` show where it is spent")]
    return [(f"Time {quantity(name).label}", cell(duty, name)) for name in known]


def ranges(answer: Part) -> Table:
    """Return the least and the largest of what the cases have."""

    def end(pick: Any) -> Any:
        return lambda name: _plain(
            pick((one for one in answer.cases if name in one), key=lambda c: c.get(name)), name
        )

    names = tuple(name for name in RANGES if has(answer, name))
    columns = (
        text_column("", lambda name: quantity(name).label),
        Column("least", end(min)),
        Column("largest", end(max)),
    )
    return Table("ranges", columns, names, "", Level.LONG)


def _plain(case: Part, name: str) -> Cell:
    """Return a number of a case without its interval."""
    return Cell(case.get(name), quantity(name), case.unit(name))


# The tables of cases.


def case_tables(answer: Part) -> Iterator[Table]:
    """Yield the worst cases, so many as a screen and a report have room for; a workbook has every number."""
    cases = answer.cases
    for most, level in ((FEW, Level.BRIEF), (SOME, Level.LONG)):
        shown = cases if len(cases) <= most else worst_first(answer)[:most]
        part = (
            ""
            if shown is cases
            else f"The worst {most} of {len(cases)} cases; sweep.csv and sweep.json have all."
        )
        yield Table("worst cases", shown_columns(answer), tuple(shown), part, level)
    yield Table("cases", tuple(every_column(answer)), tuple(cases), "", Level.SHEET)


def worst_first(answer: Part) -> list[Part]:
    """Return the cases with the worst at the top; those without an answer at the end."""
    worst = answer.get("worst")
    name, sign = (worst.quantity, -1.0 if worst.quantity == ETA else 1.0) if worst else (ETA, -1.0)
    return sorted(answer.cases, key=lambda one: sign * one.get(name) if name in one else float("inf"))


def _parameters(answer: Part) -> list[Column]:
    def of(one: Part) -> Column:
        label = quantity(one.name)
        return Column(label.head or label.label, lambda case: value_of(one, one.name, case.get(one.name)))

    number = Column("case", lambda case: Cell(str(case.case)))
    return [number, *map(of, answer.parameters)]


def shown_columns(answer: Part) -> tuple[Column, ...]:
    """Return parameters and answer of a case; a workbook and sweep.csv have why it was refused."""
    names = ["time_share", ETA]
    if not (answer.margins or answer.verdicts):
        names += ["race_damping"] if has(answer, ETA) else ["load_inner", "contact_angle_inner"]
        names += ["max_pressure_inner"]
    names += ["restitution_threshold", "margin"] if answer.margins else []
    names += ["probability_stable"] if answer.verdicts else []
    words = []
    if answer.verdicts or any(map(is_refused, answer.cases)):
        words = [text_column("verdict", lambda case: "refused" if is_refused(case) else case.verdict or "-")]
    return (*_parameters(answer), *(column(name) for name in names if has(answer, name)), *words)


def every_column(answer: Part) -> Iterator[Column]:
    """Yield every number of a case that any case has, with its interval, and its words."""
    yield from _parameters(answer)
    first = answer.cases[0].values
    ends = {f"{name}_{end}" for name in ("restitution_threshold", "probability") for end in ("low", "high")}
    for name in first:
        if name not in ("case", *WORDS, *ends, *names_of(answer)) and has(answer, name):
            yield column(name, head=quantity(name).label)
    yield from map(_words, WORDS)


def _words(name: str) -> Column:
    return text_column(name.replace("_", " "), lambda case: case.get(name) or "-")


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


def files(answer: Part, *_: Any) -> Iterator[tuple[str, bytes]]:
    """Yield the table of all cases as CSV."""
    yield "sweep.csv", csv_text(answer).encode()


# The picture.

MOST_PANELS, MOST_DRAWN, MOST_FREQUENCIES, MOST_NAMED = 3, 1000, 60, 8
"""Parameters that have a panel; cases that are drawn, whose frequencies are, and whose values stand below."""

FREQUENCIES = {
    "linear_whirl_frequency": (BLACK, "-", "_"),
    "inner_pass_frequency": (PURPLE, ":", "v"),
    "outer_pass_frequency": (ORANGE, "-.", "^"),
    "shaft_frequency": (BLUE, "--", "s"),
    "cage_frequency": (GREEN, "--", "o"),
}
"""Whirl and orders of the bearing: colour, line, and marker where a line has no meaning."""


class Way(NamedTuple):
    """How cases are laid out: an axis, the place of each, and whether lines between them mean something."""

    axis: Axis
    places: list[float]
    is_line: bool


def is_drawn(answer: Part) -> bool:
    """Whether any case has a number to draw."""
    return has(answer, "cage_speed")


def drawn_cases(answer: Part) -> list[Part]:
    """Return the cases of the picture, evenly chosen of very many."""
    cases: list[Part] = answer.cases
    return cases[:: -(-len(cases) // MOST_DRAWN)]


def ways(answer: Part, cases: Sequence[Part]) -> list[Way]:
    """Return the axes of the picture: the only parameter, several, or the cases of a duty cycle."""
    values = {one.name: [case.get(one.name) for case in cases] for one in answer.parameters}
    units = {one.name: one.get("unit") or "-" for one in answer.parameters}
    only = next(iter(values.values()))
    is_rising = all(a < b for a, b in pairwise(only))
    if len(values) == 1 and is_rising:
        return [Way(parameter_axis(*one, only), only, True) for one in units.items()]
    if len(values) > 1 and not has(answer, "time_share"):
        chosen = [*values.items()][:MOST_PANELS]
        return [
            Way(parameter_axis(name, units[name], sorted({*known})), known, False) for name, known in chosen
        ]
    names: tuple[str, ...] = ()
    label = "case [-]"
    if len(cases) <= MOST_NAMED:
        texts = [
            [value_of(one, one.name, case.get(one.name)).text for one in answer.parameters] for case in cases
        ]
        names = tuple("\n".join((str(case.case), *each)) for case, each in zip(cases, texts, strict=True))
        label = f"case: {', '.join(quantity(name).head for name in values)}"
    places = [float(place) for place in range(len(cases))]
    return [Way(Axis(label=label, low=-0.6, high=len(cases) - 0.4, names=names), places, False)]


def envelope_picture(answer: Part) -> Picture:
    """Return stability and frequencies over the cases."""
    shown, total = len(drawn_cases(answer)), len(answer.cases)
    part = "" if shown == total else f" {shown} of {total} cases are drawn."
    caption = f"Stability and frequencies over the cases; orders are those of shaft, cage and balls.{part}"
    return Picture("envelope", lambda: envelope_figure(answer), caption)


def envelope_figure(answer: Part) -> Figure:
    """Return margin, P(stable) or restitution factor over the parameters, and the frequencies."""
    cases = drawn_cases(answer)
    hover = [case_words(answer, case) for case in cases]
    across = ways(answer, cases)
    makers = [make for name, make in PANELS.items() if has(answer, name)] or [_factor]
    makers = makers if has(answer, ETA) else []
    if len(across) == 1 or len(cases) <= MOST_FREQUENCIES:
        makers = [*makers, _frequencies]
    rows, letters = [], iter("abcdefghijkl")
    worst = worst_case(answer)
    for make in makers:
        row = []
        for way in across:
            title, y, marks = make(cases, way, hover)
            marks += _worst(way, cases, worst, answer)
            letter = f"{next(letters)}  " if len(makers) * len(across) > 1 else ""
            row.append(Panel(title=f"{letter}{title}", x=way.axis, y=y, marks=tuple(marks)))
        rows.append(tuple(row))
    varied = [name.rpartition(".")[2] for name in names_of(answer)]
    return Figure(
        rows=tuple(rows),
        heading=figure_heading(answer, varied=varied),
        alt="Stability and frequencies over the cases of the sweep; the table has the numbers.",
        height=2.2,
    )


Made = tuple[str, Axis, list[Mark]]


def _numbers(cases: Sequence[Part], name: str) -> list[float | None]:
    return [one.get(name) for one in cases]


def _trace(cases: Sequence[Part], what: str, way: Way, hover: Sequence[str], **look: Any) -> Trace:
    """Return a number of the cases as a line, or as marks where a line has no meaning."""
    texts = tuple(
        f"{at}: {quantity(what).label} {told(case, what)}" for at, case in zip(hover, cases, strict=True)
    )
    line = look.pop("line", "-")
    return Trace(x=way.places, y=_numbers(cases, what), hover=texts, line=line if way.is_line else "", **look)


def _factor(cases: Sequence[Part], way: Way, hover: Sequence[str]) -> Made:
    known = [one for one in _numbers(cases, ETA) if one is not None]
    y = axis(ETA, "-", known, low=0.0, high=1.08 * max([*known, 0.05]))
    return "Restitution factor", y, [_eta(cases, way, hover)]


def _eta(cases: Sequence[Part], way: Way, hover: Sequence[str]) -> Trace:
    return _trace(cases, ETA, way, hover, name="restitution factor $eta$", marker="o", size=3.0)


def _margin(cases: Sequence[Part], way: Way, hover: Sequence[str]) -> Made:
    threshold = "restitution_threshold"
    both = [(one.get(ETA), one.get(threshold)) for one in cases]
    ends = {f"{end}": _numbers(cases, f"{threshold}_{end}") for end in ("low", "high")}
    look: dict[str, Any] = {"colour": BLUE, "marker": "s", "size": 3.0}
    look["name"] = "threshold, with its 95 % interval"
    marks: list[Mark] = []
    if way.is_line:
        known = [None if None in pair else pair for pair in both]
        x = way.places
        eta = [pair and pair[0] for pair in known]
        marks.append(Band(x=x, low=eta, high=[p and max(p) for p in known], name="margin", colour=SKY))
        if any(pair and pair[0] > pair[1] for pair in known):
            low, name = [p and min(p) for p in known], "beyond the threshold"
            marks.append(Band(x=x, low=low, high=eta, name=name, colour=VERMILION))
    marks += [_trace(cases, threshold, way, hover, **look, **ends), _eta(cases, way, hover)]
    return "Margin: threshold less restitution factor", axis(ETA, "-", [], low=-0.03, high=1.05), marks


def _probability(cases: Sequence[Part], way: Way, hover: Sequence[str]) -> Made:
    name, marks = "probability_stable", list[Mark]()
    for word, colour in VERDICT_COLOURS.items():
        those = [place for place, one in enumerate(cases) if one.verdict == word]
        if those:
            chosen = [cases[place] for place in those]
            at = Way(way.axis, [way.places[place] for place in those], False)
            look: dict[str, Any] = {"colour": colour, "marker": VERDICT_MARKERS[word], "name": word}
            ends = {end: _numbers(chosen, f"probability_{end}") for end in ("low", "high")}
            marks.append(_trace(chosen, name, at, [hover[place] for place in those], **look, **ends))
    return "Probability that the cage is stable", axis(name, "-", [], low=-0.06, high=1.06), marks


def _frequencies(cases: Sequence[Part], way: Way, hover: Sequence[str]) -> Made:
    marks: list[Mark] = []
    for name, (colour, line, marker) in FREQUENCIES.items():
        if any(one.get(name) for one in cases):
            look: dict[str, Any] = {"colour": colour, "name": quantity(name).label, "line": line}
            look |= {} if way.is_line else {"marker": marker}
            marks.append(_trace([*cases], name, way, hover, **look))
    for sign, way_round, marker in ((1.0, "forward", "^"), (-1.0, "backward", "v")):
        those = [place for place, one in enumerate(cases) if sign * (one.get("orbit_frequency") or 0.0) > 0.0]
        if those:
            y = [abs(cases[place].orbit_frequency) for place in those]
            texts = tuple(f"{hover[place]}: orbit {told(cases[place], 'orbit_frequency')}" for place in those)
            look = {"line": "", "marker": marker, "size": 5.0, "colour": VERMILION, "hover": texts}
            name = f"{quantity('orbit_frequency').label}, {way_round}"
            marks.append(Trace(x=[way.places[place] for place in those], y=y, name=name, **look))
    return "Frequencies on the housing", axis("frequency", "Hz", [], is_log=True), marks


PANELS = {"margin": _margin, "probability_stable": _probability}
"""Panels above the frequencies, each for a number of the cases; without any the restitution factor."""


def _worst(way: Way, cases: Sequence[Part], worst: Part | None, answer: Part) -> list[Mark]:
    """Return the place of the worst case, and of those that were refused."""
    marks: list[Mark] = []
    refused = [place for place, one in zip(way.places, cases, strict=True) if is_refused(one)]
    if refused:
        marks += [Across(at=place, colour=GREY, line=":", name="refused") for place in refused]
    for place, one in zip(way.places, cases, strict=True):
        if worst is not None and one.case == worst.case:
            name = f"worst, {case_words(answer, worst)}"
            marks.append(Across(at=place, colour=VERMILION, line="--", name=name))
    return marks


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
