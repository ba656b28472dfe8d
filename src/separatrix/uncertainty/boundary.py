"""From restitution factor, friction and cage to threshold and verdict of many samples at once.

The verdict is that of `cage.verdict` for an ensemble without end: STABLE where at most one run in ten whirls
from every kick, UNSTABLE where from some kick more than half whirl, clearly for an ensemble of 64, UNDECIDED
elsewhere. What the finite number of runs leaves open is drawn: a draw of the boundary is one that they allow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator, Philox
from numpy.typing import NDArray

from separatrix.uncertainty.surrogate import Surrogate
from separatrix.uncertainty.traced import TracedBoundary
from separatrix.units import Array

STABLE, UNDECIDED, UNSTABLE = 1, 0, -1
"""Verdict of a sample."""

VERDICTS = {STABLE: "STABLE", UNDECIDED: "UNDECIDED", UNSTABLE: "UNSTABLE"}
FINE = np.linspace(0.0, 1.0, 33)
"""Restitution factors at which the curve of a changed cage is taken, beside those that were traced."""

Verdicts = NDArray[np.int_]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Limits:
    """Frictions that part the verdicts of a sample, shape (sample,) each [-].

    STABLE from the first, below which the land drives the cage, to the second; UNSTABLE above the last.
    """

    stable_from: Array
    stable_up_to: Array
    unstable_above: Array

    def verdicts(self, friction: Array, *, drifts: bool = False) -> Verdicts:
        """Verdicts of frictions of shape (sample, case); a cage that drifts is never STABLE."""
        unstable = friction > self.unstable_above[:, None]
        held = (friction >= self.stable_from[:, None]) & (friction <= self.stable_up_to[:, None])
        stable = held & ~unstable & (not drifts)
        found: Verdicts = np.where(unstable, UNSTABLE, np.where(stable, STABLE, UNDECIDED))
        return found


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Boundary:
    """Boundary of a cage, with what the finite number of runs leaves open.

    Attributes
    ----------
    traced : TracedBoundary
        Lines of the cage as it is.
    surrogate : Surrogate or None
        How they move where the cage itself is uncertain.
    seed : int
        Of the draws.
    """

    traced: TracedBoundary
    surrogate: Surrogate | None = None
    seed: int = 0

    def limits(self, restitution_factor: Array, parameters: Array, draw: int | None = None) -> Limits:
        """Limits of samples.

        Parameters
        ----------
        restitution_factor : ndarray
            Shape (sample,) [-].
        parameters : ndarray
            Uncertain parameters of the cage, shape (sample, parameter); not used without a surrogate.
        draw : int or None
            Which of the boundaries that the runs allow; None is the one that they say.
        """
        if self.surrogate is None:
            few, clear = (self._lines_at(t, restitution_factor, draw) for t in (0, -1))
            least = np.zeros_like(few)
        else:
            half = self._lines_at(1, restitution_factor, None)  # their scatter is inside the surrogate's
            least, few, clear = self.surrogate.around(half, restitution_factor, parameters, draw)
        return Limits(
            stable_from=least.max(axis=0), stable_up_to=few.min(axis=0), unstable_above=clear.min(axis=0)
        )

    def critical_friction(
        self, restitution_factor: Array, parameters: Array, draw: int | None = None
    ) -> Array:
        """Friction at which half of the runs whirl from the reference kick, shape (sample,) [-]."""
        own = None if self._moves else draw
        line = self._lines_at(1, restitution_factor, own)[self.traced.middle]
        if self.surrogate is None or not self._moves:
            return np.asarray(line)
        shift = self.surrogate.shift(restitution_factor, parameters, draw)[self.traced.middle]
        return np.asarray(line * np.exp(shift))

    @property
    def _moves(self) -> bool:
        """Whether the cage itself is uncertain; if not, thresholds are those of the traced curve."""
        return self.surrogate is not None and bool(self.surrogate.scale.names)

    def _lines_at(self, target: int, eta: Array, draw: int | None) -> Array:
        """Lines of every kick at restitution factors, shape (kick, sample)."""
        lines = self._lines(draw)[:, target]
        return np.stack([np.interp(eta, self.traced.restitution_factors, line) for line in lines])

    def _lines(self, draw: int | None) -> Array:
        """Lines of the traced cage, as they may be."""
        if draw is None:
            return self.traced.lines()
        shape = (len(self.traced.kicks), self.traced.restitution_factors.size)
        return self.traced.lines(Generator(Philox(key=[self.seed, draw])).standard_normal(shape))

    def thresholds(self, friction: Array, parameters: Array, draws: NDArray[np.int_] | None = None) -> Array:
        """Restitution thresholds, shape (sample, case) [-].

        Parameters
        ----------
        friction : ndarray
            Shape (sample, case) [-].
        parameters : ndarray
            As in `limits`.
        draws : ndarray, optional
            Which boundary each sample has, shape (sample,); without it, the one that the runs say.
        """
        nodes, curves = self._curves(parameters, draws)
        return first_fall(nodes, curves, friction)

    def _curves(self, parameters: Array, draws: NDArray[np.int_] | None) -> tuple[Array, Array]:
        """Restitution factors, and the critical friction there of each sample (or of all alike)."""
        nodes, middle = self.traced.restitution_factors, self.traced.middle
        numbers = [None] if draws is None else [int(draw) for draw in np.unique(draws)]
        if self.surrogate is None or not self._moves:
            curves = np.stack([self._lines(draw)[middle, 1] for draw in numbers])
            return nodes, curves if draws is None else curves[np.searchsorted(np.unique(draws), draws)]
        fine = np.union1d(nodes, FINE)
        traced = np.interp(fine, nodes, self.traced.friction[middle, 1])
        curves = np.empty((len(parameters), fine.size))
        for draw in numbers:
            rows = slice(None) if draws is None else draws == draw
            shift = self.surrogate.shifts(middle, fine, parameters[rows], draw)
            curves[rows] = traced * np.exp(shift)
        return fine, curves


def first_fall(nodes: Array, curves: Array, friction: Array) -> Array:
    """Smallest restitution factor at which a curve falls below a friction; 1 if it does nowhere.

    Between two nodes a curve is a straight line, as in `stability.restitution_threshold`.

    Parameters
    ----------
    nodes : ndarray
        Rising restitution factors from 0 to 1, shape (node,) [-].
    curves : ndarray
        Shape (sample, node), or (1, node) for all alike [-].
    friction : ndarray
        Shape (sample, case) [-].
    """
    below = (curves[:, None, :] < friction[:, :, None]) | (curves <= 0.0)[:, None, :]
    at = np.where(below.any(axis=-1), below.argmax(axis=-1), nodes.size)
    here, before = np.minimum(at, nodes.size - 1), np.maximum(np.minimum(at, nodes.size - 1) - 1, 0)
    rows = np.arange(len(curves))[:, None] if len(curves) > 1 else 0
    f1, f0 = curves[rows, here], curves[rows, before]
    share = (f0 - friction) / np.where(f1 < f0, f0 - f1, np.inf)
    crossing = nodes[before] + (nodes[here] - nodes[before]) * np.where(f1 < f0, share, 1.0)
    return np.asarray(np.where(at == 0, nodes[0], np.where(at == nodes.size, 1.0, crossing)))


def own_draws(samples: int, draws: int) -> NDArray[np.int_]:
    """Return the boundary of each sample, all equally often, shape (sample,).

    In a fixed random order: in turn, a boundary would tell the first digits of its Sobol' points.
    """
    return np.random.default_rng((samples, draws)).permutation(samples) % draws
