"""`sensitivity`: draw bearings from the uncertain inputs and judge the cages of every candidate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from separatrix.ground.plain_data import Part
from separatrix.present.blocks import (
    Block,
    Heading,
    Level,
    Note,
    Page,
    Table,
    explained,
    facts,
    grouped,
    text_column,
)
from separatrix.present.quantity_text import all_numbers, begun, column, fill, number_of, show
from separatrix.verbs.parts import verdict_blocks as of
from separatrix.verbs.parts.answer_page import page_of
from separatrix.verbs.parts.verdict_blocks import MARK, each_verdict, evidence_column, judged, verdict
from separatrix.verbs.verb import Samples, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import SensitivityAnswer
    from separatrix.verdict.long_jobs import Runner

GUESS = "?"
"""After a friction whose scatter is a guess."""

LISTED, LEAST = 12, 0.02
"""Rows of sources, and the least share of an input shown; the workbook has all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How many bearings are drawn."""

    samples: Samples = 512


def compute(study: Study, options: Options, runner: Runner) -> SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate."""
    from separatrix.verbs.cage_answers import SensitivityAnswer
    from separatrix.verbs.parts import cage_of_study as asked
    from separatrix.verdict.uncertain_study import uncertain_study

    asked.refuse_samples(options.samples)
    solution = asked.reference(study)
    asked.drawn_bearings(solution)  # refused before anything is timed
    drawn = partial(uncertain_study, study, options.samples, runner=runner)
    return asked.answer_of_cage(SensitivityAnswer, "uncertain", solution, drawn)


def page(answer: Part) -> Page:
    """Return the page of `sensitivity`: verdicts over the uncertain inputs, and what decides them."""
    rows = answer.materials
    shares = ((one.name, each) for one in answer.drivers for each in one.shares)
    return page_of(
        answer,
        Note(f"With the uncertain inputs drawn, in {answer.environment}: {each_verdict(rows)}.", "lead"),
        Heading(begun(answer.environment)),
        *verdicts(rows),
        *footnotes(answer, rows),
        Heading("Main sources of uncertainty"),
        *sources(answer),
        Heading("Basis of this answer", Level.LONG),
        facts(*ensemble_facts(answer), level=Level.LONG),
        all_numbers("all numbers", ("material",), ((row.name, row) for row in rows)),
        all_numbers("all shares", ("material",), shares),
        draws=True,
    )


def verdicts(rows: Sequence[Part]) -> list[Block]:
    """Return friction, P(stable), verdict and motion of each candidate."""

    def marks(row: Part) -> str:
        return GUESS * bool(row.get("friction_scatter_assumed")) + MARK * bool(row.extrapolation)

    runs = "from the worst initial disturbance; fewer where the verdict was plain before"
    columns = (
        text_column("material", lambda row: row.name),
        column("friction", head="friction of a new cage", mark=marks),
        column("probability_stable", of=judged),
        text_column("verdict", verdict),
        of.motion_column(),
        *map(evidence_column, ("largest_offset", "largest_contact_force")),
        replace(column("runs", of=judged), meaning=runs),
    )
    return [Table("verdicts", columns, tuple(rows)), Note(explained(columns), "legend", Level.LONG)]


def footnotes(answer: Part, own: Sequence[Part]) -> Iterator[Note]:
    """Yield the restitution factors in the study's environment, and what the marks beside frictions mean."""
    known = [(show(row, "restitution_factor"), row.name) for row in own if "restitution_factor" in row]
    if known:
        each = of.by_verdict(known) if len({eta for eta, _ in known}) > 1 else known[0][0]
        yield Note(f"Restitution factor $eta$ of the drawn bearings, median (nine in ten): {each}.", "legend")
    if any(row.get("friction_scatter_assumed") for row in own):
        assumed = "its scatter from sample to sample was not measured: {default_scatter} of the mean is "
        yield Note(fill(answer, f"{GUESS} {assumed}assumed, a guess ([ranking] friction_scatter)."), "legend")
    yield from of.footnotes(own)


def ensemble_facts(answer: Part) -> Iterator[tuple[str, str]]:
    """Yield the uncertain inputs, and the ensemble with its seed."""
    yield from ((row.name, row.distribution) for row in answer.inputs if not is_friction(row.name))
    failed = f", of which {answer.failed} make no bearing" if answer.failed else ""
    yield "Bearings drawn", f"{show(answer, 'bearings')}{failed}; seed {answer.seed}"
    yield "Initial disturbances", ", ".join(number_of(answer, "kicks", one) for one in answer.kicks)
    yield "Runs", f"{show(answer, 'runs')} in all"
    yield "Ended early", fill(answer, "at a risk of {stopped_risk} of another verdict at each look")


def sources(answer: Part) -> Iterator[Block]:
    """Yield the sources of the cases that have any, the least decided first, and how many have none."""
    chances = {row.name: row.get("probability_stable") or 0.0 for row in answer.materials}
    known = [one for one in answer.drivers if one.shares]
    known.sort(key=lambda one: abs(chances[one.name] - 0.5))
    shares = [(case, one) for case in known for one in case.shares if one.share >= LEAST]
    columns = (
        text_column("material", lambda row: row[0].name),
        text_column("input", lambda row: "own friction" if is_friction(row[1].name) else row[1].name),
        column("share", of=lambda row: row[1]),
        column("skill", of=lambda row: row[0]),
    )
    yield Table("sources", columns, tuple(shares[:LISTED]), SOURCES)
    for reason, names in grouped((one.reason, one.name) for one in answer.drivers if one.reason).items():
        level = Level.LONG if known else Level.ALWAYS
        yield Note(f"No sources for {', '.join(names)}: {reason}.", level=level)


SOURCES = (
    "Share of the variance of the logit of P(settles) that an input brings (95 %), from 2 %, by a logistic "
    "regression of the runs: what measuring it could take away at most. Chance: the single run's disturbance "
    "and leads. Skill: part of the deviance explained, on bearings left out of the fit."
)


def is_friction(name: str) -> bool:
    """Whether an input is the friction of a candidate."""
    return name.startswith("ranking.") and ".material." not in name


VERB = Verb(
    name="sensitivity",
    compute=compute,
    page=page,
    epilog="Every number that the study writes with a distribution is drawn, and the frictions with "
    "their scatter: 9 % of the mean where none was measured, a guess.",
    options=Options,
    needs=("cage", "ranking"),
    moves_a_cage=True,
    keeps_runs=True,
    links=("candidate_cages", "drawn_bearings"),
)
