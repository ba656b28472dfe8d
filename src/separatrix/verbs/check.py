"""`check`: what a study states and assumes, its pressures at standstill, and what verbs will refuse."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from separatrix.ground.document import Part
from separatrix.present.blocks import Heading, Level, Note, Page, facts, grouped
from separatrix.verbs.parts.answer_page import APPENDIX, entry_words, page_of
from separatrix.verbs.parts.bearing_drawing import bearing_picture
from separatrix.verbs.parts.chain_blocks import clearance_facts
from separatrix.verbs.parts.study_facts import bearing_facts
from separatrix.verbs.parts.telling import fact, said
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import CheckAnswer, CheckedCage, FirstReached, Refusal

FIRST = {"POCKETS": "reached after the pockets", "LAND": "reached before the pockets"}
FIRST |= {"BOTH": "reached together with the pockets"}


def compute(study: Study, _options: NoOptions) -> CheckAnswer:
    """What follows of a study in a second, the bearing at standstill, and what verbs will refuse."""
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import SeparatrixError
    from separatrix.verbs.answer_records import CheckAnswer

    at, on = study.bearing, study.operation
    found = CheckAnswer(
        speed_parameter=(at.bore or at.pitch_diameter) * abs(on.inner_speed - on.outer_speed),
        cage=_cage(study),
        refusals=tuple(_refusals(study)),
        static=None,
    )
    try:
        static = solve(replace(study, operation=replace(on, inner_speed=0.0, outer_speed=0.0))).bearing
        found = replace(found, static=static, notes=static.notes)
    except SeparatrixError as error:
        found = replace(found, static_reason=str(error))
    try:
        clearances = solve(study).clearances
    except SeparatrixError as error:
        return replace(found, clearances_reason=str(error))
    notes = clearances.notes if clearances else ()
    return replace(found, clearances=clearances, notes=(*found.notes, *notes))


def _refusals(study: Study) -> Iterator[Refusal]:
    from separatrix.verbs import refusals
    from separatrix.verbs.answer_records import Refusal

    for verb, sentence in refusals(study):
        yield Refusal(verb=verb, sentence=sentence)


def _cage(study: Study) -> CheckedCage | None:
    from math import asin

    from separatrix.study.cage_body import cage_inertia
    from separatrix.study.pocket_shape import half_play, tilt
    from separatrix.verbs.answer_records import CheckedCage

    if study.cage is None:
        return None
    gap = None
    if study.cage.land_clearance is not None:
        gap = study.cage.land_clearance / 2.0 - study.cage.land_out_of_round
    return CheckedCage(
        mass=cage_inertia(study.cage, study.bearing).mass,
        half_play=half_play(study.cage),
        lean=asin(tilt(study.cage)[1]),
        land_gap=gap,
        first_reached=None if gap is None else _first(gap, half_play(study.cage)),
    )


def _first(gap: float, clearance: float) -> FirstReached:
    from math import isclose

    from separatrix.verbs.answer_records import FirstReached

    if isclose(gap, clearance):
        return FirstReached.BOTH
    return FirstReached.LAND if gap < clearance else FirstReached.POCKETS


def page(answer: Part) -> Page:
    """Return the page of `check`."""
    study = answer.values["study"]
    inputs = [(one["name"], one["words"]) for one in study["uncertain_inputs"]]
    return page_of(
        answer,
        Note(verdict(answer), "lead"),
        *([Heading("Refused")] if answer.refusals else []),
        facts(*refused_by(answer)),
        Heading("What the study states"),
        facts(*bearing_facts(answer), *speed_facts(answer), *pressure_facts(answer), *cage_facts(answer)),
        bearing_picture(answer, None),
        Heading("Assumed, because the study does not state it", Level.BRIEF),
        facts(*assumed(study), level=Level.BRIEF),
        Heading("Uncertain inputs"),
        facts(*inputs),
        draws=True,
        appendix=Level.FULL | APPENDIX,
    )


def verdict(answer: Part) -> str:
    """Return whether the study is valid, what it lacks, and which verbs refuse it."""
    study = answer.values["study"]
    absent = [f"[{name}]" for name in SECTIONS if not study.get(name)]
    words = "The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else "")
    verbs = dict.fromkeys(f"`{one.verb}`" for one in answer.refusals)
    refuse = "refuses" if len(verbs) == 1 else "refuse"
    return words + (f" {', '.join(verbs)} {refuse} it." if verbs else "")


SECTIONS = ("cage", "ranking")
"""Sections that a study may lack."""


def refused_by(answer: Part) -> list[tuple[str, str]]:
    """Return what is refused, each reason once with the verbs that have it."""
    each = grouped((one.sentence, one.verb) for one in answer.refusals)
    return [(", ".join(verbs), sentence) for sentence, verbs in each.items()]


def speed_facts(answer: Part) -> list[tuple[str, str]]:
    """Return the speed parameter, and of which diameter it is."""
    has_bore = answer.values["study"]["bearing"]["bore"]["value"] is not None
    which = "bore" if has_bore else "pitch diameter"
    return [("Speed parameter", said(answer, f"{{speed_parameter}} ({which} x speed)"))]


def pressure_facts(answer: Part) -> list[tuple[str, str]]:
    """Return the pressures of the contacts at standstill, or why there are none."""
    at = answer.static
    if at is None:
        return [("Pressure at rest", f"not found: {answer.static_reason}")]
    races = (said(getattr(at, race), f"{race} {{max_pressure}}") for race in ("inner", "outer"))
    words = "maximum of Hertz, most loaded ball; the mean is two thirds of it"
    return [("Pressure at rest", f"{', '.join(races)} ({words})")]


def cage_facts(answer: Part) -> list[Any]:
    """Return the cage, its clearances at rest and as it runs, and the candidates for its material."""
    study, found = answer.values["study"], answer.cage
    if found is None:
        return []
    stated = study["cage"]
    guidance = stated["guidance"]["value"]
    guided = "guided by the balls" if guidance == "ball" else f"{guidance}-guided"
    name = (stated.get("material") or {}).get("name")
    rows: list[Any] = [
        ("Cage", ", ".join(filter(None, [name, said(found, "{mass}"), guided]))),
        *_clearance_facts(stated, found),
    ]
    rows += [] if answer.clearances is None else clearance_facts(answer.clearances)
    if answer.clearances_reason:
        rows.append(("Running clearances", f"not found: {answer.clearances_reason}"))
    return rows + candidate_facts(study.get("ranking"))


def _clearance_facts(stated: Mapping[str, Any], found: Part) -> list[Any]:
    """Return the clearance in the pockets and on the land, and which of them the cage reaches first."""
    state = stated["clearances"]["value"]
    when = "" if state == RUNNING else f", {state}"
    pocket = said(found, "{half_play} each way along the circumference")
    rows: list[Any] = [("Pocket clearance", f"{entry_words(stated['pocket_clearance'])}: {pocket}{when}")]
    if found.lean != 0.0:
        rows.append(fact(found, "lean"))
    if "land_gap" not in found:
        return [*rows, ("Land clearance", "no land: the balls guide the cage")]
    least = " at the least" if stated["land_out_of_round"]["value"] else ""
    land = f"{said(found, '{land_gap}')} radial{least}, {FIRST[found.first_reached]}"
    return [*rows, ("Land clearance", f"{entry_words(stated['land_clearance'])}: {land}{when}")]


RUNNING = "as running"


def candidate_facts(ranking: Mapping[str, Any] | None) -> list[Any]:
    """Return the materials to rank, and where their frictions are known."""
    if not ranking:
        return []
    names = ", ".join(one["name"] for one in ranking["candidates"])
    known = f"{'; '.join(ranking['environments'])} (from {ranking['origin']})"
    return [("Candidates", names), ("Friction known in", known)]


def assumed(study: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the defaults of each section, in a line; where the default is an absence, what that means.

    Those of a land only where there is one.
    """
    from separatrix.study.sources import inputs_of

    is_landless = (study.get("cage") or {}).get("guidance", {}).get("value") == "ball"
    found = []
    for name, key, entry in inputs_of(study):
        if is_landless and key.startswith("land_"):
            continue
        default, _, meaning = str(entry["origin"]).partition(": ")
        if default.startswith("default"):
            found.append((f"[{name}]", f"{key}: {meaning}" if meaning else f"{key} = {entry_words(entry)}"))
    return [(name, "; ".join(each)) for name, each in grouped(found).items()]


VERB = Verb(
    name="check",
    compute=compute,
    page=page,
    has_full=True,
    writes_data=False,
)
