"""`sensitivity`: draw bearings from the uncertain inputs and judge the cages of every candidate."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

from separatrix.ground.document import Part
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import alone
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    facts,
    grouped,
    text_column,
)
from separatrix.present.figure import (
    CYCLE,
    GREY,
    MARKERS,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    Across,
    Axis,
    Figure,
    Label,
    Mark,
    Panel,
    Trace,
    Words,
    sign,
)
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import basis_facts
from separatrix.verbs.parts.refused import refused
from separatrix.verbs.parts.telling import axis, cell, column, quantity, said, told
from separatrix.verbs.parts.verdict_blocks import (
    MARK,
    all_numbers,
    by_verdict,
    evidence_column,
    is_judged,
    judged,
    motion_column,
)
from separatrix.verbs.parts.verdict_blocks import verdict as verdict_of
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.chain.solution import Solution
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import SensitivityAnswer
    from separatrix.verdict.long_jobs import Runner

SAMPLES, FEWEST_SAMPLES, MOST_SAMPLES = 512, 64, 65_536
"""Bearings that `sensitivity` draws."""

BRIEF, FULL, REPORT, SHEET, LONG = Level.BRIEF, Level.FULL, Level.REPORT, Level.SHEET, Level.LONG
GUESS = "?"
"""After a friction whose scatter is a guess."""

OVERALL = "over all environments, mean friction"
SOURCES = {
    "study": "from the study",
    "measured": "with measured scatter",
    "assumed": "with the default scatter, a guess",
}
OWN = "own friction"
CHAIN = {"restitution_factor": "Restitution factor $eta$", "race_damping": "Race damping $C_mu$"}
LISTED, MOST_COLUMNS, LEAST, MOST = 6, 4, 0.01, 7
"""Items of a list and inputs of a table on a screen, least share shown, inputs and cases of a figure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How many bearings are drawn."""

    samples: Annotated[int, Option("Bearings drawn, a power of two.", "N")] = SAMPLES


def compute(study: Study, options: Options, runner: Runner) -> SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate."""
    from separatrix.verbs.answer_records import SensitivityAnswer
    from separatrix.verbs.parts.cage_of_study import reference
    from separatrix.verdict.drawn_frictions import frictions_to_draw
    from separatrix.verdict.draws import uncertain_inputs
    from separatrix.verdict.input_shares import uncertain_study
    from separatrix.verdict.long_jobs import made_into

    samples = options.samples
    if not FEWEST_SAMPLES <= samples <= MOST_SAMPLES or samples.bit_count() != 1:
        near = 1 << max(0, samples - 1).bit_length()
        cure = f"Try {min(max(near, FEWEST_SAMPLES), MOST_SAMPLES)}."
        rule = f"must be a power of two from {FEWEST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("--samples", rule, got=str(samples), cure=cure)
    solution, cage = reference(study)
    uncertain_inputs(study, frictions_to_draw(study))  # refused before anything is timed
    return made_into(
        lambda found: SensitivityAnswer(
            solution=solution,
            cage=cage,
            uncertain=found,
            film_thickness=study.film.thickness,
            race_friction=study.film.race_friction,
            notes=(*solution.notes, *cage.notes, *found.notes),
        ),
        lambda: uncertain_study(study, samples, runner=runner),
    )


def refusals(study: Study) -> Iterator[str]:
    """Yield why no bearing can be drawn."""
    if study.cage is not None and study.ranking is not None:
        yield from refused(study, _drawable)


def _drawable(solution: Solution) -> None:
    from separatrix.study.candidates import ranking_question, required_environment
    from separatrix.verdict.drawn_frictions import frictions_to_draw
    from separatrix.verdict.draws import uncertain_inputs

    study = solution.study
    required_environment(study, ranking_question(study))
    uncertain_inputs(study, frictions_to_draw(study))


def page(answer: Part) -> Page:
    """Return the page of `sensitivity`: verdicts, what decides them, what to test, what is allowed."""
    own = next(one for one in answer.environments if one.name == answer.environment)
    others = [one for one in answer.environments if one.name != answer.environment]
    each = grouped((verdict_of(row), row.name) for row in own.materials)
    places = [(one.name, one.materials) for one in others]
    places += [(OVERALL, answer.overall)] if others else []
    return page_of(
        answer,
        Note(f"With the uncertain inputs drawn, in {own.name}: {by_verdict(each)}.", "lead"),
        *environment(own.name, own.materials, Level.ALWAYS),
        *footnotes(answer),
        *(elsewhere(answer, others) if others else []),
        *probabilities(answer),
        Heading("Which test to run next"),
        *next_tests(answer),
        Heading("Main sources of uncertainty"),
        *sources(answer),
        *allowed_frictions(answer),
        Heading(f"Which film keeps the cage stable in {answer.environment}", LONG),
        *allowed_films(answer),
        *(block for name, rows in places for block in environment(name, rows, LONG)),
        *drawn(answer),
        all_numbers(answer),
        Heading("Basis of this answer", LONG),
        facts(*basis_facts(answer), *holds_for(answer), level=LONG),
        draws=True,
    )


# Verdicts.


def environment(name: str, rows: Sequence[Part], level: Level) -> list[Block]:
    """Return friction, P(stable), verdict and motion of each candidate in one environment."""
    deviation = column("friction_deviation", of=measured, head="s.d.")
    columns = (
        text_column("material", lambda row: row.name),
        column("friction", head="friction of a new cage", mark=friction_mark),
        deviation,
        column("probability_stable", of=judged),
        text_column("verdict", verdict_of),
        motion_column(),
        *map(evidence_column, ("largest_offset", "largest_contact_force")),
        column("runs", of=judged),
    )
    etas = grouped((told(row, "restitution_factor"), row.name) for row in rows if "restitution_factor" in row)
    each = "; ".join(eta if len(etas) == 1 else f"{eta} {', '.join(who)}" for eta, who in etas.items())
    words = f"Restitution factor $eta$ of the drawn bearings, median (nine in ten): {each}."
    legend = (
        "s.d.: standard deviation of the friction of a new cage: its scatter from sample to sample, how well "
        "the mean is known, and what was not tested. P(stable): share of the bearings whose cage settles or "
        "rolls in its pockets, from the worst initial disturbance, with its 95 % interval. Motion: class of "
        "most of them. Offset and force: largest in any run; > what the races hold: there it has no meaning. "
        "Runs: bearings from the worst initial disturbance; fewer where the verdict was plain before."
    )
    return [
        Heading(name[:1].upper() + name[1:], level),
        Table(name, columns, tuple(rows), level=level),
        *([Note(words, "legend", level)] if each else []),
        *([Note(legend, "legend", LONG)] if level is Level.ALWAYS else []),
    ]


def measured(row: Part) -> Part | None:
    """Return a row that has a friction; None of another."""
    return row if "friction" in row else None


def friction_mark(row: Part) -> str:
    """Return the marks beside a friction."""
    return GUESS * bool(row.get("friction_scatter_assumed")) + MARK * bool(row.extrapolation)


def footnotes(answer: Part) -> Iterator[Note]:
    """Yield what the marks beside frictions mean, if there are any."""
    rows = [row for one in answer.environments for row in one.materials if "friction" in row]
    if any(row.friction_scatter_assumed for row in rows):
        assumed = "its scatter from sample to sample was not measured: {default_scatter} of the mean is "
        yield Note(said(answer, f"{GUESS} {assumed}assumed, a guess ([ranking] friction_scatter)."), "legend")
    words = dict.fromkeys(text for row in rows for text in row.extrapolation)
    if words:
        yield Note(f"{MARK} extrapolated beyond the tests: {'. '.join(words)}.", "legend", LONG)
        yield Note(f"{MARK} extrapolated beyond the tests: see `--full`.", "legend", BRIEF)


def elsewhere(answer: Part, others: Sequence[Part]) -> list[Block]:
    """Return verdict and P(stable) of each candidate in the other environments and over all, for a screen."""

    def place(name: str, rows: Sequence[Part]) -> Column:
        known = {row.name: row for row in rows}

        def found(row: Part) -> Cell:
            here = known.get(row.name)
            if here is None or not is_judged(here):
                return Cell("-" if here is None else verdict_of(here))
            chance = cell(here, "probability_stable")
            return Cell(here.probability_stable, chance.quantity, chance.unit, f" {here.verdict}")

        return Column(name, found)

    places = [place(one.name, one.materials) for one in others]
    columns = (
        text_column("material", lambda row: row.name),
        *places,
        place("overall, mean friction", answer.overall),
    )
    return [
        Heading("P(stable) elsewhere", BRIEF),
        Table("elsewhere", columns, tuple(answer.overall), level=BRIEF),
    ]


def holds_for(answer: Part) -> list[tuple[str, str]]:
    """Return the ensemble, its seed, and the largest drift."""
    speeds = ", ".join(
        told(Part({"kick": one}, {"kick": answer.unit("kicks")}), "kick") for one in answer.kicks
    )
    drifting = [row for row in answer.overall if "drift_rate" in row]
    fastest = max(drifting, key=lambda row: row.drift_rate, default=None)
    drift = "" if fastest is None else f"{told(fastest, 'drift_rate')} (median of a case)"
    return [
        ("Initial disturbances", speeds),
        ("Runs", f"{told(answer, 'runs')} in all; seed {answer.seed}"),
        ("Largest drift", drift),
        ("Ended early", said(answer, "at a risk of {stopped_risk} of another verdict at each look")),
    ]


# What decides, and what to test.


def is_friction(name: str) -> bool:
    """Whether an input is the friction of a candidate."""
    return name.startswith("ranking.") and ".material." not in name


def next_tests(answer: Part) -> Iterator[Block]:
    """Yield which measurement would settle undecided cases."""
    if not answer.undecided:
        none = "No case is undecided: no measurement would change a verdict."
        yield Note(none if answer.complete else "No finished case is undecided.")
        return
    yield Note(f"Undecided: {'; '.join(answer.undecided)}.")
    if not answer.next_tests:
        yield Note("No single measurement would settle any of them.")
        return
    for test in answer.next_tests[:LISTED]:
        pairs = [*zip(test.cases, test.chances, strict=True)]
        words = f"Measuring {test.name} would settle {{settled}} of them on average: "
        more = f"; and {len(pairs) - LISTED} more" if len(pairs) > LISTED else ""
        yield Note(said(test, words) + "; ".join(_chances(pairs[:LISTED])) + f"{more}.")
    columns = (
        text_column("input to measure", lambda test: test.name),
        column("settled"),
        text_column("cases", lambda test: "; ".join(_chances(zip(test.cases, test.chances, strict=True)))),
    )
    yield Table("next tests", columns, tuple(answer.next_tests), level=SHEET)


def _chances(pairs: Any) -> Iterator[str]:
    for case, chance in pairs:
        yield f"{case} ({told(Part({'chances': chance}, {}), 'chances')})"


def sources(answer: Part) -> Iterator[Block]:
    """Yield the sources of the cases that have any, the other cases, and the shares of eta and C_mu."""
    known = least_decided(answer)
    if known:
        names = _inputs_shown(known)
        columns = (
            text_column("case", lambda one: f"{one.name}, {one.environment}"),
            *(_share_column(name) for name in names),
            column("skill"),
        )
        short = "Share of the variance of the logit of P(settles) that each input brings (95 %)."
        caption = (
            "Share of the variance of the logit of P(settles) that each input brings (95 %), by a logistic "
            "regression of the runs; chance: the single run's disturbance and leads. Skill: part of the "
            "deviance explained, on bearings left out of the fit. The least decided cases come first."
        )
        yield Table("sources", columns, tuple(known[:LISTED]), short, BRIEF)
        yield Table("sources", columns, tuple(known), caption, LONG)
        yield Picture(
            "sensitivity-drivers",
            lambda: drivers_figure(answer, known[:MOST]),
            "What decides whether a cage settles, in the least decided cases, and a test of the fit.",
        )
    few, weak = "too few bearings end otherwise", "the inputs explain almost no variance"
    reasons = grouped(
        (few if one.skill is None else weak, f"{one.name} in {one.environment}")
        for one in answer.drivers
        if not one.shares
    )
    for reason, cases in reasons.items():
        listed = "; ".join(cases) if len(cases) <= LISTED else f"{len(cases)} cases"
        yield Note(f"No sources shown, {reason}: {listed}.", level=LONG if known else Level.ALWAYS)
    for smooth in answer.shares:
        parts = ", ".join(
            f"{one.name} {told(one, 'share')}" for one in smooth.total[:LISTED] if one.share >= LEAST
        )
        yield Note(f"{CHAIN[smooth.quantity]} of {smooth.name}, total Sobol indices: {parts}.", level=LONG)
    yield all_shares(answer)


def least_decided(answer: Part) -> list[Part]:
    """Return the cases whose sources are known, the least decided first."""
    chances = {
        (place.name, row.name): row.get("probability_stable")
        for place in answer.environments
        for row in place.materials
    }
    known = [one for one in answer.drivers if one.shares]
    return sorted(known, key=lambda one: abs((chances.get((one.environment, one.name)) or 0.0) - 0.5))


def by_input(case: Part) -> dict[str, Part]:
    """Return the shares of a case, chance last; the friction of its own candidate under one name."""
    *inputs, chance = case.shares
    return {OWN if is_friction(one.name) else one.name: one for one in inputs} | {"chance": chance}


def _inputs_shown(cases: Sequence[Part], most: int = MOST_COLUMNS) -> list[str]:
    """Return the inputs with the largest shares, and chance."""
    largest: dict[str, float] = {}
    for case in cases:
        for name, one in by_input(case).items():
            largest[name] = max(largest.get(name, 0.0), one.share)
    chance = largest.pop("chance")
    ordered = sorted((name for name in largest if largest[name] >= LEAST), key=lambda name: -largest[name])
    return [*ordered[:most], *(["chance"] if chance is not None else [])]


def _share_column(name: str) -> Column:
    return Column(name.replace(".", ". "), lambda case: cell(by_input(case).get(name), "share"))


def all_shares(answer: Part) -> Table:
    """Return every share of every input, for a workbook."""
    rows = [
        (one.name, one.environment, "variance of the logit", share)
        for one in answer.drivers
        for share in one.shares
    ]
    for smooth in answer.shares:
        for kind in ("first", "total"):
            words = f"{kind} index of {smooth.quantity}"
            rows += [(smooth.name, "", words, share) for share in getattr(smooth, kind)]
    columns = (
        text_column("material", lambda row: row[0]),
        text_column("environment", lambda row: row[1]),
        text_column("of", lambda row: row[2]),
        text_column("input", lambda row: row[3].name),
        column("share", of=lambda row: row[3]),
    )
    return Table("all shares", columns, tuple(rows), level=SHEET)


# What is allowed.


def allowed_frictions(answer: Part) -> Iterator[Block]:
    """Yield the largest friction that a new material may have; nothing before it is known."""
    if answer.allowed_friction:
        yield Heading("Which friction a new material may have")
    several = len(answer.allowed_friction) > 1
    for one in answer.allowed_friction:
        pocket = f" in the pockets of {', '.join(one.names)}" if several else ""
        wanted = f"with a probability of {{probability}}{pocket}"
        if one.friction is None:
            yield Note(said(one, f"To be stable {wanted}, no friction can be named: {one.reason}."))
            continue
        yield Note(
            said(
                one, f"At most {{friction}}, if it scatters by {{scatter}} of itself, to be stable {wanted}."
            )
        )


def allowed_films(answer: Part) -> Iterator[Block]:
    """Yield the largest restitution factor of each candidate, and the films that keep to it."""
    films = answer.allowed_films
    if not films:
        yield Note("No candidate was measured there." if answer.complete else "Not finished.", level=LONG)
        return
    wanted = told(films[0], "probability")

    def limit(film: Part) -> Cell:
        if film.restitution_factor is None:
            return Cell("any" if film.is_any_allowed else "none")
        return cell(film, "restitution_factor")

    def thickness(place: int) -> Column:
        friction = Part({"race_friction": films[0].race_friction[place]}, {})
        words = _thicknesses(answer, place)
        return text_column(f"film at $f_BT$ {told(friction, 'race_friction')}", words)

    columns = (
        text_column("material", lambda film: film.name),
        Column("largest $eta$", limit),
        *(thickness(place) for place in range(len(films[0].race_friction))),
    )
    caption = (
        f"Largest restitution factor $eta$ at which {wanted} of the bearings settle (95 %), and the film "
        "thickness that keeps to it, by the friction $f_BT$ of ball on race; all else as it is, with its "
        "uncertainty."
    )
    yield Table("allowed films", columns, tuple(films), caption, LONG)
    if films[0].film_thickness:
        caption = f"Films that keep the cage stable with a probability of {wanted}, for each candidate."
        yield Picture("sensitivity-film", lambda: film_figure(answer), caption)


def _largest_allowed(film: Part) -> float:
    """Return the largest restitution factor allowed: 1 where every one is, -1 where none is."""
    if film.restitution_factor is not None:
        return float(film.restitution_factor)
    return 1.0 if film.is_any_allowed else -1.0


def _thicknesses(answer: Part, place: int) -> Callable[[Part], str]:
    """Return from a case the thicknesses that are allowed at one friction of ball on race."""

    def words(film: Part) -> str:
        limit = _largest_allowed(film)
        allowed = [eta <= limit for eta in film.film_restitution_factor[place]]
        if all(allowed) or not any(allowed):
            return "any" if allowed[0] else "none"
        edges = [at for at, (a, b) in enumerate(pairwise(allowed), 1) if a != b]
        if len(edges) > 1:
            return "see figure"
        edge = film.film_thickness[edges[0] - (not allowed[-1])]
        return f"{'>=' if allowed[-1] else '<='} {_thick(answer, edge)}"

    return words


def _thick(answer: Part, thickness: float) -> str:
    return alone(thickness, quantity("film_thickness"), answer.unit("film_thickness_here"))


# What was drawn.


def drawn(answer: Part) -> Iterator[Block]:
    """Yield the uncertain inputs, the convergence of P(stable), and every drawn bearing."""
    shown = [(row.name, row.distribution) for row in answer.inputs if not is_friction(row.name)]
    origins = Counter(SOURCES[row.source] for row in answer.inputs if is_friction(row.name))
    if origins:
        counted = ", ".join(f"{count} {source}" for source, count in origins.items())
        shown.append(("frictions", f"{origins.total()}: {counted}"))
    failed = f", of which {answer.failed} make no bearing" if answer.failed else ""
    bearings = ("bearings drawn", told(answer, "bearings") + failed)
    yield Heading("Uncertain inputs", LONG)
    yield facts(*shown, bearings, level=LONG)
    columns = (
        text_column("input", lambda row: row.name),
        text_column("distribution", lambda row: row.distribution),
        text_column("source", lambda row: SOURCES[row.source]),
        _of_input("mean", "mean"),
        _of_input("standard_deviation", "standard deviation"),
    )
    yield Table("uncertain inputs", columns, tuple(answer.inputs), level=SHEET)
    yield from convergence(answer)
    yield clouds(answer)


def _of_input(name: str, head: str) -> Column:
    known = quantity(name)
    # a row has a key "unit", and a part a method of this name
    return Column(head, lambda row: Cell(getattr(row, name), known, row.values["unit"]))


def convergence(answer: Part) -> Iterator[Block]:
    """Yield P(stable) against the number of bearings: of the least decided candidate of each environment."""
    cases = [one for one in answer.convergence if one.size]
    least = {}
    for one in sorted(cases, key=lambda one: -abs(one.probability_stable[-1] - 0.5)):
        least[one.environment] = one
    columns = (
        text_column("material", lambda row: row[0]),
        text_column("environment", lambda row: row[1] or OVERALL),
        column("size", of=lambda row: row[2]),
        column("probability_stable", of=lambda row: row[2]),
    )
    words = "P(stable) of the least decided candidate of each environment against the number of bearings."
    yield Heading("Convergence", REPORT)
    yield Table("convergence", columns, tuple(_looks([*least.values()][::-1])), words, REPORT)
    yield Table("convergence", columns, tuple(_looks(cases)), level=SHEET)


def _looks(cases: Sequence[Part]) -> Iterator[tuple[str, str, Part]]:
    """Yield each look at some cases: material, environment, and its numbers."""
    names = ("size", "probability_stable", "probability_low", "probability_high")
    for one in cases:
        for values in zip(*(getattr(one, name) for name in names), strict=True):
            yield one.name, one.environment, Part(dict(zip(names, values, strict=True)), {})


def clouds(answer: Part) -> Table:
    """Return every drawn bearing of every case, for a workbook."""
    names = ("restitution_factor", "friction", "settles")
    rows = [
        (one, Part(dict(zip(names, values, strict=True)), {}))
        for one in answer.clouds
        for values in zip(*(getattr(one, name) for name in names), strict=True)
    ]
    columns = (
        text_column("material", lambda row: row[0].name),
        text_column("environment", lambda row: row[0].environment or OVERALL),
        *(column(name, of=lambda row: row[1]) for name in names),
    )
    return Table("bearings", columns, tuple(rows), level=SHEET)


# Pictures.


def probabilities(answer: Part) -> list[Block]:
    """Return the picture of every P(stable); none before the first verdict."""
    if not any(is_judged(row) for one in answer.environments for row in one.materials):
        return []
    caption = "Probability that a bearing's cage settles, of each candidate in each environment."
    return [Picture("sensitivity-probabilities", lambda: probabilities_figure(answer), caption)]


def probabilities_figure(answer: Part) -> Figure:
    """Return P(stable) of every candidate in every environment and overall, best at the top."""
    places = [(one.name, one.materials) for one in answer.environments]
    places += [(OVERALL, answer.overall)] if places[1:] else []
    panels = [_probabilities(name, rows) for name, rows in places]
    signs = [sign(marker, VERDICT_COLOURS[word], word) for word, marker in VERDICT_MARKERS.items()]
    signs += [
        sign("", GREY, "95 % interval", line="-"),
        sign("", GREY, "probabilities of 0.5 and 0.9", line=":"),
    ]
    extrapolated = any(row.extrapolation for _, rows in places for row in rows)
    signs += [sign("", GREY, f"{MARK} extrapolated beyond the tests")] if extrapolated else []
    return Figure(
        rows=tuple(tuple(panels[at : at + 2]) for at in range(0, len(panels), 2)),
        heading=figure_heading(answer, f"seed {answer.seed}"),
        alt="P(stable) with its interval of each candidate in each environment; the tables have the numbers.",
        height=0.75 + 0.17 * max(len(rows) for _, rows in places),
        legend=tuple(signs),
    )


def _probabilities(name: str, rows: Sequence[Part]) -> Panel:
    order = sorted(rows, key=lambda row: -1.0 if not is_judged(row) else row.probability_stable)
    found: list[Mark] = [Across(at=at, colour=GREY, line=":") for at in (0.5, 0.9)]
    for place, row in enumerate(order):
        if is_judged(row):
            look: dict[str, Any] = {
                "colour": VERDICT_COLOURS[row.verdict],
                "marker": VERDICT_MARKERS[row.verdict],
                "size": 4.5,
            }
            text = f"{row.name}: {row.verdict}, P(stable) {told(row, 'probability_stable')}"
            found.append(_chance(row, float(place), text, look))
        else:
            found.append(Words(x=0.0, y=float(place), text=verdict_of(row), colour=GREY))
    names = tuple(row.name + MARK * bool(row.extrapolation) for row in order)
    x = Axis(label="P(stable) [-]", low=-0.02, high=1.02)
    y = Axis(label="", low=-0.6, high=len(names) - 0.4, names=names)
    return Panel(title=name[:1].upper() + name[1:], x=x, y=y, marks=tuple(found))


def _chance(row: Part, place: float, text: str, look: dict[str, Any]) -> Trace:
    ends: dict[str, Any] = {"low": [row.probability_low], "high": [row.probability_high], "ends_along": "x"}
    return Trace(x=[row.probability_stable], y=[place], line="", hover=(text,), **ends, **look)


def drivers_figure(answer: Part, cases: Sequence[Part]) -> Figure:
    """Return which inputs decide whether a cage settles, and whether the fit predicts the counts."""
    names = _inputs_shown(cases, MOST)
    shares: list[Mark] = []
    fit: list[Mark] = [
        Trace(x=(0.0, 1.0), y=(0.0, 1.0), line="--", width=0.6, name="counted as predicted", colour=GREY)
    ]
    for place, case in enumerate(cases):
        look: dict[str, Any] = {"colour": CYCLE[place % len(CYCLE)], "marker": MARKERS[place % len(MARKERS)]}
        look |= {"size": 3.5}
        label, known = f"{case.name}, {case.environment}", by_input(case)
        shift = 0.7 * ((place + 0.5) / len(cases) - 0.5)
        rows = [
            Part({**known[name].values, "at": at + shift}, known[name].units)
            for at, name in enumerate(names)
            if name in known
        ]
        hover = tuple(f"{label}: {row.name} {told(row, 'share')}" for row in rows)
        shares.append(
            Trace(
                x=[row.share for row in rows],
                y=[row.at for row in rows],
                low=[row.share_low for row in rows],
                high=[row.share_high for row in rows],
                ends_along="x",
                line="",
                name=label,
                hover=hover,
                **look,
            )
        )
        fit.append(Trace(x=case.predicted, y=case.counted, width=0.8, **look))
    inputs = Axis(label="", low=len(names) - 0.5, high=-0.5, names=tuple(names))
    share = axis(
        "share", "-", [1.0], label="share of the variance of the logit of P(settles)", low=-0.02, high=1.02
    )
    counted, predicted = (axis(name, "-", [1.0], low=-0.02, high=1.02) for name in ("counted", "predicted"))
    return Figure(
        rows=(
            (
                Panel(
                    title="a  Inputs that matter most, 95 % intervals", x=share, y=inputs, marks=tuple(shares)
                ),
                Panel(title="b  Bearings left out of the fit", x=predicted, y=counted, marks=tuple(fit)),
            ),
        ),
        heading=figure_heading(answer, f"seed {answer.seed}"),
        alt="Shares of the inputs in the variance, and predicted against counted shares that settle; the "
        "table has the numbers.",
        widths=(1.25, 1.0),
        height=max(2.4, 0.9 + len(names) * (0.12 + 0.06 * len(cases))),
    )


def film_figure(answer: Part) -> Figure:
    """Return which film keeps each candidate stable: lines in the plane of thickness and race friction."""
    from contourpy import contour_generator

    films, labels = answer.allowed_films, []
    lines: list[Mark] = []
    thickness, friction = films[0].film_thickness[1:], films[0].race_friction
    kinds: dict[str, list[str]] = {"every": [], "no": []}
    for place, film in enumerate(films):
        below = [[_largest_allowed(film) - eta for eta in row[1:]] for row in film.film_restitution_factor]
        every = [one for row in below for one in row]
        if min(every) >= 0.0 or max(every) < 0.0:
            kinds["every" if min(every) >= 0.0 else "no"].append(film.name)
            continue
        colour, ends = CYCLE[place % len(CYCLE)], []
        border: Any = contour_generator(thickness, friction, below).lines(0.0)
        for line in border:
            ends += line.tolist()
            look: dict[str, Any] = {"colour": colour, "width": 1.2, "has_ticks": True}
            lines.append(Trace(x=line[:, 0].tolist(), y=line[:, 1].tolist(), **look))
        labels.append(Label(y=max(ends)[1], text=film.name, colour=colour))
    here = answer.film_thickness_here, answer.race_friction_here
    if here[0]:
        lines.append(Trace(x=here[:1], y=here[1:], line="", marker="o", size=4.5, name="film of the study"))
    unit = answer.unit("film_thickness_here")
    wanted = told(films[0], "probability")
    ticks = f"ticks: the side of the films with P(stable) of {wanted} or more"
    title = f"Films that keep the cage stable in {answer.environment}"
    words = [f"{kind} film here is allowed: {', '.join(names)}" for kind, names in kinds.items() if names]
    panel = Panel(
        title=title,
        x=axis(
            "film_thickness",
            unit,
            thickness,
            label="film thickness",
            low=thickness[0],
            high=thickness[-1],
            is_log=True,
        ),
        y=axis("race_friction", "-", friction, low=friction[0], high=friction[-1], is_log=True),
        marks=tuple(lines),
        labels=tuple(labels),
    )
    return Figure(
        rows=((panel,),),
        heading=(*figure_heading(answer, f"seed {answer.seed}"), *words),
        alt="Film thickness against race friction, a line for each candidate; the table has the numbers.",
        height=3.4,
        legend=(sign("", GREY, ticks, line="-"),) if labels else (),
    )


VERB = Verb(
    name="sensitivity",
    epilog="Every number that the study writes with a distribution is drawn, and the frictions with "
    "their scatter: 9 % of the mean where none was measured, a guess.",
    compute=compute,
    page=page,
    options=Options,
    needs=("cage", "ranking"),
    moves_a_cage=True,
    has_full=True,
    keeps_runs=True,
    refusals=refusals,
)
