"""Text of a resolved study: every value with where it came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import asin, degrees, isclose, pi
from typing import Any, NamedTuple

from separatrix.pocket_shape import half_play, tilt
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, table
from separatrix.study import PocketShape
from separatrix.units import format_quantity

Entry = Mapping[str, Any]
SECTIONS = ("bearing", "operation", "kinematics", "film", "cage", "stability")


def check(document: Entry) -> list[str]:
    """What matters first, and everything that was assumed; the rest is in `every_input`."""
    study = document["study"]
    blocks = [facts([*_machine(study), *_static(document), *_cage(study), *_candidates(study)])]
    if assumed := _assumed(study):
        blocks.append(section("Assumed, as the study does not say otherwise", facts(assumed)))
    if uncertain := study.get("uncertain_inputs"):
        blocks.append(section("Uncertain inputs", _uncertain(uncertain)))
    return [*blocks, _valid(study)]


def _machine(study: Entry) -> list[tuple[str, str]]:
    """Bearing, operation and film on a line each, with the speed parameter."""
    bearing, operation, film = (study[name] for name in ("bearing", "operation", "film"))
    bore = f", bore {shown(bearing['bore'])}" if bearing["bore"]["value"] is not None else ""
    sizes = f"{shown(bearing['ball_count'])} balls of {shown(bearing['ball_diameter'])}"
    loads = [
        f"{shown(operation[name])} {words}"
        for name, words in (("axial_load", "axial"), ("radial_load", "radial"), ("moment", "moment"))
        if operation[name]["value"]
    ]
    around = [shown(operation[name]) for name in ("fluid", "temperature") if operation[name]["value"]]
    speeds = [
        f"{ring} ring {shown(operation[f'{ring}_speed'])}"
        for ring in ("inner", "outer")
        if ring == "inner" or operation[f"{ring}_speed"]["value"]
    ]
    coat = "none" if film["is_bare"] else f"{shown(film['material'])}, {shown(film['thickness'])}"
    return [
        ("Bearing", f"{sizes}, pitch diameter {shown(bearing['pitch_diameter'])}{bore}"),
        ("Contact", f"{shown(bearing['contact_angle'])} free angle; balls {shown(bearing['ball_material'])}, "
                    f"rings {shown(bearing['ring_material'])}"),
        ("Operation", ", ".join([*speeds, *loads]) + (f"; {' at '.join(around)}" if around else "")),
        ("Speed parameter", _speed_parameter(bearing, operation)),
        ("Film on the races", f"{coat}; friction {shown(film['race_friction'])}"),
    ]  # fmt: skip


def _speed_parameter(bearing: Entry, operation: Entry) -> str:
    """DN as catalogues have it, of the bore, or of the pitch diameter if the bore is not given."""
    which = "pitch_diameter" if bearing["bore"]["value"] is None else "bore"
    turns = abs(operation["inner_speed"]["value"] - operation["outer_speed"]["value"]) * 30.0 / pi
    product = 1e3 * bearing[which]["value"] * turns
    return f"{product / 1e6:.3g} million mm rpm ({which.replace('_', ' ')} x speed)"


def _static(document: Entry) -> list[tuple[str, str]]:
    """Contact pressure at standstill, of the most loaded ball."""
    if document["static"] is None:
        return [("Pressure at rest", f"not found: {document['static_reason']}")]
    each = [
        f"{race} {_pressure(at['max_pressure'] / 1.5)} mean, {_pressure(at['max_pressure'])} maximum"
        for race, at in document["static"].items()
    ]
    return [("Pressure at rest", f"{'; '.join(each)} (Hertz, most loaded ball)")]


def _pressure(pressure: float) -> str:
    return quantity(float(f"{pressure:.3g}"), "Pa")


def _cage(study: Entry) -> list[tuple[str, str]]:
    """The cage on a line, and its room."""
    cage = study["cage"]
    if cage is None:
        return []
    name = cage["material"].get("name")
    material = {None: "", "given in the study": "material given in the study, "}.get(name, f"{name}, ")
    guided = {"ball": "guided by the balls"}.get(
        cage["guidance"]["value"], f"{cage['guidance']['value']}-guided"
    )
    return [("Cage", f"{material}{shown(cage['mass'])}, {guided}"), *room(cage)]


def _candidates(study: Entry) -> list[tuple[str, str]]:
    """How many candidates there are, and in which environments their friction is known."""
    ranking = study["ranking"]
    if ranking is None:
        return []
    names = [candidate["name"] for candidate in ranking["candidates"]]
    each = "; ".join(ranking["environments"])
    return [("Candidates", ", ".join(names)), ("Friction known in", f"{each} (from {ranking['origin']})")]


def _assumed(study: Entry) -> list[tuple[str, str]]:
    """Defaults of each section, in a line."""
    found = []
    for name in (*SECTIONS, "ranking"):
        entries = (study[name] or {}).items()
        each = [_default(key, entry) for key, entry in entries if _is_default(entry)]
        if each:
            found.append((f"[{name}]", "; ".join(each)))
    return found


def _is_default(entry: Any) -> bool:
    return isinstance(entry, Mapping) and str(entry.get("origin", "")).startswith("default")


def _default(key: str, entry: Entry) -> str:
    """A default value, or what its absence means."""
    meaning = entry["origin"].partition(": ")[2]
    return f"{key}: {meaning}" if meaning else f"{key} = {shown(entry)}"


def _valid(study: Entry) -> str:
    absent = [f"[{name}]" for name in (*SECTIONS, "ranking") if study[name] is None]
    return "The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else "")


def every_input(document: Entry) -> list[str]:
    """Every resolved input, its origin, and the sources of the materials."""
    study = document["study"]
    given = [name for name in SECTIONS if study[name] is not None]
    blocks = []
    for name in given:
        blocks.append(section(f"[{name}]", _values(study[name])))
        if name == "cage":
            blocks.append(section("Clearances of the cage", facts(room(study["cage"]))))
    if study["ranking"] is not None:
        blocks.append(section("[ranking] ball/cage friction", _frictions(study["ranking"])))
    if uncertain := study.get("uncertain_inputs"):
        blocks.append(section("Uncertain inputs, their means above", _uncertain(uncertain)))
    blocks.append(section("Sources of the materials", *_sources(study)))
    return [*blocks, _valid(study)]


def _values(part: Entry) -> str:
    rows = [
        [name, shown(entry), entry["origin"]] for name, entry in part.items() if isinstance(entry, Mapping)
    ]
    return table(("", "value", "from"), rows, left=3)


def _uncertain(inputs: Sequence[Entry]) -> str:
    return facts([(one["name"], one["words"]) for one in inputs])


def at_their_means(inputs: Sequence[Entry]) -> str:
    """Return the sentence of a verb that takes one value of each input."""
    names = ", ".join(one["name"] for one in inputs[:6]) + (", ..." if len(inputs) > 6 else "")
    several = f"{len(inputs)} uncertain inputs stand at their means"
    return f"{several if len(inputs) > 1 else 'An uncertain input stands at its mean'}: {names}."


def shown(entry: Entry) -> str:
    """Return the value of a resolved input as a reader likes it."""
    if "name" in entry:
        return str(entry["name"])
    value, unit = entry["value"], entry.get("unit", "")
    if isinstance(value, Sequence) and not isinstance(value, str):
        return _several(value, unit)
    if value is None or isinstance(value, bool | str):
        return ABSENT if value is None else str(value)
    return format_quantity(value, unit, 7) if unit not in ("", "-") else f"{value:g}"


def room(cage: Entry) -> list[tuple[str, str]]:
    """Return the clearance of the cage in its pockets and on its land, and which of them it meets first."""
    shape, *sizes = (cage[name]["value"] for name in _Pocket._fields)
    pocket = _Pocket(PocketShape(shape), *sizes)
    play, (_, sine) = half_play(pocket), tilt(pocket)
    rows = [("Pocket clearance", quantity(play, "m") + " each way, along the circumference")]
    if sine != 0.0:
        rows.append(("Lean of its contact", quantity(asin(sine), "rad") + ", towards the bearing axis"))
    clearance = cage["land_clearance"]["value"]
    if clearance is None:
        return [*rows, ("Land clearance", "no land: the balls guide the cage")]
    gap = clearance / 2.0 - cage["land_out_of_round"]["value"]
    order = "together with" if isclose(gap, play) else "before" if gap < play else "after"
    return [*rows, ("Land clearance", f"{quantity(gap, 'm')} radial, reached {order} the pockets")]


class _Pocket(NamedTuple):
    """What `half_play` needs of a resolved cage; the fields are its keys."""

    pocket_shape: PocketShape
    pocket_clearance: float
    pocket_axial_clearance: float | None
    pocket_axial_offset: float


def _several(values: Sequence[float], unit: str) -> str:
    if not values:
        return ABSENT
    if unit == "rad":
        return _several([round(degrees(value), 4) for value in values], "deg")
    tail = "" if unit in ("", "-") else f" {unit}"
    if len(values) > 4:
        return f"{values[0]:g} ... {values[-1]:g}{tail} ({len(values)})"
    return ", ".join(f"{value:g}" for value in values) + tail


def _frictions(ranking: Entry) -> str:
    """Return the friction table; what each column is stands below it."""
    environments = ranking["environments"]
    letters = [chr(ord("A") + i) for i in range(len(environments))]
    rows = [
        [candidate["name"], *(_friction(candidate["friction"].get(name)) for name in environments)]
        for candidate in ranking["candidates"]
    ]
    meaning = [(letter, name) for letter, name in zip(letters, environments, strict=True)]
    return "\n".join([table(("", *letters), rows), facts([*meaning, ("from", ranking["origin"])])])


def _friction(friction: Entry | None) -> str:
    if friction is None:
        return "not measured"
    spread = friction["standard_deviation"]
    return number(friction["mean"]) + ("" if spread is None else f" +/- {spread:.2g}")


def _sources(study: Entry) -> list[str]:
    """Return each material once, with its numbers, its sources and how sure they are."""
    materials: dict[str, Entry] = {}
    for name in SECTIONS:
        for entry in (study[name] or {}).values():
            if isinstance(entry, Mapping) and "elastic_modulus" in entry:
                materials[entry["name"]] = entry
    for candidate in (study["ranking"] or {}).get("candidates", ()):
        if candidate["material"] is not None:
            materials[candidate["name"]] = candidate["material"]
    return [paragraph(_source(entry), first="  ", indent="    ") for entry in materials.values()]


def _source(entry: Entry) -> str:
    numbers = f"E {quantity(entry['elastic_modulus']['value'], 'Pa')}, nu {entry['poisson_ratio']['value']:g}"
    if entry["source"] == entry["confidence"]:  # of a material written in place
        return f"{entry['name']}: {numbers}, from the study"
    said = f"{entry['name']}: {numbers}. {entry['source']} (confidence: {entry['confidence']})"
    return f"{said}{_library(entry)}"


def _library(entry: Entry) -> str:
    """Return the user's library that a material is from; nothing for a shipped one or one in place."""
    library = (entry.get("record") or {}).get("library")
    if library is None or library["shipped"]:
        return ""
    return f", from {library['file']} (sha256 {library['sha256'][:12]}...)"
