"""`life`: when the cage becomes unstable as film and pockets wear."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from separatrix.ground.errors import InputError
from separatrix.ground.plain_data import Part
from separatrix.ground.units import parse
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
from separatrix.present.figure import BLUE, GREEN, VERMILION, Across, Band, Figure, Panel, Trace
from separatrix.present.quantity_text import all_numbers, axis, column, fill, quantity, show
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.verb import Option, Samples, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import LifeAnswer
    from separatrix.verdict.long_jobs import Runner

REVOLUTIONS = 1e3, 1e12
"""Least and most, up to which draws are followed."""

MOST_SPEED = 1e6

PHASES = "Duty cycle, CSV: speeds and loads in its first row, and time_share; a phase a row."
TEST = 'Speed of the inner ring in a test, "9000 rpm".'


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How far bearings are followed, and how many are drawn."""

    revolutions: Annotated[str | float, Option("Of the rings, up to which bearings are followed.", "N")] = 1e9
    samples: Samples = 4096
    cases: Annotated[Path | Sequence[Mapping[str, float]] | None, Option(PHASES, "FILE")] = None
    accelerated: Annotated[str | float | None, Option(TEST, "SPEED")] = None

    def __post_init__(self) -> None:
        """Read a table of phases: an answer has the phases themselves."""
        if isinstance(self.cases, Path):
            from separatrix.verdict.parameter_axes import asked_cases

            object.__setattr__(self, "cases", tuple(asked_cases((), self.cases)))


def compute(study: Study, options: Options, runner: Runner) -> LifeAnswer:
    """When the cage becomes unstable, over draws of what wears film and pockets."""
    from separatrix.chain.solution import solve
    from separatrix.study.candidates import reference_candidate
    from separatrix.verbs.cage_answers import LifeAnswer
    from separatrix.verbs.parts import cage_of_study as of
    from separatrix.verdict.life_table import life
    from separatrix.verdict.parameter_axes import asked_cases, plain_number

    revolutions = plain_number(str(options.revolutions), "--revolutions")
    of.refuse_outside("--revolutions", revolutions, *REVOLUTIONS)
    of.refuse_samples(options.samples)
    speed = options.accelerated
    speed = parse(speed, "rad/s", "--accelerated") if isinstance(speed, str) else speed
    if speed is not None and not 0.0 < abs(speed) < MOST_SPEED:
        raise InputError("--accelerated", "must be above 0 and below 1e6 [rad/s]", f"{speed:g}")
    found = life(
        study,
        revolutions=revolutions,
        draws=options.samples,
        cases=asked_cases((), options.cases) if options.cases else (),
        accelerated=speed,
        runner=runner,
    )
    solution = solve(study, reference_candidate(study, study.ranking) if study.ranking else None)
    notes = (*found.notes, *of.extrapolation_notes(solution))
    return LifeAnswer(solution=solution, cage=of.cage_of(solution), life=found, notes=notes)


def page(answer: Part) -> Page:
    """Return the page of `life`."""
    rows = [one for place, one in enumerate(answer.course) if place % SHOWN == 0]
    state = answer.values["study"]["cage"]["clearances"]["value"]
    when = "" if state == "as running" else f", {state}"
    heads = {f"{one}_clearance": f"{one} clearance{when}" for one in ("pocket", "land")}
    turned, *more = (column(name, head=heads.get(name, "")) for name in COURSE if name in rows[0])
    columns = turned, Column("time", lambda row: Cell(row.time, HOURS, "s")), *more
    drivers = (text_column("input", lambda row: row.name), column("correlation"))
    return page_of(
        answer,
        Note(" ".join([*lead(answer), *bare(answer), *why(answer), *again(answer), *faster(answer)]), "lead"),
        Heading(f"In the course of time, {answer.candidate}"),
        Table("course", columns, tuple(rows)),
        Note(LEGEND, "legend", Level.LONG),
        Picture("life", lambda: life_figure(answer), CAPTION),
        *([Heading("What the life follows")] if answer.drivers else []),
        Table("drivers", drivers, tuple(answer.drivers[:LISTED]), DRIVEN),
        Heading("Basis of this answer", Level.LONG),
        facts(
            ("Bearings drawn", show(answer, "draws")),
            ("Phases of the duty cycle", str(answer.phases) if answer.phases > 1 else None),
            ("Unstable from the start", show(answer, "unstable_at_start")),
            ("Never unstable", fill(answer, "{never_unstable}, up to {horizon} revolutions")),
            ("Reservoir empty at the end", show(answer, "reservoir_empty")),
            ("Deposit keeps half of the film", show(answer, "film_sustained")),
            ("Coverage where deposit balances wear", fill(answer, FIXED)),
            level=Level.LONG,
        ),
        all_numbers("all times", (), ((row,) for row in answer.course)),
        draws=True,
    )


SHOWN, LISTED = 12, 6
HOURS = replace(quantity("time"), unit="h", form=".1e")
COURSE = (
    *("revolutions", "probability_stable", "first_decile", "last_decile", "film_inner", "film_outer"),
    *("race_friction", "pocket_friction", "pocket_clearance", "land_clearance"),
)
LEGEND = (
    "Films and frictions: medians of the drawn bearings. First and last tenth: P(stable) below and above "
    "which a tenth of them lies."
)
CAPTION = (
    "P(stable) against revolutions: mean of the drawn bearings, and the range between a tenth and nine in "
    "ten of them; beside it the median film on both tracks."
)
FIXED = "{coverage_calm} while the cage is calm, {coverage_whirling} while it whirls (median of the draws)"
DRIVEN = (
    "Rank correlation of each drawn input with the life; the first is what a measurement narrows most. "
    "Negative: more of it, a shorter life."
)


def lead(answer: Part) -> Iterator[str]:
    """Yield after how many revolutions the cage is unstable."""
    whose, half = f"of the cages of {answer.candidate}", answer.get("revolutions_50")
    if half is None:
        yield fill(answer, f"Up to {{horizon}} revolutions {{never_unstable}} {whose} never become unstable.")
    elif half > 0.0:
        words = f"Half {whose} have become unstable by {{revolutions_50}} revolutions"
        words += ", a tenth by {revolutions_10}" * (answer.revolutions_10 > 0.0)
        words += ", nine in ten by {revolutions_90}" * ("revolutions_90" in answer)
        yield fill(answer, f"{words}.")
    if answer.unstable_at_start > 0.0:
        those = whose if half == 0.0 else "of them"
        yield fill(answer, f"{{unstable_at_start}} {those} are unstable from the start.")
    if half == 0.0 < (answer.get("revolutions_90") or 0.0):
        yield fill(answer, "Nine in ten are so by {revolutions_90} revolutions.")


BARE = 0.1
"""Film on a race over that of the first time of the course, below which the race is as good as bare."""


def bare(answer: Part) -> Iterator[str]:
    """Yield when a race loses its film, if that comes before half the cages are unstable."""
    new, ends = answer.course[0], answer.get("revolutions_50") or inf
    for row in answer.course:
        for race in ("inner", "outer"):
            if row.revolutions < ends and getattr(row, name := f"film_{race}") < BARE * getattr(new, name):
                words = f"But the {race} race has lost its film by {{revolutions}} revolutions (median): "
                yield fill(row, words + "the bearing then wears, whether its cage is stable or not.")
                return


WHY = {
    "film_worn": "the film on the races is worn",
    "pocket_opened": "the pockets have opened",
    "land_opened": "the land has opened",
    "friction_risen": "the friction of worn pockets has risen",
}


SURE = 3.0
"""Rank correlation over its standard error without dependence, from which an input is worth a measurement."""


def why(answer: Part) -> Iterator[str]:
    """Yield what ends it, and what to measure."""
    shares = sorted(((getattr(answer, name), name) for name in WHY), reverse=True)
    known = [f"{show(answer, name)} because {WHY[name]}" for share, name in shares if share >= 0.05]
    if known:
        yield f"Of those that become so, {', '.join(known)}."
    first = answer.drivers[0] if answer.drivers else None
    if first and abs(first.correlation) > SURE / sqrt(answer.draws):
        yield f"Measure first: {quantity(first.name).label} (rank correlation {show(first, 'correlation')})."


def again(answer: Part) -> Iterator[str]:
    """Yield when cages become stable again, and whether worn pockets leave them to their land by then."""
    worst = 1.0
    for row in answer.course:
        worst = min(worst, row.probability_stable)
        if row.probability_stable > worst + 0.2:
            land = answer.cage.get("land_clearance")
            by_land = land is not None and row.pocket_clearance > land
            words = ": pockets worn so wide leave the cage to its land." if by_land else "."
            yield fill(row, f"By {{revolutions}} revolutions more are stable again{words}")
            return


def faster(answer: Part) -> Iterator[str]:
    """Yield whether an accelerated test shows the same cage, and how much of the mission an hour of it is."""
    test = answer.get("accelerated")
    if test is None:
        return
    yield fill(
        test,
        "A test at {inner_speed} has a critical friction of {critical_friction} and P(stable) "
        "{probability_stable} with a new cage; an hour of it wears the films as {film_time} hours of this "
        "duty, the pockets of a calm cage as {pocket_time}.",
    )
    if abs(test.probability_stable - answer.course[0].probability_stable) > 0.2:
        yield "Its cage moves otherwise than that of the mission: do not scale its wear to the mission."


def life_figure(answer: Part) -> Figure:
    """Return P(stable) with its range, and the films, against revolutions."""
    rows = answer.course
    revolutions = [one.revolutions for one in rows]
    x = axis("revolutions", "-", revolutions, is_log=True)

    def each(name: str) -> list[float]:
        return [getattr(one, name) for one in rows]

    low, high = each("first_decile"), each("last_decile")
    chance = Panel(
        title=f"a  Cages of {answer.candidate}",
        x=x,
        y=axis("probability_stable", "-", [], low=-0.02, high=1.02),
        marks=(
            Across(at=0.5, axis="y", line=":"),
            Band(x=revolutions, low=low, high=high, name="a tenth to nine in ten of the bearings"),
            Trace(x=revolutions, y=each("probability_stable"), colour=BLUE, name="P(stable), mean"),
        ),
    )
    films = each("film_inner") + each("film_outer")
    film = Panel(
        title="b  Film on the tracks, median",
        x=x,
        y=axis("film_inner", rows[0].unit("film_inner"), films, label="film", low=0.0),
        marks=(
            Trace(x=revolutions, y=each("film_inner"), colour=VERMILION, name="inner race"),
            Trace(x=revolutions, y=each("film_outer"), colour=GREEN, line="--", name="outer race"),
        ),
    )
    return figure(answer, (chance, film), height=2.6)


VERB = Verb(
    name="life",
    compute=compute,
    page=page,
    epilog="Needs [wear]; wear coefficients of film and cage that it lacks are those of the library. A "
    "coefficient without a distribution or a range scatters by a factor of ten either way.",
    options=Options,
    needs=("cage",),
    moves_a_cage=True,
    keeps_runs=True,
    links=("worn_cage",),
)
