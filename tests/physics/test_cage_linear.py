"""The linear limit: closed form, exact roots and time integration agree."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST, damping_of, followed, linear_roots

from separatrix.cage import (
    PlanarCage,
    drift_law,
    linear_critical_friction,
    linear_whirl_frequency,
    run_ensemble,
)
from separatrix.study import StabilitySettings

M, K, Z = AT_REST.mass, AT_REST.ball_cage_stiffness, AT_REST.ball_count


def gripped(damping: float, friction: float = 0.0, **change: float) -> PlanarCage:
    """Cage whose pockets have no play."""
    grip = {"pocket_clearance": 0.0, "race_damping": damping, "ball_cage_friction": friction}
    return replace(AT_REST, **grip | change)


def growth_rate(cage: PlanarCage, duration: float) -> float:
    """Growth rate of the amplitude between the middle and the end of a run, from the kinetic energy [1/s]."""
    run = followed(cage, duration, direction=0.3, samples=40000)
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


@pytest.mark.parametrize("eta", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_time_integration_meets_the_linear_limit_within_two_per_cent(eta):
    """Two per cent below the limit the whirl decays, two per cent above it grows."""
    damping = damping_of(eta)
    limit = linear_critical_friction(gripped(damping))
    # long enough for e^1 of growth at 2 %: rate about (f - f_c) omega_0/2 for light damping
    duration = 0.15 if eta > 0.6 else 0.05
    assert growth_rate(gripped(damping, 0.98 * limit), duration) < 0
    assert growth_rate(gripped(damping, 1.02 * limit), duration) > 0


@pytest.mark.parametrize("speed", [0.0, 700.0, 3000.0])
@pytest.mark.parametrize("friction", [0.075, 0.095])
def test_time_integration_grows_at_the_exact_rate(speed, friction):
    """The whirling root of the linear system by another road: within 1 % of what the friction adds."""
    cage = gripped(2000.0, friction, cage_speed=speed)
    whirl = max(linear_roots(cage)[np.abs(linear_roots(cage).imag) > 5000], key=lambda root: root.real)
    added = 0.5 * friction * 2 * math.pi * linear_whirl_frequency(cage)
    # the step has omega dt = 1/3 at most, hence a phase error of (omega dt)^2/24 = 0.5 %
    assert growth_rate(cage, 0.012) == pytest.approx(whirl.real, abs=0.01 * added)


@pytest.mark.parametrize("outer", [False, True])
def test_whirl_is_forward_for_inner_rotation_and_backward_for_outer(outer):
    """2891.2 Hz within 1 % just above the limit, in the sense of the ball set or against it."""
    speeds = {"inner_speed": 0.0, "outer_speed": 1500.0} if outer else {}
    cage = gripped(2000.0, 1.05 * 0.08257, **speeds)
    result = run_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=2, duration=0.1))
    assert set(result.whirl_direction.ravel()) == {-1 if outer else 1}
    # the step's phase error is 0.5 % (above)
    assert result.whirl_frequency == pytest.approx(2891.2, rel=0.01)


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


@pytest.mark.parametrize("play", [0.0, 6e-4])
def test_a_landless_cage_drifts_at_the_rate_of_the_law(play):
    """2 M Omega^2/(Z C_mu), with and without play."""
    cage = gripped(500.0, 0.05, cage_speed=700.0, pocket_clearance=play)
    result = run_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=4, duration=0.4))
    # next order of the slow root: Omega^2 kappa^2/omega_0^4 = 4e-3, friction 1/(1+f^2) = 2.5e-3; with play
    # fewer balls touch at first and the rate is some per cent higher
    assert result.drift_rate == pytest.approx(drift_law(cage), rel=0.01 if play == 0.0 else 0.05)


def test_the_law_of_drift_is_the_slow_root():
    """The smallest root of the exact polynomial, within its next order (0.7 %, above)."""
    cage = gripped(500.0, 0.0, cage_speed=700.0)
    slow = min(linear_roots(cage), key=abs)
    assert slow.real == pytest.approx(drift_law(cage), rel=0.01)
