"""The text of each verb, the place of its files, and the text of a resolved study with every origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from itertools import groupby
from math import asin, degrees, isclose, pi
from operator import itemgetter

from separatrix.ground.plain_data import Document
from separatrix.ground.units import format_quantity
from separatrix.study.cage_body import cage_inertia
from separatrix.study.pocket_shape import half_play, tilt
from separatrix.study.sources import inputs_of, resolved
from separatrix.study.study import ORDER, CageDesign, ClearanceState, Guidance, Study
from separatrix.told.cage import simulate
from separatrix.told.chain import bearing, mobility, restitution, running_clearances, traction
from separatrix.told.ranking import every_environment, only_table, rank
from separatrix.told.sensitivity import sensitivity
from separatrix.told.stability import stability, stability_map, sweep
from separatrix.told.tables import (
    ABSENT,
    facts,
    friction_table,
    grouped,
    heading,
    paragraph,
    quantity,
    section,
    table,
)
from separatrix.verbs.answer_records import CheckAnswer

INCOMPLETE = "INCOMPLETE: interrupted. What was not finished is left out, or has a dash in its place."

NAMED = 6
"""Uncertain inputs that a note names."""


def check(answer: CheckAnswer, study: Study) -> list[str]:
    """What matters first, and everything that was assumed; the rest is in `every_input`."""
    inputs = resolved(study)
    lines = [*_machine(study), ("Pressure at rest", _pressure_at_rest(answer))]
    if study.cage is not None:
        name = study.cage.material.name if study.cage.material else None
        material = {None: "", "given in the study": "material given in the study, "}.get(name, f"{name}, ")
        kind = study.cage.guidance.value
        guided = "guided by the balls" if kind == "ball" else f"{kind}-guided"
        mass = cage_inertia(study.cage, study.bearing).mass
        lines.append(("Cage", f"{material}{shown(mass, 'kg')}, {guided}"))
        lines += [*clearances(study.cage), *running_clearances(answer.clearances)]
        if answer.clearances_reason:
            lines.append(("Running clearances", f"not found: {answer.clearances_reason}"))
    if study.ranking is not None:
        names = ", ".join(candidate.name for candidate in study.ranking.candidates)
        each = f"{'; '.join(study.ranking.environments)} (from {inputs['ranking']['origin']})"
        lines += [("Candidates", names), ("Friction known in", each)]
    blocks = [facts(lines)]
    is_landless = study.cage is not None and study.cage.guidance is Guidance.BALL
    if assumed := _assumed(inputs, is_landless):
        blocks.append(section("Assumed, because the study does not state it", facts(assumed)))
    if study.distributions:
        blocks.append(section("Uncertain inputs", _uncertain(inputs)))
    return [*blocks, _valid(study)]


def _valid(study: Study) -> str:
    absent = [f"[{name}]" for name in ORDER if getattr(study, name) is None]
    return "The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else "")


def _machine(study: Study) -> list[tuple[str, str]]:
    """Bearing, operation and film on a line each, with the speed parameter."""
    bearing, operation, film = study.bearing, study.operation, study.film
    bore = "" if bearing.bore is None else f", bore {shown(bearing.bore, 'm')}"
    balls = f"{bearing.ball_count} balls of {shown(bearing.ball_diameter, 'm')}"
    steels = f"balls {bearing.ball_material.name}, rings {bearing.ring_material.name}"
    given = (
        (operation.axial_load, "N", "axial"),
        (operation.radial_load, "N", "radial"),
        (operation.moment, "N m", "moment"),
    )
    loads = [f"{shown(value, unit)} {words}" for value, unit, words in given if value]
    speeds = [f"inner ring {shown(operation.inner_speed, 'rad/s')}"]
    speeds += [f"outer ring {shown(operation.outer_speed, 'rad/s')}"] if operation.outer_speed else []
    around = [shown(one, unit) for one, unit in ((operation.fluid, ""), (operation.temperature, "K")) if one]
    coat = "none" if film.body is None else f"{film.body.name}, {shown(film.thickness, 'm')}"
    turns = abs(operation.inner_speed - operation.outer_speed) * 30.0 / pi
    diameter = bearing.pitch_diameter if bearing.bore is None else bearing.bore
    which = "pitch diameter" if bearing.bore is None else "bore"
    return [
        ("Bearing", f"{balls}, pitch diameter {shown(bearing.pitch_diameter, 'm')}{bore}"),
        ("Contact", f"{shown(bearing.free_angle, 'rad')} free angle; {steels}"),
        ("Operation", ", ".join([*speeds, *loads]) + (f"; {' at '.join(around)}" if around else "")),
        ("Speed parameter", f"{1e3 * diameter * turns / 1e6:.3g} million mm rpm ({which} x speed)"),
        ("Film on the races", f"{coat}; friction {shown(film.race_friction, '-')}"),
    ]


def _pressure_at_rest(answer: CheckAnswer) -> str:
    if answer.static is None:
        return f"not found: {answer.static_reason}"
    each = []
    for race, at in (("inner", answer.static.inner), ("outer", answer.static.outer)):
        most = at.ellipse.max_pressure
        each.append(f"{race} {quantity(most / 1.5, 'Pa', 3)} mean, {quantity(most, 'Pa', 3)} maximum")
    return f"{'; '.join(each)} (Hertz, most loaded ball)"


def clearances(cage: CageDesign) -> list[tuple[str, str]]:
    """Return the clearance of the cage in its pockets and on its land, and which of them it reaches first."""
    clearance, (_, sine) = half_play(cage), tilt(cage)
    stated = "" if cage.clearances is ClearanceState.RUNNING else f", {cage.clearances.value}"
    words = (
        f"{quantity(cage.pocket_clearance, 'm')}: {quantity(clearance, 'm')} each way along the circumference"
    )
    rows = [("Pocket clearance", words + stated)]
    if sine != 0.0:
        rows.append(("Lean of its contact", quantity(asin(sine), "rad") + ", towards the bearing axis"))
    if cage.land_clearance is None:
        return [*rows, ("Land clearance", "no land: the balls guide the cage")]
    gap = cage.land_clearance / 2.0 - cage.land_out_of_round
    order = "together with" if isclose(gap, clearance) else "before" if gap < clearance else "after"
    least = " at the least" if cage.land_out_of_round else ""
    words = f"{quantity(cage.land_clearance, 'm')}: {quantity(gap, 'm')} radial{least}"
    return [*rows, ("Land clearance", f"{words}, reached {order} the pockets{stated}")]


def _assumed(inputs: Document, is_landless: bool) -> list[tuple[str, str]]:
    """Defaults of each section, in a line; where the default is an absence, what that means.

    Those of a land only where there is one.
    """
    found = []
    for name, key, entry in inputs_of(inputs):
        if is_landless and key.startswith("land_"):
            continue
        default, _, meaning = str(entry["origin"]).partition(": ")
        if default.startswith("default"):
            found.append((f"[{name}]", f"{key}: {meaning}" if meaning else f"{key} = {_entry(entry)}"))
    return [(name, "; ".join(each)) for name, each in grouped(found).items()]


def every_input(answer: CheckAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Every resolved input, its origin, and the sources of the materials."""
    inputs, blocks = resolved(study), []
    for name, entries in groupby(inputs_of(inputs), key=itemgetter(0)):
        rows = [[key, _entry(entry), entry["origin"]] for _, key, entry in entries]
        blocks.append(section(f"[{name}]", table(("", "value", "from"), rows, left=3)))
        if name == "cage" and study.cage is not None:
            blocks.append(section("Clearances of the cage", facts(clearances(study.cage))))
    if study.ranking is not None:
        frictions = {candidate.name: candidate.friction for candidate in study.ranking.candidates}
        origin = ("from", str(inputs["ranking"]["origin"]))
        columns = friction_table(study.ranking.environments, frictions, origin)
        blocks.append(section("[ranking] ball/cage friction", columns))
    if study.distributions:
        blocks.append(section("Uncertain inputs, their means above", _uncertain(inputs)))
    blocks.append(section("Sources of the materials", *_sources(study)))
    return [*blocks, _valid(study)]


def _uncertain(inputs: Document) -> str:
    return facts([(one["name"], one["words"]) for one in inputs["uncertain_inputs"]])


def at_their_means(names: Sequence[str]) -> str:
    """Return the sentence of a verb that takes one value of each uncertain input."""
    listed = ", ".join(names[:NAMED]) + (", ..." if len(names) > NAMED else "")
    several = f"{len(names)} uncertain inputs are at their means"
    return f"{several if len(names) > 1 else 'An uncertain input is at its mean'}: {listed}."


def _entry(entry: Document) -> str:
    return str(entry["name"]) if "name" in entry else shown(entry["value"], entry.get("unit", ""))


def shown(value: object, unit: str) -> str:
    """Return the value of a resolved input as a reader likes it."""
    if isinstance(value, list | tuple):
        if unit == "rad":
            return shown([round(degrees(one), 4) for one in value], "deg")
        tail = "" if unit in ("", "-") else f" {unit}"
        if len(value) > 4:
            return f"{value[0]:g} ... {value[-1]:g}{tail} ({len(value)})"
        return ", ".join(f"{one:g}" for one in value) + tail if value else ABSENT
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ABSENT if value is None else str(value)
    return format_quantity(value, unit, 7) if unit not in ("", "-") else f"{value:g}"


def _sources(study: Study) -> list[str]:
    own = (study.bearing.ball_material, study.bearing.ring_material, study.film.body)
    materials = {one.name: one for one in (*own, study.cage.material if study.cage else None) if one}
    for candidate in study.ranking.candidates if study.ranking else ():
        if candidate.material is not None:
            materials[candidate.name] = candidate.material
    lines = []
    for one in materials.values():
        text = f"{one.name}: E {quantity(one.elastic_modulus, 'Pa')}, nu {one.poisson_ratio:g}"
        library = (one.record or {}).get("library")
        if one.source == one.confidence:  # of a material written in place
            text += ", from the study"
        else:
            text += f". {one.source} (confidence: {one.confidence})"
            if library is not None and not library["shipped"]:
                text += f", from {library['file']} (sha256 {library['sha256'][:12]}...)"
        lines.append(paragraph(text, first="  ", indent="    "))
    return lines


Parts = Callable[..., list[str]]
"""Blocks of text of an answer, whose type belongs to the verb, to a study."""

REPORTS: Mapping[str, Parts] = {
    "check": check,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "mobility": mobility,
    "stability": stability,
    "map": stability_map,
    "simulate": simulate,
    "rank": rank,
    "sensitivity": sensitivity,
    "sweep": sweep,
}

FULL: Mapping[str, Parts] = {"check": every_input, "rank": every_environment}
"""Of verbs whose answer is longer than a screen: all of it."""

QUIET: Mapping[str, Parts] = {"rank": only_table}
"""Of verbs whose answer can be shorter: what `--quiet` leaves."""

DRAWS = ("check", "rank", "sensitivity")
"""Verbs that show uncertain inputs as what they are."""


def in_words(
    verb: str, answer: object, study: Study, notes: Sequence[str], *, full: bool = False, quiet: bool = False
) -> str:
    """Return the answer as text, ASCII but for names in the study.

    `full` prints everything of an answer longer than a screen; `quiet` the answer alone, without notes.
    """
    missing = [] if _is_complete(answer) else [paragraph(INCOMPLETE, indent="")]
    if quiet and not full and verb in QUIET:
        return "\n\n".join([*missing, *QUIET[verb](answer, study)]) + "\n"
    parts = FULL.get(verb, REPORTS[verb]) if full else REPORTS[verb]
    blocks = [heading(study.title), *missing, *parts(answer, study)]
    means = [at_their_means([*study.distributions])] if study.distributions and verb not in DRAWS else []
    lines = [paragraph(note, first="Note: ", indent="      ") for note in (*means, *notes)]
    return "\n\n".join([*blocks, *(["\n".join(lines)] if lines else [])]) + "\n"


def _is_complete(answer: object) -> bool:
    """Whether no interrupt left anything out of the record of an answer, or of what it holds."""
    held = (getattr(answer, one.name) for one in fields(answer)) if is_dataclass(answer) else ()
    return all(getattr(one, "complete", True) for one in (answer, *held))


def whereabouts(verb: str, folder: str, *, overview: bool = False) -> str:
    """Return where the files are, and for a finished ranking which picture to open first."""
    if verb == "check":
        return f"This text and the document are in {folder}/\n"
    first = " (begin with rank-overview.png)" if overview else ""
    return f"Figures and data are in {folder}/{first}\n"
