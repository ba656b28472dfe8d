"""`tribometer`: logs of friction tests to the friction of their materials, with its scatter."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import attrgetter
from pathlib import Path
from statistics import fmean, stdev
from typing import TYPE_CHECKING, Annotated, Any

from separatrix import __version__
from separatrix.ground.errors import InputError
from separatrix.ground.files import refuse_existing, staged, writable_folder
from separatrix.ground.plain_data import Document, Group, Leaf, Part, plain, shape, units_of
from separatrix.ground.quantity import ABSENT, Estimate, Quantity, alone
from separatrix.ground.units import shown
from separatrix.present import figure as fig
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
from separatrix.present.quantity_text import begun, column, fill, itself, known_columns, quantity
from separatrix.verbs.verb import Option, Tool

if TYPE_CHECKING:
    from separatrix.friction.friction_fit import MaterialFit
    from separatrix.friction.log_series import Progress, ReducedLogs
    from separatrix.friction.reduction import Reduction


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What `tribometer` takes."""

    files: Annotated[tuple[Path, ...], Option("Logs, or folders; the format is detected.", "FILES...", True)]
    column_map: Annotated[Path | None, Option("Column map (TOML) of the logs.", "FILE", flag="--map")] = None
    run_in: Annotated[str | None, Option('Where running-in ends: "200 m" [default: found].', "END")] = None
    join: Annotated[bool, Option("The logs of one folder are strokes or parts of one test.")] = False
    out: Annotated[Path | None, Option("Friction file (.toml) to write [default: none].", "FILE")] = None


UNITS = {"time": ("s", "1/s"), "distance": ("m", "1/m"), "cycles": ("-", "-")}
ALONG = ("run_in_end", "steady_end", "along", "span_along")
RATES = ("drift_rate", "drift_error")
"""Quantities whose unit is that of the abscissa of their test, and one over it."""

FRICTION = Quantity(label="friction", digits=4)
"""Of a test: elsewhere the name is that of the friction in a pocket, of which fewer digits matter."""

EXPONENT = Quantity(label="exponent", form=".3f")

LEGEND = "Friction: mean of the steady part, with its 95 % interval, allowing for autocorrelation."
NUMBERS = (
    "Scatter: standard deviation of the means of whole cycles, of rows where no cycle is known. Drift: of "
    "the steady part."
)
COURSE = "Friction along the test with its steady part; the tables have the numbers."
FIT_LEGEND = (
    "Friction of the material at the middle of its tested conditions, with its standard error. Scatter: "
    "standard deviation of a new sample about it."
)


def reduced(
    options: Options, jobs: int = 1, progress: Progress | None = None, *, complete: bool = False
) -> ReducedLogs:
    """Read and reduce logs; `complete` refuses a test that a friction file cannot keep.

    An InputError names the first wrong file and how many others are; one whose columns are not known is an
    `UnmappedError`, with a draft of a column map.
    """
    from separatrix.friction.friction_file import place
    from separatrix.friction.log_series import tribometer

    if options.run_in is not None:
        place(options.run_in, "--run-in")
    how: dict[str, Any] = {name: getattr(options, name) for name in ("column_map", "run_in", "join")}
    return tribometer(options.files, **how, complete=complete, jobs=jobs, progress=progress)


def compute(options: Options, jobs: int = 1, progress: Progress | None = None) -> Document:
    """Friction of each test, and of each material over all of its tests; writes its friction file, if asked.

    A log whose columns are not known gets a draft of a column map beside it.
    """
    from separatrix.friction.friction_file import friction_text
    from separatrix.friction.logs import UnmappedError

    out = options.out
    with contextlib.ExitStack() as stack:
        if out is not None:
            if out.suffix != ".toml" or os.path.isdir(out):
                cure = 'Name a file like "friction.toml".'
                raise InputError("--out", "must name a file that ends in .toml", shown(str(out)), cure)
            refuse_existing(out)
            stack.enter_context(writable_folder(out.parent))
        try:
            found = reduced(options, jobs, progress, complete=out is not None)
        except UnmappedError as error:
            raise error.with_draft_written() from None
        if out is not None and found.friction_tests is not None:
            with staged(out.parent) as stage:
                (stage / out.name).write_text(friction_text(found.friction_tests), encoding="utf-8")
                refuse_existing(out)  # it may have been made since the first check
    return document(found, None if out is None else str(out))


def document(found: ReducedLogs, written: str | None = None) -> Document:
    """Return the answer as plain data, in SI units; `written` is the friction file made from it."""
    from separatrix.friction.friction_file import CONDITIONS, PRODUCT

    fit = found.fit
    nodes = [_test(one) for one in found.reductions]
    tested = {**CONDITIONS, PRODUCT: "Pa m/s"}
    return {
        "separatrix_version": __version__,
        "verb": "tribometer",
        "friction_file": written,
        "notes": list(found.notes),
        "files": [{name: plain(getattr(log, name)) for name in OF_A_LOG} for log in found.logs],
        "tests": [plain(one, "test") for one in nodes],
        "fits": [_fit(*key, one) for key, one in fit.groups.items()] if fit else [],
        "default_scatter": None if fit is None else fit.default_scatter,
        "units": {"tests": units_of(nodes[0]), "fits": {"tested": tested}},
    }


def _test(one: Reduction) -> Any:
    """Return a test as a node: its numbers, their interval, and its course."""
    from separatrix.friction.reduction import course

    low, high = one.test.interval
    ends = {"friction_low": Leaf(low, "-"), "friction_high": Leaf(high, "-")}
    node = shape(one.test)
    del node["wear"]
    return Group(node | shape(one.test.wear) | ends | {"course": Group(shape(course(one)))})


OF_A_LOG = ("source", "checksum", "format", "rows", "missing", "columns", "notes")


def _fit(material: str, environment: str, one: MaterialFit) -> Document:
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
    methods = dict.fromkeys(one.run_in_method for one in tests)
    kept = f"{answer.friction_file} is written; a study reads it with `[ranking] friction`."
    return Page(
        f"Friction of {_count(len(tests), 'test')} of a tribometer",
        f"Computed by separatrix {answer.separatrix_version}",
        (
            *(Note(one, "lead") for one in _lead(answer, tests)),
            Heading("Tests"),
            _table(tests, flags),
            *(Note(f"{i}: {flag}", "legend") for i, flag in enumerate(flags, 1)),
            _numbers(tests),
            *(Note(f"End of running-in: {one}.", "legend", Level.LONG) for one in methods),
            *(_fits(answer) if answer.fits else ()),
            Heading("What was read"),
            *_read(answer),
            *(Note(one, "caveat") for one in answer.notes),
            Note(kept if "friction_file" in answer else "Nothing written; use `--out friction.toml`."),
            Heading("Course of each test", Level.REPORT),
            *(Picture(file_name(one.source), partial(_figure, one), COURSE) for one in tests),
        ),
    )


def _count(number: int, name: str) -> str:
    return f"{number} {name}{'s'[: number != 1]}"


def _with_axis(test: Part) -> Part:
    """Return a test with the units of what lies along its abscissa."""
    length, rate = UNITS[test.run_in_axis]
    along = dict.fromkeys(ALONG, length)
    units = {**test.units, **along, **dict.fromkeys(RATES, rate)}
    course = {**test.units.get("course", {}), **along}
    return Part(test.values, units | {"course": course}, test.where)


def _along(test: Part, name: str) -> Cell:
    """Return a place along a test, in the unit that suits the test."""
    known, end = quantity(name), test.steady_end
    if test.run_in_axis == "time":
        known = replace(known, unit="h" if end >= 3 * 3600.0 else "min" if end >= 180.0 else "")
    mark = " cycles" if test.run_in_axis == "cycles" else ""
    return Cell(test.get(name), known, test.unit(name), mark)


def _lead(answer: Part, tests: Sequence[Part]) -> Iterator[str]:
    """Yield the answer: friction of each material, or of the tests."""
    words = "{standard_error}, scatter of a new sample {standard_deviation}"
    for one in answer.fits or ():
        of = f"{one.material}, {one.environment}: friction {_friction(one).text}"
        yield f"{of} from {_count(one.tests, 'test')} (standard error {fill(one, words)})."
    if not answer.fits and len(tests) == 1:
        yield f"{tests[0].source}: {_summary(tests[0])}."
    elif not answer.fits:
        low, high = (alone(of(one.friction for one in tests), FRICTION, "-") for of in (min, max))
        yield f"Steady friction of the tests lies between {low} and {high}."
    yield from _worn(tests)


def _worn(tests: Sequence[Part]) -> Iterator[str]:
    """Yield the wear coefficient of each material whose wear was logged."""
    known, worn_ones = quantity("wear_coefficient"), [one for one in tests if "wear_coefficient" in one]
    each = grouped((one.conditions.get("material") or "the sample", one) for one in worn_ones)
    for name, worn in each.items():
        logs = [math.log(one.wear_coefficient) for one in worn]
        words = f"Wear coefficient of {name}: {alone(math.exp(fmean(logs)), known, 'm3/(N m)')}"
        if len(worn) == 1:
            yield fill(
                worn[0],
                f"{words} (standard error {{wear_error}} by the noise of this test; tests differ more).",
            )
        else:
            from scipy.special import stdtrit

            count = len(logs)  # prediction interval of another test (Student)
            times = math.exp(float(stdtrit(count - 1, 0.975)) * math.sqrt(1.0 + 1.0 / count) * stdev(logs))
            yield f"{words}, a factor of {times:.2g} either way for 95 % of single tests ({len(worn)} tests)."


def _summary(test: Part) -> str:
    start, end = (_along(test, name).text for name in ("run_in_end", "steady_end"))
    return f"steady friction {_friction(test).text} from {start} to {end} of the test"


def _friction(one: Part) -> Cell:
    """Return the friction of a test with its interval, or of a material."""
    return Cell(Estimate(one.friction, one.get("friction_low"), one.get("friction_high")), FRICTION)


def _table(tests: Sequence[Part], flags: Sequence[str]) -> Table:
    of = attrgetter("conditions")
    columns = (
        TEST,
        *(_word(name, of) for name in PAIR),
        *(column(name, of=of, head=_plain(name)) for name in ("slip_speed", "pressure")),
        Column("friction", _friction),
        Column("running-in ends", lambda one: _along(one, "run_in_end")),
        text_column("notes", lambda one: ", ".join(str(flags.index(at) + 1) for at in one.flags) or ABSENT),
    )
    return Table("tests", known_columns(columns, tests), tuple(tests), LEGEND)


def _word(name: str, of: Callable[[Part], Part] = itself) -> Column:
    return text_column(name, lambda row: of(row).get(name))


PAIR = ("material", "medium", "counterface")
TEST = text_column("test", lambda one: one.source)
COUNTED = ("steady_rows", "rows", "cycles", "wear_coefficient", "wear_error")


def _numbers(tests: Sequence[Part]) -> Table:
    """Return what the friction of each test was made from, and what else its log shows."""
    names = ("standard_error", "degrees_of_freedom", "standard_deviation", "effective_count", "drift_rate")
    until = Column("steady until", lambda one: _along(one, "steady_end"))
    heat = column("temperature", of=attrgetter("conditions"))
    columns = TEST, heat, *map(column, names), until, *map(column, COUNTED)
    return Table("numbers", known_columns(columns, tests), tuple(tests), NUMBERS, Level.LONG)


def _fits(answer: Part) -> Iterator[Block]:
    yield Heading("Friction of the materials")
    columns = (
        *map(_word, ("material", "environment", "tests")),
        Column("friction", _friction),
        column("standard_error"),
        column("standard_deviation", head="scatter of a sample"),
        text_column("rests on", lambda one: one.scatter_source),
    )
    yield Table("materials", columns, tuple(answer.fits), FIT_LEGEND)
    for one in answer.fits:
        place = f"{one.material}, {one.environment}"
        yield from (Note(f"{place}: {words}.") for words in (*_slopes(one), *one.notes))


def _slopes(fit: Part) -> Iterator[str]:
    for name in fit.slopes.values:
        slope, limits = fit.slopes.get(name), fit.tested.get(name) or ()
        power = alone(Estimate(slope.value, slope.low, slope.high), EXPONENT, "-")
        ends = [alone(one, quantity(name), fit.tested.unit(name)) for one in limits]
        span = f" from {' to '.join(ends)}" if ends else ""
        yield f"friction goes as {_plain(name)} to the power {power}{span}"


def _read(answer: Part) -> Iterator[Block]:
    """Yield how the logs were understood: those that were read alike together."""
    alike = grouped(((one.format, str(one.values["columns"])), one) for one in answer.files)
    for number, (file, *more) in enumerate(alike.values(), 1):
        also = f" and {len(more)} more" if more else ""
        missing = f", {file.missing} of them without a value" if file.missing else ""
        idle = [one for one in file.columns if one.meaning is None and one.why == "not needed"]
        yield facts(
            ("Log", f"{file.source}{also}: {file.format}, {file.rows} rows{missing}"),
            ("Columns not used", ", ".join(f'"{one.header}"' for one in idle if one.header)),
        )
        taken = tuple(one for one in file.columns if one.meaning or one.why != "not needed")
        yield Table(f"columns {number}", READ, taken)
        yield from (Note(f"{begun(one)}.", "legend") for one in file.notes)


READ = (
    text_column("column", lambda one: f'"{one.header}"'),
    text_column("taken as", lambda one: (one.meaning or "not used").replace("_", " ")),
    text_column("unit", lambda one: one.get("unit") or ABSENT),
    text_column("because of", lambda one: one.why),
)


def _plain(name: str) -> str:
    """Return the words of a condition: those of its key, not of a ball in a pocket."""
    words = {"pressure": "mean pressure", "pressure_velocity": "pV"}
    return words.get(name) or name.replace("_", " ")


# --- the figure of a test -----------------------------------------------------------------------
def file_name(source: str) -> str:
    """Name of a test as the name of a file: letters, digits, dots and dashes."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in source)
    return "-".join(part for part in plain.split("-") if part).strip(".-")[:100] or "test"


def _figure(test: Part) -> fig.Figure:
    """Return friction along a test, the ends of its steady part, the means of spans and of all of it."""
    course, mean, ends = test.course, test.friction, (test.run_in_end, test.steady_end)
    low, high, drift = test.friction_low, test.friction_high, test.drift_rate * (ends[1] - ends[0]) / 2
    size, symbol = _along(test, "steady_end").scale
    name = "sliding distance" if test.run_in_axis == "distance" else test.run_in_axis
    last = max(course.along[-1], test.steady_end)
    look: dict[str, Any] = {"line": "", "marker": "o", "size": 1.2, "name": "means of spans"}
    panel = fig.Panel(
        title="Friction along the test",
        x=fig.Axis(label=f"{name} [{symbol or '-'}]", size=size, low=course.along[0], high=last),
        y=fig.Axis(label="friction [-]"),
        marks=(
            *(fig.Across(at=one, colour=fig.GREY, line="--", name="ends of the steady part") for one in ends),
            fig.Band(x=course.along, low=course.low, high=course.high, colour=fig.SKY, name="range of rows"),
            fig.Trace(x=course.along, y=course.mean, colour=fig.BLUE, width=0.6),
            fig.Trace(x=course.span_along, y=course.span_mean, colour=fig.BLUE, **look),
            fig.Band(x=ends, low=(low, low), high=(high, high), colour=fig.VERMILION, opacity=0.2),
            fig.Trace(x=ends, y=(mean, mean), colour=fig.VERMILION, name="steady mean, 95 % interval"),
            fig.Trace(x=ends, y=(mean - drift, mean + drift), colour=fig.GREEN, line="--", name="drift"),
        ),
    )
    return fig.Figure(rows=((panel,),), heading=(test.source[:120], _summary(test)), height=2.0)


VERB = Tool(
    name="tribometer",
    compute=compute,
    page=page,
    epilog="What is read is shown before it is trusted: without --out nothing is written. A file that exists "
    "is never overwritten.",
    options=Options,
    rows="tests",
    takes_time=True,
    pictures=lambda options: options.out and options.out.with_name(f"{options.out.stem}-plots"),
    ended="no friction file was written.",
)
