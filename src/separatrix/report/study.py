"""Text of a resolved study: every value with where it came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import asin, degrees
from typing import Any, NamedTuple

from separatrix.pocket_shape import half_play, tilt
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, table
from separatrix.study import PocketShape
from separatrix.units import format_quantity

Entry = Mapping[str, Any]
SECTIONS = ("bearing", "operation", "kinematics", "film", "cage", "stability")


def check(document: Entry) -> list[str]:
    """Every resolved input, its origin, and the sources of the materials."""
    study = document["study"]
    given = [name for name in SECTIONS if study[name] is not None]
    blocks = []
    for name in given:
        blocks.append(section(f"[{name}]", _values(study[name])))
        if name == "cage":
            blocks.append(section("Room of the cage", facts(room(study["cage"]))))
    if study["ranking"] is not None:
        blocks.append(section("[ranking] ball/cage friction", _frictions(study["ranking"])))
    if uncertain := study.get("uncertain_inputs"):
        blocks.append(section("Uncertain inputs, their means above", _uncertain(uncertain)))
    blocks.append(section("Sources of the materials", *_sources(study)))
    absent = [f"[{name}]" for name in (*SECTIONS, "ranking") if study[name] is None]
    blocks.append("The study is valid." + (f" It has no {' and no '.join(absent)}." if absent else ""))
    return blocks


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
    """Return the play that the cage has in its pockets and on its land, and which of them it meets first."""
    shape, *sizes = (cage[name]["value"] for name in _Pocket._fields)
    pocket = _Pocket(PocketShape(shape), *sizes)
    play, (_, sine) = half_play(pocket), tilt(pocket)
    rows = [("Half play in a pocket", quantity(play, "m") + ", along the circumference")]
    if sine != 0.0:
        rows.append(("Lean of its contact", quantity(asin(sine), "rad") + ", towards the bearing axis"))
    clearance = cage["land_clearance"]["value"]
    if clearance is None:
        return [*rows, ("Land", "none: the balls guide the cage")]
    gap = clearance / 2.0 - cage["land_out_of_round"]["value"]
    first = "before its pockets" if gap < play else "after its pockets"
    return [*rows, ("Land", f"reached at an offset of {quantity(gap, 'm')}, {first}")]


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
    said = f"{entry['name']}: {numbers}. {entry['source']} (confidence: {entry['confidence']})"
    return f"{said}{_library(entry)}{''.join(f'. Note: {caution}' for caution in entry.get('cautions', ()))}"


def _library(entry: Entry) -> str:
    """Return the user's library that a material is from; nothing for a shipped one or one in place."""
    library = (entry.get("record") or {}).get("library")
    if library is None or library["shipped"]:
        return ""
    return f", from {library['file']} (sha256 {library['sha256'][:12]}...)"
