"""How well a fitted boundary foretells runs that it was not fitted to, and what that adds to its scatter."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from separatrix.uncertainty.records import SurrogateError
from separatrix.uncertainty.surrogate import LEAST_SHARE, Points, Surrogate, foretold_of, runs_of
from separatrix.units import Array

PARTS = 5
"""Parts of equal numbers in which the held-out runs are looked at, along eta and along each parameter."""

BINS = 8
FEWEST = 12
"""Runs below which a part says nothing."""

LARGEST_ERROR = 0.2
"""Standard deviation of ln f from which on the boundary decides nothing: most frictions scatter by 0.1."""


def foretold(surrogate: Surrogate, points: Points) -> tuple[Array, Array]:
    """P(whirl) of each run, and how its logit falls with the shift of the boundary, shape (run,)."""
    share, steepness = np.zeros(points.kick.size), np.zeros(points.kick.size)
    for kick, mode in enumerate(surrogate.mode):
        own = points.kick == kick
        told = foretold_of(mode, runs_of(points.of(own), surrogate.scale, surrogate.knots))
        share[own], steepness[own] = told.share, told.by_pockets / told.width
    return share, steepness


def misfit(surrogate: Surrogate, points: Points) -> float:
    """Standard deviation of ln f by which the fit misses parts of the runs, beyond their own scatter [-].

    In every part one step of Newton's says by how much the boundary should shift, and the information how
    well that is known; what the squared shifts have in excess of it is misfit. The largest excess over the
    ways of parting counts. Misfit inside a part is not seen: it makes the fitted widths larger, which is on
    the careful side.
    """
    share, steepness = foretold(surrogate, points)
    push, information = (share - points.grew) * steepness, share * (1.0 - share) * steepness**2
    return math.sqrt(max(0.0, *(_excess(push, information, part) for part in _partings(surrogate, points))))


def _partings(surrogate: Surrogate, points: Points) -> Iterator[NDArray[np.int_]]:
    """Yield number of its part for each run: by kick, and along eta, a parameter or the land's play."""
    play = surrogate.scale.play
    ratio = [] if play is None else [play.ratio(points.parameters)]
    for along in (points.restitution_factor, *points.parameters.T, *ratio):
        ends = np.quantile(along, np.linspace(0.0, 1.0, PARTS + 1)[1:-1])
        yield points.kick.astype(np.int_) * PARTS + np.searchsorted(ends, along)


def _excess(push: Array, information: Array, part: NDArray[np.int_]) -> float:
    """Mean square shift of the parts less what their runs' scatter explains; 0 where none has enough runs."""
    sizes = np.bincount(part)
    known = np.flatnonzero(sizes >= FEWEST)
    if known.size == 0:
        return 0.0
    total = np.bincount(part, weights=information)[known]
    shift = np.bincount(part, weights=push)[known] / total
    return float(np.mean(shift**2 - 1.0 / total))


def error_of(surrogate: Surrogate, eta: Array, parameters: Array) -> float:
    """Standard deviation of ln f at samples, coefficients and misfit together, root mean square [-]."""
    terms = surrogate.terms(eta, parameters)
    spread = [np.sum((terms @ root[: terms.shape[1]]) ** 2, axis=1) for root in surrogate.root]
    return math.sqrt(float(np.mean(spread)) + surrogate.misfit**2)


def deviance(share: Array, grew: Array) -> float:
    """Mean of minus twice the logarithm of the probability of what each run did."""
    known = np.clip(np.where(grew > 0.5, share, 1.0 - share), LEAST_SHARE, 1.0)
    return float(-2.0 * np.mean(np.log(known)))


def calibration(share: Array, grew: Array) -> tuple[Array, Array, Array]:
    """Mean predicted probability, whirling runs and runs in bins of equal size, shape (bin,) each."""
    order = np.array_split(np.argsort(share, kind="stable"), BINS)
    return (
        np.array([share[part].mean() for part in order]),
        np.array([grew[part].sum() for part in order]),
        np.array([float(part.size) for part in order]),
    )


def surrogate_error(
    tried: Surrogate,
    held_out: Points,
    final: Surrogate,
    eta: Array,
    parameters: Array,
    *,
    runs: int,
    cages: int,
) -> SurrogateError:
    """Record of the error of `final`, as `tried`, fitted without the held-out runs, shows it."""
    share, _ = foretold(tried, held_out)
    common = np.full(share.size, held_out.grew.mean())
    predicted, whirling, counted = calibration(share, held_out.grew)
    error = error_of(final, eta, parameters)
    return SurrogateError(
        runs=runs,
        held_out=held_out.grew.size,
        cages=cages,
        deviance=deviance(share, held_out.grew),
        deviance_constant=deviance(common, held_out.grew),
        predicted=predicted,
        whirling=whirling,
        counted=counted,
        misfit=final.misfit,
        error=error,
        decides=error <= LARGEST_ERROR,
    )
