"""An uncertain study as plain data, and its convergence, clouds, shares and films as labelled arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.results.plain import plain_record

Document = dict[str, Any]

Arrays = dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]
"""Name of an array: its dimensions, nested values and attributes."""

ITS_OWN = (
    *("inputs", "convergence", "clouds", "drivers", "shares", "undecided", "next_tests", "notes"),
    *("allowed_friction", "allowed_films"),
)
"""Keys of the document that `grid` turns into arrays, or that stay in the document alone."""

NUMBER = {"units": "-"}
ENDS = ("", "_low", "_high")


def sensitivity(record: Any, cage: Document) -> Document:
    """Return the uncertain study, and the chain and cage of the cage's candidate."""
    answer = plain_record(record.uncertain, "sensitivity")
    return answer | {"warnings": answer["notes"]} | cage


def grid(document: Mapping[str, Any]) -> Arrays:
    """Return the arrays of the document: name to dimensions, nested values and attributes."""
    environments = [one["name"] for one in document["environments"]]
    materials = sorted(row["name"] for row in document["overall"])
    return (
        _inputs(document["inputs"])
        | _convergence(document["convergence"], [*environments, ""], materials)
        | _clouds(document["clouds"], environments, materials)
        | _drivers(document["drivers"], environments, materials)
        | _smooth(document["shares"])
        | _films(document, materials)
    )


def _inputs(rows: Sequence[Document]) -> Arrays:
    found: Arrays = {"input": (("input",), [row["name"] for row in rows], {})}
    for key in ("unit", "distribution", "source", "mean", "standard_deviation"):
        found[f"input_{key}"] = (("input",), [row[key] for row in rows], {})
    return found


def _convergence(rows: Sequence[Document], places: Sequence[str], materials: Sequence[str]) -> Arrays:
    """Return P(stable) against the number of bearings; the place "" is over all environments."""
    sizes = sorted({size for row in rows for size in row["size"]})
    found: Arrays = {"size": (("size",), sizes, {}), "place": (("place",), list(places), {})}
    for key in ("probability_stable", "probability_low", "probability_high"):
        values = {
            (row["environment"], row["name"]): dict(zip(row["size"], row[key], strict=True)) for row in rows
        }
        table = [[[values.get((p, m), {}).get(n) for n in sizes] for m in materials] for p in places]
        found[f"convergence_{key}"] = (("place", "material", "size"), table, NUMBER)
    return found


def _clouds(rows: Sequence[Document], environments: Sequence[str], materials: Sequence[str]) -> Arrays:
    known = {(row["environment"], row["name"]): row for row in rows}
    count = max((len(row["friction"]) for row in rows), default=0)
    found: Arrays = {}
    for key in ("restitution_factor", "friction", "settles"):
        table = [
            [_padded(known.get((place, name), {}).get(key, []), count) for name in materials]
            for place in environments
        ]
        found[f"cloud_{key}"] = (("environment", "material", "sample"), table, NUMBER)
    return found


def _padded(values: Sequence[float], count: int) -> list[float | None]:
    return [*values, *[None] * (count - len(values))]


def _drivers(rows: Sequence[Document], environments: Sequence[str], materials: Sequence[str]) -> Arrays:
    """Return the shares by input, chance last, and the calibration; nothing where no case has any."""
    known = {(row["environment"], row["name"]): row for row in rows if row["shares"]}
    if not known:
        return {}
    names = list(dict.fromkeys(one["name"] for row in known.values() for one in row["shares"]))
    chance = next(iter(known.values()))["shares"][-1]["name"]
    names = [name for name in names if name != chance] + [chance]
    found: Arrays = {"driver": (("driver",), names, {})}
    for end in ENDS:
        by_case = {
            case: {one["name"]: one[f"share{end}"] for one in row["shares"]} for case, row in known.items()
        }
        table = [
            [[by_case.get((place, m), {}).get(name) for name in names] for m in materials]
            for place in environments
        ]
        found[f"driver_share{end}"] = (("environment", "material", "driver"), table, NUMBER)
    bins = max(len(row["predicted"]) for row in known.values())
    for key in ("predicted", "counted"):
        table = [
            [_padded(known.get((place, m), {}).get(key, []), bins) for m in materials]
            for place in environments
        ]
        found[f"calibration_{key}"] = (("environment", "material", "bin"), table, NUMBER)
    return found


def _smooth(rows: Sequence[Document]) -> Arrays:
    """Return the Sobol indices of what the chain computes smoothly."""
    if not rows:
        return {}
    names = [one["name"] for one in rows[0]["total"]]
    found: Arrays = {
        "quantity": (("quantity",), [row["quantity"] for row in rows], {}),
        "chain_input": (("chain_input",), names, {}),
    }
    for kind in ("first", "total"):
        for end in ENDS:
            values = [{one["name"]: one[f"share{end}"] for one in row[kind]} for row in rows]
            table = [[each[name] for name in names] for each in values]
            found[f"sobol_{kind}{end}"] = (("quantity", "chain_input"), table, NUMBER)
    return found


def _films(document: Mapping[str, Any], materials: Sequence[str]) -> Arrays:
    """Return which films keep each candidate stable, and the film of the study."""
    films, own = {one["name"]: one for one in document["allowed_films"]}, document["study"]["film"]
    first = next(iter(films.values()), None)
    if first is None or not first["film_thickness"]:
        return {}
    none = [[None] * len(first["film_thickness"])] * len(first["race_friction"])
    factors = [films[name]["film_restitution_factor"] if name in films else none for name in materials]
    limits = [_limit(films[name]) if name in films else None for name in materials]
    return {
        "race_friction": (("race_friction",), first["race_friction"], NUMBER),
        "film_thickness": (("film_thickness",), first["film_thickness"], {"units": "m"}),
        "film_restitution_factor": (("material", "race_friction", "film_thickness"), factors, NUMBER),
        "film_limit": (("material",), limits, NUMBER),
        "film_probability": ((), first["probability"], NUMBER),
        "film_thickness_here": ((), own["thickness"]["value"], {"units": "m"}),
        "race_friction_here": ((), own["race_friction"]["value"], NUMBER),
    }


def _limit(film: Document) -> float:
    """Return the largest restitution factor allowed: 1 where every one is, -1 where none is."""
    if film["restitution_factor"] is not None:
        return float(film["restitution_factor"])
    return 1.0 if film["reason"].startswith("more") else -1.0
