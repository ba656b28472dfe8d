"""How often the intervals of Sobol indices hold the exact ones, on Ishigami's function.

    python benchmarks/sobol_coverage.py [REPEATS [SAMPLES ...]]

Beside them the percentile bootstrap of single rows of one scrambling (1000 resamples), which does not know
that quasi-random rows spread evenly.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from scipy.stats import qmc

from separatrix.distribution import Uniform
from separatrix.sensitivity import Case, Input, Question, sobol_indices
from separatrix.sensitivity.sobol import _first_and_total

A, B = 7.0, 0.1
RESAMPLES = 1000


class _Answer:
    """Margin, threshold and verdict alike for every purpose here."""

    def __init__(self, margin: np.ndarray) -> None:
        self.margin = self.threshold = margin
        self.verdict = (margin >= 0.0).astype(int)


def ishigami(x: np.ndarray) -> np.ndarray:
    """Return the function itself."""
    return (1.0 + B * x[..., 2] ** 4) * np.sin(x[..., 0]) + A * np.sin(x[..., 1]) ** 2


def exact() -> np.ndarray:
    """First-order and total indices, shape (2, 3)."""
    v1, v2 = 0.5 * (1.0 + B * np.pi**4 / 5.0) ** 2, A * A / 8.0
    v13 = B * B * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    return np.array([[v1, v2, 0.0], [v1 + v13, v2, v13]]) / (v1 + v2 + v13)


def asked() -> Question:
    """Ishigami's function as a question."""
    known = Uniform(low=-np.pi, high=np.pi)
    return Question(
        inputs=tuple(Input(name=f"x{i}", words=f"x{i}", unit="-", distribution=known) for i in range(3)),
        cases=(Case(candidate="ishigami", environment=""),),
        evaluate=lambda values: _Answer(ishigami(values)[:, None]),
    )


def ours(samples: int, seed: int) -> np.ndarray:
    """Low and high ends, shape (2 ends, 2, 3)."""
    rows = sorted(sobol_indices(asked(), samples, seed=seed).cases[0].margin, key=lambda one: one.factor)
    ends = [
        [[getattr(getattr(row, which), end) for row in rows] for which in ("first", "total")]
        for end in ("low", "high")
    ]
    return np.array(ends)


def bootstrap(samples: int, seed: int) -> np.ndarray:
    """Low and high ends from the same estimators by resampling the rows of one scrambling."""
    rng = np.random.default_rng(seed)
    points = np.pi * (2.0 * qmc.Sobol(6, rng=rng).random(samples) - 1.0)
    a, b = points[:, :3], points[:, 3:]
    mixed = np.repeat(a[None], 3, axis=0)
    for i in range(3):
        mixed[i, :, i] = b[:, i]
    fa, fb, fm = ishigami(a), ishigami(b), ishigami(mixed)
    middle = 0.5 * (fa.mean() + fb.mean())
    fa, fb, fm = fa - middle, fb - middle, fm - middle
    rows = np.vstack(
        [np.ones_like(fa), 0.5 * (fa + fb), 0.5 * (fa**2 + fb**2), fb * (fm - fa), 0.5 * (fm - fa) ** 2]
    )
    weights = rng.multinomial(samples, np.full(samples, 1.0 / samples), size=RESAMPLES)
    found = np.array([_first_and_total(sums) for sums in weights @ rows.T])
    return np.quantile(found, (0.025, 0.975), axis=0)


def main() -> None:
    """Print coverage and mean width for each number of samples."""
    given = [int(one) for one in sys.argv[1:]]
    repeats, sizes = (given[0] if given else 1000), (given[1:] or [256, 1024, 4096])
    true = exact()
    for samples in sizes:
        for name, method in (("scramblings", ours), ("row bootstrap", bootstrap)):
            count = repeats if method is ours else min(repeats, 100)
            start = time.perf_counter()
            ends = np.array([method(samples, seed) for seed in range(count)])
            inside = (ends[:, 0] <= true + 1e-12) & (ends[:, 1] >= true - 1e-12)
            share, width = inside.mean(axis=0), (ends[:, 1] - ends[:, 0]).mean(axis=0)
            print(
                f"n = {samples}, {name}, {count} repeats: inside {100 * inside.mean():.1f} %, "
                f"first {np.round(100 * share[0], 1)}, total {np.round(100 * share[1], 1)}; mean width "
                f"{np.round(width[0], 4)}, {np.round(width[1], 4)}; {time.perf_counter() - start:.1f} s"
            )


if __name__ == "__main__":
    main()
