"""Text of an uncertain study: verdicts, sources of uncertainty, the next test, allowed friction and films."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from separatrix.ground.plain_data import plain
from separatrix.study.study import Study
from separatrix.told.chain import basis
from separatrix.told.ranking import newtons
from separatrix.told.sentences import next_test
from separatrix.told.tables import (
    ABSENT,
    facts,
    grouped,
    interval,
    kick_list,
    number,
    paragraph,
    quantity,
    section,
    significant,
    table,
)
from separatrix.verbs.answer_records import SensitivityAnswer
from separatrix.verdict.uncertain_records import (
    AllowedFilm,
    Drivers,
    NotDrawn,
    Share,
    UncertainMaterial,
    UncertainRow,
    UncertainStudy,
)

HEADERS = (
    *("material", "friction of\na new cage", "P(stable)\n(95 %)", "verdict", "motion"),
    *("offset\nmm", "pocket\nN", "land\nN", "runs"),
)
MARK, GUESS = "*", "?"

LEGEND = paragraph(
    "friction of a new cage: mean, and standard deviation in per cent of it. P(stable): share of the "
    "bearings whose cage settles or rolls in its pockets, from the worst kick. motion: class of most of "
    "them. offset, forces: largest in any run. runs: bearings from the worst kick; fewer where the verdict "
    "was plain before."
)
SOURCES = {
    "study": "from the study",
    "measured": "with measured scatter",
    "assumed": "with the default scatter, a guess",
}
OWN = "own friction"
SOURCES_LEGEND = paragraph(
    "Share of the variance of the logit of P(settles) that each input brings (95 %), in per cent, by a "
    "logistic regression of the runs; chance: the single run's disturbance and leads. skill: part of the "
    "deviance explained, on bearings left out of the fit."
)
QUANTITIES = {"restitution_factor": "Restitution factor", "race_damping": "Race damping C_mu"}
LISTED, MOST_COLUMNS, LEAST = 6, 4, 0.01


def sensitivity(answer: SensitivityAnswer, study: Study) -> list[str]:
    """Verdicts for the bearing's own environment, then for the others, and everything behind them."""
    found = answer.uncertain
    own, *others = sorted(found.environments, key=lambda one: bool(one.name != found.environment))
    verdicts = grouped(
        ("not measured" if isinstance(row, NotDrawn) else _verdict(row), row.name) for row in own.materials
    )
    short = "; ".join(f"{verdict} {', '.join(names)}" for verdict, names in verdicts.items())
    judged = [row.judgement for row in found.overall if not isinstance(row, NotDrawn)]
    drift = [judgement.drift_rate for judgement in judged if judgement]
    holds_for = [
        *basis(study, answer),
        ("Kicks", kick_list(found.kicks)),
        ("Runs", f"{found.runs} in all; seed {study.stability.seed}"),
        ("Largest drift", f"{significant(max(drift), 2)} 1/s (median of a case)" if drift else ABSENT),
        ("Ended early", f"at a risk of {found.stopped_risk:g} of another verdict at each look"),
    ]
    overall = [_environment("over all environments, mean friction", found.overall)] if others else []
    tests = plain({"undecided": found.undecided, "next_tests": found.next_tests})
    films = section(f"Which film keeps the cage stable in {found.environment}", *_films(found.allowed_films))
    return [
        paragraph(f"With the uncertain inputs drawn, in {own.name}: {short}.", indent=""),
        _environment(own.name, own.materials),
        "\n".join([LEGEND, *marks(found)]),
        *(_environment(one.name, one.materials) for one in others),
        *overall,
        section("Uncertain inputs", facts(_inputs(found))),
        section("Main sources of uncertainty", *_sources(found)),
        section("Which test to run next", *map(paragraph, next_test(tests, LISTED))),
        section("Which friction a new material may have", *map(paragraph, _friction(found))),
        films,
        section("Basis of this answer", facts(holds_for)),
    ]


def _environment(name: str, rows: Sequence[UncertainRow]) -> str:
    etas = grouped(
        (interval(row.restitution_factor, row.restitution_factor_low, row.restitution_factor_high), row.name)
        for row in rows
        if not isinstance(row, NotDrawn)
    )
    alike = len(etas) == 1
    each = "; ".join(eta if alike else f"{eta} {', '.join(names)}" for eta, names in etas.items())
    words = paragraph(f"Restitution factor of the drawn bearings, median (nine in ten): {each}.")
    cells = [[*row, *[ABSENT] * (len(HEADERS) - len(row))] for row in map(_row, rows)]
    return section(name[:1].upper() + name[1:], table(HEADERS, cells, left=1), "", words)


def _verdict(row: UncertainMaterial) -> str:
    return row.judgement.verdict.name if row.judgement else "not finished"


def _row(row: UncertainRow) -> list[str]:
    if isinstance(row, NotDrawn):
        return [row.name, "not measured"]
    marks = (GUESS if row.friction_scatter_assumed else "") + (MARK if row.extrapolation else "")
    share = row.friction_deviation / row.friction if row.friction else 0.0
    known = [row.name, f"{number(row.friction)} ({100.0 * share:.0f} %){marks}"]
    judged = row.judgement
    if judged is None:
        return [*known, _verdict(row)]
    return [
        *known,
        interval(judged.probability_stable, judged.probability_low, judged.probability_high, to="-"),
        _verdict(row),
        judged.cage_motion.value if judged.cage_motion else "unresolved",
        number(1e3 * judged.largest_offset),
        newtons(judged),
        number(judged.largest_land_force, 0),
        str(judged.runs),
    ]


def marks(found: UncertainStudy) -> Iterator[str]:
    """Yield what the marks beside frictions mean, if there are any."""
    every = (row for one in found.environments for row in one.materials)
    rows = [row for row in every if not isinstance(row, NotDrawn)]
    if any(row.friction_scatter_assumed for row in rows):
        share = f"{100.0 * found.default_scatter:.3g} % of the mean"
        yield paragraph(
            f"{GUESS} its scatter from sample to sample was not measured: {share} is assumed, a guess "
            "([ranking] friction_scatter). The per cent beside a friction is the whole scatter of a new "
            "cage: this, how well the mean is known, and what was not tested."
        )
    words = dict.fromkeys(text for row in rows for text in row.extrapolation)
    if words:
        yield paragraph(f"{MARK} extrapolated beyond the tests: {'. '.join(words)}.")


def _is_friction(name: str) -> bool:
    return name.startswith("ranking.") and ".material." not in name


def _inputs(found: UncertainStudy) -> list[tuple[str, str]]:
    """Return the inputs one by one, but of the frictions how many there are of what origin."""
    shown = [(row.name, row.distribution) for row in found.inputs if not _is_friction(row.name)]
    origins = Counter(SOURCES[row.source] for row in found.inputs if _is_friction(row.name))
    if origins:
        counted = ", ".join(f"{count} {source}" for source, count in origins.items())
        shown.append(("frictions", f"{origins.total()}: {counted}"))
    failed = f", of which {found.failed} make no bearing" if found.failed else ""
    return [*shown, ("bearings drawn", f"{found.bearings}{failed}")]


def _sources(found: UncertainStudy) -> Iterator[str]:
    """Yield the drivers of the cases that have any, the other cases, and the shares of eta and C_mu."""
    known = [one for one in found.drivers if one.shares]
    if known:
        yield SOURCES_LEGEND
        columns = _columns(known)
        cells = [[f"{one.name}, {one.environment}", *_shares(one, columns)] for one in known]
        yield table(["case", *(name.replace(".", ".\n") for name in columns), "skill"], cells, left=1)
    few, weak = "too few bearings end otherwise", "the inputs explain almost no variance"
    reasons = grouped(
        (few if one.skill is None else weak, f"{one.name} in {one.environment}")
        for one in found.drivers
        if not one.shares
    )
    for reason, cases in reasons.items():
        listed = "; ".join(cases) if len(cases) <= LISTED else f"{len(cases)} cases"
        yield paragraph(f"No sources shown, {reason}: {listed}.")
    for smooth in found.shares:
        parts = ", ".join(f"{x.name} {_per_cent(x)}" for x in smooth.total[:LISTED] if x.share >= LEAST)
        yield paragraph(f"{QUANTITIES[smooth.quantity]} of {smooth.name}, total Sobol indices: {parts}.")


def _by_input(case: Drivers) -> dict[str, Share]:
    """Return the shares of a case, without chance; the friction of its own candidate under one name."""
    return {OWN if _is_friction(one.name) else one.name: one for one in case.shares[:-1]}


def _columns(cases: Sequence[Drivers]) -> list[str]:
    largest: dict[str, float] = {}
    for case in cases:
        for name, one in _by_input(case).items():
            largest[name] = max(largest.get(name, 0.0), one.share)
    ordered = sorted((name for name in largest if largest[name] >= LEAST), key=lambda name: -largest[name])
    return [*ordered[:MOST_COLUMNS], "chance"]


def _shares(case: Drivers, columns: Sequence[str]) -> list[str]:
    known = _by_input(case) | {"chance": case.shares[-1]}
    cells = [_per_cent(known[name]) if name in known else ABSENT for name in columns]
    return [*cells, f"{100.0 * (case.skill or 0.0):.0f} %"]


def _per_cent(one: Share) -> str:
    return f"{100.0 * one.share:.0f} ({100.0 * one.share_low:.0f}-{100.0 * one.share_high:.0f})"


def _friction(found: UncertainStudy) -> Iterator[str]:
    several = len(found.allowed_friction) > 1
    for one in found.allowed_friction:
        pocket = f" in the pockets of {', '.join(one.names)}" if several else ""
        wanted = f"with a probability of {100.0 * one.probability:.0f} %{pocket}"
        if one.friction is None:
            yield f"To be stable {wanted}, no friction can be named: {one.reason}."
            continue
        ends = f"{number(one.friction_low)} to {number(one.friction_high)}"
        yield (
            f"At most {number(one.friction)} ({ends}), if it scatters by {100.0 * one.scatter:.3g} % of "
            f"itself, to be stable {wanted}."
        )


def _films(films: Sequence[AllowedFilm]) -> Iterator[str]:
    """Yield the largest restitution factor of each candidate, and the films that keep to it."""
    if not films:
        yield paragraph("No candidate was measured there.")
        return
    wanted, frictions = f"{100.0 * films[0].probability:.0f} %", films[0].race_friction
    headers = ["material", f"eta for\n{wanted}", *(f"f_BT\n{f:g}" for f in frictions)]
    cells = []
    for film in films:
        ends = film.restitution_factor_low, film.restitution_factor_high
        eta = interval(film.restitution_factor, *ends, to="-")
        if film.restitution_factor is None:
            eta = "any" if film.is_any_allowed else "none"
        cells.append([film.name, eta, *(_thicknesses(film, i) for i in range(len(frictions)))])
    yield paragraph(
        f"Largest restitution factor eta at which {wanted} of the bearings settle (95 %), and the film "
        "thickness that keeps to it, by the friction f_BT of ball on race; all else as it is, with its "
        "uncertainty."
    )
    yield table(headers, cells, left=1)


def _thicknesses(film: AllowedFilm, i: int) -> str:
    limit = 1.0 if film.is_any_allowed else film.restitution_factor
    allowed = [limit is not None and eta <= limit for eta in film.film_restitution_factor[i]]
    if all(allowed) or not any(allowed):
        return "any" if allowed[0] else "none"
    edges = [k for k in range(1, len(allowed)) if allowed[k] != allowed[k - 1]]
    if len(edges) > 1:
        return "see figure"
    edge = quantity(film.film_thickness[edges[0] - (not allowed[-1])], "m", 2)
    return f">= {edge}" if allowed[-1] else f"<= {edge}"
