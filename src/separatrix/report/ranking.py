"""Text of a ranking: the answer for the bearing's own environment, and all of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.report.cage import (
    chain_facts,
    ensemble_facts,
    judgement_facts,
    motion_words,
    study_facts,
)
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, significant, table

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
EVIDENCE_HEADERS = (
    "material",
    "motion",
    "bearing's\neta",
    "growth rate 1/s\n(95 %)",
    "offset\nmm",
    "drift\n1/s",
    "pocket\nN",
    "land\nN",
    "whirl\nHz",
    "whirl\nratio",
)
DIRECTIONS = {1: "forward", -1: "backward", 0: ""}


def rank(document: Document) -> list[str]:
    """The answer for the bearing's own environment, on a screen; `every_environment` has the rest."""
    rows = headline(document)
    return [
        paragraph(_in_short(document), indent=""),
        section(_title(document["environment"]), _table(rows), *_notes(rows)),
        *_uncertain(document, rows),
        section(f"Evidence: {_ensemble(document)}", _short_evidence(rows), *_undecided(rows)),
        paragraph(_elsewhere(document), indent=""),
    ]


def headline(document: Document) -> Sequence[Document]:
    """Return the rows of the bearing's own environment."""
    return next(
        one["materials"] for one in document["environments"] if one["name"] == document["environment"]
    )


def only_table(document: Document) -> list[str]:
    """The table of the bearing's own environment, for `--quiet`."""
    return [section(_title(document["environment"]), _table(headline(document)))]


def every_environment(document: Document) -> list[str]:
    """Verdict, margin, rank, evidence and reason of each candidate in each environment, then overall."""
    own, overall = document["environment"], document["overall"]
    ordered = sorted(document["environments"], key=lambda one: bool(one["name"] != own))
    several = len(ordered) > 1
    return [
        paragraph(_in_short(document), indent=""),
        *(_environment(document, one) for one in ordered[:1]),
        paragraph(LEGEND),
        paragraph(EVIDENCE_LEGEND),
        *_first(ordered[0]["materials"]),
        section("What the verdicts hold for", facts(_holds_for(document))),
        *(_environment(document, one) for one in ordered[1:]),
        *([_overall(document, overall)] if several else []),
    ]


def _overall(document: Document, overall: Sequence[Document]) -> str:
    """Return the table of mean frictions, which belongs to no environment."""
    title = "Overall: mean friction over the measured environments"
    notes = [*([""] * any(row["extrapolation"] for row in overall)), *footnotes(overall), *_gaps(document)]
    return section(title, _table(overall), *notes, "", _evidence(overall), "", *_reasons(overall))


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
    return ["", *_reasons(open_rows)] if open_rows else []


def _elsewhere(document: Document) -> str:
    """Return which other answers there are, and who leads in them."""
    others = [one for one in document["environments"] if one["name"] != document["environment"]]
    more = "`--full` prints all evidence and all reasons"
    if not others:
        return f"{more}."
    leads = [f"{one['name']}: {', '.join(_first_names(one['materials'])) or 'none'}" for one in others]
    return f"First elsewhere: {'; '.join(leads)}. {more}, for every environment."


def _first_names(rows: Sequence[Document]) -> list[str]:
    return [row["name"] for row in rows if row["rank"] == 1]


def _environment(document: Document, one: Document) -> str:
    """Return verdicts, evidence and reasons of one environment."""
    rows = one["materials"]
    evidence = (f"  Evidence: {_ensemble(document)}", "", _evidence(rows), "")
    notes = ("", *footnotes(rows), *lowest(rows), "")
    drawn = [line for text in _uncertain(document, rows) for line in ("", text)]
    return section(_title(one["name"]), _table(rows), *notes, *evidence, *_reasons(rows), *drawn)


def _uncertain(document: Document, rows: Sequence[Document]) -> list[str]:
    """Return the verdicts over the uncertain inputs; nothing if the study states none."""
    known = [row for row in rows if row["uncertain_verdict"] is not None]
    if not known:
        return []
    each: dict[str, list[str]] = {}
    for row in known:
        share = _with_interval(row, "uncertain_probability_stable", "uncertain_probability")
        each.setdefault(row["uncertain_verdict"], []).append(f"{row['name']} {share}")
    found = "; ".join(f"{verdict} {', '.join(who)}" for verdict, who in each.items())
    inputs = [one["name"] for one in document["study"]["uncertain_inputs"]]
    names = ", ".join(inputs[:NAMED]) + (", ..." if len(inputs) > NAMED else "")
    text = (
        f"Uncertain inputs ({names}) are at their means above. With a bearing drawn for each of "
        f"{known[0]['uncertain_runs']} runs from each kick, P(stable) is: {found}."
    )
    return [paragraph(text, indent="")]


NAMED = 6
"""Uncertain inputs that are named; `check` lists them all."""


def _first(rows: Sequence[Document]) -> list[str]:
    """Return all the evidence of the candidate at the top; nothing if it has no verdict."""
    return [
        section(f"{row['name']} in detail", facts(judgement_facts(row)))
        for row in rows[:1]
        if row["verdict"] is not None
    ]


LEGEND = (
    "rank: by margin, = a tie within the scatter. threshold: largest stable restitution factor eta. "
    "margin: threshold less the bearing's eta. P(stable): share of runs that settle, worst kick."
)
EVIDENCE_LEGEND = (
    "motion: what most runs from the worst kick end in. growth rate: of the amplitude, mean over those runs. "
    "offset of the cage centre, force at a pocket and at the land: largest in any run. drift: median growth "
    "of the mean offset of the runs that do not whirl. whirl: median of the runs that whirl, of all runs if "
    "none does, seen from the balls; ratio: speed at which the centre orbits the axis over that of the balls."
)


def _title(name: str) -> str:
    return name[:1].upper() + name[1:]


def _table(rows: Sequence[Document]) -> str:
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


def footnotes(rows: Sequence[Document]) -> list[str]:
    """Return what was not tested, once for all candidates of whom it is said; nothing if all was."""
    who: dict[str, list[str]] = {}
    for row in rows:
        for sentence in row["extrapolation"]:
            who.setdefault(sentence, []).append(row["name"])
    measured = sum(row["friction"] is not None for row in rows)
    said = [
        sentence + ("" if len(names) == measured else f" ({', '.join(names)})")
        for sentence, names in who.items()
    ]
    text = f"extrapolated beyond the tests: {'. '.join(said)}."
    return [paragraph(text, first=f"  {MARK} ", indent="    ")] if said else []


def _with_interval(row: Document, key: str, ends: str) -> str:
    if row[key] is None:
        return ABSENT
    low, high = (number(row[f"{ends}_{end}"], 2) for end in ("low", "high"))
    return f"{number(row[key], 2)} ({low} to {high})"


def _ensemble(document: Document) -> str:
    """Return the runs behind every verdict, their length and their kicks."""
    kicks = ", ".join(f"{kick:g}" for kick in document["kicks"])
    return f"{document['runs']} runs of {quantity(document['duration'], 's')} from each kick, {kicks} m/s"


def _gaps(document: Document) -> list[str]:
    """Return in how many environments a candidate was measured, if not in all."""
    total = len(document["environments"])
    found = {row["name"]: _measured(row["name"], document["environments"]) for row in document["overall"]}
    few = [f"{name} in {count}" for name, count in found.items() if count < total]
    return ["", paragraph(f"Measured in fewer than {total} environments: {', '.join(few)}.")] if few else []


def _measured(name: str, environments: Sequence[Document]) -> int:
    """Return in how many of the environments a candidate was measured."""
    found = [row for one in environments for row in one["materials"] if row["name"] == name]
    return sum(row["friction"] is not None for row in found)


def _evidence(rows: Sequence[Document]) -> str:
    """Return the evidence of verdicts; the bearing's eta only where candidates differ in it."""
    table_rows = [[row["name"], *_evidence_row(row)] for row in rows]
    alike = len({row[ETA] for row in table_rows} - {ABSENT}) <= 1
    shown = [i for i in range(len(EVIDENCE_HEADERS)) if not (alike and i == ETA)]
    cells = [[row[i] for i in shown] for row in table_rows]
    return table([EVIDENCE_HEADERS[i] for i in shown], cells, left=2)


ETA = EVIDENCE_HEADERS.index("bearing's\neta")


def _evidence_row(row: Document) -> list[str]:
    whirl = row["whirl_frequency"]
    if whirl is None:
        return [ABSENT] * (len(EVIDENCE_HEADERS) - 1)
    return [
        motion_words(row["cage_motion"]),
        number(row["restitution_factor"], 2),
        _growth(row),
        number(1e3 * row["largest_offset"]),
        significant(row["drift_rate"], 2),
        *(number(row[f"largest_{name}_force"], 0) for name in ("contact", "land")),
        f"{number(whirl, 1 if whirl < 10 else 0)} {DIRECTIONS[row['whirl_direction']]}".rstrip(),
        number(row["whirl_ratio"], 2),
    ]


def _growth(row: Document) -> str:
    rate = significant(row["growth_rate"], 3)
    if row["growth_rate_low"] is None:
        return rate
    low, high = (significant(row[f"growth_rate_{end}"], 3) for end in ("low", "high"))
    return f"{rate} ({low} to {high})"


def _reasons(rows: Sequence[Document]) -> list[str]:
    """Return the reasons; candidates of the same friction share theirs."""
    names: dict[str, list[str]] = {}
    for row in rows:
        names.setdefault(row["reason"], []).append(row["name"])
    return [
        paragraph(f"{', '.join(who)}: {reason}", first="  ", indent="      ") for reason, who in names.items()
    ]


def _holds_for(document: Document) -> list[tuple[str, str]]:
    return [
        *study_facts(document["study"]),
        *chain_facts(document["chain"]),
        *ensemble_facts(document),
        ("Ball on pocket", _pocket(document["pocket"])),
        ("Unrepeated tests", _scatter(document)),
        ("The paper's bound", document["paper_statement"]),
        *_disagreement(document),
    ]


def _pocket(pocket: Document) -> str:
    """Return what rubs in the pocket, of which friction was asked for."""
    low, high = pocket["slip_speed_low"], pocket["slip_speed_high"]
    slip = f"{pocket['slip_speed']:.3g} m/s"
    if high > 1.001 * low:
        slip += f" ({low:.3g} to {high:.3g} around the bearing)"
    pressure = quantity(float(f"{pocket['pressure']:.3g}"), "Pa")
    force = quantity(float(f"{pocket['impact_force']:.3g}"), "N")
    return f"slides at {slip}; mean pressure {pressure} in an impact of {force} (impact speed)"


def _scatter(document: Document) -> str:
    """Return what an unrepeated test is assumed to scatter, where any candidate's friction rests on that."""
    rows = [row for one in document["environments"] for row in one["materials"]]
    if not any(row["friction_scatter_assumed"] for row in rows):
        return "none: every friction has its measured scatter"
    share = 100.0 * document["friction_scatter"]
    return f"assumed to scatter by {share:.3g} % of their mean: a guess, [ranking] friction_scatter"


def _disagreement(document: Document) -> list[tuple[str, str]]:
    """Return what to say where the chain's own eta is below the paper's least."""
    eta, limit = document["restitution_factor"], document["solid_lubrication_limit"]
    if eta >= limit:
        return []
    text = f"The contact model gives {number(eta, 2)} for this film, below that {limit:g}. Both are shown."
    return [("This film", text)]


def _in_short(document: Document) -> str:
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
    each = [f"{word} {', '.join(who)}" for word, who in names.items()]
    return [f"The others: {'; '.join(each)}."] if each else []
