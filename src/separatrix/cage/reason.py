"""The sentences of reason behind a verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.drive import drift_rate_law, drive_energy
from separatrix.cage.orbit import LEFT, kick_energy
from separatrix.cage.planar import PlanarCage, RunOutcome
from separatrix.units import Array, RadianPerSecond, Ratio

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble

Counts = NDArray[np.int64]
Mask = NDArray[np.bool_]


def at_every_kick(what: str, counts: Counts, runs: int) -> str:
    """Return what the runs do and how many of them at least."""
    least = int(counts.min())
    share = "all" if least == runs else f"at least {100 * least // runs} %"
    return f"{what} in {share} of the runs at every kick."


def untouched(ensemble: Ensemble, quiet: Array) -> str:
    """Return that nothing touches; a run may have ended before its time."""
    return (
        f"Too short to decide, or too weak a kick: from {quiet[0]:g} m/s nothing touches in any run "
        f"(at most {ensemble.duration:.3g} s)."
    )


def stalled(ensemble: Ensemble) -> str:
    """Return how many runs were ended for meeting too many events in no time."""
    count, total = int(ensemble.count(RunOutcome.STALLED).sum()), ensemble.outcome.size
    return f"{count} of {total} runs met too many impacts in no time and were ended."


def too_weak(cage: PlanarCage, ensemble: Ensemble, driven: Mask) -> str:
    """Return from which kicks the runs have more energy than the kick, but none that their drive lacks."""
    i = int(np.argmax(driven.mean(axis=1)))
    kick, drive = 1e3 * kick_energy(cage, ensemble)[i], 1e3 * drive_energy(cage)
    harder = math.sqrt(2.0 * drive_energy(cage) / cage.mass)
    return (
        f"Too weak a kick to decide: from {ensemble.kicks[i]:g} m/s ({kick:.3g} mJ) "
        f"{_percent(driven[i].mean())} of the runs end with more energy than the kick, but with no more than "
        f"{_drives(cage)} can give without it ({drive:.3g} mJ, as a kick of {harder:.3g} m/s)."
    )


def _drives(cage: PlanarCage) -> str:
    """Return what gives the cage energy without a kick."""
    acting = {
        "the turning frame": cage.cage_speed != 0.0,
        "gravity": cage.gravity > 0.0,
        "unbalance": cage.unbalance > 0.0,
        "the lead and lag of the balls": any(cage.orbital_cosines) or any(cage.orbital_sines),
    }
    *others, last = [name for name, is_there in acting.items() if is_there]
    return f"{', '.join(others)} and {last}" if others else last


def keeps_circling(cage: PlanarCage, ensemble: Ensemble, sustained: Mask) -> str:
    """Return how many runs neither die nor grow, how far from the axis, and how fast."""
    i = int(np.argmax(sustained.mean(axis=1)))
    offset = 1e3 * float(np.median(ensemble.mean_offset[i, sustained[i]]))
    speed = float(np.median(ensemble.orbit_speed[i, sustained[i]]))
    energy = _percent(np.median(ensemble.energy_growth[i, sustained[i]]))
    return (
        f"The motion neither dies nor grows in {_percent(sustained[i].mean())} of the runs from "
        f"{ensemble.kicks[i]:g} m/s: the centre keeps circling {offset:.3g} mm off the axis, "
        f"{_pace(cage, speed)}, on {energy} of the kick's energy."
    )


def _pace(cage: PlanarCage, orbit_speed: RadianPerSecond) -> str:
    """Return how fast the centre orbits the axis, and which way."""
    if cage.cage_speed == 0.0:
        return f"at {orbit_speed:.4g} rad/s"
    ratio = orbit_speed / abs(cage.cage_speed)  # runs are turned forward
    return f"{abs(ratio):.3g} times as fast as the ball set turns{'' if ratio > 0.0 else ', backward'}"


def out_of_pockets(cage: PlanarCage, ensemble: Ensemble, left: Mask) -> str:
    """Return how far off the centre ends."""
    offset, play = 1e3 * float(ensemble.mean_offset[left].max()), 1e3 * cage.half_play
    return (
        f"The motion dies, but the cage centre ends up to {offset:.3g} mm off in {int(left.sum())} of "
        f"{left.size} runs, more than {LEFT:g} times the half play of its pockets ({play:.3g} mm): the land "
        f"is too wide to guide it."
    )


def drift(cage: PlanarCage, ensemble: Ensemble, measured: float) -> str:
    """Return how many runs passed the play, and the rate of the drift as measured and by the linear law."""
    passed, total = int(ensemble.count(RunOutcome.DRIFT).sum()), ensemble.outcome.size
    seen = f"its offset passed the play of its pockets in {passed} of {total} runs"
    rate = drift_rate_law(cage)
    if rate > 0.0:
        return (
            f"The motion dies, but the cage has no land and drifts: {seen}, and by the linear law it grows "
            f"e-fold every {1.0 / rate:.3g} s (rate {rate:.3g} 1/s; measured {measured:.3g} 1/s)."
        )
    return f"The motion dies, but the cage has no land and drifts: {seen}."


def mixed(kicks: Array, calm: Mask, wild: Mask, grows: Counts, explained: Counts, runs: int) -> str:
    """Return that small kicks die and large ones grow, or what share grows from each kick.

    Parameters
    ----------
    kicks : ndarray
        Shape (kick,) [m/s].
    calm, wild : ndarray
        Whether nine in ten die, or grow beyond their drive, shape (kick,).
    grows, explained : ndarray
        Runs that grow, and those among them that their drive explains, shape (kick,).
    runs : int
        Runs at each kick.
    """
    below = max(kicks[calm], default=math.inf)
    above = min(kicks[wild], default=-math.inf)
    if below < above:
        return f"Sub-critical: the motion dies from {below:g} m/s and grows from {above:g} m/s."
    order = np.argsort(kicks)
    shares = ", ".join(_grown(kicks[i], grows[i] / runs, explained[i] / runs) for i in order)
    return f"No clear answer: the motion grows in {shares}."


def _grown(kick: float, share: Ratio, explained: Ratio) -> str:
    """Return the share that grows from a kick, and the share that its drive alone explains."""
    driven = f" (by the cage's drive alone: {_percent(explained)})" if explained else ""
    return f"{_percent(share)} from {kick:g} m/s{driven}"


def _percent(share: Ratio | np.floating) -> str:
    return f"{100 * float(share):.0f} %"
