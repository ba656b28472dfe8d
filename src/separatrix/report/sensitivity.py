"""Text of an uncertain study: verdicts, sources of uncertainty, the next test, allowed friction and films."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from separatrix.report.cage import chain_facts, motion_words, study_facts
from separatrix.report.tables import ABSENT, facts, number, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]

HEADERS = (
    "material",
    "friction of\na new cage",
    "P(stable)\n(95 %)",
    "verdict",
    "motion",
    "offset\nmm",
    "pocket\nN",
    "land\nN",
    "runs",
)
MARK, GUESS = "*", "?"

LEGEND = paragraph(
    "friction of a new cage: mean, and standard deviation in per cent of it. P(stable): share of the "
    "bearings whose cage settles, from the worst kick. motion: what most of them end in. offset, forces: "
    "largest in any run. runs: bearings from the worst kick; fewer where the verdict was plain before."
)


def sensitivity(document: Document) -> list[str]:
    """Verdicts for the bearing's own environment, then for the others, and everything behind them."""
    own = document["environment"]
    ordered = sorted(document["environments"], key=lambda one: bool(one["name"] != own))
    several = len(ordered) > 1
    return [
        paragraph(_in_short(ordered[0]), indent=""),
        _environment(ordered[0]["name"], ordered[0]["materials"]),
        "\n".join([LEGEND, *_marks(document)]),
        *(_environment(one["name"], one["materials"]) for one in ordered[1:]),
        *([_environment("over all environments, mean friction", document["overall"])] if several else []),
        section("Uncertain inputs", *_inputs(document)),
        section("Main sources of uncertainty", *_sources(document)),
        section("Which test to run next", *map(paragraph, _next_test(document))),
        section("Which friction a new material may have", *map(paragraph, _friction(document))),
        section(f"Which film keeps the cage stable in {own}", *_films(document)),
        section("What this holds for", facts(_holds_for(document))),
    ]


def _environment(name: str, rows: Sequence[Document]) -> str:
    etas: dict[str, list[str]] = {}
    for row in rows:
        if row["restitution_factor"] is not None:
            ends = (number(row[f"restitution_factor{end}"], 2) for end in ("", "_low", "_high"))
            etas.setdefault("{} ({} to {})".format(*ends), []).append(row["name"])
    alike = len(etas) == 1
    each = "; ".join(eta if alike else f"{eta} {', '.join(names)}" for eta, names in etas.items())
    words = paragraph(f"Restitution factor of the drawn bearings, median (nine in ten): {each}.")
    return section(
        name[:1].upper() + name[1:], table(HEADERS, [_row(row) for row in rows], left=1), "", words
    )


def _row(row: Document) -> list[str]:
    if row["friction"] is None:
        return [row["name"], "not measured", *[ABSENT] * (len(HEADERS) - 2)]
    marks = (GUESS if row["friction_scatter_assumed"] else "") + (MARK if row["extrapolation"] else "")
    share = row["friction_deviation"] / row["friction"] if row["friction"] else 0.0
    known = [row["name"], f"{number(row['friction'])} ({100.0 * share:.0f} %){marks}"]
    if row["verdict"] is None:
        return [*known, "not finished", *[ABSENT] * (len(HEADERS) - len(known) - 1)]
    ends = "-".join(number(row[f"probability_{end}"], 2) for end in ("low", "high"))
    return [
        *known,
        f"{number(row['probability_stable'], 2)} ({ends})",
        row["verdict"],
        motion_words(row["cage_motion"]),
        number(1e3 * row["largest_offset"]),
        *(number(row[f"largest_{name}_force"], 0) for name in ("contact", "land")),
        str(row["runs"]),
    ]


def _marks(document: Document) -> Iterator[str]:
    """Yield what the marks beside frictions mean, if there are any."""
    rows = [row for one in document["environments"] for row in one["materials"]]
    if any(row["friction_scatter_assumed"] for row in rows):
        share = f"{100.0 * document['default_scatter']:.3g} % of the mean"
        yield paragraph(
            f"{GUESS} its scatter from sample to sample was not measured: {share} is assumed, a guess "
            "([ranking] friction_scatter). The per cent beside a friction is the whole scatter of a new "
            "cage: this, how well the mean is known, and what was not tested."
        )
    words = dict.fromkeys(text for row in rows for text in row["extrapolation"])
    if words:
        yield paragraph(f"{MARK} extrapolated beyond the tests: {'. '.join(words)}.")


def _inputs(document: Document) -> list[str]:
    """Return the inputs one by one, but of the frictions how many there are of what origin."""
    rows = document["inputs"]
    frictions = [row for row in rows if _is_friction(row["name"])]
    shown = [(row["name"], row["distribution"]) for row in rows if not _is_friction(row["name"])]
    origins = Counter(SOURCES[row["source"]] for row in frictions)
    counted = ", ".join(f"{count} {source}" for source, count in origins.items())
    shown += [("frictions", f"{len(frictions)}: {counted}")] if frictions else []
    failed = document["failed"]
    drawn = f"{document['bearings']}" + (f", of which {failed} make no bearing" if failed else "")
    return [facts([*shown, ("bearings drawn", drawn)])]


SOURCES = {
    "study": "from the study",
    "measured": "with measured scatter",
    "assumed": "with the default scatter, a guess",
}


def _is_friction(name: str) -> bool:
    return name.startswith("ranking.") and ".material." not in name


OWN = "own friction"
SOURCES_LEGEND = paragraph(
    "Share of the variance of the logit of P(settles) that each input brings (95 %), in per cent, by a "
    "logistic regression of the runs; chance: the single run's disturbance and leads. skill: part of the "
    "deviance explained, on bearings left out of the fit."
)


def _sources(document: Document) -> Iterator[str]:
    """Yield the drivers of the cases that can tell, the silent ones, and the shares of eta and C_mu."""
    known = [one for one in document["drivers"] if one["shares"]]
    if known:
        yield SOURCES_LEGEND
        columns = _columns(known)
        cells = [[f"{one['name']}, {one['environment']}", *_shares(one, columns)] for one in known]
        headers = ["case", *(name.replace(".", ".\n") for name in columns), "skill"]
        yield table(headers, cells, left=1)
    silent = [one for one in document["drivers"] if not one["shares"]]
    reasons: dict[str, list[str]] = {}
    for one in silent:
        kind = (
            "too few bearings end otherwise" if one["skill"] is None else "the inputs explain next to nothing"
        )
        reasons.setdefault(kind, []).append(f"{one['name']} in {one['environment']}")
    for kind, cases in reasons.items():
        listed = "; ".join(cases) if len(cases) <= LISTED else f"{len(cases)} cases"
        yield paragraph(f"No sources shown, {kind}: {listed}.")
    for one in document["shares"]:
        parts = ", ".join(f"{x['name']} {_per_cent(x)}" for x in one["total"][:LISTED] if x["share"] >= LEAST)
        words = {"restitution_factor": "Restitution factor", "race_damping": "Race damping C_mu"}
        yield paragraph(f"{words[one['quantity']]} of {one['name']}, total Sobol indices: {parts}.")


LISTED, MOST_COLUMNS, LEAST = 6, 4, 0.01


def _columns(cases: Sequence[Document]) -> list[str]:
    """Return the inputs by their largest share, chance last."""
    largest: dict[str, float] = {}
    for case in cases:
        for one in case["shares"][:-1]:
            name = OWN if _is_friction(one["name"]) else one["name"]
            largest[name] = max(largest.get(name, 0.0), one["share"])
    ordered = sorted((name for name in largest if largest[name] >= LEAST), key=lambda name: -largest[name])
    return [*ordered[:MOST_COLUMNS], "chance"]


def _shares(case: Document, columns: Sequence[str]) -> list[str]:
    known = {OWN if _is_friction(one["name"]) else one["name"]: one for one in case["shares"][:-1]}
    known["chance"] = case["shares"][-1]
    cells = [_per_cent(known[name]) if name in known else ABSENT for name in columns]
    return [*cells, f"{100.0 * case['skill']:.0f} %"]


def _per_cent(one: Document) -> str:
    value, low, high = (f"{100.0 * one[key]:.0f}" for key in ("share", "share_low", "share_high"))
    return f"{value} ({low}-{high})"


def _next_test(document: Document) -> Iterator[str]:
    """Yield which cases are undecided, and what measuring each input would settle."""
    names = document["undecided"]
    if not names:
        yield "No case is undecided: no measurement would change a verdict."
        return
    yield f"Undecided: {'; '.join(names)}."
    for test in document["next_tests"][:LISTED]:
        pairs = list(zip(test["cases"], test["chances"], strict=True))[:LISTED]
        cases = "; ".join(f"{case} ({100.0 * chance:.0f} %)" for case, chance in pairs)
        yield f"Measuring {test['name']} would settle {test['settled']:.1f} of them on average: {cases}."
    if not document["next_tests"]:
        yield "No single measurement would settle any of them."


def _friction(document: Document) -> Iterator[str]:
    """Yield the largest friction of a new material, for each pocket."""
    several = len(document["allowed_friction"]) > 1
    for one in document["allowed_friction"]:
        pocket = f" in the pockets of {', '.join(one['names'])}" if several else ""
        wanted = f"with a probability of {100.0 * one['probability']:.0f} %{pocket}"
        if one["friction"] is None:
            yield f"To be stable {wanted}, no friction can be named: {one['reason']}."
            continue
        ends = f"{number(one['friction_low'])} to {number(one['friction_high'])}"
        yield (
            f"At most {number(one['friction'])} ({ends}), if it scatters by {100.0 * one['scatter']:.3g} % "
            f"of itself, to be stable {wanted}."
        )


def _films(document: Document) -> Iterator[str]:
    """Yield the largest restitution factor of each candidate, and the films that keep to it."""
    rows = document["allowed_films"]
    if not rows:
        yield paragraph("No candidate was measured there.")
        return
    wanted = f"{100.0 * rows[0]['probability']:.0f} %"
    frictions = rows[0]["race_friction"]
    headers = ["material", f"eta for\n{wanted}", *(f"f_BT\n{f:g}" for f in frictions)]
    cells = [
        [row["name"], _limit(row), *(_thicknesses(row, i) for i in range(len(frictions)))] for row in rows
    ]
    yield paragraph(
        f"Largest restitution factor eta at which {wanted} of the bearings settle (95 %), and the film "
        "thickness that keeps to it, by the friction f_BT of ball on race; all else as it is, with its "
        "uncertainty."
    )
    yield table(headers, cells, left=1)


def _limit(row: Document) -> str:
    if row["restitution_factor"] is None:
        return "any" if row["reason"].startswith("more") else "none"
    low, high = (number(row[f"restitution_factor_{end}"], 2) for end in ("low", "high"))
    return f"{number(row['restitution_factor'], 2)} ({low}-{high})"


def _thicknesses(row: Document, i: int) -> str:
    """Return which film thicknesses are allowed at one race friction."""
    limit = 1.0 if row["reason"].startswith("more") else row["restitution_factor"]
    allowed = [limit is not None and eta <= limit for eta in row["film_restitution_factor"][i]]
    if all(allowed) or not any(allowed):
        return "any" if allowed[0] else "none"
    edges = [k for k in range(1, len(allowed)) if allowed[k] != allowed[k - 1]]
    if len(edges) > 1:
        return "see figure"
    edge = quantity(float(f"{row['film_thickness'][edges[0] - (not allowed[-1])]:.2g}"), "m")
    return f">= {edge}" if allowed[-1] else f"<= {edge}"


def _holds_for(document: Document) -> list[tuple[str, str]]:
    kicks = ", ".join(f"{kick:g}" for kick in document["kicks"])
    drift = [row["drift_rate"] for row in document["overall"] if row["drift_rate"] is not None]
    return [
        *study_facts(document["study"]),
        *chain_facts(document["chain"]),
        ("Kicks", f"{kicks} m/s"),
        ("Runs", f"{document['runs']} in all; seed {document['seed']}"),
        ("Largest drift", f"{significant(max(drift), 2)} 1/s (median of a case)" if drift else ABSENT),
        ("Ended early", f"at a risk of {document['stopped_risk']:g} of another verdict at each look"),
    ]


def _in_short(own: Document) -> str:
    """Return the verdicts of the bearing's own environment in a sentence."""
    each: dict[str, list[str]] = {}
    for row in own["materials"]:
        word = row["verdict"] or ("not measured" if row["friction"] is None else "not finished")
        each.setdefault(word, []).append(row["name"])
    found = "; ".join(f"{verdict} {', '.join(names)}" for verdict, names in each.items())
    return f"With the uncertain inputs drawn, in {own['name']}: {found}."
