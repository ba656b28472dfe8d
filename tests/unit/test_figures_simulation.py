"""What the figures of a run rely on: true boundaries, force by pocket, the ledger, common scales."""

from __future__ import annotations

import drawn
import numpy as np
import pytest

from separatrix.figures import forces, simulation
from separatrix.figures.comparison import comparison, headline
from separatrix.figures.orbit import (
    AROUND,
    half_plays,
    land_boundary,
    last_turns,
    pocket_angles,
    pocket_boundary,
    ring,
    smooth_path,
)
from separatrix.figures.style import journal

ODD = {
    "nothing touches": drawn.run(touching=False),
    "no land": drawn.run(guidance="ball"),
    "one sample": drawn.run(samples=1),
    "one sample of a run that dies": drawn.run(samples=1, outcome="SETTLES"),
    "it grows at once": drawn.run(samples=2),
    "it stalls": drawn.run(samples=7, outcome="STALLED"),
    "a land only": drawn.run(play=1e-2, contact_force=(("time", "ball"), np.zeros((drawn.MADE, 5)))),
    "it dies": drawn.run(outcome="SETTLES"),
    "one ball": drawn.run(count=1),
    "no play": drawn.run(play=0.0),
    "hundred balls": drawn.run(count=100),
    "at rest": drawn.run(touching=False).map(lambda v: 0.0 * v if v.dims[:1] == ("time",) else v),
}


@pytest.fixture(params=ODD.values(), ids=ODD.keys())
def odd(request):
    """A run that is out of the ordinary."""
    return request.param


@pytest.mark.parametrize("draw", [simulation.run, forces.forces])
def test_every_run_is_drawn_without_a_warning(draw, odd):
    """Warnings are errors here."""
    with journal():
        draw(odd).draw_without_rendering()


@pytest.mark.parametrize("kind", ["nothing touches", "one sample", "at rest"])
def test_any_two_runs_are_compared_without_a_warning(kind):
    """One of them is ordinary."""
    with journal():
        comparison(ODD[kind], drawn.run(), ("one", "the other")).draw_without_rendering()


def test_compared_runs_have_common_scales():
    """Both orbits, of a run that dies early and one that grows twice as far; all else on shared axes."""
    grows = drawn.run()
    far = grows.assign(position=2 * grows["position"], contact_force=3 * grows["contact_force"])
    with journal():
        figure = comparison(drawn.run(outcome="SETTLES", samples=40), far, ("a", "b"))
    left, right, *shared = figure.axes
    assert left.get_xlim() == right.get_xlim() == left.get_ylim() == right.get_ylim()
    assert [len(axes.get_legend().get_texts()) for axes in shared] == [2, 2, 2]


def test_a_long_name_is_cut_above_its_column():
    """Two lines of it, then how the run ended."""
    lines = headline("a very long name " * 20, drawn.run()).splitlines()
    assert len(lines) == 3
    assert lines[1].endswith("...")
    assert lines[2] == "kick 0.5 m/s: the cage whirls (run of 10 ms)"


def test_a_circle_of_few_samples_is_drawn_as_a_circle():
    """Eight samples a turn: within 1e-3 of the radius, where straight lines are off by 1 - cos 22.5 deg."""
    time = np.linspace(0.0, 3.0, 25)
    circle = ring(1.0, 2 * np.pi * time)
    velocity = 2 * np.pi * circle[:, ::-1] * [-1.0, 1.0]
    path = smooth_path(time, circle, velocity)
    assert np.hypot(*path.T) == pytest.approx(1.0, abs=1e-3)  # a cubic's error, (pi/4)^4 / 384 = 1e-3
    assert path[::6] == pytest.approx(circle)


def test_the_last_turns_of_a_long_path_are_told_from_the_rest():
    """Five of twenty turns; of a path of six turns all."""
    for turns, first in ((20, 15), (6, 0)):
        path = ring(1.0, np.linspace(0.0, 2 * np.pi * turns, 100 * turns + 1))
        assert last_turns(path) == pytest.approx(100 * first, abs=2)  # chords are shorter than arcs


def test_the_close_view_shows_some_turns_around_the_largest_force():
    """A whirl of 143 Hz: six turns are 42 ms, longer than the run; one of 5 kHz: 1.2 ms around it."""
    slow = drawn.run(samples=400)
    assert forces.close_view(slow).sizes["time"] == 400
    around = 2 * np.pi * 5e3 * slow["time"].values
    force = slow["contact_force"].copy()
    force[200, 3] = 1e3
    fast = forces.close_view(slow.assign(velocity=(("time", "axis"), ring(1.0, around)), contact_force=force))
    width = float(fast["time"][-1] - fast["time"][0])
    assert width == pytest.approx(forces.TURNS / 5e3, abs=3 * 0.01 / 400)  # the samples at its ends
    assert forces.largest_force(fast).max() == 1e3


@pytest.mark.parametrize(
    ("largest", "unit"),
    [(2e3, (1e3, "kJ")), (5.0, (1.0, "J")), (3e-3, (1e-3, "mJ")), (0.0, (1e-6, "\u00b5J"))],
)
def test_energy_is_shown_in_a_unit_of_which_it_is_at_least_one(largest, unit):
    """No power of ten beside an axis."""
    assert simulation.energy_unit(largest) == unit


def test_on_the_pocket_boundary_one_pocket_touches_and_none_is_pressed():
    """|r . e_t| reaches half the play of the ball nearest to touching, in every direction."""
    angles = np.array([0.1, 1.0, 2.9, 4.0])
    plays = np.array([1.0, 2.0, 1.5, 0.7])
    reach = pocket_boundary(angles, plays)
    centre = reach[:, None] * np.stack([np.cos(AROUND), np.sin(AROUND)], axis=1)
    across = np.abs(centre @ np.stack([-np.sin(angles), np.cos(angles)]))
    assert np.max(across / plays, axis=1) == pytest.approx(1.0, abs=1e-12)  # rounding


def test_one_pocket_leaves_the_way_along_its_ball_free():
    """Along the radius of the only ball there is no boundary; across it, half the play."""
    reach = pocket_boundary(np.zeros(1), np.ones(1), np.array([0.0, 0.5 * np.pi, np.pi]))
    assert reach.tolist() == [np.inf, 1.0, np.inf]


def test_pockets_are_where_the_run_says():
    """Angles and plays of the run come before those of an even cage."""
    even, uneven = (
        drawn.run(),
        drawn.run(pocket_angle=("ball", [0, 1, 2, 4, 5]), half_play=("ball", [1e-4] * 5)),
    )
    assert pocket_angles(even)[1] == pytest.approx(2 * np.pi / 5)
    assert half_plays(even).tolist() == [3e-4] * 5
    assert pocket_angles(uneven).tolist() == [0, 1, 2, 4, 5]
    assert half_plays(uneven).tolist() == [1e-4] * 5


@pytest.mark.parametrize(("guidance", "side"), [("outer", 1), ("inner", -1)])
@pytest.mark.parametrize("lobes", [2, 3])
def test_on_the_land_boundary_the_depth_is_zero(guidance, side, lobes):
    """Depth r - c + a L cos n(psi - theta), L = 1 outside and (-1)^n inside (docs/theory/cage.md)."""
    lobed = drawn.run(guidance=guidance, cage_land_out_of_round=2e-5, cage_land_lobes=lobes)
    sign = 1 if side > 0 else (-1) ** lobes
    reach = land_boundary(lobed, AROUND, 0.3)
    depth = reach - 5e-4 + 2e-5 * sign * np.cos(lobes * (AROUND - 0.3))
    assert np.abs(depth).max() < 1e-15  # rounding of half a millimetre


def test_without_a_land_there_is_no_boundary():
    """A cage on its balls, and data of a cage that names no clearance."""
    assert land_boundary(drawn.run(guidance="ball")) is None
    assert land_boundary(drawn.run(cage_land_clearance=np.nan)) is None


def test_a_touch_is_counted_once_and_on_its_side():
    """One that begins before the first sample counts; one that changes side counts on both."""
    force = np.array([[5.0, 0.0, 0.0], [4.0, -1.0, 2.0], [0.0, 0.0, -2.0], [3.0, -1.0, -2.0]])
    assert forces.touches(force).tolist() == [[2, 0, 1], [0, 2, 1]]


@pytest.mark.parametrize("columns", [3, 10, 40])
def test_pooling_loses_no_impact(columns):
    """The largest force of each pocket stays, with fewer columns than samples and with more."""
    rng = np.random.default_rng(1)
    time, force = np.linspace(0.0, 1.0, 11), rng.normal(size=(11, 4))
    shown = forces.pooled(time, force, np.linspace(0.0, 1.0 + 1e-9, columns + 1))
    assert shown.shape == (columns, 4)
    assert shown.max(axis=0).tolist() == np.abs(force).max(axis=0).tolist()


def test_the_ledger_gap_is_what_no_source_explains():
    """3 t - 2 t = t is closed; a spring that nobody loads leaves its energy over the largest work."""
    closed = drawn.run()
    assert simulation.ledger_gap(closed) < 1e-12  # rounding
    spring = closed["time"].values * 0.3
    assert simulation.ledger_gap(closed.assign(spring_energy=("time", spring))) == pytest.approx(0.1)
    assert simulation.ledger_gap(drawn.run(touching=False)) == 0.0


def test_land_springs_hold_energy_too():
    """Energy of the land's spring counts as stored."""
    with_land = drawn.run(land_energy=("time", np.full(drawn.MADE, 0.5)))
    more = simulation.total_energy(with_land) - simulation.total_energy(drawn.run())
    assert more == pytest.approx(0.5, abs=1e-15)  # rounding


def test_a_source_has_one_look_everywhere():
    """No two sources share colour and dashes."""
    looks = [tuple(map(str, simulation.source_look(name).values())) for name in simulation.SOURCES]
    assert len(set(looks)) == len(looks)


def test_the_judged_part_of_a_run_is_shaded():
    """In energy, offset and work; nothing in a file of an earlier version, which does not say it."""
    page = simulation.run(drawn.run(samples=40, judged_from=0.008, judged_until=0.009))
    shaded = [patch for axes in page.axes for patch in axes.patches if patch.get_alpha() == 0.2]
    assert [np.round(patch.get_extents().width > 0.0) for patch in shaded] == [1.0] * 3
    assert [float(patch.get_xy()[0]) for patch in shaded] == pytest.approx([8.0] * 3)
    page = simulation.run(drawn.run(samples=40))
    assert not [patch for axes in page.axes for patch in axes.patches if patch.get_alpha() == 0.2]


def test_equal_clearances_and_the_path_on_them_are_all_seen():
    """The land wide and light, the pockets dashed on it, the path above both."""
    data = drawn.run(samples=40, play=1e-3)
    axes = simulation.run(data).axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    land, pockets = lines["land clearance"], lines["pocket clearance"]
    assert land.get_linewidth() > 3.0 * pockets.get_linewidth()
    assert land.get_alpha() < 0.6
    path = lines["path"]
    assert path.get_zorder() > max(land.get_zorder(), pockets.get_zorder())


def test_the_close_view_begins_before_the_largest_force():
    """Also where the kick throws the cage into a pocket at once: the force stands inside the picture."""
    data = drawn.run(samples=400)
    data["contact_force"][:] = 0.0
    data["contact_force"][1, 2] = 50.0
    near = forces.close_view(data)
    first, last = forces.view_ends(near)
    peak = simulation.milliseconds(near)[int(forces.largest_force(near).argmax())]
    assert (peak - first) / (last - first) > 0.1
