"""`traction`: traction curves, and by strips at other pivoting-to-rolling ratios."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from separatrix.ground.document import Part
from separatrix.ground.quantity import Quantity, alone
from separatrix.ground.units import format_number
from separatrix.present.blocks import (
    Cell,
    Column,
    Equation,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
)
from separatrix.present.figure import (
    BLUE,
    GREY,
    SEQUENCE,
    Across,
    Axis,
    Band,
    Figure,
    Mark,
    Panel,
    Trace,
)
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.chain_blocks import RACES
from separatrix.verbs.parts.refused import compared, refused, rolling
from separatrix.verbs.parts.telling import axis, by_race, cell, number_of, place_column, said, told
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import TractionAnswer

CONTACT = (
    "load",
    "contact_angle",
    "spin_roll_ratio",
    "rolling_speed",
    "slope",
    "slope_error",
    "free_rolling_offset",
)
RATIO = Quantity(label="size of the pivoting to rolling ratio", digits=2)


def compute(study: Study, _options: NoOptions) -> TractionAnswer:
    """Traction curves, and by strips at other pivoting-to-rolling ratios."""
    from separatrix.chain.contacts import race_tracks
    from separatrix.chain.race_curve import beyond_strips
    from separatrix.chain.shown_traction import curves_by_ratio, shear, shown_curve
    from separatrix.chain.solution import solve
    from separatrix.verbs.answer_records import TractionAnswer

    solution = solve(study)
    _ = solution.slopes  # refused, and noted, as everything after them
    tracks = race_tracks(study.bearing, study.film, solution.bearing)
    inner, outer = (shown_curve(track, study.traction) for track in tracks)
    return TractionAnswer(
        race_friction=study.film.race_friction,
        bearing=solution.bearing,
        inner=inner,
        outer=outer,
        inner_others=curves_by_ratio(tracks[0], inner),
        outer_others=curves_by_ratio(tracks[1], outer),
        inner_shear=shear(tracks[0]),
        outer_shear=shear(tracks[1]),
        outside=tuple(beyond_strips(tracks, study.traction)),
        notes=solution.notes,
    )


def refusals(study: Study) -> Iterator[str]:
    """Yield why there are no traction curves."""
    yield from refused(study, rolling, compared)


def page(answer: Part) -> Page:
    """Return the page of `traction`."""
    slopes = (
        f"{told(answer.inner, 'slope')} at the inner race, {told(answer.outer, 'slope')} at the outer race"
    )
    return page_of(
        answer,
        Note(f"Slopes $alpha$ of the traction curves of the most loaded ball: {slopes}.", "lead"),
        Heading("Traction of the most loaded ball"),
        Equation(
            r"\alpha = \left.\dfrac{\partial C_T}{\partial\,\delta\xi}\right|_{\delta\xi = 0}",
            "Slope $alpha$ of the traction coefficient $C_T$ against the creep increment $dxi$.",
        ),
        by_race("traction", answer.inner, answer.outer, *CONTACT),
        Picture("traction-curves", lambda: curves_figure(answer), CURVES),
        Heading("Slope at other pivoting to rolling ratios, by strips"),
        by_ratio(answer),
        Picture("traction-slopes", lambda: slopes_figure(answer), SLOPES),
        Heading("Shear in free rolling, by strips"),
        Picture("traction-shear", lambda: shear_figure(answer), SHEAR),
        *([Heading("Range of the strips")] if answer.outside else []),
        *(Note(sentence) for sentence in answer.outside),
        *(curve_table(part, race) for race, part in (("inner", answer.inner), ("outer", answer.outer))),
    )


CURVES = (
    "Traction coefficient against creep increment for both races (the paper's Fig. 7): this bearing with its "
    "slope at the origin, and by strips at other pivoting to rolling ratios of the same sign."
)
SLOPES = (
    "Slope of the traction curve at the origin against the size of the pivoting to rolling ratio: by strips, "
    "and of this bearing by the model of the study."
)
SHEAR = (
    "Shear along rolling in three strips of each contact in free rolling (the paper's Fig. 6). Surfaces "
    "enter at the right; the grey area is what friction bears."
)


def by_ratio(answer: Part) -> Table:
    """Return the slopes at other ratios, whose signs are those of this bearing."""
    inner, outer = answer.inner.by_spin_roll_ratio, answer.outer.by_spin_roll_ratio

    def slope(others: list[Part], race: str) -> Column:
        return Column(f"slope, {race} race", lambda place: cell(others[place], "slope"))

    ratio = Column(
        "ratio",
        lambda place: Cell(abs(inner[place].spin_roll_ratio), RATIO, inner[place].unit("spin_roll_ratio")),
    )
    return Table(
        "other ratios", (ratio, slope(inner, "inner"), slope(outer, "outer")), tuple(range(len(inner)))
    )


def curve_table(part: Part, race: str) -> Table:
    """Return the points of the curves of a race, for the workbook."""
    others = part.by_spin_roll_ratio

    def other(one: Part) -> Column:
        head = f"traction coefficient at {told(one, 'spin_roll_ratio')}"
        return place_column(one, "traction_coefficient", head=head)

    columns = (place_column(part, "creep_increment"), place_column(part, "traction_coefficient"))
    rows = tuple(range(len(part.creep_increment)))
    return Table(f"curves, {race} race", (*columns, *map(other, others)), rows, level=Level.SHEET)


def curves_figure(answer: Part) -> Figure:
    """Return the curves of both races: the bearing's own with its tangent, and those at other ratios."""
    high = 1.12 * max(
        abs(one) for race in ("inner", "outer") for one in getattr(answer, race).traction_coefficient
    )
    y = axis("traction_coefficient", answer.inner.unit("traction_coefficient"), [], low=-high, high=high)
    panels = tuple(
        curves_panel(getattr(answer, race), f"{letter}  Ball on {race} race", y)
        for race, letter in (("inner", "a"), ("outer", "b"))
    )
    return Figure(
        rows=(panels,),
        heading=figure_heading(answer),
        height=2.9,
        alt="Traction coefficient against creep increment for both races; the table has their slopes.",
    )


def curves_panel(part: Part, title: str, y: Axis) -> Panel:
    """Return the curves of one race."""
    increment: list[float] = part.creep_increment
    marks: list[Mark] = [Across(at=0.0, axis=way, colour="#c8c8c8") for way in ("x", "y")]
    for place, one in enumerate(part.by_spin_roll_ratio):
        ratio = alone(abs(one.spin_roll_ratio), RATIO, one.unit("spin_roll_ratio"))
        colour = SEQUENCE[place % len(SEQUENCE)]
        coefficient = one.traction_coefficient
        marks.append(
            Trace(x=increment, y=coefficient, colour=colour, width=0.9, name=f"ratio {ratio}, by strips")
        )
    own: list[float] = part.traction_coefficient
    hover = tuple(
        f"creep increment {number_of(part, 'creep_increment', x)}: "
        f"{number_of(part, 'traction_coefficient', c)}"
        for x, c in zip(increment, own, strict=True)
    )
    marks.append(Trace(x=increment, y=own, width=1.8, name="this bearing", hover=hover))
    rise = 0.85 * max(map(abs, own))
    tangent: dict[str, Any] = {"line": "--", "width": 0.9, "name": "slope $alpha$ at the origin"}
    marks.append(Trace(x=[-rise / part.slope, rise / part.slope], y=[-rise, rise], **tangent))
    here = said(part, "{spin_roll_ratio}; $alpha$ = {slope}")
    return Panel(
        title=f"{title}: ratio {here}",
        x=axis("creep_increment", part.unit("creep_increment"), [], low=increment[0], high=increment[-1]),
        y=y,
        marks=tuple(marks),
    )


def slopes_figure(answer: Part) -> Figure:
    """Return slopes against the size of the ratio, by strips, and those of this bearing."""
    marks: list[Mark] = []
    for race, colour, marker, _ in RACES:
        part = getattr(answer, race)
        others = part.by_spin_roll_ratio
        look: dict[str, Any] = {"colour": colour, "marker": marker}
        hover = tuple(said(one, f"{race} race, ratio {{spin_roll_ratio}}: slope {{slope}}") for one in others)
        x, y = [abs(one.spin_roll_ratio) for one in others], [one.slope for one in others]
        marks.append(Trace(x=x, y=y, line="", name=f"{race} race, by strips", hover=hover, **look))
        said_own = said(part, f"{race} race of this bearing, ratio {{spin_roll_ratio}}: slope {{slope}}")
        own: dict[str, Any] = {"x": [abs(part.spin_roll_ratio)], "y": [part.slope], "hover": (said_own,)}
        marks.append(
            Trace(**own, line="", size=7.0, is_open=True, name=f"{race} race of this bearing", **look)
        )
    races = (answer.inner, answer.outer)
    slopes = [one.slope for part in races for one in (part, *part.by_spin_roll_ratio)]
    panel = Panel(
        title="Slope of the traction curve at the origin",
        x=axis("spin_roll_ratio", "-", [], label=RATIO.label, low=-0.02),
        y=slope_axis(answer, slopes),
        marks=tuple(marks),
    )
    return Figure(
        rows=((panel,),),
        heading=figure_heading(answer),
        height=2.8,
        alt="Slope against the pivoting to rolling ratio: it falls with the ratio for both races.",
    )


def slope_axis(answer: Part, slopes: Sequence[float]) -> Axis:
    """Return the axis of the slopes, which differ by powers of ten, with ticks at 1, 2 and 5."""
    low, high = 0.8 * min(slopes), 1.25 * max(slopes)
    places = [step * 10.0**power for power in range(-3, 5) for step in (1.0, 2.0, 5.0)]
    ticks = tuple((one, format_number(one)) for one in places if low <= one <= high)
    found = axis("slope", answer.inner.unit("slope"), slopes, low=low, high=high, is_log=True)
    return replace(found, ticks=ticks)


def shear_figure(answer: Part) -> Figure:
    """Return the shear in three strips of each contact: without slip, with slip, and what friction bears."""
    rows = []
    for race, letters in (("inner", "abc"), ("outer", "def")):
        field = getattr(answer, race).shear
        middle = len(field.across) // 2
        strips = (middle // 2, middle, len(field.across) - 1 - middle // 2)
        bound = max(one for strip in strips for one in field.bound[strip])
        y = axis(
            "shear",
            field.unit("shear"),
            [bound],
            low=-1.6 * bound,
            high=1.6 * bound,
            label=f"{race} race: shear",
        )
        rows.append(
            tuple(
                strip_panel(field, strip, letter, y if letter in "ad" else bare_axis(y))
                for strip, letter in zip(strips, letters, strict=True)
            )
        )
    return Figure(
        rows=tuple(rows),
        heading=figure_heading(answer),
        height=2.1,
        alt="Six panels: shear along rolling in three strips of each contact, within what friction bears.",
    )


def bare_axis(one: Axis) -> Axis:
    """Return an axis without its label, beside one that has it."""
    return replace(one, label="")


def strip_panel(field: Part, strip: int, letter: str, y: Axis) -> Panel:
    """Return one strip across a contact."""
    x, bound, shear = field.along[strip], field.bound[strip], field.shear[strip]
    friction = Band(x=x, low=[-one for one in bound], high=bound, colour=GREY, opacity=0.15, name=BOUND)
    hover = tuple(
        f"x {number_of(field, 'along', a)}: {number_of(field, 'shear', q)}"
        for a, q in zip(x, shear, strict=True)
    )
    place, creep = (number_of(field, name, getattr(field, name)[strip]) for name in ("across", "creep_ratio"))
    return Panel(
        title=f"{letter}  y = {place}, creep {creep}",
        x=axis("along", field.unit("along"), x),
        y=y,
        marks=(
            friction,
            Trace(x=x, y=field.shear_without_slip[strip], line="--", width=0.8, name="without slip"),
            Trace(x=x, y=shear, colour=BLUE, name="with slip", hover=hover),
        ),
    )


BOUND = "within $f_BT$ $p$"

VERB = Verb(
    name="traction",
    compute=compute,
    page=page,
    refusals=refusals,
)
