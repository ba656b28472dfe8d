"""`check`: what a study states and assumes, its pressures at standstill, refusals and long verbs."""

from __future__ import annotations

from dataclasses import replace
from math import asin, isclose
from typing import TYPE_CHECKING, Any, TypeVar

from separatrix.ground.plain_data import Part
from separatrix.present.blocks import Heading, Level, Note, Page, facts, grouped
from separatrix.present.quantity_text import fact, fill, show
from separatrix.verbs.parts.answer_page import APPENDIX, bearing_facts, entry_words, page_of
from separatrix.verbs.parts.chain_blocks import bearing_picture, clearance_facts
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from separatrix.ground.units import Second
    from separatrix.study.study import Study
    from separatrix.verbs.chain_answers import CheckAnswer, CheckedCage

Link = TypeVar("Link")
SECTIONS = ("cage", "ranking")
"""Sections that a study may lack."""

COUNTED, LONG = ("stability", "rank"), 60.0
"""Verbs whose time is expected, and what of one core is long [s]."""


def compute(study: Study, _options: NoOptions) -> CheckAnswer:
    """What follows of a study in a second, the bearing at standstill, and what verbs will refuse."""
    from separatrix.chain.solution import solve
    from separatrix.verbs import refusals
    from separatrix.verbs.chain_answers import CheckAnswer, LongVerb, Refusal

    at, on = study.bearing, study.operation
    still = replace(study, operation=replace(on, inner_speed=0.0, outer_speed=0.0))
    static, static_reason = _tried(lambda: solve(still).bearing)
    clearances, clearances_reason = _tried(lambda: solve(study).clearances)
    return CheckAnswer(
        refusals=tuple(Refusal(verb=verb, sentence=sentence) for verb, sentence in refusals(study)),
        long_verbs=tuple(LongVerb(verb=verb, one_core_time=time) for verb, time in _long_verbs(study)),
        speed_parameter=(at.bore or at.pitch_diameter) * abs(on.inner_speed - on.outer_speed),
        cage=_cage(study),
        static=static,
        static_reason=static_reason,
        clearances=clearances,
        clearances_reason=clearances_reason,
        notes=tuple(note for one in (static, clearances) if one is not None for note in one.notes),
    )


def _tried(link: Callable[[], Link]) -> tuple[Link | None, str]:
    """Return a link of the chain, or why it is refused."""
    from separatrix.ground.errors import SeparatrixError

    try:
        return link(), ""
    except SeparatrixError as error:
        return None, str(error)


def _long_verbs(study: Study) -> Iterator[tuple[str, Second]]:
    """Yield the verbs that take long, with the time that one core needs."""
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import SeparatrixError
    from separatrix.study.study import TractionSettings
    from separatrix.verbs import verb_named
    from separatrix.verdict.long_jobs import Counting, Foreseen, time_of_runs

    quick = replace(study, traction=TractionSettings(), distributions={})  # as many runs
    for name in COUNTED:
        verb = verb_named(name)
        if all(getattr(study, section) is not None for section in verb.needs):
            try:
                verb.compute(quick, verb.options(), Counting())
            except SeparatrixError:  # it is refused
                continue
            except Foreseen as found:
                time = time_of_runs(solve(quick), found.runs)
                if time > LONG:
                    yield name, time


def _cage(study: Study) -> CheckedCage | None:
    from separatrix.study.cage_body import cage_inertia
    from separatrix.study.cage_design import half_play, tilt
    from separatrix.verbs.chain_answers import CheckedCage

    cage = study.cage
    if cage is None:
        return None
    gap = None if cage.land_clearance is None else cage.land_clearance / 2.0 - cage.land_out_of_round
    mass, lean = cage_inertia(cage, study.bearing).mass, asin(tilt(cage)[1])
    return CheckedCage(mass=mass, half_play=half_play(cage), lean=lean, land_gap=gap)


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
        *([Heading("Uncertain inputs")] if inputs else []),
        facts(*inputs),
        draws=True,
        appendix=Level.FULL | APPENDIX,
    )


def verdict(answer: Part) -> str:
    """Return whether the study is valid, what it lacks, and which verbs refuse it or take long."""
    absent = [f"[{name}]" for name in SECTIONS if not answer.values["study"].get(name)]
    words = "The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else "")
    verbs = dict.fromkeys(f"`{one.verb}`" for one in answer.refusals)
    words += f" {', '.join(verbs)} {'refuses' if len(verbs) == 1 else 'refuse'} it." if verbs else ""
    minutes = [(one.verb, float(f"{one.one_core_time / 60.0:.1g}")) for one in answer.long_verbs]
    long = [f"`{verb}` takes about {time:g} min" for verb, time in minutes]
    return words + (f" On one core {' and '.join(long)}, within a factor of 3." if long else "")


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
    radius = " and the radius" * (stated["pocket_shape"]["value"] == "spherical")
    pocket = fill(found, f"{{half_play}} each way along the circumference{radius}")
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


VERB = Verb(name="check", compute=compute, page=page, writes_data=False)
