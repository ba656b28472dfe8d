"""`check`: what a study states and assumes, its pressures at standstill, and what verbs will refuse."""

from __future__ import annotations

from collections.abc import Mapping
from math import isclose
from typing import Any

from separatrix.ground.document import Part
from separatrix.present.blocks import Heading, Level, Note, Page, facts, grouped
from separatrix.present.quantity_text import fact, fill, show
from separatrix.verbs.parts.answer_page import APPENDIX, bearing_facts, entry_words, page_of
from separatrix.verbs.parts.bearing_drawing import bearing_picture
from separatrix.verbs.parts.chain_blocks import clearance_facts
from separatrix.verbs.verb import Verb, later

SECTIONS = ("cage", "ranking")
"""Sections that a study may lack."""


def page(answer: Part) -> Page:
    """Return the page of `check`."""
    study = answer.values["study"]
    inputs = [(one["name"], one["words"]) for one in study["uncertain_inputs"]]
    reasons = grouped((one.sentence, one.verb) for one in answer.refusals)  # each once
    return page_of(
        answer,
        Note(verdict(answer), "lead"),
        Heading("Refused"),
        facts(*((", ".join(verbs), sentence) for sentence, verbs in reasons.items())),
        Heading("What the study states"),
        facts(*bearing_facts(answer), *ring_facts(answer), *cage_facts(answer), *candidate_facts(study)),
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
    absent = [f"[{name}]" for name in SECTIONS if not answer.values["study"].get(name)]
    words = "The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else "")
    verbs = dict.fromkeys(f"`{one.verb}`" for one in answer.refusals)
    return words + (f" {', '.join(verbs)} {'refuses' if len(verbs) == 1 else 'refuse'} it." if verbs else "")


def ring_facts(answer: Part) -> list[tuple[str, str]]:
    """Return the speed parameter, and the pressures at standstill or why there are none."""
    has_bore = answer.values["study"]["bearing"]["bore"]["value"] is not None
    speed = f"{{speed_parameter}} ({'bore' if has_bore else 'pitch diameter'} x speed)"
    pressure = f"not found: {answer.static_reason}"
    if answer.static is not None:
        inner, outer = (show(one, "max_pressure") for one in (answer.static.inner, answer.static.outer))
        words = "maximum of Hertz, most loaded ball; the mean is two thirds of it"
        pressure = f"inner {inner}, outer {outer} ({words})"
    return [("Speed parameter", fill(answer, speed)), ("Pressure at rest", pressure)]


def cage_facts(answer: Part) -> list[Any]:
    """Return the cage, and its clearances at rest and as it runs."""
    stated, found = answer.values["study"].get("cage"), answer.cage
    if not stated or found is None:
        return []
    guidance, state = stated["guidance"]["value"], stated["clearances"]["value"]
    when = "" if state == "as running" else f", {state}"
    guided = "guided by the balls" if guidance == "ball" else f"{guidance}-guided"
    name = (stated.get("material") or {}).get("name")
    pocket = fill(found, "{half_play} each way along the circumference")
    land = "no land: the balls guide the cage"
    if "land_gap" in found:
        least = " at the least" if stated["land_out_of_round"]["value"] else ""
        first = "before" if found.land_gap < found.half_play else "after"
        first = "together with" if isclose(found.land_gap, found.half_play) else first
        gap = f"{show(found, 'land_gap')} radial{least}, reached {first} the pockets"
        land = f"{entry_words(stated['land_clearance'])}: {gap}{when}"
    return [
        ("Cage", ", ".join(filter(None, [name, show(found, "mass"), guided]))),
        ("Pocket clearance", f"{entry_words(stated['pocket_clearance'])}: {pocket}{when}"),
        *([fact(found, "lean")] if found.lean != 0.0 else []),
        ("Land clearance", land),
        *clearance_facts(answer.clearances),
        ("Running clearances", answer.clearances_reason and f"not found: {answer.clearances_reason}"),
    ]


def candidate_facts(study: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the materials to rank, and where their frictions are known."""
    if not (ranking := study.get("ranking")):
        return []
    known = f"{'; '.join(ranking['environments'])} (from {ranking['origin']})"
    names = ", ".join(one["name"] for one in ranking["candidates"])
    return [("Candidates", names), ("Friction known in", known)]


def assumed(study: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the defaults of each section, in a line; where the default is an absence, what that means.

    Those of a land only where there is one.
    """
    from separatrix.study.sources import inputs_of

    is_landless = (study.get("cage") or {}).get("guidance", {}).get("value") == "ball"
    found = []
    for name, key, entry in inputs_of(study):
        default, _, meaning = str(entry["origin"]).partition(": ")
        if default.startswith("default") and not (is_landless and key.startswith("land_")):
            found.append((f"[{name}]", f"{key}: {meaning}" if meaning else f"{key} = {entry_words(entry)}"))
    return [(name, "; ".join(each)) for name, each in grouped(found).items()]


VERB = Verb(name="check", compute=later("chain_answers", "check_answer"), page=page, writes_data=False)
