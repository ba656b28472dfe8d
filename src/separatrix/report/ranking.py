"""Text of a ranking: the answer for the bearing's own environment, and all of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.report.cage import (
    motion_words,
)
from separatrix.report.tables import ABSENT, number, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]

HEADERS = (
    "rank",
    "material",
    "friction",
    "threshold\n(95 %)",
    "margin",
    "P(stable)\n(95 %)",
    "verdict",
)


def rank(document: Document) -> list[str]:
    """The answer for the bearing's own environment, on a screen; `every_environment` has the rest."""
    rows = headline(document)
    return [
        paragraph(in_short(document), indent=""),
        section(title(document["environment"]), verdicts(rows), *_notes(rows)),
        *uncertain(document, rows),
        section(f"Evidence: {ensemble(document)}", _short_evidence(rows), *_undecided(rows)),
        paragraph(_elsewhere(document), indent=""),
    ]


def headline(document: Document) -> Sequence[Document]:
    """Return the rows of the bearing's own environment."""
    return next(
        one["materials"] for one in document["environments"] if one["name"] == document["environment"]
    )


def only_table(document: Document) -> list[str]:
    """The table of the bearing's own environment, for `--quiet`."""
    return [section(title(document["environment"]), verdicts(headline(document)))]


def _notes(rows: Sequence[Document]) -> list[str]:
    """Return what the columns are, and what holds for the whole table."""
    return ["", paragraph(LEGEND), *footnotes(rows), *lowest(rows)]


SHORT_EVIDENCE = (
    *("material", "motion", "stable runs by kick", "largest\noffset", "drift\n1/s"),
    *("force at\na pocket", "force on\nthe land", "rubs\nwith"),
)


def _short_evidence(rows: Sequence[Document]) -> str:
    """Return motion, largest offset, drift, forces and rubbing of every candidate that has a verdict."""
    known = [row for row in rows if row["verdict"] is not None]
    if not known:
        return "  none: no verdict was finished"
    cells = [
        [
            row["name"],
            motion_words(row["cage_motion"]),
            " ".join(str(kick["settles"]) for kick in row["by_kick"]),
            quantity(float(f"{row['largest_offset']:.3g}"), "m"),
            significant(row["drift_rate"], 2),
            *(quantity(float(f"{row[f'largest_{at}_force']:.3g}"), "N") for at in ("contact", "land")),
            quantity(float(f"{row['rubbing_power']:.2g}"), "W"),
        ]
        for row in known
    ]
    return table(SHORT_EVIDENCE, cells, left=3)


def _undecided(rows: Sequence[Document]) -> list[str]:
    """Return why candidates are undecided; one reason of several is printed once."""
    open_rows = [row for row in rows if row["verdict"] == "UNDECIDED"]
    return ["", *reasons(open_rows)] if open_rows else []


def _elsewhere(document: Document) -> str:
    """Return which other answers there are, and who leads in them."""
    others = [one for one in document["environments"] if one["name"] != document["environment"]]
    more = "`--full` prints all evidence"
    if not others:
        return f"{more}."
    leads = [f"{one['name']}: {_first_names(one['materials']) or 'none'}" for one in others]
    return f"First elsewhere: {'; '.join(leads)}. {more}, for every environment."


def _first_names(rows: Sequence[Document]) -> str:
    """Return the candidates of rank 1, at most three of them by name."""
    names = [row["name"] for row in rows if row["rank"] == 1]
    more = f" and {len(names) - LEADERS} more" if len(names) > LEADERS else ""
    return ", ".join(names[:LEADERS]) + more


LEADERS = 3


def uncertain(document: Document, rows: Sequence[Document]) -> list[str]:
    """Return the verdicts over the uncertain inputs; nothing if the study states none."""
    known = [row for row in rows if row["uncertain_verdict"] is not None]
    if not known:
        return []
    each: dict[str, list[str]] = {}
    for row in known:
        share = _with_interval(row, "uncertain_probability_stable", "uncertain_probability")
        each.setdefault(row["uncertain_verdict"], []).append(f"{row['name']} {share}")
    inputs = [one["name"] for one in document["study"]["uncertain_inputs"]]
    names = ", ".join(inputs[:NAMED]) + (", ..." if len(inputs) > NAMED else "")
    text = (
        f"Uncertain inputs ({names}) are at their means above. With a bearing drawn for each of "
        f"{known[0]['uncertain_runs']} runs from each kick, P(stable) is: {_by_verdict(each)}."
    )
    return [paragraph(text, indent="")]


NAMED = 6
"""Uncertain inputs that are named; `check` lists them all."""


LEGEND = (
    "rank: by margin, = a tie within the scatter. threshold: largest stable restitution factor eta. "
    "margin: threshold less the bearing's eta. P(stable): share of runs that settle, worst kick."
)


def title(name: str) -> str:
    """Return the name of an environment as the title of its section."""
    return name[:1].upper() + name[1:]


def verdicts(rows: Sequence[Document]) -> str:
    """Return the table of verdicts, margins and ranks."""
    shared = Counter(row["rank"] for row in rows)
    return table(HEADERS, [_row(row, tied=shared[row["rank"]] > 1) for row in rows], left=2)


def _row(row: Document, *, tied: bool) -> list[str]:
    return [
        ABSENT if row["rank"] is None else f"{row['rank']}{'=' if tied else ''}",
        row["name"],
        number(row["friction"]) + (MARK if row["extrapolation"] else ""),
        _with_interval(row, "restitution_threshold", "restitution_threshold"),
        ABSENT if row["margin"] is None else f"{row['margin']:+.2f}",
        _with_interval(row, "probability_stable", "probability"),
        row["verdict"] or ("not measured" if row["friction"] is None else "not finished"),
    ]


def lowest(rows: Sequence[Document]) -> list[str]:
    """Return who has the lowest mean friction, with what probability; nothing if none was measured."""
    measured = [row for row in rows if row["friction"] is not None]
    known = [(row["probability_lowest_friction"] or 0.0, row["name"]) for row in measured]
    likely = [f"{name} {share:.2f}" for share, name in sorted(known, reverse=True) if share >= 0.005]
    if not measured:
        return []
    names = ", ".join(likely) or f"none, for only {measured[0]['name']} was measured here"
    return [paragraph(f"Probability of the lowest mean friction: {names}.")]


MARK = "*"
"""After a friction that was asked for where nothing was tested."""


POCKET = " (pocket: "
"""Before what the pocket has, at the end of a sentence on what was not tested."""


def footnotes(rows: Sequence[Document]) -> list[str]:
    """Return what was not tested, once for all candidates of whom it is said; nothing if all was."""
    who: dict[str, list[str]] = {}
    for row in rows:
        for sentence in row["extrapolation"]:
            who.setdefault(sentence, []).append(row["name"])
    measured = sum(row["friction"] is not None for row in rows)
    each: dict[str, list[str]] = {}
    for sentence, names in who.items():
        stem, pocket, value = sentence.partition(POCKET)
        whose = "" if len(names) == measured else f" {', '.join(names)}"
        each.setdefault(stem + pocket, []).append(f"{value.removesuffix(')')}{whose}" if pocket else whose)
    said = [
        f"{stem}{'; '.join(values)})"
        if stem.endswith(POCKET)
        else stem + (f" ({values[0][1:]})" if values[0] else "")
        for stem, values in each.items()
    ]
    text = f"extrapolated beyond the tests: {'. '.join(said)}."
    return [paragraph(text, first=f"  {MARK} ", indent="    ")] if said else []


def _with_interval(row: Document, key: str, ends: str) -> str:
    if row[key] is None:
        return ABSENT
    low, high = (number(row[f"{ends}_{end}"], 2) for end in ("low", "high"))
    return f"{number(row[key], 2)} ({low} to {high})"


def ensemble(document: Document) -> str:
    """Return the runs behind every verdict, their length and their kicks."""
    kicks = ", ".join(f"{kick:g}" for kick in document["kicks"])
    return f"{document['runs']} runs of {quantity(document['duration'], 's')} from each kick, {kicks} m/s"


def reasons(rows: Sequence[Document]) -> list[str]:
    """Return the reasons; candidates of the same friction share theirs."""
    names: dict[str, list[str]] = {}
    for row in rows:
        names.setdefault(row["reason"], []).append(row["name"])
    return [
        paragraph(f"{', '.join(who)}: {reason}", first="  ", indent="      ") for reason, who in names.items()
    ]


def in_short(document: Document) -> str:
    """Return the answer in three sentences: who is first here, with what margin, and what the others are."""
    rows, place = headline(document), document["environment"]
    first = [row for row in rows if row["rank"] == 1]
    if not first:
        return f"No candidate was ranked in {place}."
    return " ".join((_lead(first, place), _margin_words(first), *_rest(rows)))


def _lead(first: Sequence[Document], place: str) -> str:
    verdicts = ", ".join(dict.fromkeys(row["verdict"] or "not finished" for row in first))
    if len(first) == 1:
        return f"{first[0]['name']} ranks first in {place}: {verdicts}."
    names = ", ".join(row["name"] for row in first)
    return f"{len(first)} materials tie for first in {place} ({names}): {verdicts}."


def _margin_words(first: Sequence[Document]) -> str:
    """Return threshold, eta and margin; their ranges where several tie."""
    etas = [row["restitution_factor"] for row in first]
    limits = [row["restitution_threshold"] for row in first]
    margins = [row["margin"] for row in first]
    it, has = ("It tolerates", "has") if len(first) == 1 else ("They tolerate", "have")
    pocket = "this bearing with its pocket" if len(first) == 1 else "this bearing and their pockets"
    return (
        f"{it} a restitution factor up to {_span(limits)}; {pocket} {has} {_span(etas)} "
        f"(margin {_span(margins, signed=True)})."
    )


def _span(values: Sequence[float], *, signed: bool = False) -> str:
    """Return one number, or the least and the largest of several."""
    form = "{:+.2f}" if signed else "{:.2f}"
    ends = dict.fromkeys(form.format(value + 0.0) for value in (min(values), max(values)))
    return " to ".join(ends)


def _rest(rows: Sequence[Document]) -> list[str]:
    """Return the verdicts of those that are not first, each with its names; nothing if there is none."""
    names: dict[str, list[str]] = {}
    for row in rows:
        if row["rank"] != 1:
            word = row["verdict"] or ("not measured" if row["friction"] is None else "not finished")
            names.setdefault(word, []).append(row["name"])
    return [f"The others: {_by_verdict(names)}."] if names else []


def _by_verdict(each: Mapping[str, Sequence[str]]) -> str:
    return "; ".join(f"{verdict} {', '.join(who)}" for verdict, who in each.items())
