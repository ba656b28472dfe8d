"""What an ensemble says of its runs, against sums over densely sampled histories of the same runs.

Tolerances: a history of 20 000 rows has some 50 within an impact, so trapezia are good to 1e-3, and the
largest of the rows to (pi/50)^2/8 = 5e-4; rates go with logarithms of such means, over a fifth of 4 ms. The
ensemble reads the turning of the velocity at five places of a step: to 1 %. What counts events is exact.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import ON_A_LAND

from separatrix.cage import run_ensemble, simulate
from separatrix.cage.closed_forms import time_unit
from separatrix.cage.ending import run_limits
from separatrix.study import Guidance, StabilitySettings

HELD = replace(
    ON_A_LAND,
    moment_of_inertia=1.3 * ON_A_LAND.moment_of_inertia,
    race_damping=1500.0,
    land_clearance=5e-4,
)
CAGES = {
    "land": HELD,
    "backward": replace(HELD, cage_speed=-670.0, inner_speed=-1570.0),
    "no land": replace(HELD, guidance=Guidance.BALL, land_clearance=None, ball_cage_friction=0.02),
    "no land, at rest": replace(HELD, guidance=Guidance.BALL, land_clearance=None, cage_speed=0.0),
    "Hertz": replace(HELD, hertz_coefficient=3e8),
}
SETTINGS = StabilitySettings(kicks=(0.5,), runs=3, duration=0.02, seed=4)


@pytest.mark.parametrize("cage", CAGES.values(), ids=CAGES)
def test_the_evidence_of_a_run_is_that_of_its_history(cage):
    """Means, spreads, rates and largest values over the run and its last part; impacts one by one."""
    found = run_ensemble(cage, SETTINGS)
    for run in range(SETTINGS.runs):
        ours = simulate(cage, kick=0.5, run=run, seed=4, duration=0.02, samples=160_000)
        assert (ours.judged_from, ours.judged_until) == (found.judged_from[0, run], found.followed[0, run])
        for name, value, tolerance in told(cage, ours):
            assert getattr(found, name)[0, run] == pytest.approx(value, **tolerance), name
        whole = between(ours, 0.0, ours.judged_until)
        assert found.pocket_impacts[0, run].tolist() == begun(ours.contact_force[whole] != 0.0).tolist()
        # A land that presses again before the cage has left it is one impact (2 of 28 seen).
        pressed = begun(ours.land_force[whole] > 0.0)
        assert pressed - 3 <= found.land_impacts[0, run] <= pressed + 1


def test_the_largest_offset_and_force_without_play_are_those_of_the_history():
    """Dying down it is farthest off at its first turn, within a step: by parabolas, 5e-4 (1e-4 seen)."""
    cage = replace(
        CAGES["no land, at rest"], pocket_clearance=0.0, ball_cage_friction=0.0, race_damping=800.0
    )
    found = run_ensemble(cage, replace(SETTINGS, duration=0.005))
    for run in range(SETTINGS.runs):
        ours = simulate(cage, kick=0.5, run=run, seed=4, duration=0.005, samples=100_000)
        farthest, force = np.hypot(*ours.position.T).max(), np.abs(ours.contact_force).max()
        assert found.largest_offset[0, run] == pytest.approx(farthest, rel=5e-4)
        assert found.largest_contact_force[0, run] == pytest.approx(force, rel=1e-5)  # the history's rows


def told(cage, ours):
    """Name, value and tolerance of what a history tells of its run.

    A fifth has 4000 rows or more and ends within one, 2.5e-4 of it at each end: means differ by up to 6e-4,
    rates and orbit by such a part of what they are differences of. Between two rows a largest value is missed
    by up to 6e-5. A row across an impact, of some 10 in its contact, turns the heading by a finite angle, and
    an ensemble reads it at five places of a step: 2.5 % of what it turns either way (seen: 2.1 %). Work done
    in a touch at an end of the last part is cut by a row (seen: 3.3e-3 of the work there).
    """
    near, cut, largest = {"rel": 1e-3}, {"rel": 5e-3}, {"rel": 5e-4}
    limits = run_limits(cage, 0.5, SETTINGS.duration)
    look = limits.beats * limits.beat * time_unit(cage)
    end = round(ours.judged_until / look)
    n, half = end // 5, end // 2 - end // 5 // 2
    last = between(ours, ours.judged_from, ours.judged_until)
    roams = math.isinf(cage.land_gap) and cage.cage_speed != 0.0
    drift = max(n, min(end, limits.window) // 2 if roams else min(limits.window // 2, end // 4))
    halfway, fifth = (between(ours, look * a, look * (a + n)) for a in (half, end - n))
    before, after = (between(ours, look * (end - a * drift), look * (end - (a - 1) * drift)) for a in (2, 1))
    (x, y), (vx, vy) = ours.position.T, ours.velocity.T
    energy, r, speed = ours.kinetic_energy, np.hypot(x, y), np.hypot(vx, vy)
    heading = np.unwrap(np.arctan2(vy, vx))
    growth = 0.5 * math.log(mean(ours, energy, fifth) / mean(ours, energy, halfway))
    offset, square = mean(ours, r, last), mean(ours, r**2, last)
    swept = mean(ours, x * vy - y * vx, last)
    turning = ((0.5 * (speed[1:] + speed[:-1])) ** 2 * np.diff(heading))[last][:-1]
    weight = 2 * math.pi * mean(ours, speed**2, last) * np.ptp(ours.time[last])
    whirl, either_way = np.sum(turning) / weight, np.sum(np.abs(turning)) / weight
    sense = 1 if cage.cage_speed >= 0.0 else -1
    ends = [
        math.hypot(mean(ours, x, rows), mean(ours, y, rows)) if roams else mean(ours, r, rows)
        for rows in (before, after)
    ]
    whole = between(ours, 0.0, ours.judged_until)
    return [
        ("end_energy", mean(ours, energy, last), near),
        ("growth_rate", growth / ((end - n - half) * look), {"abs": 1e-3 / ((end - n - half) * look)}),
        ("largest_offset", r[whole].max(), largest),
        ("mean_offset", offset, near),
        ("offset_spread", math.sqrt(square - offset**2), near),
        ("orbit_speed", sense * swept / square + abs(cage.cage_speed), {"rel": 1e-3, "abs": 1e-3 * 670.0}),
        ("drift_rate", math.log(ends[1] / ends[0]) / (drift * look), {"abs": 1e-3 / (drift * look)}),
        ("whirl_frequency", abs(whirl), {"abs": 0.025 * either_way}),
        ("whirl_direction", sense * np.sign(whirl), {}),
        ("largest_contact_force", np.abs(ours.contact_force[whole]).max(), largest),
        ("largest_land_force", ours.land_force[whole].max(), largest),
        ("rubbing_force", mean(ours, ours.land_force, last), near),
        *((name, power(ours, work, last), cut) for name, work in WORKS.items()),
    ]


WORKS = {"pocket_power": "pocket_friction", "land_power": "land_friction"}


def power(ours, work, rows):
    """Mean power of a source of work over some rows."""
    return np.ptp(ours.time[rows]) ** -1 * (ours.work[work][rows][-1] - ours.work[work][rows][0])


def between(ours, start, end):
    """Rows of a part of the run."""
    first, last = np.searchsorted(ours.time, [start, end])
    return slice(int(first), int(last))


def mean(ours, values, rows):
    """Mean over time of some rows."""
    return np.trapezoid(values[rows], ours.time[rows]) / np.ptp(ours.time[rows])


def begun(touching):
    """How often each column begins to be true."""
    return (touching[1:] & ~touching[:-1]).sum(axis=0) + touching[0]
