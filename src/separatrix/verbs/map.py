"""`map`: verdicts in the plane of two parameters of a study."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import TYPE_CHECKING, Annotated, Any

from separatrix.ground import errors
from separatrix.ground.plain_data import Document, Part
from separatrix.ground.units import UNITS, format_number
from separatrix.present import quantity_text as q
from separatrix.present.blocks import Column, Heading, Note, Page, Picture, Table, facts, grouped, text_column
from separatrix.present.figure import BLACK, VERMILION, Cells, Figure, Hatched, Mark, Panel, Trace
from separatrix.verbs.parts.answer_page import figure, is_chosen, page_of
from separatrix.verbs.parts.verdict_blocks import linear_law, pocket_friction
from separatrix.verbs.verb import Kick, Option, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import MapAnswer
    from separatrix.verdict.long_jobs import Runner

AXIS = "LOW..HIGH[unit][:N][:log]"
X, Y = "restitution_factor=0..1", "ball_cage_friction=0..0.5"
FRICTION, RESTITUTION, KICK = "ball_cage_friction", "restitution_factor", "kick"

SHOWN = 9
"""Most changes in the table."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Axes of a map, and how its points are run."""

    x: Annotated[str, Option(f"PARAM={AXIS}.", "AXIS")] = X
    y: Annotated[str, Option("Vertical axis, same syntax as --x.", "AXIS")] = Y
    points: Annotated[int, Option("Points per axis, unless the axis states a number.", "N")] = 100
    runs: Annotated[int, Option("Most runs of a point.", "N")] = 16
    kick: Kick = None


def compute(study: Study, options: Options, runner: Runner) -> MapAnswer:
    """Verdicts in the plane of two parameters of a study."""
    from separatrix.cage import settings_for
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import InputError
    from separatrix.verbs.cage_answers import MapAnswer
    from separatrix.verbs.parts import cage_of_study as of
    from separatrix.verdict.parameter_axes import checked_points, read_axis
    from separatrix.verdict.stability_map import MapQuestion, stability_map, value_here

    checked_points(options.points, "--points")
    of.refuse_outside("--runs", options.runs, 1, of.MOST_RUNS)
    axes = [read_axis(text, f"--{way}", options.points) for way, text in (("x", options.x), ("y", options.y))]
    names = [axis.parameter for axis in axes]
    if names[0] == names[1]:
        cure = f"Without --x it is {X}, without --y {Y}."
        raise InputError("--x and --y", "must be two parameters", got=f"{names[0]} twice", cure=cure)
    if options.kick is not None and KICK in names:
        raise InputError("--kick", "and an axis kick exclude each other", cure="Give one of the two.")
    solution = solve(study)
    usual = settings_for(study.stability, of.cage_of(solution)).middle_kick
    speed = usual if options.kick is None else of.kick_speed(options.kick)
    across, up = (replace(axis, here=value_here(solution, axis.parameter)) for axis in axes)
    asked = MapQuestion(study=study, x=across, y=up, kick=speed, runs=options.runs)
    notes = of.extrapolation_notes(solution)
    return of.answer_of_cage(MapAnswer, "map", solution, lambda: stability_map(asked, runner=runner), *notes)


def page(answer: Part) -> Page:
    """Return the page of `map`."""
    refused = [one for one in answer.points if one.get("state") == "REFUSED"]
    sheets = ("points", "changes") if answer.complete else ()  # else there is no workbook
    friction = "" if FRICTION in _names(answer) else pocket_friction(answer)
    return page_of(
        answer,
        Note(" ".join(filter(None, [counted(answer), nearest_words(answer)])), "lead"),
        *(Note(f"The first of the refused points: {one.reason}") for one in refused[:1]),
        *(Note(f"Undecided without a whirl: {one}") for one in undecided(answer)[:1]),
        facts(
            ("Across", _axis_words(answer.x)),
            ("Upward", _axis_words(answer.y)),
            ("Runs", runs_words(answer)),
            ("Pocket friction", friction),
        ),
        Picture("stability-map", lambda: map_figure(answer), "Share of the runs that whirl; white: not run."),
        Heading("Where the cage begins to whirl"),
        bands(answer),
        facts(*unchanged(answer)),
        *(q.all_numbers(name, (), ((one,) for one in answer.get(name) or ())) for name in sheets),
    )


def undecided(answer: Part) -> list[str]:
    """Return why points at which no run whirls are not stable; those that differ in numbers together."""
    known = (one for one in answer.points if one.get("decision") == "UNDECIDED" and not one.whirling)
    return errors.grouped(one.reason for one in known)


def _names(answer: Part) -> tuple[str, str]:
    return answer.x.parameter, answer.y.parameter


def at_point(answer: Document, base: str, x: float, y: float) -> tuple[str, str, dict[str, object]]:
    """Return the point of a map next to a place: in words, as a study that extends `base`, as options.

    Restitution factor and disturbance are not keys of a study: they are options of `simulate`, as the model
    is that the command chose.
    """
    axes = ((answer["x"], x), (answer["y"], y))
    point = {axis["parameter"]: _nearest(axis["values"], place) for axis, place in axes}
    units = {axis["parameter"]: axis["unit"] for axis, _ in axes}
    plain = {name: name.rpartition(".")[2].replace("_", " ") for name in point}
    words = ", ".join(f"{plain[name]} {format_number(value)}" for name, value in point.items())
    model = answer["study"]["cage"].get("model", {})
    options: dict[str, object] = {"model": model["value"]} if is_chosen(model) else {}
    options[KICK] = f"{point.pop(KICK, answer['kick']):.9g} m/s"
    if RESTITUTION in point:
        options[RESTITUTION] = f"{point.pop(RESTITUTION):.9g}"
    keys = {"extends": json.dumps(base), "title": json.dumps(f"{answer['title']}: {words}")}
    for name, value in point.items():
        key = f"cage.{name}" if name == FRICTION else name
        keys[key] = f'"{value:.9g} {units[name]}"' if units[name] in UNITS else f"{value:.9g}"
    return words, "".join(f"{key} = {value}\n" for key, value in keys.items()), options


def _nearest(values: Sequence[float], place: float) -> float:
    return min(values, key=lambda one: abs(one - place))


def counted(answer: Part) -> str:
    """Return of how many points the cage is stable, unstable, and what became of the others."""
    each = [f"{n} {kind.replace('_', ' ')}" for kind, n in answer.counts.values.items() if n]
    return f"Of {len(answer.points)} points {', '.join(each)}."


def _value(axis: Part, value: float | None) -> str:
    return q.value_of(axis, axis.parameter, value).text


def _axis_words(axis: Part) -> str:
    values = axis.get("values")
    here = f"; the study has {_value(axis, axis.here)}" if "here" in axis else ""
    ends = f"{q.at(axis, axis.parameter, values[0])} to {_value(axis, values[-1])}"
    return f"{ends}, {len(values)} values{here}"


def nearest_words(answer: Part) -> str:
    """Return the point next to the study, and where its column changes; empty if the map is elsewhere."""
    x, y = answer.x, answer.y
    if not (_has_here(x) and _has_here(y)):
        return ""
    place = tuple(_nearest(one.get("values"), one.here) for one in (x, y))
    point = next(one for one in answer.points if (one.x, one.y) == place)
    words = f"The point next to the study: {_hover(answer, point)}."
    for one in answer.get("changes") or ():
        if one.x == point.x:
            does = "begins" if one.whirls_above else "ceases"
            ends = f"{q.at(y, y.parameter, one.y_low)} and {_value(y, one.y_high)}"
            words += f" In this column the cage {does} to whirl between {ends}."
    return words


def _has_here(axis: Part) -> bool:
    """Whether the study's own value is on an axis."""
    values = axis.get("values")
    return "here" in axis and bool(values[0] <= axis.here <= values[-1])


def runs_words(answer: Part) -> str:
    """Return how many runs a point has, of which length, from which disturbance."""
    words = q.fill(
        answer.stopping,
        "up to {most_runs}, stopped after {agreeing_runs} that agree (risk of the wrong side "
        "{wrong_side_probability}, of another decision {other_decision_probability})",
    )
    kick = "" if KICK in _names(answer) else q.fill(answer, ", from an initial disturbance of {kick}")
    return f"{words}, each of {q.show(answer, 'duration')}{kick}"


def bands(answer: Part) -> Table:
    """Return where the answer changes, in some columns of the map; a workbook has all."""
    every = answer.get("changes") or []

    def of(axis: Part, name: str, head: str) -> Column:
        return Column(head, lambda change: q.value_of(axis, axis.parameter, change.get(name)))

    x, y = (q.quantity(name).label for name in _names(answer))
    columns = (
        of(answer.x, "x", x),
        of(answer.y, "y_low", f"{y} from"),
        of(answer.y, "y_high", "to"),
        text_column("whirls", lambda change: "above" if change.whirls_above else "below"),
        of(answer.y, "margin", "margin"),
    )
    step = max(1.0, (len(every) - 1) / (SHOWN - 1))
    chosen = tuple(every[round(i * step)] for i in range(min(SHOWN, len(every))))
    part = f"{SHOWN} of {len(every)} places; map.json has all. " if len(every) > SHOWN else ""
    return Table("bands", columns, chosen, part + LEGEND)


def unchanged(answer: Part) -> Iterator[tuple[str, str]]:
    """Yield at which values of x the cage whirls at no point, or at every one, beyond the scatter."""
    changed = {one.x for one in answer.get("changes") or ()}
    known = grouped((one.x, one) for one in answer.points if one.runs and one.x not in changed)
    calm = [x for x, along in known.items() if all(one.probability_high < 0.5 for one in along)]
    wild = [x for x, along in known.items() if all(one.probability_low > 0.5 for one in along)]
    for words, found in (("Whirls nowhere", calm), ("Whirls everywhere", wild)):
        if found:
            values = ", ".join(_value(answer.x, x) for x in found[:SHOWN])
            yield words, f"at {values}" + ", ..." * (len(found) > SHOWN)


LEGEND = (
    "Between the last point of a column at which, beyond the scatter, less than half of the runs whirl and "
    "the first at which more than half do. Margin: distance of the study's own value to that band, positive "
    "where the cage settles."
)


# The picture.


def map_figure(answer: Part) -> Figure:
    """Return the share of the runs that whirl, where it changes, and what has no verdict."""
    axes = [(one.parameter, one.get("unit") or "-", one.get("values")) for one in (answer.x, answer.y)]
    x, y = (q.parameter_axis(*one, is_tight=True) for one in axes)
    kick = "" if KICK in _names(answer) else q.fill(answer, ", initial disturbance {kick}")
    marks = (*_cells(answer), *_overlays(answer))
    panel = Panel(title=f"Share of the runs that whirl{kick}", x=x, y=y, marks=marks)
    return figure(answer, (panel,), height=4.1, varied=_names(answer))


def _cells(answer: Part) -> Iterator[Mark]:
    """Yield the share at each point, and what has none."""
    x, y = answer.x.get("values"), answer.y.get("values")
    table = [answer.points[i :: len(y)] for i in range(len(y))]
    label = f"{q.quantity('probability_whirl').label} [-]"
    values = [[one.probability_whirl for one in row] for row in table]
    hover = [[_hover(answer, one) for one in row] for row in table]
    yield Cells(x=x, y=y, values=values, label=label, low=0.0, high=1.0, colours="cividis", hover=hover)
    refused = [[one.get("state") == "REFUSED" for one in row] for row in table]
    undecided = [[one.decision == "UNDECIDED" for one in row] for row in table]
    if any(map(any, refused)):
        yield Hatched(x=x, y=y, where=refused, name="refused", strokes="xxxx", fill="#9a9a9a")
    if any(map(any, undecided)):
        yield Hatched(x=x, y=y, where=undecided, name="undecided: the runs, or their drift, allow no verdict")


def _hover(answer: Part, point: Part) -> str:
    both = ("x", answer.x), ("y", answer.y)
    place = ", ".join(q.at(one, one.parameter, point.get(way)) for way, one in both)
    if point.decision is None:
        return f"{place}: {point.reason}"
    share = f"share that whirls {q.show(point, 'probability_whirl')}, {point.runs} runs"
    return f"{place}: {point.decision}; {share}"


def _overlays(answer: Part) -> Iterator[Mark]:
    """Yield the linear limit, a bar from each point below a change to that above, and the study."""
    x, y, found = answer.x, answer.y, answer.get("changes")
    if set(_names(answer)) == {FRICTION, RESTITUTION}:
        damped = [(0.0, 2.0 * sqrt(2.0 / answer.cage.ball_count))]
        law = linear_law(damped, is_upright=x.parameter == FRICTION)
        yield replace(law, name=f"{law.name}, balls as dampers", colour=BLACK, has_halo=True)
    if found:
        place, low, high = ([one.get(name) for one in found] for name in ("x", "y_low", "y_high"))
        middle = [0.5 * (one.y_low + one.y_high) for one in found]
        bar: dict[str, Any] = {"line": "", "marker": "|", "colour": VERMILION, "low": low, "high": high}
        yield Trace(x=place, y=middle, name="begins to whirl between these points", **bar)
    if _has_here(x) and _has_here(y):
        look: dict[str, Any] = {"line": "", "marker": "D", "size": 6.0, "is_open": True, "has_halo": True}
        yield Trace(x=[x.here], y=[y.here], name="the study itself", **look)


VERB = Verb(
    name="map",
    compute=compute,
    page=page,
    options=Options,
    needs=("cage",),
    moves_a_cage=True,
    epilog="An axis is a numeric key of the study file with its section, or restitution_factor, "
    "ball_cage_friction, kick: --x cage.pocket_clearance=0.1..1mm --y film.race_friction="
    "0.02..0.3:40:log. Finished runs are kept in the folder of the answer: after Ctrl-C run the same "
    "command to resume. With --json and no --out nothing is kept.",
    keeps_runs=True,
    links=("cage_motion",),
)
