"""What the figures of the stability curve and of the map rely on."""

from __future__ import annotations

import drawn
import numpy as np
import pytest

from separatrix.chain.impact_restitution import restitution_factor
from separatrix.figures import map as maps
from separatrix.figures import stability
from separatrix.figures.style import journal

ON = "restitution_factor"
NAN = np.nan
CURVES = {
    "ordinary": drawn.curve(),
    "with every kick": drawn.curve(kick_critical_friction=((ON, "kick"), [[0.1] * 3] * 4)),
    "no threshold": drawn.curve(
        **{f"critical_friction{end}": (ON, [NAN] * 4) for end in ("", "_low", "_high")}
    ),
    "empty intervals": drawn.curve(scatter_low=(ON, [NAN] * 4), scatter_high=(ON, [NAN, 0.2, NAN, NAN])),
    "one point": drawn.curve(points=1),
    "one kick": drawn.curve(kicks=("kick", [0.5])),
    "candidates": drawn.curve(**drawn.candidates([[0.1, 0.2, NAN], [0.15, NAN, NAN]])),
    "no measured candidate": drawn.curve(**drawn.candidates([[NAN, NAN]])),
    "its own point": drawn.curve(
        here_restitution_factor=0.27, here_critical_friction=0.2, here_scatter_low=0.1, here_scatter_high=0.3
    ),
    "its own point unknown": drawn.curve(here_restitution_factor=0.27, here_critical_friction=NAN),
}
AGREE = np.array([["not run: the points around agree", "As they do."], ["not run: interrupted", ""]])
MAPS = {
    "an ordinary map": drawn.plane([[0.0, 0.4], [0.6, 1.0]]),
    "all refused": drawn.plane([[NAN, NAN], [NAN, NAN]]),
    "all undecided": drawn.plane([[0.5, 0.4], [0.4, 0.5]]),
    "all undecided at one half": drawn.plane([[0.5, 0.5], [0.5, 0.5]]),
    "all grow": drawn.plane([[1.0, 1.0], [1.0, 1.0]]),
    "one column": drawn.plane([[0.0], [0.6], [1.0]]),
    "one cell": drawn.plane([[0.6]]),
    "partly run": drawn.plane([[NAN, 0.0], [NAN, 1.0]]).assign(reason=(("y", "x"), AGREE)),
    "other parameters": drawn.plane(
        [[0.0, 0.4]] * 3, y=np.array([1e-4, 1e-3, 1e-2]), y_parameter="cage.mass"
    ),
    "no point of its own": drawn.plane([[0.0, 1.0], [0.6, 1.0]], x_here=NAN),
    "at zero": drawn.plane([[0.0, 1.0]], y=np.zeros(1)),
}


@pytest.mark.parametrize("kind", [*CURVES, *MAPS])
def test_every_curve_and_every_map_is_drawn_without_a_warning(kind):
    """Warnings are errors here."""
    with journal():
        figure = stability.stability(CURVES[kind]) if kind in CURVES else maps.stability_map(MAPS[kind])
        figure.draw_without_rendering()


@pytest.mark.parametrize("zeta", [0.02, 0.3, 0.9])
def test_the_linear_limit_is_that_of_the_cage(zeta):
    """Drawn from restitution factor and number of balls alone: 2 zeta sqrt(2/Z), as the engine has it."""
    limit = stability.linear_limit(np.array([restitution_factor(zeta)]), 11)
    # eta to zeta and back
    assert limit[0] == pytest.approx(2.0 * zeta * np.sqrt(2.0 / 11.0), rel=1e-9)


def test_a_band_without_an_end_reaches_the_edge_and_an_unknown_point_has_none():
    """Whirl without friction: from 0; settling up to the most: beyond the top; unknown: nothing drawn."""
    low, middle, high = [NAN, 0.1, NAN], [0.2, 0.2, NAN], [0.3, NAN, NAN]
    ends = {"critical_friction_low": (ON, low), "critical_friction_high": (ON, high)}
    found = stability.band_ends(drawn.curve(points=3, critical_friction=(ON, middle), **ends), 0.5)
    assert found[0].tolist() == pytest.approx([0.0, 0.1, NAN], nan_ok=True)
    assert found[1].tolist() == pytest.approx([0.3, 1.0, NAN], nan_ok=True)


def test_the_picture_holds_every_curve_and_every_mark():
    """A curve from 0.51 to 0.9, its kicks, and a critical friction of 0.77: all below the top."""
    high, ends = np.linspace(0.9, 0.51, 4), {"scatter_low": 0.95, "scatter_high": 1.02}
    ends |= {f"critical_friction{end}": part for end, part in (("", 1.0), ("_low", 0.8), ("_high", 1.05))}
    kicks = np.stack([0.8 * high, high, 1.1 * high], axis=1)
    data = drawn.curve(
        kick_critical_friction=((ON, "kick"), kicks),
        here_restitution_factor=0.3,
        **{name: (ON, part * high) for name, part in ends.items()},
        **{f"here_{name}": 0.77 * part for name, part in ends.items()},
    )
    axes = stability.stability(data).axes[0]
    top = axes.get_ylim()[1]
    marked = [line for line in axes.lines if line.get_marker() not in ("None", "")]
    assert {line.get_marker() for line in marked} == {".", "v", "^", "D"}
    assert all(float(np.max(line.get_ydata())) < top for line in marked)
    assert top == pytest.approx(1.12 * 0.99)


def test_the_picture_is_high_enough_for_the_candidates():
    """Without any number a usual friction."""
    low = drawn.curve(**drawn.candidates([[0.38, 0.2]])).isel({ON: [3]})
    assert stability.highest(low, candidates=True) == pytest.approx(1.12 * 0.38)
    assert stability.highest(low) == pytest.approx(1.12 * 0.045)
    assert stability.highest(drawn.curve(**drawn.candidates([[0.9]])), candidates=True) > 0.9
    assert stability.highest(CURVES["no threshold"].drop_vars("scatter_high")) == stability.HIGHEST


def test_the_warning_colour_of_a_map_is_for_the_unstable():
    """Dark where the cage is stable, bright where it whirls, ever brighter between."""
    red, green, blue = np.array([maps.COLOURS(share)[:3] for share in (0.0, 0.25, 0.5, 0.75, 1.0)]).T
    brightness = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    assert (np.diff(brightness) > 0.05).all()
    assert brightness[0] < 0.2
    assert brightness[-1] > 0.8


@pytest.mark.parametrize(("reason", "mark"), [("too fast", " *"), ("", "")])
def test_each_candidate_is_drawn_at_its_friction_in_each_environment(reason, mark):
    """Beside the curve, in rising order of the mean; marked if extrapolated in one environment."""
    data = drawn.curve(**drawn.candidates([[0.3, 0.1], [0.2, 0.12]]))
    data["material_extrapolation"][1, 0] = reason
    _, beside = stability.stability(data).axes
    assert [label.get_text() for label in beside.get_xticklabels()] == ["material 1", f"material 0{mark}"]
    points = [line.get_ydata().tolist() for line in beside.lines if line.get_marker() in ("o", "s")]
    assert points == [[0.1, 0.3], [0.12, 0.2]]
    assert ("friction extrapolated" in beside.get_legend_handles_labels()[1]) is bool(reason)


def test_cells_are_halfway_between_values():
    """In steps and, where values are in proportion, in factors; a single value has a cell of its own."""
    assert maps.cell_edges(np.array([0.0, 1.0, 3.0])).tolist() == [-0.5, 0.5, 2.0, 4.0]
    assert maps.cell_edges(np.array([1.0, 100.0, 1e4])) == pytest.approx([0.1, 10.0, 1e3, 1e5], rel=1e-12)
    assert maps.cell_edges(np.array([4.0])).tolist() == [2.0, 6.0]
    assert maps.cell_edges(np.array([0.0])).tolist() == [-0.5, 0.5]


def test_only_values_in_proportion_make_an_axis_logarithmic():
    """Two values are not evidence."""
    axes = (
        np.geomspace(0.02, 0.3, 40),
        np.linspace(0.0, 1.0, 9),
        np.linspace(1.0, 1.2, 9),
        np.array([1.0, 2.0]),
    )
    assert [maps.is_proportional(values) for values in axes] == [True, False, False, False]


def test_a_length_is_shown_as_an_engineer_writes_it():
    """Clearances in mm, however the file has them."""
    data = drawn.plane(
        [[0.0, 1.0]], x=np.array([1e-4, 1e-3]), x_parameter="cage.pocket_clearance", x_here=5e-4
    )
    data["x"].attrs["units"] = "m"
    assert maps.shown_unit(data, "x") == (1e-3, "mm")
    assert maps.axis_values(data, "x").tolist() == pytest.approx([0.1, 1.0])
    axes = maps.stability_map(data).axes[0]
    assert axes.get_xlabel() == "cage pocket clearance [mm]"
    own = next(line for line in axes.lines if line.get_label() == "the study itself")
    assert own.get_xdata().tolist() == pytest.approx([0.5])


def test_refused_not_run_and_agreed_points_are_distinct():
    """A refusal has a reason of its own; an interrupt leaves nothing; agreeing points lend their value."""
    data = drawn.plane([[NAN, 0.25], [NAN, NAN]]).assign(
        reason=(
            ("y", "x"),
            np.array([["not run: the points around agree", ""], ["not run: interrupted", "No land."]]),
        )
    )
    found = maps.cells(data)
    assert found.refused.tolist() == [[False, False], [False, True]]
    assert found.not_run.tolist() == [[True, False], [True, False]]
    assert found.agreed.tolist() == [[True, False], [False, False]]
    assert found.share == pytest.approx(np.array([[0.25, 0.25], [NAN, NAN]]), nan_ok=True)


@pytest.mark.parametrize(("x", "words"), [("restitution_factor", "0.5 m/s"), ("kick", "as on the axis")])
def test_the_kick_of_a_map_is_named_unless_it_is_an_axis(x, words):
    """In the title."""
    axes = maps.stability_map(drawn.plane([[0.0]], x_parameter=x)).axes[0]
    assert f"whirl, kick {words}, at most 16 runs" in axes.get_title()
