"""Text of a ranking: the answer for the bearing's own environment, and all of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from separatrix.ground.plain_data import Document, plain
from separatrix.study.study import Study
from separatrix.told.cage import judgement_facts, motion_words
from separatrix.told.chain import basis
from separatrix.told.sentences import (
    by_verdict,
    drift,
    margin,
    pocket_force,
    probability,
    rank_texts,
    threshold,
    verdict,
    verdict_sentences,
)
from separatrix.told.stability import ensemble_facts
from separatrix.told.tables import (
    ABSENT,
    facts,
    grouped,
    kick_list,
    number,
    paragraph,
    quantity,
    rate,
    section,
    table,
)
from separatrix.verbs.answer_records import RankingAnswer
from separatrix.verdict.judgement import Judgement, Verdict
from separatrix.verdict.ranking_records import (
    NotFinished,
    NotMeasured,
    Ranked,
    RankedEnvironment,
    Ranking,
    Row,
)

HEADERS = (*("rank", "material", "friction", "threshold\n(95 %)", "margin", "P(stable)\n(95 %)", "verdict"),)
TILT, ROLL = "tilt\nmrad", "of them\nroll"
"""Columns of a cage in space, and of one that rolls in its pockets."""

SHORT_EVIDENCE = (
    *("material", "motion", "stable runs by kick", ROLL, "largest\noffset", TILT, "drift\n1/s"),
    *("force at\na pocket", "force on\nthe land", "rubs\nwith"),
)
ETA = "bearing's\neta"
EVIDENCE = (
    *("material", "motion", ETA, "growth rate 1/s\n(95 %)", "offset\nmm", "drift\n1/s", "pocket\nN"),
    *("land\nN", "whirl\nHz", "whirl\nratio"),
)
DIRECTIONS = {1: " forward", -1: " backward", 0: ""}

LEGEND = (
    "rank: by margin, = a tie within the scatter. threshold: largest stable restitution factor eta "
    "from the reference kick. margin: threshold less the bearing's eta. "
    "P(stable): share of runs that settle, or roll in their pockets, from the worst kick."
)
EVIDENCE_LEGEND = (
    "motion: what most runs from the worst kick end in. growth rate: of the amplitude, mean over all of "
    "them. offset of the cage centre, force at a pocket (> what the races hold: there it has no meaning) "
    "and at the land: largest in any run. drift: median "
    "growth of the mean offset of the runs that do not whirl. whirl: median of the runs that end in the "
    "motion, seen from the balls; ratio: speed at which the centre orbits the axis over "
    "that of the balls."
)

MARK = "*"
"""After a friction that is extrapolated beyond its tests."""

POCKET = " (pocket: "
"""Before what the pocket has, at the end of a sentence on an extrapolation."""

NAMED, LEADERS = 6, 3
"""Uncertain inputs, and candidates that lead elsewhere, that are named."""


def rank(answer: RankingAnswer, study: Study) -> list[str]:
    """The answer for the bearing's own environment, on a screen; `every_environment` has the rest."""
    found = answer.ranking
    rows, more = headline(found), "`--full` prints all evidence"
    undecided = [row for row in rows if (own := judgement(row)) and own.verdict is Verdict.UNDECIDED]
    leads = []
    for one in found.environments:
        if one.name != found.environment:
            names = [row.name for row in one.materials if isinstance(row, Ranked) and row.rank == 1]
            rest = f" and {len(names) - LEADERS} more" if len(names) > LEADERS else ""
            leads.append(f"{one.name}: {', '.join(names[:LEADERS]) + rest or 'none'}")
    elsewhere = (
        f"First elsewhere: {'; '.join(leads)}. {more}, for every environment." if leads else more + "."
    )
    legend = ("", paragraph(LEGEND), *footnotes(rows), *lowest(rows))
    return [
        _in_short(found),
        section(_title(found.environment), verdicts(rows), *legend),
        *_over_inputs(rows, study),
        section(
            f"Evidence: {_ensemble(found)}",
            _short_evidence(rows),
            *(["", *reasons(undecided)] if undecided else []),
        ),
        paragraph(elsewhere, indent=""),
    ]


def only_table(answer: RankingAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """The table of the bearing's own environment, for `--quiet`."""
    found = answer.ranking
    return [section(_title(found.environment), verdicts(headline(found)))]


def every_environment(answer: RankingAnswer, study: Study) -> list[str]:
    """Verdict, margin, rank, evidence and reason of each candidate in each environment, then overall."""
    found = answer.ranking
    own, *others = sorted(found.environments, key=lambda one: bool(one.name != found.environment))
    first, detail, overall = own.materials[0], [], []
    if (judged := judgement(first)) is not None:
        detail = [section(f"{first.name} in detail", facts(judgement_facts(judged, first.reason)))]
    if others:
        notes = footnotes(found.overall)
        blocks = [*([""] if notes else []), *notes, *gaps(found)]
        title = "Overall: mean friction over the measured environments"
        overall = [_environment(title, found.overall, *blocks)]
    return [
        _in_short(found),
        environment(found, own),
        *_over_inputs(own.materials, study),
        paragraph(LEGEND),
        paragraph(EVIDENCE_LEGEND),
        *detail,
        section("Basis of the verdicts", facts(_holds_for(answer, study))),
        *(environment(found, one) for one in others),
        *overall,
    ]


def environment(found: Ranking, one: RankedEnvironment) -> str:
    """Return verdicts, evidence and reasons of one environment."""
    notes = *footnotes(one.materials), *lowest(one.materials)
    return _environment(one.name, one.materials, "", *notes, "", f"  Evidence: {_ensemble(found)}")


def _environment(name: str, rows: Sequence[Row], *blocks: str) -> str:
    """Return verdicts, evidence and reasons of one environment, or of their mean."""
    return section(_title(name), verdicts(rows), *blocks, "", evidence(rows), "", *reasons(rows))


def headline(found: Ranking) -> tuple[Row, ...]:
    """Return the rows of the bearing's own environment."""
    return next(one.materials for one in found.environments if one.name == found.environment)


def _plain(rows: Iterable[Row]) -> list[Document]:
    """Return the rows as a document has them."""
    return [plain(row, left_out=[]) for row in rows]


def _in_short(found: Ranking) -> str:
    """Return the answer in a few sentences, with the reason of the verdict alone."""
    rows = [
        plain(row, left_out=[]) | ({"reason": own.reason} if (own := judgement(row)) else {})
        for row in headline(found)
    ]
    return paragraph(" ".join(verdict_sentences(rows, found.environment)), indent="")


def _measured(rows: Iterable[Row]) -> list[Ranked | NotFinished]:
    return [row for row in rows if not isinstance(row, NotMeasured)]


def judgement(row: Row) -> Judgement | None:
    """Return verdict and evidence of a candidate; None if it has none."""
    return None if isinstance(row, NotMeasured) else row.judgement


def _title(name: str) -> str:
    return name[:1].upper() + name[1:]


def verdicts(rows: Sequence[Row]) -> str:
    """Return the table of verdicts, margins and ranks."""
    found = _plain(rows)
    cells = [
        [
            *(place, row["name"], number(row["friction"]) + (MARK if row["extrapolation"] else "")),
            *(threshold(row), margin(row), probability(row), verdict(row)),
        ]
        for row, place in zip(found, rank_texts(row["rank"] for row in found), strict=True)
    ]
    return table(HEADERS, cells, left=2)


def lowest(rows: Sequence[Row]) -> list[str]:
    """Return the probability of the lowest mean friction of each candidate; empty if none was measured."""
    measured = _measured(rows)
    known = [(row.probability_lowest_friction or 0.0, row.name) for row in measured]
    likely = [f"{name} {share:.2f}" for share, name in sorted(known, reverse=True) if share >= 0.005]
    if not measured:
        return []
    names = ", ".join(likely) or f"none, for only {measured[0].name} was measured here"
    return [paragraph(f"Probability of the lowest mean friction: {names}.")]


def footnotes(rows: Sequence[Row]) -> list[str]:
    """Return the extrapolations, each sentence once, with its candidates unless all share it."""
    measured = _measured(rows)
    who = grouped((sentence, row.name) for row in measured for sentence in row.extrapolation)
    each: dict[str, list[str]] = {}
    for sentence, names in who.items():
        stem, pocket, value = sentence.partition(POCKET)
        whose = "" if len(names) == len(measured) else f" {', '.join(names)}"
        each.setdefault(stem + pocket, []).append(f"{value.removesuffix(')')}{whose}" if pocket else whose)
    sentences = [
        f"{stem}{'; '.join(values)})"
        if stem.endswith(POCKET)
        else stem + (f" ({values[0][1:]})" if values[0] else "")
        for stem, values in each.items()
    ]
    text = f"extrapolated beyond the tests: {'. '.join(sentences)}."
    return [paragraph(text, first=f"  {MARK} ", indent="    ")] if sentences else []


def reasons(rows: Sequence[Row]) -> list[str]:
    """Return the reasons; candidates of the same friction share theirs."""
    each = grouped((row.reason, row.name) for row in rows)
    return [
        paragraph(f"{', '.join(who)}: {reason}", indent="      ", first="  ") for reason, who in each.items()
    ]


def _over_inputs(rows: Sequence[Row], study: Study) -> list[str]:
    """Return the verdicts over the uncertain inputs; empty if the study states none."""
    known = [(row.name, row.over_inputs) for row in _measured(rows) if row.over_inputs]
    if not known:
        return []
    each = grouped((found.verdict.name, f"{name} {probability(plain(found))}") for name, found in known)
    names = ", ".join([*study.distributions][:NAMED]) + (", ..." if len(study.distributions) > NAMED else "")
    text = (
        f"Uncertain inputs ({names}) are at their means above. With a bearing drawn for each of "
        f"{known[0][1].runs} runs from each kick, P(stable) is: {by_verdict(each)}."
    )
    return [paragraph(text, indent="")]


def _ensemble(found: Ranking) -> str:
    return f"{found.runs} runs of {quantity(found.duration, 's')} from each kick, {kick_list(found.kicks)}"


def _short_evidence(rows: Sequence[Row]) -> str:
    """Return motion, largest offset, drift, forces and rubbing of every candidate that has a verdict."""
    judged = [found for row in rows if (found := judgement(row)) is not None]
    flat = all(found.largest_tilt is None for found in judged)
    calm = all(count.rolls == 0 for found in judged for count in found.by_kick)
    left_out = {TILT: flat, ROLL: calm}
    headers = [header for header in SHORT_EVIDENCE if not left_out.get(header)]
    cells = [
        [
            row.name,
            motion_words(found.cage_motion),
            " ".join(str(kick.calm) for kick in found.by_kick),
            *([] if calm else [" ".join(str(kick.rolls) for kick in found.by_kick)]),
            quantity(found.largest_offset, "m", 3),
            *([] if flat else [number(1e3 * (found.largest_tilt or 0.0), 1)]),
            drift(plain(found)),
            pocket_force(found.largest_contact_force, found.force_limit, short=True),
            quantity(found.largest_land_force, "N", 3),
            quantity(found.rubbing_power, "W", 2),
        ]
        for row in rows
        if (found := judgement(row)) is not None
    ]
    return table(headers, cells, left=3) if cells else "  none: no verdict was finished"


def evidence(rows: Sequence[Row]) -> str:
    """Return the evidence of verdicts; the bearing's eta only where candidates differ in it."""
    etas = {number(row.restitution_factor, 2) for row in _measured(rows) if row.judgement is not None}
    headers = [header for header in EVIDENCE if header != ETA or len(etas) > 1]
    cells = []
    for row in rows:
        if isinstance(row, NotMeasured) or row.judgement is None:
            cells.append([row.name, *[ABSENT] * (len(headers) - 1)])
            continue
        found = row.judgement
        whirl = number(found.whirl_frequency, 1 if found.whirl_frequency < 10 else 0)
        cells.append(
            [
                *(row.name, motion_words(found.cage_motion)),
                *([number(row.restitution_factor, 2)] if len(etas) > 1 else []),
                rate(found.growth_rate, found.growth_rate_low, found.growth_rate_high),
                *(number(1e3 * found.largest_offset), drift(plain(found))),
                *(newtons(found), number(found.largest_land_force, 0)),
                *(whirl + DIRECTIONS[found.whirl_direction], number(found.whirl_ratio, 2)),
            ]
        )
    return table(headers, cells, left=2)


def newtons(found: Judgement) -> str:
    """Return the largest force in a pocket as a number [N], or above what it means nothing."""
    if found.force_exceeds_races:
        return f"> {number(found.force_limit, 0)}"
    return number(found.largest_contact_force, 0)


def gaps(found: Ranking) -> list[str]:
    """Return in how many environments a candidate was measured, if not in all."""
    total = len(found.environments)
    counts = Counter(row.name for one in found.environments for row in _measured(one.materials))
    few = [f"{row.name} in {counts[row.name]}" for row in found.overall if counts[row.name] < total]
    return ["", paragraph(f"Measured in fewer than {total} environments: {', '.join(few)}.")] if few else []


def _holds_for(answer: RankingAnswer, study: Study) -> list[tuple[str, str]]:
    found, pocket = answer.ranking, answer.ranking.pocket
    rows = [row for one in found.environments for row in _measured(one.materials)]
    scatter = "none: every friction has its measured scatter"
    if any(row.friction_scatter_assumed for row in rows):
        share = f"{100.0 * found.friction_scatter:.3g} %"
        scatter = f"assumed to scatter by {share} of their mean: a guess, [ranking] friction_scatter"
    slip = f"slides at {pocket.slip_speed:.3g} m/s"
    if pocket.slip_speed_high > 1.001 * pocket.slip_speed_low:
        slip += f" ({pocket.slip_speed_low:.3g} to {pocket.slip_speed_high:.3g} around the bearing)"
    pressure, force = quantity(pocket.pressure, "Pa", 3), quantity(pocket.impact_force, "N", 3)
    eta, limit, film = found.restitution_factor, found.solid_lubrication_limit, []
    if eta < limit:
        words = f"The contact model predicts {number(eta, 2)} for this film, below this bound of {limit:g}."
        film = [("This film", f"{words} Both are shown.")]
    return [
        *basis(study, answer),
        *ensemble_facts(found.kicks, found.runs, found.duration),
        ("Ball on pocket", f"{slip}; mean pressure {pressure} in an impact of {force} (impact speed)"),
        *_masses(answer),
        *_running_clearances(answer),
        ("Unrepeated tests", scatter),
        ("The paper's bound", found.paper_statement),
        *film,
    ]


def _masses(answer: RankingAnswer) -> list[tuple[str, str]]:
    rows = _measured(answer.ranking.overall)
    if len({row.cage_mass for row in rows}) < 2:
        return []
    each = (f"{row.name} {quantity(row.cage_mass, 'kg', 3)}" for row in rows)
    return [("Mass of the cage", f"by its shape: {'; '.join(each)}")]


def _running_clearances(answer: RankingAnswer) -> list[tuple[str, str]]:
    if answer.solution.clearances is None:
        return []
    rows = _measured(answer.ranking.overall)
    each = [
        f"{row.name} {quantity(row.pocket_clearance, 'm', 3)}"
        + (f" and {quantity(row.land_clearance, 'm', 3)}" if row.land_clearance else "")
        for row in rows
    ]
    return [("Pocket and land as they run", "; ".join(each))]
