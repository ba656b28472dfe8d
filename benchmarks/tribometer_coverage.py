"""How often the stated 95 % interval of friction holds the known one, over synthetic logs of every kind.

    python benchmarks/tribometer_coverage.py [LOGS] [FORMAT ...]

LOGS logs (1000) are drawn from the recipes of tests/physics/synthetic_friction.py, reduced as they are and, for
each format, written, read back and reduced. "Held" counts logs whose interval holds the truth: the mean, over the
steady part that the reduction states, of the friction without noise, running-in and modulation. "Flagged" ones
carry the sentence that the interval may be too narrow, or that running-in does not end.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "physics"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "unit"))

from synthetic_friction import CORRELATIONS, Made, Recipe, made, recipes

from separatrix.cage import wilson_interval
from separatrix.errors import InputError
from separatrix.tribometer.friction_test import TestFriction
from separatrix.tribometer.reduction import reduce_log

SEED = 20260
WARNED = ("may be too narrow", "does not end")


def groups(recipe: Recipe) -> Iterator[str]:
    """Names of the groups that a recipe belongs to."""
    near = min(CORRELATIONS, key=lambda value: abs(value - recipe.correlation))
    yield f"correlation {100 * near:g} %"
    yield f"run-in {100 * recipe.run_in:2.0f} %" if recipe.run_in == 0.0 else f"run-in to {100 * _up(recipe.run_in):.0f} %"
    yield "drift" if recipe.drift else "no drift"
    yield "missing rows" if recipe.missing else "every row"
    yield "irregular" if recipe.irregular else "regular"
    yield f"{_size(recipe.rows)} rows"
    yield "modulated" if recipe.modulation else "not modulated"
    yield "with white noise" if recipe.white else "without white noise"


def _up(run_in: float) -> float:
    return next(value for value in (0.05, 0.15, 0.3) if run_in <= value)


def _size(rows: int) -> str:
    return next(f"up to {most}" for most in (400, 1400, 6000, 20000) if rows <= most)


def holds(test: TestFriction, known: Made) -> tuple[float, bool]:
    """Error in standard errors, and whether the interval holds the truth."""
    error = test.friction - known.truth(test.run_in_end, test.steady_end)
    return error / test.standard_error, abs(error) <= test.half_width


class Tally:
    """Counts of one group."""

    def __init__(self) -> None:
        self.errors: list[float] = []
        self.held: list[bool] = []
        self.warned: list[bool] = []

    def add(self, test: TestFriction, known: Made) -> None:
        """Count one test."""
        error, held = holds(test, known)
        self.errors.append(error)
        self.held.append(held)
        self.warned.append(any(words in flag for flag in test.flags for words in WARNED))

    def line(self) -> str:
        """Counts as text."""
        n, k = len(self.held), sum(self.held)
        low, high = wilson_interval(k, n)
        calm = [held for held, warned in zip(self.held, self.warned, strict=True) if not warned]
        return (
            f"{n:5d} logs, held {100 * k / n:5.1f} % ({100 * low:.1f} to {100 * high:.1f}), median error "
            f"{np.median(self.errors):+.2f} standard errors, flagged {100 * np.mean(self.warned):.1f} %, "
            f"held of the others {100 * np.mean(calm):.1f} %"
        )


def report(pairs: Iterator[tuple[TestFriction, Made]]) -> None:
    """Print the counts of every group."""
    tallies: dict[str, Tally] = defaultdict(Tally)
    for test, known in pairs:
        for name in ("all", *groups(known.recipe)):
            tallies[name].add(test, known)
    for name in sorted(tallies, key=lambda name: (name != "all", name)):
        print(f"  {name:22s} {tallies[name].line()}", flush=True)


def logs(count: int, seed: int = SEED) -> Iterator[Made]:
    """Logs of every kind, the same for the same seed."""
    rng = np.random.default_rng(seed)
    for recipe in recipes(count, rng):
        yield made(recipe, rng)


def as_made(count: int, seed: int) -> Iterator[tuple[TestFriction, Made]]:
    """Friction of the logs without a file between."""
    for known in logs(count, seed):
        try:
            yield reduce_log(known.log), known
        except InputError as error:
            print(f"  refused: {error}")


def main() -> None:
    """Report the coverage without a file."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else SEED
    print("as made:")
    report(as_made(count, seed))


if __name__ == "__main__":
    main()
