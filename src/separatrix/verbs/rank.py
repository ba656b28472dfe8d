"""`rank`: verdict, margin, rank and reason of each candidate material, and what they rest on."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

from separatrix.ground.plain_data import Part
from separatrix.present import figure as fig
from separatrix.present import quantity_text as q
from separatrix.present.blocks import (
    Block,
    Column,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    explained,
    facts,
    grouped,
    text_column,
)
from separatrix.verbs.parts import verdict_blocks as of
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.parts.chain_blocks import basis_facts, restitution_blocks
from separatrix.verbs.parts.verdict_blocks import MARK, by_verdict, has_safety, judged, verdict
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import RankingAnswer
    from separatrix.verdict.long_jobs import Runner

BRIEF, REPORT, LONG = Level.BRIEF, Level.REPORT, Level.LONG
EVIDENCE = (
    "stable runs: that settle, or roll in their pockets, from each initial disturbance; the worst one "
    "decides. Offset and forces: largest of any run; > what the races hold: there none has a meaning."
)
SHORT = (
    *("largest_offset", "largest_tilt", "drift_rate", "largest_contact_force", "largest_land_force"),
    "rubbing_power",
)
NAME = text_column("material", lambda row: row.name)
POCKET = ("slip_speed", "impact_force", "pressure", "max_pressure", "contact_radius")


def compute(study: Study, options: NoOptions, runner: Runner) -> RankingAnswer:  # noqa: ARG001
    """Verdict, margin, rank and reason of each candidate material."""
    from separatrix.verbs.cage_answers import RankingAnswer
    from separatrix.verbs.parts.cage_of_study import answer_of_cage, overdamped_notes, reference
    from separatrix.verdict.ranking import rank

    solution = reference(study)
    notes = overdamped_notes(solution.restitution)
    return answer_of_cage(RankingAnswer, "ranking", solution, lambda: rank(study, runner=runner), *notes)


def page(answer: Part) -> Page:
    """Return the page of `rank`: the bearing's own environment, what it rests on, then the others."""
    (own,) = (one for one in answer.environments if one.name == answer.environment)
    others = [one for one in answer.environments if one.name != answer.environment]
    rows = own.materials
    known = [row for row in rows if judged(row)]
    apart = [row.name for row in known if row.get("paper_verdict") not in (None, row.verdict)]
    paper = f"the paper's method{'' if apart else ' (the same verdicts)'}"
    every = [(one.name, row.name, row) for one in answer.environments for row in one.materials]
    every += [("overall", row.name, row) for row in answer.overall]
    overall = verdicts("Overall: mean friction over the measured environments", answer.overall, LONG)
    return page_of(
        answer,
        Note(" ".join([of.verdict_sentences(rows, own.name), *of.deciding(answer, rows)]), "lead"),
        *verdicts(own.name, rows),
        *by_paper(answer, known, apart),
        *over_inputs(answer, rows),
        *pictures(answer, own),
        *[Heading(evidence_head(answer))] * bool(known),
        Table(f"{own.name}, evidence", evidence(known), tuple(known)),
        Note(EVIDENCE, "legend", LONG),
        *reasons(rows),
        *effects(answer, rows),
        Heading("Basis of the verdicts", LONG),
        facts(*basis_facts(answer), *holds_for(answer), level=LONG),
        Heading("Ball on pocket", LONG, 3),
        facts(*(q.fact(answer.pocket, name) for name in POCKET), level=LONG),
        *restitution_blocks(answer.chain, REPORT),
        *(of.curve_blocks(answer.stability, REPORT) if "stability" in answer else []),
        *(block for one in others for block in verdicts(one.name, one.materials, LONG)),
        *(overall if others else []),
        q.all_numbers("all numbers", ("environment", "material"), every),
        draws=True,
        more=[*[paper] * has_safety(rows), "all evidence", *["the other environments"] * bool(others)],
    )


# Tables.


def verdicts(name: str, rows: Sequence[Part], level: Level = Level.ALWAYS) -> list[Block]:
    """Return rank, friction, what is compared with it, and verdict of each candidate."""
    compared = list[Column]()  # none if an interrupt left nothing of it
    if has_safety(rows):
        compared = [q.column("own_critical_friction", is_short=True), q.column("safety_factor")]
    elif any("margin" in row for row in rows):
        compared = [q.column("restitution_threshold"), q.column("margin")]
    ranks, order = ranks_of(rows), "safety factor" if has_safety(rows) else "margin"
    columns = (
        text_column("rank", lambda row: ranks[row.name], f"by {order}, = a tie within the scatter"),
        NAME,
        q.column("friction", mark=lambda row: MARK * bool(row.extrapolation)),
        *compared,
        q.column("probability_stable"),
        text_column("verdict", verdict),
    )
    table = Table(name, columns, tuple(rows), level=level)
    legend = [Note(explained(columns), "legend", LONG)] if level == Level.ALWAYS else []
    return [Heading(q.begun(name), LONG), table, *legend, *of.footnotes(rows, level)]


def ranks_of(rows: Sequence[Part]) -> dict[str, str]:
    """Return the ranks of candidates as text, by name: = after a shared one, a dash for none."""
    known = [row.get("rank") for row in rows]
    texts = ["-" if rank is None else f"{rank}{'=' * (known.count(rank) > 1)}" for rank in known]
    return dict(zip((row.name for row in rows), texts, strict=True))


def by_paper(answer: Part, known: Sequence[Part], apart: Sequence[str]) -> list[Block]:
    """Return the answer of the paper's model beside another one, and for whom the two stand apart."""
    rows = [row for row in known if row.get("paper_verdict") is not None]
    if not has_safety(rows):
        return []
    numbers = ("restitution_threshold", "margin", "paper_probability_stable")
    columns = (NAME, *map(q.column, numbers), text_column("verdict", lambda row: row.paper_verdict))
    model = q.fill(answer.chain, "in the plane, balls as dampers of {race_damping}, Eq. 18")
    ball = "a ball that may spin in an impact resists it with {race_damping_free_spin} and slides beyond the "
    ball = f"{ball}friction of its races" * (answer.ball_model != "damper")
    tilts = "the cage also tilts and moves along the axis" * (answer.cage.motion == "space")
    full = ", and ".join(filter(None, (tilts, ball)))
    driven = [row.name for row in rows if row.name in apart and of.is_land_driven(row)]
    others = [name for name in apart if name not in driven]
    why = ""
    if driven:
        why = f" It differs for {', '.join(driven)}: friction on the land drives the cage."
        look = answer.get("long_look")
        if look and look.takes_over:
            why += q.fill(look, " Runs of {duration} show it; those of the paper are shorter.")
    if others:
        why += q.fill(answer.chain, f" It differs for {', '.join(others)}: in the full model {full}.")
    each = by_verdict((row.paper_verdict, row.name) for row in rows)
    caption = f"{q.begun(model)}.{why}"
    return [
        *([Note(f"The paper's method ({model}): {each}.{why}", level=BRIEF)] if apart else []),
        Heading("The paper's method", LONG, 3),
        Table("The paper's method", columns, tuple(rows), caption, LONG),
    ]


def evidence_head(answer: Part) -> str:
    """Return how many runs are behind the verdicts, from where, how long; longer after a long look."""
    kicks, look = of.disturbances(answer), answer.get("long_look")
    if look and look.takes_over:
        longer = q.show(look.count, "kick")
        kicks = [f"{one} ({q.show(look, 'duration')})" if one == longer else one for one in kicks]
    return q.fill(answer, f"Evidence: {answer.runs} runs of {{duration}} from each of {', '.join(kicks)}")


def evidence(rows: Sequence[Part]) -> tuple[Column, ...]:
    """Return the columns of motion, stable runs from each initial disturbance, offset, forces and rubbing."""
    rolls = any(count.rolls for row in rows for count in row.by_kick)
    return (
        NAME,
        of.motion_column(),
        _runs("stable runs", "settles", "rolls"),
        *([_runs("of them roll", "rolls")] if rolls else []),
        *q.known_columns(map(of.evidence_column, SHORT), rows),
    )


def _runs(head: str, *keys: str) -> Column:
    """Return the column of runs that end in one of some ways, from each initial disturbance."""
    return text_column(head, lambda row: " ".join(str(sum(map(count.get, keys))) for count in row.by_kick))


def reasons(rows: Sequence[Part]) -> list[Block]:
    """Return the reasons, on a screen of those undecided; candidates of the same friction share theirs."""
    shared = grouped((row.reason, row.name) for row in rows if row.get("verdict") == "UNDECIDED")
    notes = [Note(f"{', '.join(who)}: {reason}", level=BRIEF) for reason, who in shared.items()]
    each = grouped((row.reason, row.name) for row in rows)
    return [*notes, facts(*((", ".join(who), reason) for reason, who in each.items()), level=LONG)]


def effects(answer: Part, rows: Sequence[Part]) -> list[Block]:
    """Return what else moves the critical friction of the reference cage; nothing if no input allows it."""
    own = [row for row in rows if row.name == answer.candidate and "own_critical_friction_low" in row]
    columns = (
        text_column("with", lambda row: row.get("change") or "all inputs as stated"),
        q.column("own_critical_friction"),
    )
    title = f"What else moves the critical friction of {answer.candidate}"
    known = (*own, *answer.effects) if answer.effects else ()
    return [Heading(title, LONG, 3), Table("effects", columns, known, level=LONG)]


def over_inputs(answer: Part, rows: Sequence[Part]) -> list[Block]:
    """Return the verdicts with the uncertain inputs drawn; none if the study states none."""
    known = [row for row in rows if row.get("uncertain_verdict") is not None]
    chance = "uncertain_probability_stable"
    each = by_verdict((row.uncertain_verdict, f"{row.name} {q.show(row, chance)}") for row in known)
    names = ", ".join(one["name"] for one in answer.values["study"]["uncertain_inputs"])
    words = f"Uncertain inputs ({names}) are at their means above; drawn for each run, P(stable) is: "
    return [Note(f"{words}{each}.")] if known else []


def holds_for(answer: Part) -> list[tuple[str, Any]]:
    """Return what the ranking rests on besides the chain."""
    rows = [row for one in answer.environments for row in one.materials if "friction" in row]
    scatter = "none: every friction has its measured scatter"
    if any(row.friction_scatter_assumed for row in rows):
        scatter = q.fill(answer, "assumed to scatter by {friction_scatter} of their mean: a guess")
    film = ""
    if answer.restitution_factor < answer.solid_lubrication_limit:
        film = q.fill(answer, " The contact model predicts {restitution_factor} for this film.")
    bound = f"{answer.paper_statement}{film}"
    return [("Unrepeated tests", scatter), ("The paper's bound", bound), *long_look(answer)]


def long_look(answer: Part) -> list[tuple[str, Any]]:
    """Return what was seen of a calm cage on its land long after it settled; nothing without a land."""
    look = answer.get("long_look")
    return [("A long look", look.reason)] if look else []


# Pictures.


def pictures(answer: Part, own: Part) -> list[Block]:
    """Return the overview, and the candidates where the bearing runs on the paper's stability curve."""
    if answer.get("complete") is False or not any("restitution_threshold" in row for row in answer.overall):
        return []
    caption = "Restitution thresholds of the candidates: larger is better; the upright line is this bearing."
    if has_safety(answer.overall):
        caption = "Safety factors of the candidates, larger is better: at 1 half the runs whirl."
        caption += " An arrow has no upper end; a factor of 0 has no mark."
    found: list[Block] = [Picture("rank-overview", lambda: overview(answer, own), caption)]
    if "stability" in answer:
        caption = f"The candidates in {own.name} on the paper's stability curve: below it the cage is stable."
        found.append(Picture("rank-paper", lambda: on_the_curve(answer, own), caption))
    return found


def on_the_curve(answer: Part, own: Part) -> fig.Figure:
    """Return the paper's stability curve with the candidates where the bearing runs, and its verdicts."""
    rows = [row for row in own.materials if "friction" in row]
    found, labels = list[fig.Mark](), list[fig.Label]()
    for row in rows:
        word = row.get("paper_verdict") or row.get("verdict") or "not finished"
        look, star = look_of(word), MARK * bool(row.extrapolation)
        eta, friction = row.restitution_factor, row.friction
        found.append(fig.Trace(x=(0.0, 1.0), y=(friction, friction), colour=look["colour"], width=0.4))
        found.append(fig.Trace(x=(eta,), y=(friction,), line="", size=5.0, hover=(hover(row),), **look))
        text = f"{row.name}  {q.show(row, 'friction')}{star}  {word}"
        labels.append(fig.Label(y=friction, text=text, colour=look["colour"]))
    panel = of.curve_panel(
        answer,
        answer.stability,
        title=f"The paper's method, {own.name}",
        more=found,
        frictions=[row.friction for row in rows],
        labels=labels,
        head="candidate  friction  verdict",
    )
    return figure(answer, (panel,), height=4.3, more=(f"seed {answer.seed}",))


def look_of(word: str) -> dict[str, Any]:
    """Return colour and marker of a verdict."""
    return {"colour": fig.VERDICT_COLOURS.get(word, fig.GREY), "marker": fig.VERDICT_MARKERS.get(word, "x")}


def hover(row: Part) -> str:
    """Return what a candidate's mark says under the pointer."""
    compared = ("safety_factor",) if has_safety([row]) else ("restitution_threshold", "margin")
    names = (*compared, "probability_stable") if judged(row) else ()
    numbers = [f"{q.quantity(name).label} {q.show(row, name)}" for name in ("friction", *names)]
    return "; ".join([f"{row.name}: {verdict(row)}", *numbers])


def overview(answer: Part, own: Part) -> fig.Figure:
    """Return what candidates are ranked by in each environment and overall; best at the top.

    That is the safety factor, or the restitution threshold in the paper's model; with its interval where the
    bearing runs.
    """
    safe, ranks = has_safety(own.materials), ranks_of(own.materials)
    place = {name: float(at) for at, name in enumerate(reversed(ranks))}
    name, what = "restitution_threshold", "Restitution thresholds"
    x, bound = q.axis(name, "-", [], low=-0.012, high=1.0), answer.restitution_factor
    if safe:
        name, what, bound = "safety_factor", "Safety factors", 1.0
        x = q.axis(name, "-", [], is_log=True)

    def trace(rows: Sequence[Part], shift: float, where: str, **look: Any) -> fig.Trace:
        known = [row for row in rows if f"{name}_low" in row]
        is_own = shift == 0.0  # of the others a lower end alone is shown
        return fig.Trace(
            low=[row.get(f"{name}_low") if is_own or name not in row else None for row in known],
            high=[row.get(f"{name}_high") for row in known],
            ends_along="x",
            x=[row.get(name) or row.get(f"{name}_low") for row in known],
            y=[place[row.name] + shift for row in known],
            hover=tuple(f"{where}; {hover(row)}" for row in known),
            line="",
            name=where,
            **look,
        )

    ours: dict[str, Any] = {"marker": "D", "size": 4.5}
    found: list[fig.Mark] = [
        fig.Across(at=bound, name="half the runs whirl" if safe else "this bearing with this film"),
        trace(own.materials, 0.0, f"{own.name}, with its 95 % interval", **ours),
    ]
    others = [(one.name, one.materials) for one in answer.environments if one.name != own.name]
    others += [("overall", answer.overall)] if others else []
    looks = zip(others, cycle(fig.MARKERS), cycle(fig.CYCLE), strict=False)
    for at, ((where, rows), marker, colour) in enumerate(looks):
        shift = 0.26 - 0.52 * (at + 0.5) / len(others)
        found.append(trace(rows, shift, where, marker=marker, colour=colour, size=3.6))
    words = [(place[row.name], verdict(row)) for row in own.materials]
    labels = tuple(fig.Label(y=at, text=word, **look_of(word)) for at, word in words)
    ticks = tuple(f"{one}  {ranks[one]}" for one in place)
    y = fig.Axis(label="", low=-0.6, high=len(place) - 0.4, names=ticks)
    title = f"{what}, larger is better; ranks in {own.name}"
    return figure(
        answer,
        (fig.Panel(title=title, x=x, y=y, marks=tuple(found), labels=labels, head="verdict"),),
        height=0.9 + 0.32 * len(place),
        more=(f"seed {answer.seed}",),
    )


VERB = Verb(
    name="rank",
    compute=compute,
    page=page,
    needs=("cage", "ranking"),
    moves_a_cage=True,
    keeps_runs=True,
    links=("candidate_cages",),
)
