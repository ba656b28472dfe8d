"""What the figures of a run rely on: true boundaries, spectra, forces, energies, common scales."""

from __future__ import annotations

import drawn
import numpy as np
import pytest
import xarray as xr

from separatrix.figures import motion, simulation
from separatrix.figures.motion import AROUND, land_boundary, pocket_boundary
from separatrix.figures.style import journal

ODD = {
    "nothing touches": drawn.run(touching=False),
    "no land": drawn.run(guidance="ball"),
    "one sample": drawn.run(samples=1),
    "it whirls at once": drawn.run(samples=2),
    "it rolls": drawn.run(samples=7, outcome="ROLLS"),
    "a land only": drawn.run(play=1e-2, contact_force=(("time", "ball"), np.zeros((drawn.MADE, 5)))),
    "in space": drawn.run(outcome="SETTLES", space=True, cage_land_count=2, cage_land_spacing=1e-2),
    "one sample in space": drawn.run(samples=1, space=True),
    "in space without a land": drawn.run(guidance="ball", space=True, play=0.0),
    "one ball": drawn.run(count=1),
    "no play": drawn.run(play=0.0),
    "hundred balls": drawn.run(count=100),
    "at rest": drawn.run(touching=False).map(lambda v: 0.0 * v if v.dims[:1] == ("time",) else v),
}


def compared(data):
    """The comparison with an ordinary run."""
    return simulation.comparison(data, drawn.run(), ("one", "the other"))


@pytest.mark.parametrize("draw", [simulation.course, compared])
@pytest.mark.parametrize("data", ODD.values(), ids=ODD.keys())
def test_every_run_is_drawn_without_a_warning(draw, data):
    """Warnings are errors here."""
    with journal():
        draw(data).draw_without_rendering()


def test_compared_runs_have_common_scales_and_short_names():
    """Both orbits, of a run that settles early and one that whirls twice as far; all else on shared axes."""
    whirls = drawn.run()
    far = whirls.assign(position=2 * whirls["position"], contact_force=3 * whirls["contact_force"])
    with journal():
        figure = simulation.comparison(
            drawn.run(outcome="SETTLES", samples=40), far, ("a", "a long name " * 20)
        )
    left, right, *shared = figure.axes
    assert left.get_xlim() == right.get_xlim() == left.get_ylim() == right.get_ylim()
    assert [len(axes.get_legend().get_texts()) for axes in shared] == [2, 2, 2]
    lines = right.get_title(loc="left").splitlines()
    assert len(lines) == 3
    assert lines[1].endswith("...")
    assert lines[2] == "kick 0.5 m/s: the cage whirls (run of 10 ms)"


def turning(time, angle, speed=600.0):
    """A run whose velocity has this direction, among balls of this orbital speed."""
    velocity = ("time", "across"), motion.ring(1.0, angle)
    return xr.Dataset({"velocity": velocity, "cage_cage_speed": speed}, coords={"time": time})


@pytest.mark.parametrize("speed", [600.0, -600.0])
@pytest.mark.parametrize("turns", [40.0, -40.0])
def test_whirl_spectrum_tells_forward_from_backward(turns, speed):
    """A velocity turning at 40 Hz with the ball set peaks at +40 Hz, against it at -40 Hz."""
    time = np.linspace(0, 1, 1001)
    frequency, share = motion.whirl_spectrum(turning(time, 2 * np.pi * turns * time, speed))
    # one bin of a run of 1 s
    assert frequency[share.argmax()] == pytest.approx(turns * np.sign(speed), abs=1.0)
    assert share.max() == 1.0


def test_a_circle_of_few_samples_is_drawn_as_a_circle():
    """Eight samples a turn: within 1e-3 of the radius, where straight lines are off by 1 - cos 22.5 deg."""
    time = np.linspace(0.0, 3.0, 25)
    circle = motion.ring(1.0, 2 * np.pi * time)
    path = motion.smooth_path(time, circle, 2 * np.pi * circle[:, ::-1] * [-1.0, 1.0])
    # a cubic's error, (pi/4)^4 / 384 = 1e-3
    assert np.hypot(*path.T) == pytest.approx(1.0, abs=1e-3)
    assert path[::6] == pytest.approx(circle)


@pytest.mark.parametrize(("turns", "first"), [(20, 15), (6, 0)])
def test_the_last_turns_of_a_long_path_are_found(turns, first):
    """Five of twenty turns; of a path of six turns all."""
    path = motion.ring(1.0, np.linspace(0.0, 2 * np.pi * turns, 100 * turns + 1))
    # the chords of 100 points a turn are shorter than its arcs
    assert motion.last_turns(path) == pytest.approx(100 * first, abs=2)


@pytest.mark.parametrize("count", [2, 3, 8, 13])
def test_on_the_pocket_boundary_one_pocket_touches(count):
    """There max |r . e_t,j| / c_j = 1 over the pockets, whatever their plays (docs/theory/cage.md)."""
    rng = np.random.default_rng(count)
    angles, plays = np.sort(rng.uniform(0.0, 2 * np.pi, count)), rng.uniform(0.5, 1.5, count)
    centre = motion.ring(pocket_boundary(angles, plays), AROUND)
    along = np.stack([-np.sin(angles), np.cos(angles)])
    # rounding
    assert (np.abs(centre @ along) / plays).max(axis=1) == pytest.approx(1.0, rel=1e-9)


def test_one_pocket_leaves_the_way_along_its_ball_free():
    """Along the radius of the only ball there is no boundary; across it, half the play."""
    reach = pocket_boundary(np.zeros(1), np.ones(1))[[0, 360, 720]]
    assert reach.tolist() == [np.inf, 1.0, np.inf]


@pytest.mark.parametrize(("guidance", "side"), [("outer", 1), ("inner", -1)])
@pytest.mark.parametrize("lobes", [2, 3])
def test_on_the_land_boundary_the_depth_is_zero(guidance, side, lobes):
    """Depth r - c + a L cos(n psi), L = 1 outside and (-1)^n inside (docs/theory/cage.md)."""
    lobed = drawn.run(guidance=guidance, cage_land_out_of_round=2e-5, cage_land_lobes=lobes)
    sign = 1 if side > 0 else (-1) ** lobes
    depth = land_boundary(lobed) - 5e-4 + 2e-5 * sign * np.cos(lobes * AROUND)
    # rounding of half a millimetre
    assert np.abs(depth).max() < 1e-15
    assert land_boundary(drawn.run(guidance="ball")) is None
    assert land_boundary(drawn.run(cage_land_clearance=np.nan)) is None


@pytest.mark.parametrize(("judged", "spans"), [({"judged_from": 0.008, "followed": 0.009}, 3), ({}, 0)])
def test_the_judged_part_of_a_run_is_shaded(judged, spans):
    """In offset, forces and energy; nothing where the run is not judged."""
    pages = simulation.course(drawn.run(samples=40, **judged)).axes
    shaded = [patch for axes in pages for patch in axes.patches if patch.get_alpha() == 0.2]
    assert [float(patch.get_xy()[0]) for patch in shaded] == pytest.approx([8.0] * spans)
    assert all(patch.get_extents().width > 0.0 for patch in shaded)


def test_equal_clearances_and_the_path_on_them_are_all_seen():
    """The land wide and light, the pockets dashed on it, the path above both."""
    axes = simulation.course(drawn.run(samples=40, play=1e-3)).axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    land, pockets, path = (lines[name] for name in ("land clearance", "pocket clearance", "path"))
    assert land.get_linewidth() > 3.0 * pockets.get_linewidth()
    assert land.get_alpha() < 0.6
    assert path.get_zorder() > max(land.get_zorder(), pockets.get_zorder())


def test_energy_is_shown_in_a_unit_of_which_it_is_at_least_one():
    """No power of ten beside an axis."""
    shown = [simulation.energy_unit(largest)[1] for largest in (2e3, 5.0, 3e-3, 0.0)]
    assert shown == ["kJ", "J", "mJ", "\N{MICRO SIGN}J"]
