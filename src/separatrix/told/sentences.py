"""Words and sentences on documents of answers that the printed text, reports, workbooks and figures share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

from separatrix.told.tables import ABSENT, grouped, interval, quantity, significant

Row = Mapping[str, Any]
"""A document of an answer, or a part of one."""

# A row of a ranking.


def with_interval(row: Row, name: str, ends: str = "") -> str:
    """Return a number of a row with its interval, or a dash; `ends` is how the names of its ends begin."""
    if row.get(name) is None:
        return ABSENT
    return interval(row[name], *(row[f"{ends or name}_{end}"] for end in ("low", "high")))


def probability(row: Row, by: str = "") -> str:
    """Return P(stable) with its interval, or a dash; `by` begins the names of another model's."""
    return with_interval(row, f"{by}probability_stable", f"{by}probability")


def threshold(row: Row) -> str:
    """Return the restitution threshold with its interval, or a dash."""
    return with_interval(row, "restitution_threshold")


def margin(row: Row) -> str:
    """Return the margin with its sign, or a dash."""
    return ABSENT if row.get("margin") is None else f"{row['margin']:+.2f}"


def drift(row: Row) -> str:
    """Return the drift rate; a dash where every run from the worst kick whirls."""
    worst = next(one for one in row["by_kick"] if one["kick"] == row["worst_kick"])
    return ABSENT if worst["whirls"] == row["runs"] else significant(row["drift_rate"], 2)


def pocket_force(largest: float, limit: float | None, *, short: bool = False) -> str:
    """Return the largest force in a pocket, or what the races hold, beyond which it means nothing."""
    if limit is None or largest <= limit:
        return quantity(largest, "N", 3)
    return ("> " if short else "above what the races hold, ") + quantity(limit, "N", 3)


def verdict(row: Row) -> str:
    """Return the verdict, or why there is none."""
    if row.get("verdict"):
        return str(row["verdict"])
    return "not measured" if row.get("friction") is None else "not finished"


def rank_texts(column: Iterable[object]) -> list[str]:
    """Return the ranks as text: = after a shared one, a dash for none; a column of nothing is of text."""
    ranks = [int(rank) if isinstance(rank, int | float) and isfinite(rank) else None for rank in column]
    return [ABSENT if rank is None else f"{rank}{'=' * (ranks.count(rank) > 1)}" for rank in ranks]


def verdict_sentences(rows: Sequence[Row], place: str) -> list[str]:
    """Return the answer of a ranking: the first, its margin and why it is undecided if it is, the others."""
    first = [row for row in rows if row.get("rank") == 1]
    if not first:
        return [f"No candidate was ranked in {place}."]
    each = grouped((verdict(row), row["name"]) for row in first)
    word, names = next(iter(each)), ", ".join(row["name"] for row in first)
    lead = f"{names} ranks first in {place}: {word}."
    if len(first) > 1:
        said = f" ({names}): {word}" if len(each) == 1 else f": {by_verdict(each)}"
        lead = f"{len(first)} materials tie for first in {place}{said}."
    limits, etas = (
        _span([row[key] for row in first]) for key in ("restitution_threshold", "restitution_factor")
    )
    if len(first) == 1:
        limits = threshold(first[0])
    whose = "The cage" if len(first) == 1 else "Their cages"
    up_to = f"{whose} remain{'s' * (len(first) == 1)} stable up to a restitution factor of {limits}"
    if not any(row["restitution_threshold"] for row in first):
        up_to = f"{whose} {'is' if len(first) == 1 else 'are'} stable at no restitution factor above 0"
    elif [*each] != ["STABLE"]:
        up_to = f"From the reference kick the largest stable restitution factor is {limits}"
    by_it = (
        f"{up_to}; this bearing and film have {etas}, "
        f"a margin of {_span([row['margin'] for row in first], '{:+.2f}')}."
    )
    if first[0]["verdict"] == "UNDECIDED":
        by_it += f" {first[0]['name']}: {first[0]['reason']}"
    others = grouped((verdict(row), row["name"]) for row in rows if row not in first)
    rest = f"The others: {by_verdict(others)}." if others else "There is no other candidate."
    return [lead, by_it, rest]


def by_verdict(each: Mapping[str, Sequence[str]]) -> str:
    """Return verdicts, each with who has it."""
    return "; ".join(f"{word} {', '.join(who)}" for word, who in each.items())


def _span(values: Sequence[float], form: str = "{:.2f}") -> str:
    return " to ".join(dict.fromkeys(form.format(one + 0.0) for one in (min(values), max(values))))


# Clearances, curves, sweeps and uncertain studies.


def drift_sentence(drifts: bool, rate: float | None) -> str:
    """Return that a cage without a land is stable nowhere, and how fast it drifts; empty if it has one."""
    if not drifts:
        return ""
    pace = ""
    if rate:
        pace = (
            f", by the linear law at {significant(rate, 3)} 1/s (e-fold every {quantity(1 / rate, 's', 3)})"
        )
    return (
        f"The cage has no land and drifts at any friction{pace}. Below the curve disturbances decay, but no "
        "verdict there is STABLE."
    )


def strain_facts(found: Row, metres: Callable[[float, str, int], str]) -> list[tuple[str, str]]:
    """Return what changes the clearances of a cage; `metres` writes a length."""
    strains = [
        f"{part} {100.0 * found[f'{key}_strain']:.3g} %"
        for part, key in (("cage", "cage"), ("balls", "ball"), ("rings", "ring"))
        if found[f"{key}_strain"] is not None
    ]
    grown = [f"cage +{100.0 * found['hoop_strain']:.3g} % at its pitch radius"] + [
        f"{part} +{metres(found[f'{key}_land_growth'], 'm', 3)} in radius"
        for part, key in (("its land", "cage"), ("the ring's land", "ring"))
        if found[f"{key}_land_growth"]
    ]
    return [("Thermal strain", ", ".join(strains)), ("Growth by rotation", ", ".join(grown))]


DECIDES = {
    "margin": "lowest margin",
    "probability_stable": "lowest P(stable)",
    "restitution_factor": "highest restitution factor",
}
TIMES = {
    "below_margin": "with a margin below 0",
    "stable": "STABLE",
    "unstable": "UNSTABLE",
    "undecided": "UNDECIDED",
    "refused": "without an answer",
}


def deciding(quantity: str, value: float, of: str = "") -> str:
    """Return the number that makes a case of a sweep the worst."""
    return f"{DECIDES[quantity]}{of}, {significant(value, 3)}"


def time_shares(duty: Row) -> list[tuple[str, str]]:
    """Return what is known of the time of a duty cycle, each with its share; what is refused, if any is."""
    known = {words: duty[key] for key, words in TIMES.items() if duty[key] or key != "refused"}
    return [(words, f"{100 * share:.3g} %") for words, share in known.items() if share is not None]


def next_test(found: Row, most: int) -> Iterator[str]:
    """Yield which measurement would settle undecided cases, `most` of them with as many cases each."""
    if not found["undecided"]:
        yield "No case is undecided: no measurement would change a verdict."
        return
    yield f"Undecided: {'; '.join(found['undecided'])}."
    for test in found["next_tests"][:most]:
        pairs = list(zip(test["cases"], test["chances"], strict=True))[:most]
        cases = "; ".join(f"{case} ({100.0 * chance:.0f} %)" for case, chance in pairs)
        yield f"Measuring {test['name']} would settle {test['settled']:.1f} of them on average: {cases}."
    if not found["next_tests"]:
        yield "No single measurement would settle any of them."
