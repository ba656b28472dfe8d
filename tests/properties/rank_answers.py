"""What an answer of `rank` contradicts in itself: for a test, and for benchmarks/rank_sane_studies.py."""

from collections.abc import Iterator
from typing import Any

Document = dict[str, Any]

MOST_OPEN = 3e-2
"""Share of the work done that the ledger may leave unexplained, of random cages."""


def contradictions(document: Document) -> Iterator[str]:
    """Every verdict of an answer that its own evidence contradicts, with the numbers."""
    for environment in document["environments"]:
        for row in environment["materials"]:
            if row["verdict"] is not None:
                said = f"{environment['name']}, {row['name']}, {row['verdict']}"
                yield from (f"{said}: {what}" for what in _of_row(row, document["cage"]))
    for row in document["environments"][0]["materials"]:
        if row["verdict"] is None:
            yield f"{row['name']}: no verdict, {row['reason']}"


def _of_row(row: Document, cage: Document) -> Iterator[str]:
    for name in ("probability", "restitution_threshold"):
        value = row["probability_stable" if name == "probability" else name]
        low, high = row[f"{name}_low"], row[f"{name}_high"]
        if not low <= value <= high:
            yield f"{name} {value} outside {low} to {high}"
    if abs(row["margin"] - (row["restitution_threshold"] - row["restitution_factor"])) > 1e-12:
        yield f"margin {row['margin']} is not the threshold less eta"
    counts, ends = row["by_kick"], ("settles", "rolls", "whirls", "drifts", "unresolved")
    if any(sum(count[end] for end in ends) != row["runs"] for count in counts):
        yield f"runs do not add up to {row['runs']}: {counts}"
    if row["energy_imbalance"] > MOST_OPEN:
        yield f"the ledger leaves {row['energy_imbalance']} open"
    yield from _of_verdict(row, cage)


def _of_verdict(row: Document, cage: Document) -> Iterator[str]:
    counts, most = row["by_kick"], {"WHIRLING": "whirls", "DRIFTING": "drifts", "ROLLING": "rolls"}
    worst = next(count for count in counts if count["kick"] == row["worst_kick"])
    if row["cage_motion"] in most and 4 * worst[most[row["cage_motion"]]] < row["runs"]:
        yield f"{row['cage_motion']} in few runs: {worst}"
    low, high = row["safety_factor_low"], row["safety_factor_high"]
    if row["verdict"] == "STABLE" and high is not None and high < 1.0:
        yield f"STABLE with a safety factor of at most {high}"
    if row["verdict"] == "UNSTABLE" and low is not None and low > 1.0:
        yield f"UNSTABLE with a safety factor of at least {low}"
    is_by_land = row["verdict"] == "UNSTABLE" and row["driven_by_land"]
    few = 0.1 * row["runs"] if is_by_land or (low is not None and low <= 1.0) else 0.5 * row["runs"]
    if row["verdict"] == "UNSTABLE" and worst["whirls"] <= few:
        yield f"few whirl: {worst}"
    if is_by_land and low is not None:
        yield f"a safety factor from {low} with {worst}"
    if row["verdict"] != "STABLE":
        return
    room = max(cage["pocket_clearance"], cage["land_clearance"] or 0.0) / 2.0
    if row["largest_offset"] > 2.0 * room:
        yield f"offset {row['largest_offset']} m beyond twice the room {room} m"
    if row["mean_offset"] > 1.2 * room:
        yield f"ends {row['mean_offset']} m off in a room of {room} m"
    for count in counts:
        if count["settles"] + count["rolls"] < 0.9 * row["runs"]:
            yield f"STABLE with {count}"
    if row["cage_motion"] not in ("SETTLED", "ON THE LAND", "ROLLING"):
        yield f"STABLE and {row['cage_motion']}"
    if row["cage_motion"] == "ON THE LAND" and row["rubbing_force"] <= 0.0:
        yield "on the land without a force there"
