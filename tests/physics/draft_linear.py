# ruff: noqa: E501 - a draft
"""The linear limit, a cage without clearance: closed forms, exact roots and the engine agree, in plane and space."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST, TURNING, damping_of, followed, linear_roots
from space_cages import PITCH, ring, starts_at

from separatrix.ball_traction import BallTraction
from separatrix.cage import (
    MovingCage,
    drift_law,
    linear_critical_friction,
    linear_whirl_frequency,
    run_ensemble,
)
from separatrix.cage.closed_forms import whirl_rate
from separatrix.cage.course import follow_start
from separatrix.study import StabilitySettings

M, K, Z = AT_REST.mass, AT_REST.ball_cage_stiffness, AT_REST.ball_count
LAW = BallTraction(mass=6.567e-3, slope=900.0, speed=math.inf)


def gripped(damping: float, friction: float = 0.0, **change: object) -> MovingCage:
    """Cage whose pockets have no clearance."""
    grip = {"pocket_clearance": 0.0, "race_damping": damping, "ball_cage_friction": friction}
    return replace(AT_REST, **(grip | change))


def growth_rate(cage: MovingCage, duration: float) -> float:
    """Growth rate of the amplitude between the middle and the end of a run, from the kinetic energy [1/s]."""
    run = followed(cage, duration, direction=0.3, samples=40_000)
    half, end = run.time[-1] / 2, run.time[-1]
    width = 5 / linear_whirl_frequency(cage)  # whole turns, so that the mean has no beat
    means = []
    for until in (half, end):
        window = (run.time > until - width) & (run.time <= until)
        means.append(np.trapezoid(run.kinetic_energy[window], run.time[window]) / np.ptp(run.time[window]))
    return 0.5 * math.log(means[1] / means[0]) / (end - half)


@pytest.mark.parametrize(("damping", "friction"), [(2000.0, 0.08257), (4000.0, 0.04129), (8000.0, 0.02064)])
def test_critical_friction_of_the_linear_limit(damping, friction):
    """sqrt(2 k M/Z)/C_mu = 2 zeta sqrt(2/Z), to the four digits given; whirl at sqrt(Z k/2M)/(2 pi)."""
    found, zeta = linear_critical_friction(gripped(damping)), math.sqrt(K * M) / (2 * damping)
    assert found == pytest.approx(friction, abs=5e-6)
    assert found == pytest.approx(2 * zeta * math.sqrt(2 / Z), rel=1e-14)  # rounding
    assert linear_whirl_frequency(gripped(damping)) == pytest.approx(2891.2, abs=0.05)  # digits given


@pytest.mark.parametrize("eta", [0.1, 0.5, 0.9])
def test_a_whirl_decays_below_the_linear_limit_and_grows_above_it(eta):
    """One per cent below and above."""
    damping = damping_of(eta)
    limit = linear_critical_friction(gripped(damping))
    duration = 0.15 if eta > 0.6 else 0.05  # for e^(1/2) of growth at 1 %
    assert growth_rate(gripped(damping, 0.99 * limit), duration) < 0
    assert growth_rate(gripped(damping, 1.01 * limit), duration) > 0


@pytest.mark.parametrize("speed", [0.0, 700.0, 3000.0])
@pytest.mark.parametrize("friction", [0.075, 0.095])
def test_a_whirl_grows_at_the_rate_of_its_exact_root(speed, friction):
    """Within 1 % of what the friction adds."""
    cage = gripped(2000.0, friction, cage_speed=speed)
    whirl = max(linear_roots(cage)[np.abs(linear_roots(cage).imag) > 5000], key=lambda root: root.real)
    added = 0.5 * friction * 2 * math.pi * linear_whirl_frequency(cage)
    assert growth_rate(cage, 0.012) == pytest.approx(whirl.real, abs=0.01 * added)


@pytest.mark.parametrize("law", [None, LAW], ids=["dampers", "balls of one state"])
def test_small_motions_are_the_exponentials_of_the_roots(law):
    """All three or four of them, from the disturbance on: 1e-4 of the motion at the step that runs have."""
    cage = replace(
        TURNING,
        cage_speed=669.0,
        pocket_clearance=0.0,
        traction=law,
        race_damping=900.0,
        ball_cage_friction=0.1,
    )
    run = followed(cage, 2e-3, direction=0.4, samples=200)
    # z and three derivatives at the start: the balls press with q only, and q' = v; times in 1/w0
    roots, v, w0 = linear_roots(cage), 0.5 * np.exp(0.4j), whirl_rate(cage)
    turn = cage.cage_speed / w0
    begun = np.array([0.0, 1.0, -2j * turn, (-2j * turn) ** 2 + turn**2 - (1 - 0.1j)])[: len(roots)] * v / w0
    share = np.linalg.solve(np.vander(roots / w0, increasing=True).T, begun)
    exact = np.exp(np.outer(run.time, roots)) @ share
    np.testing.assert_allclose(run.position @ [1, 1j], exact, rtol=0, atol=1e-4 * np.abs(exact).max())


def test_critical_friction_of_balls_of_one_state_is_a_root_that_neither_grows_nor_dies():
    """And that of dampers as the balls become light; the engine's whirl decays 1 % below it and grows 1 % above."""
    grip = replace(TURNING, pocket_clearance=0.0, cage_speed=0.0, traction=LAW)
    found = linear_critical_friction(grip)
    whirl = [r for r in linear_roots(replace(grip, ball_cage_friction=found)) if abs(r.imag) > 3000.0]
    assert min(abs(r.real) for r in whirl) < 1e-8 * max(abs(r) for r in whirl)
    light = linear_critical_friction(replace(grip, traction=replace(LAW, mass=1e-9)))
    massless = linear_critical_friction(replace(grip, traction=None, race_damping=900.0))
    assert light == pytest.approx(massless, rel=1e-8)  # mass changes k m_e/C^2, 3.7e-9
    assert growth_rate(replace(grip, ball_cage_friction=0.99 * found), 0.05) < 0
    assert growth_rate(replace(grip, ball_cage_friction=1.01 * found), 0.05) > 0


@pytest.mark.parametrize("whirl", [2.7e4, 2.9e4])
def test_a_turning_ball_set_whirls_at_the_friction_of_its_formula(whirl):
    """(omega + Omega)^2 (G - k m) = omega_0^2 G, f = k C/omega (G - k m), G = (m omega)^2 + C^2; rounding."""
    C, m, k, w0 = LAW.slope, LAW.mass, K, whirl_rate(TURNING)
    G = (m * whirl) ** 2 + C * C
    turning = {
        "cage_speed": w0 * math.sqrt(G / (G - k * m)) - whirl,
        "ball_cage_friction": k * C / (whirl * (G - k * m)),
    }
    roots = linear_roots(replace(TURNING, pocket_clearance=0.0, traction=LAW, **turning))
    assert np.abs(roots - 1j * whirl).min() < 1e-9 * whirl


@pytest.mark.parametrize("outer", [False, True])
def test_whirl_is_forward_for_inner_rotation_and_backward_for_outer(outer):
    """2891.2 Hz just above the limit, in the sense of the ball set or against it; 0.5 %: the phase of a step."""
    speeds = {"inner_speed": 0.0, "outer_speed": 1500.0} if outer else {}
    cage = gripped(2000.0, 1.05 * 0.08257, **speeds)
    found = run_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=2, duration=0.1))
    assert set(found.whirl_direction.ravel()) == {-1 if outer else 1}
    assert found.whirl_frequency == pytest.approx(2891.2, rel=5e-3)


def test_turning_raises_the_limit_of_forward_whirl():
    """At f_c/(1 - Omega/omega_0) a root lies on the imaginary axis, at omega_0 - Omega; rounding only."""
    w0 = 2 * math.pi * linear_whirl_frequency(gripped(2000.0))
    for sense, speeds in ((1, {}), (-1, {"inner_speed": 0.0, "outer_speed": 1500.0})):
        cage = gripped(2000.0, cage_speed=700.0, **speeds)
        limit = linear_critical_friction(cage) / (1 - sense * 700.0 / w0)
        roots = linear_roots(replace(cage, ball_cage_friction=limit))
        whirl = min(roots, key=lambda root: abs(abs(root.imag) - w0 + sense * 700.0))
        assert abs(whirl.real) < 1e-9 * w0
        assert whirl.imag == pytest.approx(sense * w0 - 700.0, rel=1e-12)


@pytest.mark.parametrize("clearance", [0.0, 6e-4])
def test_a_landless_cage_drifts_at_the_rate_of_the_law(clearance):
    """2 M Omega^2/(Z C_mu), the slow root; with clearance fewer balls touch at first: some per cent more."""
    cage = gripped(500.0, 0.05, cage_speed=700.0, pocket_clearance=clearance)
    slow = min(linear_roots(replace(cage, ball_cage_friction=0.0)), key=abs)
    assert slow.real == pytest.approx(drift_law(cage), rel=0.01)  # next order: 0.7 %
    found = run_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=4, duration=0.4))
    assert found.drift_rate == pytest.approx(drift_law(cage), rel=0.05 if clearance else 0.01)


CRITICAL = 0.045720
ACROSS = {"groove_damping": math.inf, "groove_stiffness": 0.0, "race_damping": 4000.0}


def course_in_space(cage: MovingCage, duration: float, samples: int):
    """A run of a cage in space from 0.5 m/s, in double precision."""
    return follow_start(cage, 0.5, starts_at(cage), duration, samples, duration, real=np.float64)


@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.02, True)])
@pytest.mark.parametrize(
    ("changes", "critical"),
    [(ACROSS, CRITICAL), ({"race_damping": 2000.0, "groove_stiffness": 5.05e6}, 0.0903)],
)
def test_in_space_a_whirl_grows_above_the_linear_threshold(share, grows, changes, critical):
    """E9: sqrt(2 k M/Z)/(C cos b) = .045720 with flats that are free along the axis; .0903 with flats as stiff there."""
    cage = replace(ring(share * critical, clearance=0.0), **changes)
    if changes is ACROSS:
        cage = replace(cage, is_axially_held=False, pocket_clearance=0.0)
    energy = course_in_space(cage, 0.12, 121).kinetic_energy
    assert bool(energy[90:].mean() > energy[30:60].mean()) is grows


def test_in_space_a_whirl_tilts_as_the_linear_law_says():
    """E9: 2891.193 Hz, and a forced tilt of .039251 of the offset; the fit leaves 2e-3."""
    there = course_in_space(replace(ring(CRITICAL, clearance=0.0), **ACROSS), 0.1, 20_001)
    late = there.time > 0.05
    time, w, R = there.time[late], 2.0 * math.pi * 2891.193, AT_REST.pitch_radius
    waves = np.stack([0.0 * time + 1.0, time, np.exp(1j * w * time), np.exp(-1j * w * time)], 1)
    offset, tilt = (
        np.linalg.lstsq(waves, v[late] @ [1.0, 1j], rcond=None)[0] for v in (there.position, there.lean)
    )
    assert R * np.abs(tilt[2:]).max() / np.abs(offset[2:]).max() == pytest.approx(0.039251, rel=2e-3)
    turns = np.unwrap(np.angle(there.velocity[late] @ [1.0, 1j])) / (2.0 * math.pi)
    assert abs(np.polyfit(time, turns, 1)[0]) == pytest.approx(2891.193, rel=1e-4)
    assert ring(0.0).spin[1] / -ring(0.0).spin[0] == pytest.approx(math.tan(PITCH))
