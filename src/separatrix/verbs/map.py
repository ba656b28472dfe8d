"""`map`: verdicts in the plane of two parameters of a study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from separatrix.ground.document import Part
from separatrix.present.blocks import Column, Heading, Level, Note, Page, Picture, Table, facts, text_column
from separatrix.present.figure import BLACK, VERMILION, Cells, Figure, Hatched, Mark, Panel, Trace, sign
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import basis_facts
from separatrix.verbs.parts.curve_blocks import linear_law, pocket_friction
from separatrix.verbs.parts.telling import column, quantity, said, told
from separatrix.verbs.parts.varied import parameter_axis, value_of
from separatrix.verbs.verb import Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import MapAnswer
    from separatrix.verdict.long_jobs import Runner

AXIS = "LOW..HIGH[unit][:N][:log]"
X, Y = "restitution_factor=0..1", "ball_cage_friction=0..0.5"
FRICTION, RESTITUTION, KICK = "ball_cage_friction", "restitution_factor", "kick"
KINDS = ("STABLE", "UNSTABLE", "UNDECIDED", "refused", "inferred", "not_run")

SOME_COLUMNS, MORE_COLUMNS = 9, 40
"""Columns of a map whose bands stand on a screen and in a report: of more, so many are chosen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Axes of a map, and how its points are run."""

    x: Annotated[str, Option(f"PARAM={AXIS}.", "AXIS")] = X
    y: Annotated[str, Option("Vertical axis, same syntax as --x.", "AXIS")] = Y
    points: Annotated[int, Option("Points per axis, unless the axis states a number.", "N")] = 100
    runs: Annotated[int, Option("Most runs of a point.", "N")] = 16
    kick: Annotated[
        str | float | None,
        Option('Initial disturbance, for instance "0.5 m/s" [default: the reference of the study].', "SPEED"),
    ] = None
    adaptive: Annotated[
        bool, Option("Run only points near a change of the answer; infer the others, and check some of them.")
    ] = False


def compute(study: Study, options: Options, runner: Runner) -> MapAnswer:
    """Verdicts in the plane of two parameters of a study."""
    from separatrix.cage import settings_for
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import InputError
    from separatrix.verbs.answer_records import MapAnswer
    from separatrix.verbs.parts.cage_of_study import MOST_RUNS, cage_of, extrapolation_notes, kick_speed
    from separatrix.verdict.long_jobs import made_into
    from separatrix.verdict.map_records import MapQuestion, StabilityMap
    from separatrix.verdict.parameter_axes import checked_points, read_axis
    from separatrix.verdict.stability_map import stability_map, value_here

    checked_points(options.points, "--points")
    if not 1 <= options.runs <= MOST_RUNS:
        raise InputError("--runs", f"must lie between 1 and {MOST_RUNS}", got=str(options.runs))
    axes = [read_axis(text, f"--{way}", options.points) for way, text in (("x", options.x), ("y", options.y))]
    names = [axis.parameter for axis in axes]
    if names[0] == names[1]:
        cure = f"Without --x it is {X}, without --y {Y}."
        raise InputError("--x and --y", "must be two parameters", got=f"{names[0]} twice", cure=cure)
    if options.kick is not None and KICK in names:
        raise InputError("--kick", "and an axis kick exclude each other", cure="Give one of the two.")
    solution = solve(study)
    cage = cage_of(solution)
    if options.kick is None:
        speed = settings_for(study.stability, cage).middle_kick
    else:
        speed = kick_speed(options.kick)
    across, up = (replace(axis, here=value_here(solution, axis.parameter)) for axis in axes)
    asked = MapQuestion(study=study, x=across, y=up, kick=speed, runs=options.runs, adaptive=options.adaptive)
    notes = (*solution.notes, *cage.notes, *extrapolation_notes(solution))

    def made(found: StabilityMap) -> MapAnswer:
        every = (*notes, *(note for point in found.points for note in point.notes))
        return MapAnswer(solution=solution, cage=cage, map=found, notes=every)

    return made_into(
        made,
        lambda: stability_map(asked, runner=runner),
    )


def page(answer: Part) -> Page:
    """Return the page of `map`."""
    x, y = answer.x, answer.y
    refused = [one for one in answer.points if one.get("state") == "REFUSED"]
    more = f"The first of the refused points: {refused[0].reason}" if refused else ""
    friction = [] if FRICTION in _names(answer) else [("Pocket friction", pocket_friction(answer))]
    scatter = ("Scatter of the balls", told(answer, "ball_scatter"))
    return page_of(
        answer,
        Note(" ".join(filter(None, [counted(answer), nearest_words(answer)])), "lead"),
        *([Note(more)] if more else []),
        facts(
            ("Across", _axis_words(x)),
            ("Upward", _axis_words(y)),
            ("Runs", runs_words(answer)),
            *_inference(answer),
        ),
        map_picture(answer),
        Heading("Where the cage begins to whirl"),
        *bands(answer),
        Heading("Basis of this answer", Level.LONG),
        facts(*basis_facts(answer), *friction, scatter, level=Level.LONG),
        points_table(answer),
    )


def _names(answer: Part) -> tuple[str, str]:
    return answer.x.parameter, answer.y.parameter


def counted(answer: Part) -> str:
    """Return of how many points the cage is stable, unstable, and what became of the others."""
    counts = answer.counts
    each = [f"{counts.get(one)} {one.replace('_', ' ')}" for one in KINDS if counts.get(one)]
    near = Counter(one.get("inferred_decision") for one in answer.points if "inferred_decision" in one)
    if near:
        each.append(f"those inferred as {', '.join(f'{count} {word}' for word, count in near.items())}")
    return f"Of {len(answer.points)} points {', '.join(each)}."


def _value(axis: Part, value: float | None) -> str:
    return value_of(axis, axis.parameter, value).text


def _axis_words(axis: Part) -> str:
    values = axis.get("values")
    here = f"; the study has {_value(axis, axis.here)}" if "here" in axis else ""
    ends = f"{_value(axis, values[0])} to {_value(axis, values[-1])}"
    return f"{quantity(axis.parameter).label}, {ends}, {len(values)} values{here}"


def nearest_words(answer: Part) -> str:
    """Return where the answer changes in the column next to the study; empty if the map is elsewhere."""
    x, y, values = answer.x, answer.y, answer.x.get("values")
    if "here" not in x or not values[0] <= x.here <= values[-1]:
        return ""
    at = min(values, key=lambda value: abs(value - x.here))
    across, up = (quantity(one.parameter).label for one in (x, y))
    first = f"Next to the study, at {across} {_value(x, at)}, the cage"
    own = f" The study itself has {across} {_value(x, x.here)}"
    own += f" and {up} {_value(y, y.here)}." if "here" in y else "."
    changes = [row.change for row in rows(answer, [at]) if row.change is not None]
    if not changes:
        kind = rows(answer, [at])[0].kind
        words = {EVERYWHERE: "whirls everywhere", NOWHERE: "whirls nowhere", OPEN: "was not finished"}
        return f"{first} {words.get(kind, 'has no boundary that was found')}.{own}"
    each = (
        f"{'begins' if one.whirls_above else 'ceases'} to whirl between {up} {_value(y, one.y_low)} and "
        f"{_value(y, one.y_high)}"
        for one in changes
    )
    return f"{first} {', and '.join(each)}.{own}"


def runs_words(answer: Part) -> str:
    """Return how many runs a point has, of which length, from which disturbance."""
    rule = answer.stopping
    words = said(rule, "{most_runs} at every point")
    if rule.agreeing_runs != rule.most_runs:
        words = said(
            rule,
            "up to {most_runs}, stopped after {agreeing_runs} that agree (risk of the wrong side "
            "{wrong_side_probability}, of another decision {other_decision_probability})",
        )
    kick = "" if KICK in _names(answer) else said(answer, ", from an initial disturbance of {kick}")
    return f"{words}, each of {told(answer, 'duration')}{kick}"


def _inference(answer: Part) -> list[tuple[str, str]]:
    """Return how many points were not run, and how often those around them were wrong where they were."""
    found = answer.get("inference")
    if found is None or not found.points + found.checked:
        return []
    inferred = f"{found.points} points were not run, as those around them agree; "
    if "error_low" not in found:
        return [("Inferred", f"{inferred}none was checked")]
    ends = said(found, "(95 %: {error_low} to {error_high})")
    checked = f"{found.checked} more of that kind were run as a check, of which {found.decided_otherwise}"
    return [("Inferred", f"{inferred}{checked} are decided otherwise {ends}")]


# Where the answer changes.

EVERYWHERE, NOWHERE, OPEN = "everywhere", "nowhere", "not finished"


class Row(NamedTuple):
    """A change in a column of the map; of a column without one, what it is."""

    x: float
    change: Part | None
    kind: str


def rows(answer: Part, columns: Sequence[float]) -> list[Row]:
    """Return the changes in some columns of the map."""
    found = []
    for x in columns:
        changes = [one for one in answer.get("changes") or () if one.x == x]
        found += [Row(x, one, "above" if one.whirls_above else "below") for one in changes]
        if not changes:
            found.append(Row(x, None, _kind([one for one in answer.points if one.x == x])))
    return found


def _kind(column: Sequence[Part]) -> str:
    """Return what a column without a change is."""
    sides = {_side(one) for one in column if one.runs}
    if any(_state(one) == "NOT_RUN" for one in column):
        return OPEN
    if not sides:
        return "refused"
    return "no boundary found" if 0 in sides else EVERYWHERE if sides == {1} else NOWHERE


def _side(point: Part) -> int:
    """Return 1 where more than half of the runs whirl, -1 where fewer do, 0 where neither is sure."""
    return 1 if point.probability_low > 0.5 else -1 if point.probability_high < 0.5 else 0


def bands(answer: Part) -> Iterator[Table | Note]:
    """Yield the bands of the columns, so many as a screen and a report have room for; a workbook has all."""
    every = answer.x.get("values")
    if not answer.get("changes"):
        kinds = ", ".join(dict.fromkeys(row.kind for row in rows(answer, every)))
        yield Note(f"No column of the map has a boundary: {kinds}.")
        return
    if len(every) <= SOME_COLUMNS:
        yield _bands(answer, every, Level.ALWAYS)
        return
    yield _bands(answer, _spread(every, SOME_COLUMNS), Level.BRIEF)
    yield _bands(answer, _spread(every, MORE_COLUMNS), Level.LONG)
    if len(every) > MORE_COLUMNS:
        yield _bands(answer, every, Level.SHEET)


def _spread(values: Sequence[float], most: int) -> list[float]:
    if len(values) <= most:
        return list(values)
    return [values[round(i * (len(values) - 1) / (most - 1))] for i in range(most)]


def _bands(answer: Part, chosen: Sequence[float], level: Level) -> Table:
    x, y, total = answer.x, answer.y, len(answer.x.get("values"))

    def of(name: str, head: str) -> Column:
        return Column(
            head, lambda row: value_of(y, y.parameter, row.change.get(name) if row.change else None)
        )

    label = quantity(y.parameter).label
    columns = (
        Column(quantity(x.parameter).label, lambda row: value_of(x, x.parameter, row.x)),
        of("y_low", f"{label} from"),
        of("y_high", "to"),
        text_column("whirls", lambda row: row.kind),
        of("margin", "margin"),
    )
    part = "" if len(chosen) == total else f"{len(chosen)} of {total} columns; map.json has all. "
    return Table("bands", columns, tuple(rows(answer, chosen)), part + LEGEND, level)


LEGEND = (
    "Between the last point of a column at which, beyond the scatter, less than half of the runs whirl and "
    "the first at which more than half do. Margin: distance of the study's own value to that band, positive "
    "where the cage settles."
)


def points_table(answer: Part) -> Table:
    """Return every point of the map with its evidence, for a workbook."""
    x, y = answer.x, answer.y
    names = ("probability_whirl", "runs", "whirling", "growth_rate", "largest_offset", "drift_rate")
    columns = (
        Column(quantity(x.parameter).label, lambda row: value_of(x, x.parameter, row.x)),
        Column(quantity(y.parameter).label, lambda row: value_of(y, y.parameter, row.y)),
        text_column("decision", lambda row: row.decision or row.get("inferred_decision")),
        *map(column, names),
        column("largest_contact_force"),
        column("restitution_factor", head="restitution factor of the point"),
        Column("margin", lambda row: value_of(y, y.parameter, row.margin)),
        text_column("reason", lambda row: row.reason),
    )
    return Table("points", columns, tuple(answer.points), "", Level.SHEET)


# The picture.


def map_picture(answer: Part) -> Picture:
    """Return the map, with its bands and the study itself."""
    white = " White: not run." if answer.counts.get("not_run") else ""
    return Picture(
        "stability-map", lambda: map_figure(answer), f"Share of the runs that whirl, point by point.{white}"
    )


def map_figure(answer: Part) -> Figure:
    """Return the share of the runs that whirl, where it changes, and what has no verdict."""
    x, y = answer.x, answer.y
    axes = [
        parameter_axis(one.parameter, one.get("unit") or "-", one.get("values"), is_tight=True)
        for one in (x, y)
    ]
    kick = "" if KICK in _names(answer) else said(answer, ", initial disturbance {kick}")
    panel = Panel(
        title=f"Share of the runs that whirl{kick}",
        x=axes[0],
        y=axes[1],
        marks=(*_cells(answer), *_limit(answer), *_changes(answer), *_study(answer)),
    )
    return Figure(
        rows=((panel,),),
        heading=figure_heading(answer, varied=[one.rpartition(".")[2] for one in _names(answer)]),
        alt="Map of the share of runs that whirl over two inputs of the study.",
        height=4.1,
        legend=(sign("|", VERMILION, "begins to whirl between these points"),) if answer.changes else (),
    )


def _cells(answer: Part) -> Iterator[Mark]:
    """Yield the share at each point, that of the nearest one where it was inferred, and what has none."""
    import numpy as np
    from scipy.ndimage import distance_transform_cdt

    x, y = answer.x.get("values"), answer.y.get("values")
    table = np.array(answer.points, dtype=object).reshape(len(x), len(y)).T
    state = np.vectorize(_state)(table)
    share = np.vectorize(lambda one: np.nan if (p := one.probability_whirl) is None else p, "d")(table)
    unknown = np.isnan(share)
    near = distance_transform_cdt(unknown, "chessboard", return_distances=False, return_indices=True)
    shown = np.where(state == "INFERRED", share[tuple(near)], share)
    values = [[None if np.isnan(one) else float(one) for one in row] for row in shown]
    hover = [[_hover(answer, one) for one in row] for row in table]
    label = f"{quantity('probability_whirl').label} [-]"
    yield Cells(x=x, y=y, values=values, label=label, low=0.0, high=1.0, colours="cividis", hover=hover)
    decided = np.vectorize(lambda one: str(one.decision or one.get("inferred_decision")))(table)
    refused = (state == "REFUSED") | ((state == "INFERRED") & (decided == "None"))
    if refused.any():
        yield Hatched(x=x, y=y, where=refused.tolist(), name="refused", strokes="xxxx", fill="#9a9a9a")
    if (undecided := decided == "UNDECIDED").any():
        name = "undecided: the runs, or their drift, allow no verdict"
        yield Hatched(x=x, y=y, where=undecided.tolist(), name=name)
    if (state == "INFERRED").any():
        was_run = [one for one in answer.points if one.runs]
        name = "was run; elsewhere the points around agree"
        at: dict[str, Any] = {"x": [one.x for one in was_run], "y": [one.y for one in was_run]}
        yield Trace(**at, name=name, line="", marker="o", size=2.2, is_open=True, has_halo=True, width=0.5)


def _state(point: Part) -> str:
    """Return what became of a point."""
    return "RUN" if point.runs else str(point.state)


def _hover(answer: Part, point: Part) -> str:
    at = ", ".join(
        f"{quantity(axis.parameter).label} {_value(axis, value)}"
        for axis, value in ((answer.x, point.x), (answer.y, point.y))
    )
    if point.decision is None:
        return f"{at}: {point.reason}"
    share = f"share that whirls {told(point, 'probability_whirl')}, {point.runs} runs"
    return f"{at}: {point.decision}; {share}"


def _changes(answer: Part) -> Iterator[Mark]:
    """Yield a bar at each column from the last point below a change to the first above it."""
    found = answer.get("changes") or []
    if found:
        low = [one.y_low for one in found]
        ends: dict[str, Any] = {"low": low, "high": [one.y_high for one in found]}
        yield Trace(x=[one.x for one in found], y=low, **ends, line="", colour=VERMILION)


def _limit(answer: Part) -> Iterator[Mark]:
    """Yield the linear limit in the plane of restitution factor and friction."""
    if set(_names(answer)) == {FRICTION, RESTITUTION}:
        law = linear_law(2.0 * sqrt(2.0 / answer.cage.ball_count), is_upright=answer.x.parameter == FRICTION)
        yield replace(law, colour=BLACK, has_halo=True)


def _study(answer: Part) -> Iterator[Mark]:
    """Yield the point of the study itself, if the map has it."""
    at = [one.get("here") for one in (answer.x, answer.y)]
    ends = [one.get("values") for one in (answer.x, answer.y)]
    if all(here is not None and one[0] <= here <= one[-1] for here, one in zip(at, ends, strict=True)):
        words = ", ".join(
            f"{quantity(one.parameter).label} {_value(one, one.here)}" for one in (answer.x, answer.y)
        )
        look: dict[str, Any] = {"line": "", "marker": "D", "size": 6.0, "is_open": True, "has_halo": True}
        yield Trace(x=at[:1], y=at[1:], name="the study itself", hover=(f"the study: {words}",), **look)


VERB = Verb(
    name="map",
    options=Options,
    compute=compute,
    page=page,
    needs=("cage",),
    moves_a_cage=True,
    epilog="An axis is a numeric key of the study file with its section, or restitution_factor, "
    "ball_cage_friction, kick: --x cage.pocket_clearance=0.1..1mm --y film.race_friction="
    "0.02..0.3:40:log. Finished runs are kept in the folder of the answer: after Ctrl-C run the same "
    "command to resume. With --json and no --out nothing is kept.",
    keeps_runs=True,
)
