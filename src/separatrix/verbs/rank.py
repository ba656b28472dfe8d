"""`rank`: verdict, margin, rank and reason of each candidate material, and what they rest on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

from separatrix.ground.document import Part
from separatrix.ground.quantity import Estimate
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Equation,
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
    sign,
)
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import basis_facts, restitution_blocks
from separatrix.verbs.parts.curve_blocks import curve_blocks, curve_panel
from separatrix.verbs.parts.quantity_text import (
    axis,
    begun,
    column,
    estimate,
    fact,
    fill,
    marks,
    quantity,
    show,
)
from separatrix.verbs.parts.refused import candidate_cages, refused
from separatrix.verbs.parts.verdict_blocks import (
    MARK,
    by_verdict,
    candidate_numbers,
    deciding,
    evidence_column,
    has_safety,
    is_any,
    is_judged,
    motion_column,
    rank_texts,
    threshold_alone,
    verdict,
    verdict_facts,
    verdict_sentences,
)
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Iterator

    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import RankingAnswer
    from separatrix.verdict.long_jobs import Runner
    from separatrix.verdict.ranking_records import Ranking

BRIEF, FULL, REPORT, LONG = Level.BRIEF, Level.FULL, Level.REPORT, Level.LONG
EVIDENCE = (
    "stable runs: that settle, or roll in their pockets, from each initial disturbance; the worst one "
    "decides. Offset and forces: largest of any run; > what the races hold: there none has a meaning."
)
SHORT = (
    "largest_offset",
    "largest_tilt",
    "drift_rate",
    "largest_contact_force",
    "largest_land_force",
    "rubbing_power",
)
MOTION = (
    "growth_rate",
    "whirl_frequency",
    "whirl_ratio",
    "mean_offset",
    "end_energy",
    "cone_ratio",
    "axial_travel",
)


def compute(study: Study, options: NoOptions, runner: Runner) -> RankingAnswer:  # noqa: ARG001
    """Verdict, margin, rank and reason of each candidate material."""
    from separatrix.verbs.cage_answers import RankingAnswer
    from separatrix.verbs.parts.cage_of_study import overdamped_notes, reference
    from separatrix.verdict.long_jobs import made_into
    from separatrix.verdict.ranking import rank

    solution, cage = reference(study)
    notes = (*solution.notes, *cage.notes, *overdamped_notes(solution.restitution))

    def made(found: Ranking) -> RankingAnswer:
        every = (*found.notes, *notes)
        return RankingAnswer(solution=solution, cage=cage, ranking=found, notes=every)

    return made_into(made, lambda: rank(study, runner=runner))


def refusals(study: Study) -> Iterator[str]:
    """Yield why there is no ranking: no environment, or no cage of a candidate to move."""
    yield from refused(study, candidate_cages)


def page(answer: Part) -> Page:
    """Return the page of `rank`: the bearing's own environment, what it rests on, then the others."""
    own = next(one for one in answer.environments if one.name == answer.environment)
    others = [one for one in answer.environments if one.name != answer.environment]
    rows = own.materials
    known = [row for row in rows if is_judged(row)]
    return page_of(
        answer,
        Note(" ".join([verdict_sentences(rows, own.name), *deciding(answer, rows)]), "lead"),
        Heading(_title(own.name), LONG),
        *verdicts(own.name, rows, legend=LONG),
        *footnotes(rows),
        *by_paper(answer, known),
        *over_inputs(answer, rows),
        *pictures(answer),
        Heading(fill(answer, f"Evidence: {answer.runs} runs of {{duration}} from each of {_speeds(answer)}")),
        evidence(own.name, known),
        Note(EVIDENCE, "legend", LONG),
        *(Note(f"{row.name}: {row.reason}", level=BRIEF) for row in known if row.verdict == "UNDECIDED"),
        motion(own.name, known),
        reasons(rows, LONG),
        *free_balls_decided(known),
        Note(f"`--full` has all evidence{', and the other environments' * bool(others)}.", level=BRIEF),
        *in_detail(known),
        Heading("Basis of the verdicts", LONG),
        facts(*basis_facts(answer), *ensemble_facts(answer), *holds_for(answer), level=LONG),
        *restitution_blocks(answer.chain, REPORT),
        *pocket(answer.pocket),
        *(curve_blocks(answer.stability, REPORT) if "stability" in answer else []),
        *(block for one in others for block in environment(one.name, one.materials)),
        *(
            environment("Overall: mean friction over the measured environments", answer.overall)
            if others
            else []
        ),
        *gaps(answer),
        candidate_numbers(answer),
        draws=True,
    )


def _title(name: str) -> str:
    return name[:1].upper() + name[1:]


# Tables.


def verdicts(
    name: str, rows: Sequence[Part], *, legend: Level | None = None, level: Level = Level.ALWAYS
) -> list[Block]:
    """Return rank, friction, what is compared with it, and verdict of each candidate."""
    ranks = dict(zip((row.name for row in rows), rank_texts(row.get("rank") for row in rows), strict=True))
    compared, order = ("restitution_threshold", "margin"), "margin"
    if has_safety(rows):
        compared, order = ("own_critical_friction", "safety_factor"), "safety factor"
    columns = (
        text_column("rank", lambda row: ranks[row.name], f"by {order}, = a tie within the scatter"),
        text_column("material", lambda row: row.name),
        column("friction", mark=lambda row: MARK * bool(row.extrapolation)),
        column(compared[0], is_short=True) if has_safety(rows) else threshold_column(),
        column(compared[1]),
        column("probability_stable"),
        text_column("verdict", verdict),
    )
    table = Table(name, columns, tuple(rows), level=level)
    return [table, *([Note(explained(columns), "legend", legend)] if legend else [])]


def by_paper(answer: Part, rows: Sequence[Part]) -> list[Block]:
    """Return the answer of the paper's model beside another one, and where the two differ."""
    if not has_safety(rows):
        return []
    columns = (
        _name(),
        threshold_column(),
        column("margin"),
        column("paper_probability_stable"),
        text_column("verdict", lambda row: row.paper_verdict),
    )
    model = fill(answer.chain, "in the plane, balls as dampers of {race_damping}, Eq. 18")
    each = grouped((row.paper_verdict, row) for row in rows)
    apart = [row.name for row in rows if row.paper_verdict != row.verdict]
    why = ""
    if apart:
        why = f" It differs for {', '.join(apart)}: " + fill(
            answer.chain,
            "a ball that may spin yields to a slow push by {race_damping_free_spin}, and takes more energy "
            "from an impact.",
        )
    first = next(iter(each.values()))[0]

    def numbers(row: Part) -> str:
        words = ("threshold ", "margin ") if row is first else ("", "")
        return f"{words[0]}{threshold_alone(row)}, {words[1]}{show(row, 'margin')}"

    listed = by_verdict({word: [f"{row.name} ({numbers(row)})" for row in who] for word, who in each.items()})
    heading = Heading("The paper's method", LONG, 3)
    table = Table("The paper's method", columns, tuple(rows), f"{begun(model)}.{why}", LONG)
    return [Note(f"The paper's method ({model}): {listed}.{why}", level=BRIEF), heading, table]


def threshold_column() -> Column:
    """Return the column of restitution thresholds."""
    one = column("restitution_threshold")

    def found(row: Part) -> Cell:
        return Cell("any") if "restitution_threshold" in row and is_any(row) else one.cell(row)

    return Column(one.head, found, meaning=one.meaning)


def evidence(name: str, rows: Sequence[Part]) -> Table:
    """Return motion, stable runs from each initial disturbance, largest offset, drift, forces and rubbing."""
    rolls = any(count.rolls for row in rows for count in row.by_kick)
    of_them = [_runs("of them roll", "rolls")] if rolls else []
    known = [one for one in SHORT if any(one in row for row in rows)]
    columns = (
        _name(),
        motion_column(),
        _runs("stable runs", "settles", "rolls"),
        *of_them,
        *map(evidence_column, known),
    )
    return Table(f"{name}, evidence", columns, tuple(rows))


def _name() -> Column:
    return text_column("material", lambda row: row.name)


def _runs(head: str, *keys: str) -> Column:
    """Return the column of runs that end in one of some ways, from each initial disturbance."""

    def counts(row: Part) -> str:
        return " ".join(str(sum(getattr(count, key) for key in keys)) for count in row.by_kick)

    return text_column(head, counts)


def motion(name: str, rows: Sequence[Part], level: Level = LONG) -> Table:
    """Return how the cage moves; the bearing's own restitution factor only where candidates differ in it."""
    differ = len({show(row, "restitution_factor") for row in rows}) > 1
    known = [one for one in MOTION if any(one in row for row in rows)]
    eta = [column("restitution_factor")] if differ else []
    columns = (_name(), motion_column(), *eta, *map(evidence_column, known))
    return Table(f"{name}, motion", columns, tuple(rows), explained(columns), level)


def reasons(rows: Sequence[Part], level: Level) -> Block:
    """Return the reasons; candidates of the same friction share theirs."""
    each = grouped((row.reason, row.name) for row in rows)
    return facts(*((", ".join(who), reason) for reason, who in each.items()), level=level)


def free_balls_decided(rows: Sequence[Part]) -> list[Note]:
    """Return for which candidates free balls decided; none if for none."""
    free = [row.name for row in rows if row.ball == "free" and row.ball_reason]
    words = f"Free balls decided for {', '.join(free)}: with one state the cage would not be called stable."
    return [Note(words, level=LONG)] if free else []


def environment(name: str, rows: Sequence[Part]) -> list[Block]:
    """Return verdicts, evidence and reasons in another environment."""
    known = [row for row in rows if is_judged(row)]
    notes = [Note(note.text, note.kind, FULL) for note in footnotes(rows)]
    return [
        Heading(_title(name), LONG),
        *verdicts(name, rows, level=LONG),
        *notes,
        motion(name, known, FULL),
        reasons(rows, FULL),
    ]


# Words.


def footnotes(rows: Sequence[Part]) -> list[Note]:
    """Return in what respect frictions are extrapolated; on a screen, that of all of them."""
    measured = [row for row in rows if "friction" in row]
    who = grouped((sentence, row.name) for row in measured for sentence in row.extrapolation)
    alike = grouped((tuple(names), sentence) for sentence, names in who.items())
    of_all = alike.pop(tuple(row.name for row in measured), [])
    some = [f"{' '.join(f'{one}.' for one in each)} ({', '.join(names)})" for names, each in alike.items()]
    if not who:
        return []
    words = " ".join([f"{MARK} extrapolated beyond the tests:", *(f"{one}." for one in of_all)])
    more = " More, by material: `--full`." if some else ""
    whole = Note(" ".join([words, *some]), "legend", LONG if some else Level.ALWAYS)
    return [whole, *([Note(words + more, "legend", BRIEF)] if some else [])]


def over_inputs(answer: Part, rows: Sequence[Part]) -> list[Block]:
    """Return the verdicts with the uncertain inputs drawn; none if the study states none."""
    known = [row for row in rows if row.get("uncertain_verdict") is not None]
    if not known:
        return []
    each = grouped(
        (row.uncertain_verdict, f"{row.name} {show(row, 'uncertain_probability_stable')}") for row in known
    )
    names = ", ".join(one["name"] for one in answer.values["study"]["uncertain_inputs"])
    words = f"with a bearing drawn for each of {known[0].uncertain_runs} runs from each initial disturbance"
    return [
        Note(
            f"Uncertain inputs ({names}) are at their means above; {words}, P(stable) is: {by_verdict(each)}."
        )
    ]


def in_detail(rows: Sequence[Part]) -> list[Block]:
    """Return the evidence of the first candidate."""
    return (
        [Heading(f"{rows[0].name} in detail", FULL), facts(*verdict_facts(rows[0]), level=FULL)]
        if rows
        else []
    )


def ensemble_facts(answer: Part) -> list[tuple[str, str]]:
    """Return the ensemble in a few words."""
    return [
        ("Initial disturbances", _speeds(answer)),
        ("Runs", fill(answer, f"{answer.runs} from each, of {{duration}}")),
    ]


def _speeds(answer: Part) -> str:
    """Return the initial disturbances."""
    return ", ".join(show(Part({"kick": one}, {"kick": "m/s"}), "kick") for one in answer.kicks)


def holds_for(answer: Part) -> list[tuple[str, Any]]:
    """Return what the ranking rests on besides the chain."""
    rows = [row for one in answer.environments for row in one.materials if "friction" in row]
    scatter = "none: every friction has its measured scatter"
    if any(row.friction_scatter_assumed for row in rows):
        scatter = fill(answer, "assumed to scatter by {friction_scatter} of their mean: a guess")
    film = []
    if answer.restitution_factor < answer.solid_lubrication_limit:
        words = "The contact model predicts {restitution_factor} for this film, below this bound"
        film = [("This film", fill(answer, f"{words} of {{solid_lubrication_limit}}. Both are shown."))]
    return [
        ("Unrepeated tests", scatter),
        *_differing(answer.overall, "Mass of the cage", "cage_mass"),
        *_differing(answer.overall, "Pocket as it runs", "pocket_clearance"),
        *_differing(answer.overall, "Land as it runs", "land_clearance"),
        ("The paper's bound", answer.paper_statement),
        *film,
    ]


def _differing(rows: Sequence[Part], label: str, name: str) -> list[tuple[str, str]]:
    """Return a quantity of each candidate where they differ in it."""
    each = [f"{row.name} {show(row, name)}" for row in rows if name in row]
    return [(label, "; ".join(each))] if len({getattr(row, name) for row in rows}) > 1 else []


def pocket(found: Part) -> list[Block]:
    """Return where ball and pocket rub."""
    names = ("slip_speed", "impact_force", "pressure", "max_pressure", "contact_radius")
    return [
        Heading("Ball on pocket", LONG, 3),
        Equation(
            r"\bar p = \dfrac{F}{\pi\,r^2}", "Mean pressure of ball on pocket in an impact of force $F$."
        ),
        facts(*(fact(found, name) for name in names), level=LONG),
    ]


def gaps(answer: Part) -> list[Block]:
    """Return in how many environments a candidate was measured, if not in all."""
    total = len(answer.environments)
    counts = Counter(row.name for one in answer.environments for row in one.materials if "friction" in row)
    few = [f"{row.name} in {counts[row.name]}" for row in answer.overall if counts[row.name] < total]
    return (
        [Note(f"Measured in fewer than {total} environments: {', '.join(few)}.", level=LONG)] if few else []
    )


# Pictures.


def pictures(answer: Part) -> list[Block]:
    """Return the overview, and the candidates of each environment on the paper's stability curve."""
    if answer.get("complete") is False or not any("restitution_threshold" in row for row in answer.overall):
        return []
    caption = "Restitution thresholds of the candidates: larger is better; the upright line is this bearing."
    if has_safety(answer.overall):
        caption = "Safety factors of the candidates, larger is better: at 1 half the runs whirl."
    found: list[Block] = [Picture("rank-overview", lambda: overview(answer), caption)]
    if "stability" not in answer:
        return found
    order = sorted(answer.environments, key=lambda one: bool(one.name != answer.environment))
    for place, one in enumerate(order):
        caption = f"The candidates in {one.name} on the paper's stability curve: below it the cage is stable."
        level = REPORT if place == 0 else FULL
        found.append(Picture(f"rank-{_slug(one.name)}", _on_the_curve(answer, one), caption, level))
    return found


def _slug(text: str) -> str:
    """Return a text as the part of a file's name."""
    plain = "".join(c if c.isascii() and c.isalnum() else "-" for c in text.lower())
    return "-".join(part for part in plain.split("-") if part)[:60] or "environment"


def _on_the_curve(answer: Part, place: Part) -> Callable[[], Figure]:
    return lambda: on_the_curve(answer, place)


def on_the_curve(answer: Part, place: Part) -> Figure:
    """Return the paper's stability curve with the candidates of one environment on it, and its verdicts."""
    rows = [row for row in place.materials if "friction" in row]
    ranks = dict(
        zip(
            (row.name for row in place.materials),
            rank_texts(row.get("rank") for row in place.materials),
            strict=True,
        )
    )
    found: list[Mark] = []
    for row in rows:
        word, eta = by_the_paper(row), row.restitution_factor
        colour = VERDICT_COLOURS.get(word, GREY)
        found.append(Trace(x=(0.0, 1.0), y=(row.friction, row.friction), colour=colour, width=0.4))
        if "restitution_threshold" in row:
            look: dict[str, Any] = {"colour": colour, "marker": "o", "is_open": True, "size": 4.5}
            found.append(marks([row], "restitution_threshold", "friction", **look))
        look = {"colour": colour, "marker": VERDICT_MARKERS.get(word, "."), "size": 5.0}
        found.append(Trace(x=(eta,), y=(row.friction,), line="", hover=(hover(row),), **look))
    labels = tuple(
        Label(
            y=row.friction,
            text=f"{ranks[row.name]}  {row.name}  {show(row, 'friction')}{MARK * bool(row.extrapolation)}",
        )
        for row in rows
    )
    signs = [
        sign(marker, VERDICT_COLOURS[word], f"{word}, at the candidate's own $eta$")
        for word, marker in VERDICT_MARKERS.items()
    ]
    signs.append(sign("o", GREY, "threshold with its 95 % interval", is_open=True))
    panel = curve_panel(
        answer,
        answer.stability,
        title=f"The paper's method, {place.name}",
        more=found,
        frictions=[row.friction for row in rows],
        labels=labels,
        head="rank  candidate  friction",
    )
    return Figure(
        rows=((panel,),),
        heading=figure_heading(answer, f"seed {answer.seed}"),
        alt="Critical friction against restitution factor, with the friction of each candidate at the "
        "bearing's own restitution factor; the table has the numbers.",
        height=4.3,
        legend=tuple(signs),
    )


def by_the_paper(row: Part) -> str:
    """Return the verdict of a row by the paper's model; a dash in another environment."""
    return str(row.get("paper_verdict") or "-")


def _colour(row: Part) -> str:
    return VERDICT_COLOURS.get(verdict(row), GREY)


def hover(row: Part) -> str:
    """Return what a candidate's mark says under the pointer."""
    parts = [f"{row.name}: {verdict(row)}", f"friction {show(row, 'friction')}"]
    compared = ("safety_factor",) if has_safety([row]) else ("restitution_threshold", "margin")
    for name in (*compared, "probability_stable"):
        parts += [f"{quantity(name).label} {show(row, name)}"] if row.get("verdict") else []
    return "; ".join(parts)


def overview(answer: Part) -> Figure:
    """Return what candidates are ranked by in each environment and overall; best at the top.

    That is the safety factor, or the restitution threshold in the paper's model; with its interval where the
    bearing runs.
    """
    own = next(one for one in answer.environments if one.name == answer.environment)
    names = [row.name for row in own.materials][::-1]
    place = {name: float(at) for at, name in enumerate(names)}
    safe, here = has_safety(own.materials), f"{own.name}, with its 95 % interval"
    name = "safety_factor" if safe else "restitution_threshold"
    bound = (
        (1.0, "half the runs whirl") if safe else (answer.restitution_factor, "this bearing with this film")
    )

    def trace(rows: Sequence[Part], shift: float, where: str, **look: Any) -> Trace:
        known = [row for row in rows if f"{name}_low" in row]
        values = [estimate(row, name) for row in known]
        found: dict[str, Any] = {"line": "", "name": where, "size": 3.6} | look
        ends = [(one.low, one.high) if isinstance(one, Estimate) else (None, None) for one in values]
        if where == here:
            found |= {"ends_along": "x", "low": [low for low, _ in ends], "high": [high for _, high in ends]}
        return Trace(
            x=[row.get(name) or row.get(f"{name}_low") for row in known],
            y=[place[row.name] + shift for row in known],
            hover=tuple(f"{where}; {hover(row)}" for row in known),
            **found,
        )

    others = [(one.name, one.materials) for one in answer.environments if one.name != answer.environment]
    others += [("overall", answer.overall)] if others else []
    found: list[Mark] = [Across(at=bound[0], name=bound[1])]
    found.append(trace(own.materials, 0.0, here, marker="D", size=4.5))
    looks = zip(range(99), others, cycle(MARKERS), cycle(CYCLE), strict=False)
    found += [
        trace(rows, 0.26 - 0.52 * (at + 0.5) / len(others), where, marker=marker, colour=colour)
        for at, (where, rows), marker, colour in looks
    ]
    verdicts_here = tuple(
        Label(
            y=place[row.name],
            text=verdict(row),
            colour=_colour(row),
            marker=VERDICT_MARKERS.get(verdict(row), "x"),
        )
        for row in own.materials
    )
    ranks = dict(zip(names[::-1], rank_texts(row.get("rank") for row in own.materials), strict=True))
    x = axis(name, "-", [], is_log=True) if safe else axis(name, "-", [], low=-0.012, high=1.0)
    ticks = tuple(f"{one}  {ranks[one]}" for one in names)
    y = Axis(label="", low=-0.6, high=len(names) - 0.4, names=ticks)
    what = "Safety factors" if safe else "Restitution thresholds"
    title = f"{what}, larger is better; ranks in {own.name}"
    return Figure(
        rows=((Panel(title=title, x=x, y=y, marks=tuple(found), labels=verdicts_here, head="verdict"),),),
        heading=figure_heading(answer, f"seed {answer.seed}"),
        alt=f"{what} of each candidate in each environment, where the bearing runs with their interval; the "
        "table has the numbers.",
        height=0.9 + 0.32 * len(names),
    )


VERB = Verb(
    name="rank",
    compute=compute,
    page=page,
    needs=("cage", "ranking"),
    moves_a_cage=True,
    has_full=True,
    keeps_runs=True,
    refusals=refusals,
)
