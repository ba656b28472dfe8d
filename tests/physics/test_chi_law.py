"""Kick over clearance, chi = v0 sqrt(M/k)/c_p, decides: impacts, a softened whirl, then the linear law.

The whole curves are in docs/images/chi-law.csv (benchmarks/chi_law.py); the points here are of that cage.
"""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from cages import SMALL as CAGE

from separatrix.cage import linear_critical_friction, run_ensemble
from separatrix.study.study import StabilitySettings
from separatrix.verdict.crossing import cage_at

MASS, STIFFNESS, HALF_PLAY = CAGE.mass, CAGE.ball_cage_stiffness, CAGE.half_play
CROSSINGS = 250


def settings(chi, runs=64):
    """Ensemble of one kick, as long as in the curves: 0.3 s, or 250 crossings of the clearance."""
    duration = max(0.3, CROSSINGS * crossing(chi))
    return StabilitySettings(kicks=(2 * HALF_PLAY / crossing(chi),), runs=runs, duration=duration)


def crossing(chi):
    """Time in which the kick crosses the play [s]."""
    return 2 * sqrt(MASS / STIFFNESS) / chi


def linear(eta):
    """Critical friction without clearance."""
    return linear_critical_friction(cage_at(CAGE, eta, 0.0))


@pytest.mark.parametrize("chi", [0.0121, 0.215])
def test_kick_and_clearance_count_by_their_ratio_only(chi):
    """Twice the kick in twice the play is the same motion, twice as large: every bit of it.

    So must be the speeds of the ball's surface, against which friction acts.
    """
    cage, ensemble = cage_at(CAGE, 0.8, 0.12), settings(chi, 16)
    cage = replace(cage, ball_diameter=0.01, ball_spin=(-1e6, 0.0, 0.0))
    wide = replace(cage, pocket_clearance=2 * CAGE.pocket_clearance, ball_spin=(-2e6, 0.0, 0.0))
    small = run_ensemble(cage, ensemble)
    large = run_ensemble(wide, ensemble, kicks=[2 * kick for kick in ensemble.kicks])
    assert (small.outcome == large.outcome).all()
    assert (4 * small.end_energy == large.end_energy).all()


def energy_over_kick(eta, friction, chi):
    """Energy at the end over the kick's, of four runs."""
    how, cage = settings(chi, 4), cage_at(CAGE, eta, friction)
    return run_ensemble(cage, how).end_energy[0] / (0.5 * MASS * how.kicks[0] ** 2)


@pytest.mark.parametrize(
    ("chi", "eta", "dies", "grows"),
    [(12.1, 0.6, 0.82, 0.97), (12.1, 0.3, 0.82, 0.97), (121.0, 0.8, 0.94, 1.05), (121.0, 0.3, 0.94, 1.05)],
)
def test_strong_kicks_meet_the_linear_law_from_below(chi, eta, dies, grows):
    """Harmonic balance has 0.88 of the limit at chi of 12, 0.988 at 121: all shrink below it, all grow above.

    At 12 the play takes a fifth of the pockets' stiffness, and the linear law goes with its root.
    """
    assert np.all(energy_over_kick(eta, dies * linear(eta), chi) < 0.5)
    assert np.all(energy_over_kick(eta, grows * linear(eta), chi) > 2.0)
