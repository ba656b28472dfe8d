"""What several verbs tell of a verdict: its words, its evidence as columns and facts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import inf

from separatrix.ground.document import Part
from separatrix.present.blocks import Cell, Column, Table, grouped, text_column
from separatrix.verbs.parts.quantity_text import all_numbers, cell, column, fill, number_of, show

DIRECTIONS = {1: "forward", -1: "backward", 0: ""}
MARK = "*"
"""After a friction that is extrapolated beyond its tests."""


def is_judged(row: Part) -> bool:
    """Whether a row has a verdict."""
    return row.get("verdict") is not None


def has_safety(rows: Iterable[Part]) -> bool:
    """Whether some of the rows have a safety factor: not in the paper's model."""
    return any(row.get("own_critical_friction_low") is not None for row in rows)


def verdict(row: Part) -> str:
    """Return the verdict of a row, or why there is none."""
    if is_judged(row):
        return str(row.verdict)
    return "not measured" if row.get("friction") is None else "not finished"


def rank_texts(ranks: Iterable[int | None]) -> list[str]:
    """Return ranks as text: = after a shared one, a dash for none."""
    known = [*ranks]
    return ["-" if rank is None else f"{rank}{'=' * (known.count(rank) > 1)}" for rank in known]


def by_verdict(each: Mapping[str, Sequence[str]]) -> str:
    """Return verdicts, each with who has it."""
    return "; ".join(f"{word} {', '.join(who)}" for word, who in each.items())


def judged(row: Part) -> Part | None:
    """Return a row that has a verdict; None of another."""
    return row if is_judged(row) else None


def drifting(row: Part) -> Part | None:
    """Return a row whose runs do not all whirl: only these have a drift rate."""
    if not is_judged(row):
        return None
    worst = next(one for one in row.by_kick if one.kick == row.worst_kick)
    return None if worst.whirls == row.runs else row


def pocket_force(row: Part) -> Cell:
    """Return the largest force in a pocket, or what the races hold, beyond which it means nothing."""
    if not is_judged(row):
        return cell(None, "largest_contact_force")
    if not row.force_exceeds_races:
        return cell(row, "largest_contact_force")
    held = cell(row, "force_limit")
    return Cell(held.value, cell(row, "largest_contact_force").quantity, held.unit, before="> ")


def evidence_column(name: str) -> Column:
    """Return a column of evidence; numbers that a row cannot have are absent."""
    if name == "largest_contact_force":
        one = column(name)
        return Column(one.head, pocket_force, meaning=one.meaning)
    marks: dict[str, Callable[[Part], str]] = {
        "whirl_frequency": lambda row: f" {DIRECTIONS[row.whirl_direction]}".rstrip()
    }
    return column(name, of=drifting if name == "drift_rate" else judged, mark=marks.get(name, lambda _: ""))


def motion_column() -> Column:
    """Return the motion that most runs from the worst disturbance end in."""
    return text_column("motion", lambda row: (row.cage_motion or "unresolved") if is_judged(row) else "-")


def power_facts(row: Part) -> list[tuple[str, str]]:
    """Return what friction feeds into the cage or takes from it, and what rubs on the land."""
    powers = (("pocket", "pocket_power"), ("land", "land_power"))
    each = [f"{show(row, name)} by the {where}" for where, name in powers if getattr(row, name)]
    rows = [("Friction power into the cage", ", ".join(each) or "none")]
    if row.rubbing_force > 0.0:
        rows.append(
            ("Rubbing on the land", fill(row, "{rubbing_force} at {rubbing_speed}, {rubbing_power} of heat"))
        )
    return rows


def verdict_sentences(rows: Sequence[Part], place: str) -> str:
    """Return the answer of a ranking: the first, its safety factor or margin, the others."""
    first = [row for row in rows if row.get("rank") == 1]
    if not first:
        return f"No candidate was ranked in {place}."
    each = grouped((verdict(row), row.name) for row in first)
    names = ", ".join(row.name for row in first)
    lead = f"{names} ranks first in {place}: {verdict(first[0])}."
    if len(first) > 1:
        words = f" ({names}): {verdict(first[0])}" if len(each) == 1 else f": {by_verdict(each)}"
        lead = f"{len(first)} materials tie for first in {place}{words}."
    margin = _safety(first) if has_safety(first) else _margin(first)
    others = grouped((verdict(row), row.name) for row in rows if row not in first)
    rest = f"The others: {by_verdict(others)}." if others else "There is no other candidate."
    rest = f"All others: {next(iter(others))}." if len(others) == 1 else rest
    return f"{lead} {margin} {rest}"


def _margin(first: Sequence[Part]) -> str:
    """Return the restitution thresholds of the candidates that rank first, in the paper's model."""
    name = "restitution_threshold"
    threshold = span(first, name) if len(first) > 1 else show(first[0], name)
    return (
        f"From the reference disturbance the largest stable restitution factor is {threshold}; this bearing "
        f"and film have {span(first, 'restitution_factor')}, a margin of {span(first, 'margin')}."
    )


def _safety(first: Sequence[Part]) -> str:
    """Return the safety factors of the candidates that rank first, and what they are made of."""
    criticals, frictions = span(first, "own_critical_friction"), span(first, "friction")
    lowest = min(first, key=lambda row: row.get("safety_factor_low") or inf)
    factor = show(lowest, "safety_factor")
    at = "at least " if len(first) > 1 and not factor.startswith(">") else ""
    return (
        f"Safety factor {at}{factor}: half the runs whirl at a friction of {criticals}, the pockets have "
        f"{frictions}."
    )


def deciding(answer: Part, rows: Sequence[Part]) -> Iterator[str]:
    """Yield what decides a ranking besides frictions: land or pockets, a weak whirl, extrapolation."""
    judged = [row for row in rows if is_judged(row)]
    if not judged or not has_safety(judged):
        return
    best = judged[0]
    both = fill(best, "land clearance {land_clearance}, pocket clearance {pocket_clearance}")
    wide = next((one for one in answer.effects or () if one.name == "wide_land"), None)
    if wide is not None:
        critical = wide.get("own_critical_friction") or wide.own_critical_friction_low
        above = [row.name for row in judged if row.friction > critical]
        words = f"The land stops the cage before its pockets can drive it ({both}): with {wide.change} the "
        words += f"critical friction of {answer.candidate} would be {{own_critical_friction}}"
        whose = f", less than the friction of {', '.join(above)}" if above else ""
        yield f"{fill(wide, words)}{whose}."
    elif best.get("land_clearance") is not None and any(row.verdict != "STABLE" for row in judged):
        yield fill(
            best, "The pockets decide, not the land (clearances {pocket_clearance}, {land_clearance})."
        )
    weak = [row for row in judged if row.cage_motion == "ROLLING" and row.verdict == "STABLE"]
    if weak:
        words = "a weak whirl remains, fed {pocket_power}, with pocket forces up to {largest_contact_force}"
        yield f"{weak[0].name} rolls in its pockets: {fill(weak[0], words)}."
    beyond = [row.name for row in judged if row.extrapolation]
    if beyond:
        yield f"{'All' if len(beyond) == len(judged) else 'Some'} frictions are extrapolated."


def span(rows: Sequence[Part], name: str) -> str:
    """Return the least and the largest value of a quantity among some rows, one where they look alike."""
    known = [getattr(row, name) for row in rows if name in row]
    ends = [number_of(rows[0], name, one) for one in (min(known), max(known))] if known else []
    return " to ".join(dict.fromkeys(ends)) or show(rows[0], name)


def candidate_numbers(answer: Part) -> Table:
    """Return every number of every candidate in every environment, for a workbook."""
    rows = [(one.name, row.name, row) for one in answer.environments for row in one.materials]
    rows += [("overall", row.name, row) for row in answer.overall]
    return all_numbers("all numbers", ("environment", "material"), rows)
