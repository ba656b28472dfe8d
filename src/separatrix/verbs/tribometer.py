"""`tribometer`: logs of friction tests to the friction of their materials, with its scatter."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from separatrix.ground.document import Document, Part
from separatrix.ground.quantity import ABSENT, Estimate, Quantity, alone
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
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    Across,
    Axis,
    Band,
    Figure,
    Panel,
    Trace,
)
from separatrix.verbs.parts.telling import axis, column, quantity, told
from separatrix.verbs.verb import Option, Tool

if TYPE_CHECKING:
    from separatrix.friction.friction_fit import MaterialFit
    from separatrix.friction.log_series import Progress, ReducedLogs
    from separatrix.friction.logs.log import RawLog
    from separatrix.friction.reduction import Reduction


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What `tribometer` takes."""

    files: Annotated[
        tuple[Path, ...],
        Option("Raw tribometer logs, or folders of them; the format is detected.", "FILES...", True),
    ]
    column_map: Annotated[
        Path | None, Option("Column map (TOML) for what the logs do not state.", "FILE", flag="--map")
    ] = None
    run_in: Annotated[
        str | None, Option('Where running-in ends, for instance "200 m" [default: found].', "END")
    ] = None
    join: Annotated[bool, Option("The logs of one folder are strokes or parts of one test.")] = False


AXIS_UNITS = {"time": "s", "distance": "m", "cycles": "-"}
RATE_UNITS = {"time": "1/s", "distance": "1/m", "cycles": "-"}
ALONG = ("run_in_end", "steady_end", "along", "span_along", "lag", "correlation_length")
RATES = ("drift_rate", "drift_error", "stick_slip_frequency")
"""Quantities whose unit is that of the abscissa of their test, and one over it."""

FRICTION = Quantity(label="friction", digits=4)
"""Of a test: elsewhere the name is that of the friction in a pocket, of which fewer digits matter."""

EXPONENT, DRIFT = Quantity(label="exponent", form=".3f"), Quantity(label="drift", form=".2e")

MINUTES = (3600.0 * 3, 60.0 * 3)
"""Times from which a test is told in hours, and in minutes [s]."""

BESIDE = ("normal_force", "temperature", "slip_speed", "wear_depth")
"""What is drawn below friction if the log has it; three of them at most."""

LEGEND = "friction: mean of the steady part, with its 95 % interval, allowing for autocorrelation."
FIT_LEGEND = (
    "friction: of the material, at the middle of its tested conditions. standard error: of that. scatter: "
    "standard deviation of a new sample about it."
)
WIDTH = 128
"""Letters on a line above a figure."""


def reduced(
    options: Options, jobs: int = 1, progress: Progress | None = None, *, complete: bool = False
) -> ReducedLogs:
    """Read and reduce logs; `complete` refuses a test that a friction file cannot keep.

    Raises
    ------
    InputError
        A file is wrong: the first one, and how many others are; an `UnmappedError` with a draft of a column
        map if one is needed.
    """
    from separatrix.friction.friction_file import place
    from separatrix.friction.log_series import tribometer

    if options.run_in is not None:
        place(options.run_in, "--run-in")
    return tribometer(
        options.files,
        column_map=options.column_map,
        run_in=options.run_in,
        join=options.join,
        complete=complete,
        jobs=jobs,
        progress=progress,
    )


def compute(options: Options, jobs: int = 1, progress: Progress | None = None) -> Document:
    """Friction of each test, and of each material over all of its tests."""
    return document(reduced(options, jobs, progress))


def document(found: ReducedLogs, written: str | None = None) -> Document:
    """Return the answer as plain data, in SI units; `written` is the friction file made from it."""
    from separatrix import __version__
    from separatrix.friction.friction_file import CONDITIONS, PRODUCT
    from separatrix.ground.plain_data import plain, units_of

    fit = found.fit
    nodes = [_test(one) for one in found.reductions]
    tested = {**CONDITIONS, PRODUCT: "Pa m/s"}
    return {
        "separatrix_version": __version__,
        "verb": "tribometer",
        "friction_file": written,
        "notes": list(found.notes),
        "files": [_file(log) for log in found.logs],
        "tests": [plain(one, "test") for one in nodes],
        "fits": [_fit(*key, one) for key, one in fit.groups.items()] if fit else [],
        "components": None if fit is None else plain(fit.components(), "components"),
        "default_scatter": None if fit is None else fit.default_scatter,
        "units": {"tests": units_of(nodes[0]), "fits": {"tested": tested}},
    }


def _test(one: Reduction) -> Any:
    """Return a test as a node: its numbers, their interval, and its course."""
    from separatrix.friction.test_course import course
    from separatrix.ground.plain_data import Group, Leaf, shape

    low, high = one.test.interval
    ends = {"friction_low": Leaf(low, "-"), "friction_high": Leaf(high, "-")}
    return Group(shape(one.test) | ends | {"course": Group(shape(course(one)))})


def _file(log: RawLog) -> Document:
    from separatrix.friction.logs import described
    from separatrix.ground.plain_data import plain

    known = {name: plain(getattr(log, name)) for name in ("source", "checksum", "format", "rows", "missing")}
    known |= {"columns": plain(log.columns), "metadata": dict(log.metadata), "notes": list(log.notes)}
    return known | {"described": described(log)}


def _fit(material: str, environment: str, one: MaterialFit) -> Document:
    from separatrix.ground.plain_data import plain

    at = one.at()  # the centre of its tested conditions
    return {
        "material": material,
        "environment": environment,
        "tests": len(one.tests),
        "friction": at.mean,
        "standard_error": at.standard_error,
        "standard_deviation": at.standard_deviation,
        "scatter_source": one.scatter_source,
        "slopes": plain(one.slopes, "slope"),
        "tested": plain(one.ranges, "tested"),
        "notes": list(one.covariates.notes),
    }


# --- the page -----------------------------------------------------------------------------------
def page(answer: Part) -> Page:
    """Return the page of `tribometer`."""
    tests = [_with_axis(one) for one in answer.tests]
    flags = list(dict.fromkeys(flag for one in tests for flag in one.flags))
    kept = f"{answer.friction_file} is written; a study reads it with `[ranking] friction`."
    several = "s"[: len(tests) != 1]
    return Page(
        f"Friction of {len(tests)} test{several} of a tribometer",
        f"Computed by separatrix {answer.separatrix_version}",
        (
            *(Note(one, "lead") for one in _lead(answer, tests)),
            Heading("Tests"),
            _table(tests, flags),
            *(Note(f"{i}: {flag}", "legend") for i, flag in enumerate(flags, 1)),
            Note(LEGEND, "legend"),
            *_numbers(tests),
            *_fits(answer),
            Heading("What was read"),
            *_read(answer, tests),
            *(Note(one, "caveat") for one in answer.notes),
            Note(kept if "friction_file" in answer else "Nothing written; use `--out friction.toml`."),
            Heading("Course of each test", Level.REPORT),
            *(_picture(one) for one in tests),
        ),
    )


def _with_axis(test: Part) -> Part:
    """Return a test with the units of what lies along its abscissa."""
    along = dict.fromkeys(ALONG, AXIS_UNITS[test.run_in_axis])
    units = {**test.units, **along, **dict.fromkeys(RATES, RATE_UNITS[test.run_in_axis])}
    course = {**test.units.get("course", {}), **along}
    return Part(test.values, units | {"course": course}, test.where)


def _along(test: Part, name: str) -> Cell:
    """Return a place along a test, in the unit that suits the test."""
    known = quantity(name)
    if test.run_in_axis == "time":
        hours, minutes = MINUTES
        end = test.steady_end
        known = replace(known, unit="h" if end >= hours else "min" if end >= minutes else "")
    mark = " cycles" if test.run_in_axis == "cycles" else ""
    return Cell(test.get(name), known, test.unit(name), mark)


def _lead(answer: Part, tests: Sequence[Part]) -> Iterator[str]:
    """Yield the answer: friction of each material, or of the tests."""
    if answer.fits:
        for one in answer.fits:
            several = "s"[: one.tests != 1]
            error, scatter = (told(one, name) for name in ("standard_error", "standard_deviation"))
            yield (
                f"{one.material}, {one.environment}: friction {_friction(one).text} from {one.tests} "
                f"test{several} (standard error {error}, scatter of a new sample {scatter})."
            )
        return
    if len(tests) == 1:
        yield f"{tests[0].source}: steady friction {_summary(tests[0])}."
        return
    ends = [choose(tests, key=lambda one: one.friction) for choose in (min, max)]
    low, high = (alone(one.friction, FRICTION, "-") for one in ends)
    yield f"Steady friction of the tests lies between {low} and {high}."


def _summary(test: Part) -> str:
    start, end = (_along(test, name).text for name in ("run_in_end", "steady_end"))
    return f"{_friction(test).text} from {start} to {end} of the test"


def _friction(one: Part) -> Cell:
    """Return the friction of a test with its interval, or of a material."""
    return Cell(Estimate(one.friction, one.get("friction_low"), one.get("friction_high")), FRICTION)


def _table(tests: Sequence[Part], flags: Sequence[str]) -> Table:
    def known(*names: str) -> Any:
        return lambda one: ", ".join(one.conditions.get(name) or ABSENT for name in names)

    def numbers(one: Part) -> str:
        return ", ".join(str(flags.index(flag) + 1) for flag in one.flags) or ABSENT

    def stated(*names: str) -> bool:
        return any(name in one.conditions for one in tests for name in names)

    def conditions(one: Part) -> Part:
        return one.conditions  # type: ignore[no-any-return]

    pair, loads = ("medium", "counterface"), ("slip_speed", "pressure")
    columns = (
        text_column("test", lambda one: one.source),
        *([text_column("material", known("material"))] if stated("material") else []),
        *([text_column(", ".join(pair), known(*pair))] if stated(*pair) else []),
        *(column(name, of=conditions, head=_plain(name)) for name in loads if stated(name)),
        Column("friction", _friction),
        Column("running-in ends", lambda one: _along(one, "run_in_end")),
        text_column("notes", numbers),
    )
    return Table("tests", columns, tuple(tests))


def _numbers(tests: Sequence[Part]) -> Iterator[Block]:
    """Yield what the friction of each test was made from, and what else its log shows."""
    names = ("standard_error", "degrees_of_freedom", "standard_deviation", "effective_count")
    counts = ("steady_rows", "rows", "cycles")
    test = text_column("test", lambda one: one.source)
    first = (
        test,
        *map(column, names),
        Column("steady until", lambda one: _along(one, "steady_end")),
        *map(column, counts),
    )
    caption = "scatter: standard deviation of the means of whole cycles, of rows where no cycle is known."
    yield Table("numbers", first, tuple(tests), caption, Level.LONG)
    for method in dict.fromkeys(one.run_in_method for one in tests):
        yield Note(f"End of running-in: {method}.", "legend", Level.LONG)
    rates = [_drift("drift", "drift_rate"), _drift("standard error", "drift_error")]
    rates.append(column("stick_slip_amplitude"))
    caption = "Drift, and the strongest oscillation that is not the cycle's; 0 if none exceeds the noise."
    second = (test, *rates, column("stick_slip_frequency"))
    for unit, rows in grouped((RATE_UNITS[one.run_in_axis], one) for one in tests).items():
        per = caption if unit != "-" else f"{caption} Rates are per cycle."
        yield Table(f"rates {unit}".replace("/", " per "), second, tuple(rows), per, Level.LONG)


def _drift(head: str, name: str) -> Column:
    return Column(head, lambda test: Cell(test.get(name), DRIFT, test.unit(name)))


def _fits(answer: Part) -> Iterator[Block]:
    if not answer.fits:
        return
    yield Heading("Friction of the materials")
    columns = (
        text_column("material", lambda one: one.material),
        text_column("environment", lambda one: one.environment),
        text_column("tests", lambda one: str(one.tests)),
        Column("friction", _friction),
        column("standard_error"),
        column("standard_deviation", head="scatter of a sample"),
        text_column("rests on", lambda one: one.scatter_source),
    )
    yield Table("materials", columns, tuple(answer.fits))
    yield Note(FIT_LEGEND, "legend")
    for one in answer.fits:
        place = f"{one.material}, {one.environment}"
        yield from (Note(f"{place}: {slope}.") for slope in _slopes(one))
        yield from (Note(f"{place}: {note}.") for note in one.notes)
    if "components" not in answer:
        share = told(answer, "default_scatter")
        yield Note(f"No test was repeated: each is assumed to scatter by {share} of its mean, a guess.")
        return
    found = answer.components
    tests = (
        f", between tests of one sample {told(found, 'between_tests')}" if "between_tests" in found else ""
    )
    samples = f"between samples {told(found, 'between_samples')}"
    yield Note(f"Scatter over all materials, by restricted maximum likelihood: {samples}{tests}.")


def _slopes(fit: Part) -> Iterator[str]:
    words = {"slip_speed": "slip speed", "pressure": "pressure", "pressure_velocity": "pV"}
    for name in fit.slopes.values:
        slope, limits = fit.slopes.get(name), fit.tested.get(name)
        power = alone(Estimate(slope.value, slope.low, slope.high), EXPONENT, "-")
        span = ""
        if limits and name in ("slip_speed", "pressure"):
            low, high = (alone(one, quantity(name), fit.tested.unit(name)) for one in limits)
            span = f" from {low} to {high}"
        yield f"friction goes as {words[name]} to the power {power}{span}"


def _read(answer: Part, tests: Sequence[Part]) -> Iterator[Block]:
    """Yield how the logs were understood: those that were read alike together."""
    alike = grouped(
        ((file.format, str(file.values["columns"])), (file, test))
        for file, test in zip(answer.files, tests, strict=True)
    )
    for number, pairs in enumerate(alike.values()):
        file = pairs[0][0]
        names = [one.source for one, _ in pairs]
        also = f" and {len(names) - 1} more" if names[1:] else ""
        unused = [one for one in file.columns if one.meaning is None and one.header]
        idle = [f'"{one.header}"' for one in unused if one.why == "not needed"]
        yield facts(
            ("Log", f"{names[0]}{also}: {file.format}, {_rows(file)}"),
            ("Conditions", "; ".join(_conditions(pairs[0][1])) or "none known"),
            ("Columns not used", ", ".join(idle)),
        )
        columns = (
            text_column("column", lambda one: f'"{one.header}"'),
            text_column("taken as", lambda one: (one.meaning or "not used").replace("_", " ")),
            text_column("unit", lambda one: one.get("unit") or ABSENT),
            text_column("because of", lambda one: one.why),
        )
        taken = tuple(one for one in file.columns if one.meaning or one.why != "not needed")
        yield Table(f"columns {number + 1}", columns, taken)
        notes = list(dict.fromkeys(note for one, _ in pairs for note in one.notes))
        shown = notes if len(pairs) == 1 else [one for one in notes if one in pairs[0][0].notes]
        yield from (Note(f"{one[:1].upper()}{one[1:]}.", "legend") for one in shown)
    rows = tuple(answer.files)
    sums = (text_column("log", lambda one: one.source), text_column("SHA-256", lambda one: one.checksum))
    yield Table("logs", (*sums, column("rows")), rows, "Logs and their checksums.", Level.LONG)


def _rows(file: Part) -> str:
    missing = f", {file.missing} of them without a value" if file.missing else ""
    return f"{file.rows} rows{missing}"


def _conditions(test: Part) -> Iterator[str]:
    """Yield material, counterface, medium and loads of a test, as far as they are known."""
    known = test.conditions
    pair = " on ".join(known.get(name) for name in ("material", "counterface") if name in known)
    yield from filter(None, (pair, known.get("medium")))
    yield from (f"{name} {known.get(name)}" for name in ("sample", "test") if name in known)
    for name in ("temperature", "slip_speed", "pressure", "normal_force", "cycle_time"):
        if name in known:
            yield f"{_plain(name)} {told(known, name)}"


def _plain(name: str) -> str:
    """Return the words of a condition: those of its key, not of a ball in a pocket."""
    return "mean pressure" if name == "pressure" else name.replace("_", " ")


# --- the figure of a test -----------------------------------------------------------------------
def _picture(test: Part) -> Picture:
    caption = f"{test.source}: friction along the test, its distribution, the correlation of its means."
    return Picture(file_name(test.source), lambda: _figure(test), caption)


def file_name(source: str) -> str:
    """Name of a test as the name of a file: letters, digits, dots and dashes."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in source)
    return "-".join(part for part in plain.split("-") if part).strip(".-")[:100] or "test"


def _figure(test: Part) -> Figure:
    course = test.course
    beside = [name for name in BESIDE if name in course][:3]
    last = tuple(_beside(test, name, letter) for name, letter in zip(beside, "def", strict=False))
    facts_of = "; ".join(_conditions(test))
    error, scatter = (told(test, name) for name in ("standard_error", "standard_deviation"))
    of = f"{told(test, 'cycles')} whole cycles" if test.cycles else f"{told(test, 'steady_rows')} rows"
    numbers = (
        f"Friction {_summary(test)}; standard error {error}; scatter {scatter} of {of}, "
        f"worth {told(test, 'effective_count')} independent ones"
    )
    lines = [line for one in (test.source, facts_of, numbers) for line in textwrap.wrap(one, WIDTH)[:3]]
    first = (_course_panel(test),), (_distribution(test), _correlation(test))
    return Figure(
        rows=(*first, last) if last else first,
        heading=tuple(lines),
        alt="Friction along the test with its steady part, the distribution of its rows, and the "
        "autocorrelation of its means; the tables have the numbers.",
        height=2.0,
    )


def _axis_along(test: Part, low: float, high: float, label: str = "") -> Axis:
    """Return the abscissa of a test, or of distances along it."""
    size, symbol = _along(test, "steady_end").scale
    name = {"time": "time", "distance": "sliding distance", "cycles": "cycles"}[test.run_in_axis]
    return Axis(label=f"{label or name} [{symbol or '-'}]", size=size, low=low, high=high)


def _course_panel(test: Part) -> Panel:
    """Return friction along the test, the parts left out, means of spans and the steady mean."""
    course, start, end = test.course, test.run_in_end, test.steady_end
    first, last = course.along[0], max(course.along[-1], end)
    low, high = min(course.low), max(course.high)
    low = min(low, 0.0) if low < 0.5 * high else low
    room = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    low, high = (low if low == 0.0 else low - room), high + room
    outside = [(a, b) for a, b in ((first, start), (end, last)) if b - a > 2e-3 * (last - first)]
    drift = test.drift_rate * (end - start) / 2
    mean, around, ends = test.friction, (test.friction_low, test.friction_high), (start, end)
    return Panel(
        title="a  Friction along the test",
        x=_axis_along(test, first, last),
        y=Axis(label="friction [-]", low=low, high=high),
        marks=(
            *(Band(x=one, low=(low, low), high=(high, high), colour=GREY, opacity=0.18, name="left out")
              for one in outside),
            Band(x=course.along, low=course.low, high=course.high, colour=SKY, name="range of rows"),
            Trace(x=course.along, y=course.mean, colour=BLUE, width=0.6),
            Trace(x=course.span_along, y=course.span_mean, colour=BLUE, line="", marker="o", size=1.2,
                  name=f"means of {_spans(course)}"),
            Band(x=ends, low=(around[0],) * 2, high=(around[1],) * 2, colour=VERMILION, opacity=0.2),
            Trace(x=ends, y=(mean, mean), colour=VERMILION, name="steady mean, 95 % interval"),
            Trace(x=ends, y=(mean - drift, mean + drift), colour=GREEN, line="--", width=0.9, name="drift"),
        ),
    )  # fmt: skip


def _spans(course: Part) -> str:
    count = course.span_cycles
    return (
        f"{alone(count, Quantity(label='', digits=2), '-')} cycle{'s'[: count != 1.0]}" if count else "spans"
    )


def _distribution(test: Part) -> Panel:
    course, mean = test.course, test.friction
    most = max([*course.row_share, *(course.get("cycle_share") or ())])
    marks: list[Any] = [_steps(course.edges, course.row_share, colour=SKY, line="", fill=0.6)]
    if "cycle_share" in course:
        marks.append(_steps(course.edges, course.cycle_share, colour=BLUE, width=1.0, name="whole cycles"))
    ends = (test.friction_low, test.friction_high)
    marks.append(Band(x=ends, low=(0.0, 0.0), high=(1.05 * most,) * 2, colour=VERMILION, opacity=0.2))
    marks.append(Across(at=mean, colour=VERMILION))
    return Panel(
        title="b  Distribution of the rows in the steady part",
        x=Axis(label="friction [-]", most_ticks=6),
        y=axis("row_share", "-", [most], low=0.0, high=1.05 * most),
        marks=tuple(marks),
    )


def _steps(edges: Sequence[float], values: Sequence[float], **look: Any) -> Trace:
    """Return the outline of a histogram."""
    x = [one for edge in edges for one in (edge, edge)]
    return Trace(x=x, y=[0.0, *(one for value in values for one in (value, value)), 0.0], **look)


def _correlation(test: Part) -> Panel:
    """Return the correlation of spans against their distance, with the length from the spectrum."""
    course = test.course
    lag, bound, length = course.lag, course.noise_correlation, course.correlation_length
    zero = [0.0] * len(lag)
    low, high = zip(*(sorted((0.0, one)) for one in course.correlation), strict=True)
    marks: list[Any] = [
        Band(x=(0.0, lag[-1]), low=(-bound,) * 2, high=(bound,) * 2, colour=PURPLE, opacity=0.2,
             name="95 % of white noise"),
        Trace(x=lag, y=zero, low=low, high=high, line="", colour=BLUE),
    ]  # fmt: skip
    if lag[1] / 4 < length <= lag[-1]:
        marks.append(Across(at=length, colour=ORANGE, name="correlation length"))
    return Panel(
        title="c  Autocorrelation of the means",
        x=_axis_along(test, 0.0, lag[-1], "lag"),
        y=Axis(label="autocorrelation [-]", low=min(-1.3 * bound, *low) - 0.05, high=1.05),
        marks=tuple(marks),
    )


def _beside(test: Part, name: str, letter: str) -> Panel:
    """Return a condition along the test, with the ends of the steady part."""
    course = test.course
    values = course.get(name)
    ends = (Across(at=one, colour=GREY, line="--") for one in (test.run_in_end, test.steady_end))
    return Panel(
        title=f"{letter}  {_plain(name).capitalize()}",
        x=_axis_along(test, course.along[0], max(course.along[-1], test.steady_end)),
        y=axis(name, course.unit(name), values, label=_plain(name)),
        marks=(Trace(x=course.along, y=values, colour=BLUE, width=0.8), *ends),
    )


VERB = Tool(
    name="tribometer",
    epilog="What is read is shown before it is trusted: without --out nothing is written. A file that exists "
    "is never overwritten.",
    compute=compute,
    page=page,
    options=Options,
    rows="tests",
    takes_time=True,
    has_full=True,
)
