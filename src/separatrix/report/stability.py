"""Text of the stability curve: its points, and what this bearing's own restitution factor means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, table

Document = Mapping[str, Any]

HEADERS = (
    "restitution\nfactor",
    "critical friction\n(95 %)",
    "band\nlow",
    "band\nhigh",
    "linear\nlimit",
    "hard\nlimit",
)
LEGEND = "\n" + paragraph(
    "critical friction: half the runs whirl from the reference kick; fewer below, more above. band: nine in "
    "ten runs settle from every kick below its low end, and whirl from every kick above its high end. linear "
    "limit: no clearance. hard limit: walls as pockets, evenly spaced. Both for balls at rest."
)


def curve(document: Document) -> list[str]:
    """Points of the curve with band and limits, and the band at this bearing's own restitution factor."""
    limits = [_by_eta(document[key]) for key in ("linear_limit", "hard_limit")]
    rows = [_row(point, limits) for point in document["curve"]]
    blocks = [section("Stability curve", table(HEADERS, rows), LEGEND + drift_note(document))]
    return blocks + ([_here(document)] if document["here"] else [])


def drift_note(document: Document) -> str:
    """Say that a cage which nothing holds is stable nowhere, and how fast it drifts; empty if it is held."""
    if not document["drifts"]:
        return ""
    rate = document["drift_rate_law"]
    pace = (
        f", by the linear law at {number(rate)} 1/s (e-fold every {quantity(1.0 / rate, 's')})"
        if rate
        else ""
    )
    return "\n\n" + paragraph(
        f"This cage has no land and drifts at any friction{pace}. Below the curve disturbances decay, but no "
        "verdict there is STABLE."
    )


def _by_eta(limits: Any) -> dict[float, float | None]:
    return {row["restitution_factor"]: row["critical_friction"] for row in limits}


def _row(point: Document, limits: list[dict[float, float | None]]) -> list[str]:
    eta = point["restitution_factor"]
    return [
        number(eta),
        _interval(point),
        number(point["critical_friction_low"]),
        number(point["critical_friction_high"]),
        *(number(limit.get(eta)) for limit in limits),
    ]


def _interval(point: Document) -> str:
    if point["critical_friction"] is None:
        return ABSENT
    low, high = number(point["scatter_low"]), number(point["scatter_high"])
    return f"{number(point['critical_friction'])} ({low} to {high})"


def _here(document: Document) -> str:
    """What this bearing's own damping allows: frictions between which the kick decides."""
    here = document["here"]
    low, high = here["critical_friction_low"], here["critical_friction_high"]
    kicks = zip(document["kicks"], here["kick_critical_friction"], strict=True)
    each = ", ".join(f"{number(friction)} from {kick:g} m/s" for kick, friction in kicks)
    lines = [
        ("Every kick settles below", "none" if low is None else f"a friction of {number(low)}"),
        ("Every kick whirls above", "none" if high is None else f"a friction of {number(high)}"),
        ("Half the runs whirl at", each),
    ]
    title = f"Sub-critical band of this bearing, restitution factor {number(here['restitution_factor'])}"
    return section(title, facts([*lines, *([("Reason", here["reason"])] if here["reason"] else [])]))
