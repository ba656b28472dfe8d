"""The drawing of the bearing is to scale, and a mark of an overlay is where matplotlib drew it."""

from __future__ import annotations

import re

import pytest

from separatrix.figures.drawing import bearing_drawing, guesses, shape_of
from separatrix.figures.hover import Plot, Series, places
from separatrix.figures.style import canvas, settled, svg_of


def study(**cage: float | str | None) -> dict:
    """A resolved study in SI units: 5 mm balls on 20 mm, a cage of 16.5 to 22.5 mm, 4 mm wide."""
    bearing = {
        "ball_diameter": 5e-3,
        "pitch_diameter": 20e-3,
        "ball_count": 8,
        "contact_angle": 0.26,
        "inner_conformity": 0.53,
        "outer_conformity": 0.53,
        "bore": 12e-3,
    }
    own = {
        "inner_diameter": 18e-3,
        "outer_diameter": 22e-3,
        "width": 6e-3,
        "pocket_clearance": 0.2e-3,
        "land_clearance": 0.4e-3,
        "guidance": "outer",
        "pocket_shape": "square",
    }
    sections = {"bearing": bearing, "cage": own | cage}
    return {name: {key: {"value": one} for key, one in at.items()} for name, at in sections.items()}


@pytest.mark.parametrize(("guidance", "land"), [("outer", 22e-3 / 2 + 0.2e-3), ("inner", 18e-3 / 2 - 0.2e-3)])
def test_the_land_is_its_clearance_away_from_the_cage(guidance, land):
    """The radius of the ring's land is that of the cage and half the clearance [mm]."""
    shape = shape_of(study(guidance=guidance))
    assert getattr(shape, f"{guidance}_land") == pytest.approx(1e3 * land)
    assert shape.cage == pytest.approx((9.0, 11.0, 3.0))


def test_what_the_study_does_not_state_is_named():
    """Widths of rings are never stated; a cage without its width is guessed."""
    assert "cage" not in guesses(study())
    assert "the cage's section" in guesses(study(width=None))


def test_balls_and_pockets_are_to_scale():
    """Every ball on the view along the axis has its diameter, and there are as many as stated."""
    view = bearing_drawing(study()).axes[1]
    radii = [one.get_radius() for one in view.patches if hasattr(one, "get_radius")]
    assert radii.count(2.5) == 8
    assert view.get_aspect() == 1.0


def test_a_place_is_where_the_mark_is_in_the_svg():
    """The overlay's point is at the coordinates that matplotlib gave the mark."""
    figure, axes = canvas()
    axes.plot([0.3], [0.7], "o")
    axes.set(xlim=(0, 1), ylim=(0, 1))
    series = Series(name="s", kind="points", x=(0.3, 2.0), y=(0.7, 0.5), text=("here", "outside"))
    plot = Plot(title="", x_label="", y_label="", series=(series,))
    settled(figure)
    svg, _, _ = svg_of(figure)
    marks = [tuple(map(float, one)) for one in re.findall(r'<use [^>]*x="([\d.]+)" y="([\d.]+)"', svg)]
    ((x, y, text),) = places(axes, plot, 10)
    assert text == "here"
    assert min(abs(x - u) + abs(y - v) for u, v in marks) < 0.02
