"""Where methods of the literature cut running-in, and what their cut does to the mean and its interval.

    python benchmarks/run_in_methods.py [LOGS]

Each method cuts the same synthetic logs (500 for each length of running-in); what is left goes through the
same mean and standard error. Reported are the share of intervals that hold the truth, root mean square and
median size of the error over the noise of the logs, and the middle cut.

none: nothing is cut. mser5: the marginal standard error of means of five rows is least, within the first half
(White 1997; White, Cobb and Spratt 2000). geweke: tenths are cut until the first tenth agrees with the last
half at 1.96 (Geweke 1992). chodera: most effective samples are left (Chodera 2016), by Geyer's positive
sequence. cusum: the largest excursion of the cumulative sum, one change point in the first half.
ours: `separatrix.friction.steady`, and the same without the rest of the fall in the error.
"""
# ruff: noqa: E402  the makers of logs are found beside the tests

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT / "tests" / "physics")]

from synthetic_friction import RUN_INS, Made, made, recipes

from separatrix.friction.steady import half_width, run_in, steady_mean
from separatrix.ground.units import Array

SPANS = 256


def none(_values: Array) -> float:
    """Cut nothing."""
    return 0.0


def mser5(values: Array) -> float:
    """Cut where the marginal standard error of means of five is least."""
    means = spans(values, values.size // 5)
    n = means.size
    left = np.arange(n, 0, -1)
    mean = np.cumsum(means[::-1])[::-1] / left
    square = np.cumsum(means[::-1] ** 2)[::-1] - left * mean**2
    return float(np.argmin((square / left**2)[: n // 2]) / n)


def geweke(values: Array) -> float:
    """Cut tenths until the first tenth agrees with the last half."""
    means = spans(values)
    n = means.size
    for tenth in range(6):
        left = means[tenth * n // 10 :]
        first, last = left[: left.size // 10], left[left.size // 2 :]
        error = np.hypot(error_of(first), error_of(last))
        if abs(first.mean() - last.mean()) < 1.96 * error:
            return tenth / 10
    return 0.5


def chodera(values: Array) -> float:
    """Cut where most effective samples are left."""
    means = spans(values)
    cuts = np.arange(0, 3 * means.size // 4, 4)
    counts = [(means.size - cut) / inefficiency(means[cut:]) for cut in cuts.tolist()]
    return float(cuts[int(np.argmax(counts))] / means.size)


def cusum(values: Array) -> float:
    """Cut at the most likely single change of the mean, if it is in the first half."""
    means = spans(values)
    n = means.size
    split = np.arange(1, n)
    left = np.cumsum(means - means.mean())[:-1]
    change = int(split[np.argmax(left**2 / (split * (n - split)))])
    return change / n if change <= n // 2 else 0.0


def ours(values: Array) -> float:
    """Cut as the package does."""
    return run_in(spans(values)).end


def ours_bare(values: Array) -> float:
    """Cut as the package does."""
    return ours(values)


METHODS: tuple[Callable[[Array], float], ...] = (none, mser5, geweke, chodera, cusum, ours_bare, ours)


def spans(values: Array, count: int = SPANS) -> Array:
    """Means over equal numbers of rows, those that fill none left out at the start."""
    count = max(12, min(count, values.size // 3))
    size = values.size // count
    return np.asarray(values[values.size - size * count :].reshape(count, size).mean(axis=1))


def inefficiency(values: Array) -> float:
    """Statistical inefficiency by Geyer's initial positive sequence."""
    level = values - values.mean()
    n = level.size
    power = np.abs(np.fft.rfft(level, 2 * n)) ** 2
    rho = np.fft.irfft(power)[:n]
    pairs = (rho / max(rho[0], 1e-300))[: n // 2 * 2].reshape(-1, 2).sum(axis=1)
    end = int(np.argmax(pairs <= 0.0)) if (pairs <= 0.0).any() else pairs.size
    return max(1.0, float(2.0 * pairs[:end].sum() - 1.0))


def error_of(values: Array) -> float:
    """Standard error of a mean with that inefficiency."""
    return float(np.sqrt(values.var(ddof=1) * inefficiency(values) / values.size))


def main() -> None:
    """Compare the methods."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    for length in RUN_INS:
        rng = np.random.default_rng(77)
        found: dict[str, list[tuple[bool, float, float]]] = {method.__name__: [] for method in METHODS}
        for recipe in recipes(count, rng):
            even = replace(recipe, run_in=length, modulation=0.0, missing=0.0, irregular=False)
            known = made(even, rng)
            for method in METHODS:
                found[method.__name__].append(judged(method, known))
        print(f"running-in {100 * length:.0f} % of {count} logs:")
        for name, results in found.items():
            held, errors, cuts = (np.array(column) for column in zip(*results, strict=True))
            print(
                f"  {name:9s} held {100 * held.mean():5.1f} %, error / noise: root mean square "
                f"{np.sqrt((errors**2).mean()):.3f}, median size {np.median(np.abs(errors)):.3f}, "
                f"middle cut {100 * np.median(cuts):3.0f} %",
                flush=True,
            )


def judged(method: Callable[[Array], float], known: Made) -> tuple[bool, float, float]:
    """Whether the interval after a cut holds the truth, its error over the noise, and the cut."""
    friction = known.log.friction
    cut = method(friction)
    left = spans(friction[round(cut * friction.size) :])
    used = left.size * ((friction.size - round(cut * friction.size)) // left.size)
    mean = steady_mean(left)
    rest = run_in(spans(friction)).rest if method is ours else 0.0
    error = mean.mean - known.truth(known.length * (1.0 - used / friction.size), known.length)
    half = half_width(float(np.hypot(mean.standard_error, rest)), mean.degrees_of_freedom)
    return abs(error) <= half, error / known.recipe.noise, cut


if __name__ == "__main__":
    main()
