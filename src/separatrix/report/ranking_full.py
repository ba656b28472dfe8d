"""Text of a ranking: all of it, for every environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.report.cage import (
    chain_facts,
    ensemble_facts,
    judgement_facts,
    motion_words,
    study_facts,
)
from separatrix.report.ranking import (
    LEGEND,
    ensemble,
    footnotes,
    in_short,
    lowest,
    reasons,
    title,
    uncertain,
    verdicts,
)
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]

EVIDENCE_HEADERS = (
    "material",
    "motion",
    "bearing's\neta",
    "growth rate 1/s\n(95 %)",
    "offset\nmm",
    "drift\n1/s",
    "pocket\nN",
    "land\nN",
    "whirl\nHz",
    "whirl\nratio",
)


DIRECTIONS = {1: "forward", -1: "backward", 0: ""}


def every_environment(document: Document) -> list[str]:
    """Verdict, margin, rank, evidence and reason of each candidate in each environment, then overall."""
    own, overall = document["environment"], document["overall"]
    ordered = sorted(document["environments"], key=lambda one: bool(one["name"] != own))
    several = len(ordered) > 1
    return [
        paragraph(in_short(document), indent=""),
        *(_environment(document, one) for one in ordered[:1]),
        *uncertain(document, ordered[0]["materials"]),
        paragraph(LEGEND),
        paragraph(EVIDENCE_LEGEND),
        *_first(ordered[0]["materials"]),
        section("What the verdicts hold for", facts(_holds_for(document))),
        *(_environment(document, one) for one in ordered[1:]),
        *([_overall(document, overall)] if several else []),
    ]


def _overall(document: Document, overall: Sequence[Document]) -> str:
    """Return the table of mean frictions, which belongs to no environment."""
    title = "Overall: mean friction over the measured environments"
    notes = [*([""] * any(row["extrapolation"] for row in overall)), *footnotes(overall), *_gaps(document)]
    return section(title, verdicts(overall), *notes, "", _evidence(overall), "", *reasons(overall))


def _environment(document: Document, one: Document) -> str:
    """Return verdicts, evidence and reasons of one environment."""
    rows = one["materials"]
    evidence = (f"  Evidence: {ensemble(document)}", "", _evidence(rows), "")
    notes = ("", *footnotes(rows), *lowest(rows), "")
    return section(title(one["name"]), verdicts(rows), *notes, *evidence, *reasons(rows))


def _first(rows: Sequence[Document]) -> list[str]:
    """Return all the evidence of the candidate at the top; nothing if it has no verdict."""
    return [
        section(f"{row['name']} in detail", facts(judgement_facts(row)))
        for row in rows[:1]
        if row["verdict"] is not None
    ]


EVIDENCE_LEGEND = (
    "motion: what most runs from the worst kick end in. growth rate: of the amplitude, mean over those runs. "
    "offset of the cage centre, force at a pocket and at the land: largest in any run. drift: median growth "
    "of the mean offset of the runs that do not whirl. whirl: median of the runs that whirl, of all runs if "
    "none does, seen from the balls; ratio: speed at which the centre orbits the axis over that of the balls."
)


def _gaps(document: Document) -> list[str]:
    """Return in how many environments a candidate was measured, if not in all."""
    total = len(document["environments"])
    found = {row["name"]: _measured(row["name"], document["environments"]) for row in document["overall"]}
    few = [f"{name} in {count}" for name, count in found.items() if count < total]
    return ["", paragraph(f"Measured in fewer than {total} environments: {', '.join(few)}.")] if few else []


def _measured(name: str, environments: Sequence[Document]) -> int:
    """Return in how many of the environments a candidate was measured."""
    found = [row for one in environments for row in one["materials"] if row["name"] == name]
    return sum(row["friction"] is not None for row in found)


def _evidence(rows: Sequence[Document]) -> str:
    """Return the evidence of verdicts; the bearing's eta only where candidates differ in it."""
    table_rows = [[row["name"], *_evidence_row(row)] for row in rows]
    alike = len({row[ETA] for row in table_rows} - {ABSENT}) <= 1
    shown = [i for i in range(len(EVIDENCE_HEADERS)) if not (alike and i == ETA)]
    cells = [[row[i] for i in shown] for row in table_rows]
    return table([EVIDENCE_HEADERS[i] for i in shown], cells, left=2)


ETA = EVIDENCE_HEADERS.index("bearing's\neta")


def _evidence_row(row: Document) -> list[str]:
    whirl = row["whirl_frequency"]
    if whirl is None:
        return [ABSENT] * (len(EVIDENCE_HEADERS) - 1)
    return [
        motion_words(row["cage_motion"]),
        number(row["restitution_factor"], 2),
        _growth(row),
        number(1e3 * row["largest_offset"]),
        significant(row["drift_rate"], 2),
        *(number(row[f"largest_{name}_force"], 0) for name in ("contact", "land")),
        f"{number(whirl, 1 if whirl < 10 else 0)} {DIRECTIONS[row['whirl_direction']]}".rstrip(),
        number(row["whirl_ratio"], 2),
    ]


def _growth(row: Document) -> str:
    rate = significant(row["growth_rate"], 3)
    if row["growth_rate_low"] is None:
        return rate
    low, high = (significant(row[f"growth_rate_{end}"], 3) for end in ("low", "high"))
    return f"{rate} ({low} to {high})"


def _holds_for(document: Document) -> list[tuple[str, str]]:
    return [
        *study_facts(document["study"]),
        *chain_facts(document["chain"]),
        *ensemble_facts(document),
        ("Ball on pocket", _pocket(document["pocket"])),
        ("Unrepeated tests", _scatter(document)),
        ("The paper's bound", document["paper_statement"]),
        *_disagreement(document),
    ]


def _pocket(pocket: Document) -> str:
    """Return what rubs in the pocket, of which friction was asked for."""
    low, high = pocket["slip_speed_low"], pocket["slip_speed_high"]
    slip = f"{pocket['slip_speed']:.3g} m/s"
    if high > 1.001 * low:
        slip += f" ({low:.3g} to {high:.3g} around the bearing)"
    pressure = quantity(float(f"{pocket['pressure']:.3g}"), "Pa")
    force = quantity(float(f"{pocket['impact_force']:.3g}"), "N")
    return f"slides at {slip}; mean pressure {pressure} in an impact of {force} (impact speed)"


def _scatter(document: Document) -> str:
    """Return what an unrepeated test is assumed to scatter, where any candidate's friction rests on that."""
    rows = [row for one in document["environments"] for row in one["materials"]]
    if not any(row["friction_scatter_assumed"] for row in rows):
        return "none: every friction has its measured scatter"
    share = 100.0 * document["friction_scatter"]
    return f"assumed to scatter by {share:.3g} % of their mean: a guess, [ranking] friction_scatter"


def _disagreement(document: Document) -> list[tuple[str, str]]:
    """Return what to say where the chain's own eta is below the paper's least."""
    eta, limit = document["restitution_factor"], document["solid_lubrication_limit"]
    if eta >= limit:
        return []
    text = f"The contact model gives {number(eta, 2)} for this film, below that {limit:g}. Both are shown."
    return [("This film", text)]
