"""`traction`: traction curves, and by strips at other spin-to-roll ratios."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

from separatrix.ground.plain_data import Part
from separatrix.present import figure as fig
from separatrix.present.blocks import Equation, Heading, Level, Note, Page, Picture, Table
from separatrix.present.quantity_text import axis, by_race, fill, number_of, place_column, show
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.chain_answers import TractionAnswer

SLOPE = ("slope", "slope_error", "free_rolling_offset")
CONTACT = ("load", "contact_angle", "spin_roll_ratio", "rolling_speed", *SLOPE)


def compute(study: Study, _options: NoOptions) -> TractionAnswer:
    """Traction curves, and by strips at other spin-to-roll ratios."""
    from separatrix.chain.race_traction import beyond_strips, curves_by_ratio, shear, shown_curve
    from separatrix.chain.solution import solve
    from separatrix.verbs.chain_answers import TractionAnswer

    solution = solve(study)
    _ = solution.slopes  # refused, and noted, as everything after them
    tracks = solution.rolling.tracks
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


def page(answer: Part) -> Page:
    """Return the page of `traction`."""
    inner, outer = answer.inner, answer.outer
    lead = f"{show(inner, 'slope')} at the inner race, {show(outer, 'slope')} at the outer race."
    return page_of(
        answer,
        Note(f"Slopes $alpha$ of the traction curves of the most loaded ball: {lead}", "lead"),
        Heading("Traction of the most loaded ball"),
        Equation(
            r"\alpha = \left.\dfrac{\partial C_T}{\partial\,\delta\xi}\right|_{\delta\xi = 0}",
            "Slope $alpha$ of the traction coefficient $C_T$ against the creep increment $dxi$.",
        ),
        by_race("traction", inner, outer, *CONTACT),
        Picture("traction-curves", lambda: curves_figure(answer), CURVES),
        *([Heading("Range of the strips")] if answer.outside else []),
        *(Note(sentence) for sentence in answer.outside),
        *(curve_table(part, race) for race, part in (("inner", inner), ("outer", outer))),
    )


CURVES = (
    "Traction coefficient against creep increment for both races (the paper's Fig. 7): this bearing with its "
    "slope at the origin, and by strips at other spin to roll ratios of the same sign. Below: shear "
    "along rolling in free rolling, in a strip half way to the edge of each contact (the paper's Fig. 6). "
    "Surfaces enter at the right; the coloured area is what friction bears."
)


def curve_table(part: Part, race: str) -> Table:
    """Return the points of the curves of a race, for the workbook."""
    columns = [place_column(part, name) for name in ("creep_increment", "traction_coefficient")]
    for one in part.by_spin_roll_ratio:
        head = fill(one, "traction coefficient at {spin_roll_ratio}, slope {slope}")
        columns.append(place_column(one, "traction_coefficient", head=head))
    rows = tuple(range(len(part.creep_increment)))
    return Table(f"curves, {race} race", tuple(columns), rows, level=Level.SHEET)


def curves_figure(answer: Part) -> fig.Figure:
    """Return the curves of both races, and below them the shear in a strip of each."""
    races = answer.inner, answer.outer
    high = 1.12 * max(abs(one) for part in races for one in part.traction_coefficient)
    y = axis("traction_coefficient", answer.inner.unit("traction_coefficient"), [], low=-high, high=high)
    titles = "a  Ball on inner race", "b  Ball on outer race"
    panels = tuple(curves_panel(part, title, y) for part, title in zip(races, titles, strict=True))
    return figure(answer, panels, (shear_panel(answer),), height=2.6)


def curves_panel(part: Part, title: str, y: fig.Axis) -> fig.Panel:
    """Return the curves of one race."""
    x, own = part.creep_increment, part.traction_coefficient
    marks: list[fig.Mark] = [fig.Across(at=0.0, axis=way, colour="#c8c8c8") for way in ("x", "y")]
    for colour, one in zip(cycle(fig.SEQUENCE), part.by_spin_roll_ratio, strict=False):
        name = f"ratio {number_of(one, 'ratio', abs(one.spin_roll_ratio))}, by strips"
        marks.append(fig.Trace(x=x, y=one.traction_coefficient, colour=colour, width=0.9, name=name))
    rise = 0.85 * max(map(abs, own))
    run = rise / part.slope
    marks.append(fig.Trace(x=x, y=own, width=1.8, name="this bearing"))
    tangent = "slope $alpha$ at the origin"
    marks.append(fig.Trace(x=[-run, run], y=[-rise, rise], line="--", width=0.9, name=tangent))
    return fig.Panel(
        title=fill(part, title + ": ratio {spin_roll_ratio}; $alpha$ = {slope}"),
        x=axis("creep_increment", part.unit("creep_increment"), [], low=x[0], high=x[-1]),
        y=y,
        marks=tuple(marks),
    )


def shear_panel(answer: Part) -> fig.Panel:
    """Return the shear in a strip of each contact, with what friction bears."""
    marks, along, every = list[fig.Mark](), list[float](), list[float]()
    for race, colour, line in (("inner", fig.BLUE, "-"), ("outer", fig.VERMILION, "--")):
        field = getattr(answer, race).shear
        strip = len(field.across) - 1 - (len(field.across) - 1) // 4
        x, bound = field.along[strip], field.bound[strip]
        names = "across", "creep_ratio"
        place, creep = (number_of(field, name, getattr(field, name)[strip]) for name in names)
        name = f"{race} race at y = {place}, $xi$ = {creep}"
        marks.append(fig.Band(x=x, low=[-one for one in bound], high=bound, colour=colour, opacity=0.12))
        marks.append(fig.Trace(x=x, y=field.shear[strip], colour=colour, line=line, name=name))
        along += x
        every += bound
    field, high = answer.inner.shear, 1.2 * max(every)
    return fig.Panel(
        title="c  Shear in free rolling, within $f_BT$ $p$",
        x=axis("along", field.unit("along"), along),
        y=axis("shear", field.unit("shear"), [high], low=-high, high=high),
        marks=tuple(marks),
    )


VERB = Verb(name="traction", compute=compute, page=page, links=("rolling",))
