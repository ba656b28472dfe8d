"""An uncertain ranking as plain data, and its convergence, clouds, lines and indices as labelled arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.results.plain import plain, plain_record

Document = dict[str, Any]

Arrays = dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]
"""Name of an array: its dimensions, nested values and attributes."""

ITS_OWN = (
    *("inputs", "sizes", "convergence", "clouds", "boundaries", "sobol", "next_test", "notes"),
    *("allowed_friction", "films", "films_reason", "doubt_reason"),
)
"""Keys of the document that `grid` turns into arrays, or that stay in the document alone."""

BOUNDARY = "boundary"
"""The factor that is no input of the study: what the finite number of runs leaves open."""

INTERRUPTED = "interrupted before this was computed"


EVIDENCE = (
    *("verdict", "growth_rate", "growth_rate_low", "growth_rate_high", "worst_kick"),
    *("largest_offset", "mean_offset", "orbit_evenness", "drift_rate", "drift_rate_law"),
    *("largest_contact_force", "largest_land_force", "land_impact_share"),
    *("whirl_frequency", "whirl_direction", "whirl_ratio"),
    *("drive_energy", "end_energy", "pocket_power", "energy_imbalance", "runs", "duration"),
)
"""What a row takes from the single runs with every input at its central value."""


def sensitivity(record: Any, cage: Document) -> Document:
    """Return the uncertain ranking, the sources of uncertainty, and the chain of the cage's candidate."""
    answer = plain_record(record.ranking, "sensitivity")
    found = record.evidence or {}
    for one in (*answer["environments"], {"name": "", "materials": answer["overall"]}):
        for row in one["materials"]:
            judged = found.get((one["name"], row["name"]))
            row |= {key: plain(getattr(judged, key, None), key) for key in EVIDENCE}
            motion = getattr(judged, "cage_motion", None)
            row["cage_motion"] = None if motion is None else motion.value
    return answer | _doubt(record.doubt) | cage | {"complete": record.doubt is not None}


def _doubt(doubt: Any) -> Document:
    """Return indices, tests, inverse answers and their sentences; None where an interrupt left them out."""
    if doubt is None:
        parts = dict.fromkeys(("sobol", "next_test", "allowed_friction", "films", "films_reason"))
        return parts | {"doubt_reason": INTERRUPTED}
    from separatrix import sensitivity as doubts

    following = plain_record(doubt.next_test, "next_test")
    return {
        "sobol": plain_record(doubt.sobol, "sobol")
        | {"sentences": [doubts.sobol_sentence(case) for case in doubt.sobol.cases]},
        "next_test": following | {"sentences": list(doubts.next_test_sentences(doubt.next_test))},
        "allowed_friction": [
            plain_record(one, "allowed_friction") | {"sentence": doubts.allowed_sentence(one)}
            for one in doubt.allowed_friction
        ],
        "films": [_film(one) for one in doubt.films],
        "films_reason": doubt.films_reason,
        "doubt_reason": "",
    }


def _film(region: Any) -> Document:
    """Return where in the plane of film thickness and race friction a case is stable."""
    from separatrix.sensitivity import region_sentences

    return {
        "candidate": region.candidate,
        "environment": region.environment,
        "probability": region.probability,
        "film_thickness": plain(region.grid.x.values),
        "holds_up_to": plain(region.grid.holds_up_to),
        "race_friction": plain(region.grid.y.values),
        "probability_stable": plain(region.probability_stable),
        "rows": plain(region.rows),
        "sentences": list(region_sentences(region)),
    }


def grid(document: Mapping[str, Any]) -> Arrays:
    """Return the arrays of the document: name to dimensions, nested values and attributes."""
    environments = [one["name"] for one in document["environments"]]
    materials = sorted(row["name"] for row in document["overall"])
    places = [*environments, ""]
    return (
        _inputs(document["inputs"])
        | _convergence(document, places, materials)
        | _clouds(document["clouds"], environments, materials)
        | _lines(document["boundaries"])
        | _indices(document, environments, materials)
        | _films(document, environments, materials)
    )


def _inputs(rows: Sequence[Document]) -> Arrays:
    found: Arrays = {"input": (("input",), [row["name"] for row in rows], {})}
    for key in ("unit", "distribution", "source", "mean", "standard_deviation"):
        found[f"input_{key}"] = (("input",), [row[key] for row in rows], {})
    return found


def _convergence(document: Mapping[str, Any], places: Sequence[str], materials: Sequence[str]) -> Arrays:
    """Return probabilities against the number of samples; the place "" is over all environments."""
    sizes, dims = document["sizes"], ("place", "material", "size")
    rows = {(row["environment"], row["name"]): row for row in document["convergence"]}
    found: Arrays = {"size": (("size",), sizes, {}), "place": (("place",), list(places), {})}
    for name in ("probability_stable", "probability_best"):
        for end in ("", "_low", "_high"):
            values = _table(rows, places, materials, name + end, len(sizes))
            found[f"convergence_{name}{end}"] = (dims, values, {"units": "-"})
    return found


def _clouds(rows: Sequence[Document], environments: Sequence[str], materials: Sequence[str]) -> Arrays:
    known = {(row["environment"], row["name"]): row for row in rows}
    count = max((len(row["friction"]) for row in rows), default=0)
    dims = ("environment", "material", "sample")
    return {
        f"cloud_{name}": (dims, _table(known, environments, materials, name, count), {"units": "-"})
        for name in ("restitution_factor", "friction")
    }


def _table(
    rows: Mapping[tuple[str, str], Document],
    places: Sequence[str],
    materials: Sequence[str],
    key: str,
    count: int,
) -> Any:
    """Return lists of numbers by place and material; None where a material was not measured, or alone."""
    none = [None] * count
    return [[rows.get((place, name), {}).get(key) or none for name in materials] for place in places]


def _lines(boundaries: Sequence[Document]) -> Arrays:
    """Return the line of each boundary, and which of them a material has."""
    dims = ("boundary", "restitution_factor")
    found: Arrays = {}
    for key in boundaries[0]["line"]:
        values = [one["line"][key] for one in boundaries]
        if key == "restitution_factor":
            found[key] = ((key,), values[0], {"units": "-"})
        else:
            found[f"line_{key}"] = (dims, values, {"units": "-"})
    names = sorted(name for one in boundaries for name in one["candidates"])
    own = [next(i for i, one in enumerate(boundaries) if name in one["candidates"]) for name in names]
    return found | {"boundary_of": (("material",), own, {})}


def _indices(document: Mapping[str, Any], environments: Sequence[str], materials: Sequence[str]) -> Arrays:
    """Return total Sobol indices by factor; missing where a factor does not enter."""
    if document["sobol"] is None:
        return {}
    cases = {(case["environment"], case["candidate"]): case for case in document["sobol"]["cases"]}
    names = [row["name"] for row in document["inputs"]] + [BOUNDARY]
    found: Arrays = {"factor": (("factor",), names, {})}
    for what in ("margin", "verdict"):
        for kind in ("first", "total"):
            for end in ("value", "low", "high"):
                table = [
                    [_of_factor(cases.get((place, name)), what, kind, end, names) for name in materials]
                    for place in environments
                ]
                suffix = "" if end == "value" else f"_{end}"
                dims = ("environment", "material", "factor")
                found[f"sobol_{what}_{kind}{suffix}"] = (dims, table, {"units": "-"})
    return found


def _of_factor(case: Document | None, what: str, kind: str, end: str, names: Sequence[str]) -> list[Any]:
    known = {} if case is None else {index["factor"]: index[kind][end] for index in case[what]}
    return [known.get(name) for name in names]


def _films(document: Mapping[str, Any], environments: Sequence[str], materials: Sequence[str]) -> Arrays:
    """Return P(STABLE) over film thickness and race friction, and the film of the study."""
    films, own = document["films"], document["study"]["film"]
    if not films:
        return {}
    axes = {name: films[0][name] for name in ("race_friction", "film_thickness")}
    known = {(one["environment"], one["candidate"]): one["probability_stable"] for one in films}
    none = [[None] * len(axes["film_thickness"])] * len(axes["race_friction"])
    values = [[known.get((place, name), none) for name in materials] for place in environments]
    return {
        "race_friction": (("race_friction",), axes["race_friction"], {"units": "-"}),
        "film_thickness": (("film_thickness",), axes["film_thickness"], {"units": "m"}),
        "film_probability_stable": (("environment", "material", *axes), values, {"units": "-"}),
        "film_holds_up_to": ((), films[0]["holds_up_to"], {"units": "m"}),
        "film_probability": ((), films[0]["probability"], {"units": "-"}),
        "film_thickness_here": ((), own["thickness"]["value"], {"units": "m"}),
        "film_race_friction_here": ((), own["race_friction"]["value"], {"units": "-"}),
    }
