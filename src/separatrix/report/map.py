"""Text for a stability map: its shares, and where along y the answer changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.report.cage import chain_facts, friction_text, study_facts
from separatrix.report.tables import facts, paragraph, quantity, section, table

Document = Mapping[str, Any]

FRICTION = "ball_cage_friction"
MOST_COLUMNS, SOME_COLUMNS = 20, 9
"""Columns of the map whose bands are all printed, and how many are chosen of more."""

KINDS = {
    "STABLE": "stable",
    "UNSTABLE": "unstable",
    "UNDECIDED": "undecided",
    "refused": "refused",
    "inferred": "inferred",
    "not_run": "not run",
}


def stability_map(document: Document) -> list[str]:
    """Shares of the plane, bands at a few columns, the rule, and what it holds for."""
    blocks = [
        section("Stability map", facts(_axes(document)), "", _shares(document)),
        section(
            "Where the cage begins to whirl", table(_headers(document), _bands(document)), *_legend(document)
        ),
        section("What it holds for", facts(_holds_for(document))),
    ]
    refused = _first_refusal(document["points"])
    return [*blocks, paragraph(refused, first="  - : ", indent="      ")] if refused else blocks


ROUNDING = 1e-9
"""A distance to a band below this share of the value is the rounding of its unit."""

LEGEND = paragraph(
    "between the last point of a column at which, beyond the scatter, less than half the runs whirl and the "
    "first at which more than half do; margin: distance of the study's own value to that band, positive "
    "where the cage settles."
)


def _legend(document: Document) -> list[str]:
    """What the columns of the table are, and which part of the map it shows."""
    total, shown = len(document["x"]["values"]), len(_chosen(document))
    part = f"{shown} of {total} columns of the map are shown; map.json and map.nc have all of them."
    return ["", *([paragraph(part)] if shown < total else []), LEGEND]


def _chosen(document: Document) -> list[float]:
    """Values of x whose bands are printed: all, or evenly chosen."""
    values = list(document["x"]["values"])
    if len(values) <= MOST_COLUMNS:
        return values
    return [values[round(i * (len(values) - 1) / (SOME_COLUMNS - 1))] for i in range(SOME_COLUMNS)]


def _axes(document: Document) -> list[tuple[str, str]]:
    whose = document["study"]["cage"]["ball_cage_friction"]["candidate"]
    return [(name, _axis(document[name], whose)) for name in ("x", "y")]


def _axis(axis: Document, candidate: str | None) -> str:
    low, high = (quantity(axis["values"][i], axis["unit"]) for i in (0, -1))
    whose = candidate if candidate and axis["parameter"] == FRICTION else "the study"
    here = "" if axis["here"] is None else f", {whose} has {quantity(axis['here'], axis['unit'])}"
    return f"{axis['parameter']}, {low} to {high}, {len(axis['values'])} values{here}"


def _shares(document: Document) -> str:
    total = len(document["points"])
    rows = [
        [name, str(document["counts"][kind]), f"{100 * document['counts'][kind] / total:.1f} %"]
        for kind, name in KINDS.items()
        if document["counts"][kind] or kind in ("STABLE", "UNSTABLE")
    ]
    return table(("", "points", "share"), rows)


def _headers(document: Document) -> tuple[str, ...]:
    return (document["x"]["parameter"], "from", "to", "whirls", "margin")


def _bands(document: Document) -> list[list[str]]:
    """Rows of the chosen columns; a column that does not change says what it is."""
    return [row for x in _chosen(document) for row in _band(document, x)]


def _band(document: Document, x: float) -> list[list[str]]:
    unit, here = document["y"]["unit"], document["y"]["here"]
    start = quantity(x, document["x"]["unit"])
    found = [change for change in document["changes"] if change["x"] == x]
    if not found:
        return [[start, "-", "-", _of_one_kind(document["points"], x), "-"]]
    return [
        [
            start,
            *(quantity(change[end], unit) for end in ("y_low", "y_high")),
            "above" if change["whirls_above"] else "below",
            _margin(change, here, unit),
        ]
        for change in found
    ]


def _margin(change: Document, here: float | None, unit: str) -> str:
    if here is None:
        return "-"
    low, high = change["y_low"], change["y_high"]
    below, above = low - here, here - high
    distance = max(below, above, 0.0)
    distance *= distance > ROUNDING * abs(here)
    whirls = (here > high) == change["whirls_above"] and distance > 0.0
    return quantity(-distance if whirls else distance, unit)


def _of_one_kind(points: Sequence[Document], x: float) -> str:
    """Return what the points of a column are that does not change, beyond the scatter."""
    run = [p for p in points if p["x"] == x and p["runs"]]
    if not run:
        return "not run"
    whirls = any(p["probability_low"] > 0.5 for p in run)
    settles = any(p["probability_high"] < 0.5 for p in run)
    unclear = any(p["probability_low"] <= 0.5 <= p["probability_high"] for p in run)
    if unclear:
        return "no boundary found"
    return "everywhere" if whirls and not settles else "nowhere"


def _holds_for(document: Document) -> list[tuple[str, str]]:
    facts_of_all = [*study_facts(document["study"]), *chain_facts(document["chain"])]
    return [*facts_of_all, *_friction(document), *_ensemble(document)]


def _friction(document: Document) -> list[tuple[str, str]]:
    """Return the pocket friction of every point, unless it is an axis."""
    return [] if _is_axis(document, FRICTION) else [("Pocket friction", friction_text(document))]


def _ensemble(document: Document) -> list[tuple[str, str]]:
    kick = "each point its own" if _is_axis(document, "kick") else quantity(document["kick"], "m/s")
    return [
        ("Kick", kick),
        ("Runs", _runs(document["stopping"])),
        *_inference(document["inference"]),
        ("Run", f"{quantity(document['duration'], 's')}, ball scatter {document['ball_scatter']:g}"),
    ]


def _runs(rule: Document) -> str:
    if rule["agreeing_runs"] == rule["most_runs"]:
        return f"{rule['most_runs']} at every point"
    wrong, other = (100 * rule[f"{name}_probability"] for name in ("wrong_side", "other_decision"))
    return (
        f"up to {rule['most_runs']}, stopped after {rule['agreeing_runs']} that agree (risk of the wrong "
        f"side {wrong:.2g} %, of another decision {other:.2g} %)"
    )


def _inference(found: Document | None) -> list[tuple[str, str]]:
    """Return how many points were not run, and how often those around them were wrong where they were."""
    if found is None or not found["points"] + found["checked"]:
        return []
    inferred = f"{found['points']} points were not run, as those around them agree"
    if not found["checked"]:
        return [("Inferred", f"{inferred}; none was checked")]
    low, high = (100 * found[f"error_{end}"] for end in ("low", "high"))
    return [
        (
            "Inferred",
            f"{inferred}; {found['checked']} more of that kind were run as a check, of which "
            f"{found['decided_otherwise']} are decided otherwise (95 %: {low:.2g} to {high:.2g} %)",
        )
    ]


def _is_axis(document: Document, parameter: str) -> bool:
    return parameter in (document["x"]["parameter"], document["y"]["parameter"])


def _first_refusal(points: Sequence[Document]) -> str | None:
    refused = [p for p in points if not p["runs"] and not p["reason"].startswith("not run")]
    if not refused:
        return None
    return f"{len(refused)} points were refused; the first: {refused[0]['reason']}"
