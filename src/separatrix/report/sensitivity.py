"""Text of an uncertain ranking: probabilities, sources of uncertainty, the next test, inverse answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from separatrix.report.cage import chain_facts, motion_words, study_facts
from separatrix.report.tables import (
    ABSENT,
    WIDTH,
    facts,
    number,
    paragraph,
    quantity,
    section,
    significant,
    table,
)

Document = Mapping[str, Any]

HEADERS = (
    "tie",
    "material",
    "friction of\na new cage",
    "threshold",
    "margin\n(5-95 %)",
    "P(stable)\n(95 %)",
    "P(un-\nstable)",
    "P(best)",
)
MARK, GUESS = "*", "?"

LEGEND = paragraph(
    "tie: 1 is the leader and all that cannot be told from it at 95 %. friction of a new cage: mean, and "
    "standard deviation in per cent of it. threshold: largest restitution factor eta at which the cage is "
    "stable, median; margin: threshold less the eta of bearing and film, the ends between which nine in ten "
    "samples lie. P(stable): at most one run in ten whirls, from every kick; P(unstable): more than half "
    "whirl, from some kick; the rest is undecided. P(best): largest threshold of its environment; none "
    "where no other was measured."
)


EVIDENCE_HEADERS = (
    "material",
    "verdict",
    "motion",
    "offset\nmm",
    "drift\n1/s",
    "pocket\nN",
    "land\nN",
    "whirl\nHz",
    "runs",
)
EVIDENCE_LEGEND = paragraph(
    "Single runs, every input at its mean (as rank): verdict; motion: what the cage centre does at the end, "
    "from the worst kick; offset of the cage centre, force at a pocket and at the land: largest in any run; "
    "drift: median growth of the mean offset in the runs that do not whirl; runs: from each kick."
)


def sensitivity(document: Document) -> list[str]:
    """Probabilities in every environment and overall, then everything behind them."""
    return [
        *(_environment(one["name"], one["materials"]) for one in document["environments"]),
        _environment("over all environments, mean friction", document["overall"]),
        "\n".join([LEGEND, EVIDENCE_LEGEND, *_marks(document)]),
        section("Uncertain inputs", *_inputs(document)),
        section("Boundary", *(_boundary(one) for one in document["boundaries"])),
        section("Convergence of P(stable), where it is least decided", _convergence(document)),
        *_doubt(document),
        section("What this holds for", facts(_holds_for(document))),
        paragraph(_in_short(document), first="In short: ", indent="          "),
    ]


def _environment(name: str, rows: Sequence[Document]) -> str:
    shared = Counter(row["tie_group"] for row in rows)
    cells = [_row(row, tied=shared[row["tie_group"]] > 1) for row in rows]
    judged = [_evidence(row) for row in rows if row["verdict"] is not None]
    evidence = ["", table(EVIDENCE_HEADERS, judged, left=3)] if judged else []
    return section(name[:1].upper() + name[1:], table(HEADERS, cells, left=2), *evidence)


def _evidence(row: Document) -> list[str]:
    """Return what single runs show of a candidate."""
    whirl = row["whirl_frequency"]
    return [
        row["name"],
        row["verdict"],
        motion_words(row["cage_motion"]),
        number(1e3 * row["largest_offset"]),
        significant(row["drift_rate"], 2),
        *(number(row[f"largest_{name}_force"], 0) for name in ("contact", "land")),
        number(whirl, 1 if whirl < 10.0 else 0),
        f"{row['runs']} of {quantity(row['duration'], 's')}",
    ]


def _row(row: Document, *, tied: bool) -> list[str]:
    if row["friction"] is None:
        return [ABSENT, row["name"], "not measured", *[ABSENT] * (len(HEADERS) - 3)]
    marks = (GUESS if row["friction_scatter_assumed"] else "") + (MARK if row["extrapolation"] else "")
    share = row["friction_deviation"] / row["friction"] if row["friction"] else 0.0
    return [
        f"{row['tie_group']}{'=' if tied else ''}",
        row["name"],
        f"{number(row['friction'])} ({100.0 * share:.0f} %){marks}",
        number(row["restitution_threshold"], 2),
        f"{row['margin_low']:+.2f} to {row['margin_high']:+.2f}",
        _between(row, "probability_stable"),
        number(row["probability_unstable"], 2),
        "none" if row["probability_best"] is None else number(row["probability_best"], 2),
    ]


def _between(row: Document, key: str) -> str:
    return f"{number(row[key], 2)} ({number(row[f'{key}_low'], 2)}-{number(row[f'{key}_high'], 2)})"


def _marks(document: Document) -> Iterator[str]:
    """Yield what the marks beside frictions mean, if there are any."""
    rows = [row for one in document["environments"] for row in one["materials"]]
    if any(row["friction_scatter_assumed"] for row in rows):
        share = f"{100.0 * document['default_scatter']:.3g} % of the mean"
        yield paragraph(
            f"{GUESS} its scatter from sample to sample was not measured: {share} is taken for that, a guess "
            "([ranking] friction_scatter). The per cent beside a friction is the whole scatter of the next "
            "cage: this, how well the mean is known, and what was not tested; over all environments, that of "
            "their mean."
        )
    words = dict.fromkeys(text for row in rows for text in row["extrapolation"])
    if words:
        yield paragraph(
            f"{MARK} extrapolated beyond the tests: {'. '.join(words)}. Where the tests themselves are not "
            "known, no scatter is added for that."
        )


def _moves(row: Document) -> str:
    """What an input moves beside the restitution factor, in brackets."""
    moved = [words for key, words in MOVES.items() if row[key]]
    return f" (moves {' and '.join(moved)})" if moved else ""


def _inputs(document: Document) -> list[str]:
    """Return the inputs that are no frictions one by one, and how many frictions there are of what origin."""
    rows = document["inputs"]
    frictions = [row for row in rows if _is_friction(row)]
    others = [row for row in rows if not _is_friction(row)]
    origins = Counter(row["source"] for row in frictions)
    told = ", ".join(f"{count} {SOURCES[source]}" for source, count in origins.items())
    shown = [(row["name"], row["distribution"] + _moves(row)) for row in others]
    shown += [("frictions", f"{len(frictions)}: {told}")] if frictions else []
    failed = document["failed"]
    shown.append(
        ("samples", f"{document['samples']}" + (f", of which {failed} have no answer" if failed else ""))
    )
    return [facts(shown), *(paragraph(note) for note in document["notes"])]


MOVES = {"moves_boundary": "the boundary", "moves_friction": "frictions from tests"}

SOURCES = {
    "study": "from the study",
    "measured": "with measured scatter",
    "assumed": "with the default scatter, a guess",
}


def _is_friction(row: Document) -> bool:
    return str(row["name"]).startswith("ranking.") and ".material." not in row["name"]


def _boundary(one: Document) -> str:
    """Return how a boundary was found, and how far it can be trusted."""
    error = one["surrogate"]
    moved = ", ".join(one["parameters"])
    first = f"It moves with {moved}." if moved else "No uncertain input changes the cage itself."
    cages = f"of {error['cages']} other cages" if moved else "of the same cage"
    decides = "" if error["decides"] else " THAT IS TOO MUCH TO DECIDE ANYTHING: narrow these inputs."
    return paragraph(
        f"{first} Traced, and fitted to {error['runs']} single runs {cages}; {one['runs']} runs in all. The "
        f"friction at which it lies is known to {100.0 * error['error']:.1f} %, of that "
        f"{100.0 * error['misfit']:.1f} % misfit, found in {error['held_out']} runs held out; deviance of a "
        f"held-out run {error['deviance']:.2f}, without a law {error['deviance_constant']:.2f}. The error is "
        f"in every interval.{decides}"
    )


def _convergence(document: Document) -> str:
    """Return P(stable) of the least decided case of each environment for several numbers of samples."""
    last = len(document["sizes"]) - 1
    sizes = sorted({0, last // 2, last})
    headers = ["case", *(f"{document['sizes'][k]}\nsamples" for k in sizes)]
    rows = []
    for place in dict.fromkeys(row["environment"] for row in document["convergence"]):
        own = [row for row in document["convergence"] if row["environment"] == place]
        least = min(own, key=lambda row: abs(row["probability_stable"][-1] - 0.5))
        rows.append([f"{least['name']}, {place or 'overall'}", *(_at(least, k) for k in sizes)])
    return table(headers, rows)


def _at(row: Document, k: int) -> str:
    value, low, high = (row[f"probability_stable{end}"][k] for end in ("", "_low", "_high"))
    return f"{number(value, 2)} ({number(low, 2)}-{number(high, 2)})"


def _doubt(document: Document) -> Iterator[str]:
    """Yield the main sources of uncertainty, the next test, and the inverse answers."""
    if document["sobol"] is None:
        yield section("Main sources of uncertainty", paragraph(document["doubt_reason"]))
        return
    yield section("Main sources of uncertainty", DRIVERS_LEGEND, *_drivers(document))
    yield section("Which test to run next", *map(paragraph, _next_test(document["next_test"])))
    allowed = dict.fromkeys(one["sentence"] for one in document["allowed_friction"]) or [NO_FRICTION]
    error = max(one["surrogate"]["error"] for one in document["boundaries"])
    known = (
        f"The boundary has an uncertainty of {100.0 * error:.1f} %, included in the first number and not in "
        "the last."
    )
    yield section("Which friction a new material may have", *map(paragraph, [*allowed, known]))
    yield section("Which film keeps the cage stable", *_films(document))


NO_FRICTION = "No candidate's friction is uncertain: none was varied."
DRIVERS_LEGEND = paragraph(
    "Shares of the variance of margin and verdict, in per cent: first (95 % interval) what would be left if "
    "all else were known, for inputs decide together and these may add up to more than 100; behind the comma "
    "what would go if this input alone were known. own friction: of the pocket, in that environment. "
    "boundary: what the finite number of runs leaves open."
)


def _next_test(answer: Document) -> Iterator[str]:
    """Yield what is undecided, and the tests that would settle it."""
    names = [f"{name} in {place}" for name, place in answer["undecided"]]
    if names:
        rule = "between 5 and 95 % stable, the boundary's doubt included"
        yield f"Undecided ({rule}): {'; '.join(names)}."
    yield from answer["sentences"]


def _drivers(document: Document) -> Iterator[str]:
    """Yield a table for each environment: the cases that are not decided there; all if none is open."""
    cases = document["sobol"]["cases"]
    shown = [case for case in cases if 0.05 < case["probability_stable"]["value"] < 0.95] or cases
    columns = _columns(shown)
    for place in dict.fromkeys(case["environment"] for case in shown):
        own = [case for case in shown if case["environment"] == place]
        yield ""
        texts = [_of(place, own, columns[:n]) for n in range(MOST_COLUMNS, 0, -1)]
        yield next((text for text in texts if _fits(text)), texts[-1])


OWN, MOST_COLUMNS, LEAST = "own friction", 6, 0.01


def _of(place: str, cases: Sequence[Document], columns: Sequence[str]) -> str:
    """Return the table of one environment."""
    cells = [[*row, *_shares(case, row[1], columns)] for case in cases for row in _lines_of(case)]
    return table([place, "of", *columns], cells, left=2)


def _fits(text: str) -> bool:
    return max(map(len, text.splitlines())) <= WIDTH


def _lines_of(case: Document) -> Iterator[list[str]]:
    """Yield the two lines of a case."""
    yield [case["candidate"], "margin"]
    yield ["", "verdict"]


def _columns(cases: Sequence[Document]) -> list[str]:
    """Return the inputs by their largest total index, but those that matter to none."""
    largest: dict[str, float] = {}
    for case in cases:
        for index in (*case["margin"], *case["verdict"]):
            name = _factor(index)
            largest[name] = max(largest.get(name, 0.0), index["total"]["value"])
    return sorted((name for name in largest if largest[name] >= LEAST), key=lambda name: -largest[name])


def _factor(index: Document) -> str:
    return OWN if _is_friction({"name": index["factor"]}) else str(index["factor"])


def _shares(case: Document, what: str, columns: Sequence[str]) -> list[str]:
    """Return total with its interval, and first-order index, of each column in per cent."""
    known = {_factor(index): index for index in case[what]}
    return [_share(known[name]) if name in known else ABSENT for name in columns]


def _share(index: Document) -> str:
    value, low, high, alone = (
        f"{100.0 * one:.0f}"
        for one in (*(index["total"][k] for k in ("value", "low", "high")), index["first"]["value"])
    )
    return f"{value} ({low}-{high}), {alone}"


def _films(document: Document) -> list[str]:
    """Return a table for each environment: film thickness that keeps a material stable, by race friction."""
    films = document["films"]
    if not films:
        return [paragraph(document["films_reason"])]
    head = (
        f"Film thickness with a probability of STABLE of {films[0]['probability']:.2f} or more, by the "
        "friction f of ball on race; all else as it is, with its doubt."
    )
    blocks = [paragraph(f"{head} {_thick(films[0])}")]
    for place in dict.fromkeys(one["environment"] for one in films):
        own = [one for one in films if one["environment"] == place]
        rows = [i for i, f in enumerate(own[0]["race_friction"]) if f in RACE_FRICTIONS]
        headers = [place, *(f"f {own[0]['race_friction'][i]:.3g}" for i in rows)]
        cells = [[one["candidate"], *(_spans(one["rows"][i]["probable"]) for i in rows)] for one in own]
        blocks += ["", table(headers, cells)]
    return blocks


RACE_FRICTIONS = (0.02, 0.05, 0.1, 0.2, 0.4)
"""Of those that were asked, the ones that a table has room for."""


def _thick(film: Document) -> str:
    """Return up to which thickness the model of the film holds."""
    limit = f"{1e6 * film['holds_up_to']:.2g} um"
    return f"Beyond {limit} the film is thicker than the model of a film in series holds for."


def _spans(spans: Sequence[Document]) -> str:
    return " or ".join(_span(span) for span in spans) or "none"


def _span(span: Document) -> str:
    low, high = (quantity(float(f"{span[end]:.2g}"), "m") for end in ("low", "high"))
    if span["from_edge"] and span["to_edge"]:
        return "any"
    if span["to_edge"]:
        return f">= {low}"
    return f"<= {high}" if span["from_edge"] else f"{low} to {high}"


def _holds_for(document: Document) -> list[tuple[str, str]]:
    kicks = ", ".join(f"{kick:g}" for kick in document["kicks"])
    return [
        *study_facts(document["study"]),
        *chain_facts(document["chain"]),
        ("Kicks", f"{kicks} m/s"),
        ("Seed", f"{document['seed']}; {document['runs']} runs in all"),
    ]


def _in_short(document: Document) -> str:
    """Return the leaders over all environments in a sentence."""
    rows = [row for row in document["overall"] if row["tie_group"] == 1]
    if not rows:
        return "no candidate was measured."
    names = " and ".join(row["name"] for row in rows)
    first = rows[0]
    best = "is the only one measured" if first["probability_best"] is None else "is best"
    tie = "cannot be told apart at the top" if len(rows) > 1 else best
    low, high = first["probability_stable_low"], first["probability_stable_high"]
    who = "it" if first["probability_best"] is None else first["name"]
    return (
        f"{names} {tie} over all environments; {who} is stable with a probability of "
        f"{number(first['probability_stable'], 2)} ({number(low, 2)} to {number(high, 2)})."
    )
