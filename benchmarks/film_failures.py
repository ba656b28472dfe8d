"""How often a film that fails early in a test is told, and how often one that does not.

    python benchmarks/film_failures.py [--seed SEED] [LOGS]

LOGS logs (1000) are made as by tribometer_coverage.py and reduced: none holds a failure. In as many again
friction is multiplied by 2 to 5 at 5 to 30 % of the test, and stays there; running-in and drift go on. They
are grouped by friction behind running-in over that just before the failure, running-in included.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "physics"))

from synthetic_friction import Recipe, made, recipes

from separatrix.friction.reduction import reduce_log
from separatrix.verdict.judgement import wilson_interval

SEED = 60606
PLACES, SIZES = (0.05, 0.3), (2.0, 5.0)
"""Shares of the test, and friction after over before, without running-in."""

EDGES = (0.0, 1.5, 2.0, 2.5, 3.0, 5.0, 10.0)
"""Of the groups."""

WORDS = ("next to what is cut as running-in", "Seizure or a failed film")
"""By which flags tell of it."""

Told = tuple[float, list[bool]]


def sound(count: int, rng: np.random.Generator) -> Iterator[tuple[bool, bool]]:
    """Whether the friction of a log rises in running-in at all, and whether it is told as a failure."""
    for recipe in recipes(count, rng):
        flags = " ".join(reduce_log(made(recipe, rng).log).flags)
        yield recipe.run_in > 0.0 and recipe.excess < 0.0, WORDS[0] in flags


def failed(count: int, rng: np.random.Generator) -> Iterator[Told]:
    """Friction behind a failure over that before it, and which flags tell of it."""
    for recipe in recipes(count, rng):
        place, size = rng.uniform(*PLACES), rng.uniform(*SIZES)
        known = made(recipe, rng)
        time = known.log.time
        step = (size - 1.0) * recipe.friction * (time >= place * known.length)
        log = replace(known.log, friction=known.log.friction + step)
        flags = " ".join(reduce_log(log).flags)
        yield size * recipe.friction / _before(recipe, place), [words in flags for words in WORDS]


def _before(recipe: Recipe, place: float) -> float:
    left = recipe.excess * np.exp(-3.0 * place / recipe.run_in) if recipe.run_in else 0.0
    return float(recipe.friction + recipe.drift * (place - 0.5) + left)


def share(flags: list[bool]) -> str:
    """Count and share with its interval."""
    low, high = wilson_interval(sum(flags), len(flags))
    return f"{sum(flags)} of {len(flags)}, {100 * np.mean(flags):.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def main() -> None:
    """Report both rates."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("logs", type=int, nargs="?", default=1000)
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    rng = np.random.default_rng(given.seed)
    calm = list(sound(given.logs, rng))
    print(f"no failure, told as one: {share([alarm for _, alarm in calm])}")
    print(f"  where running-in rises: {share([alarm for rises, alarm in calm if rises])}")
    answers = list(failed(given.logs, rng))
    for low, high in [*itertools.pairwise(EDGES), (2.0, EDGES[-1])]:
        told = [flags for rise, flags in answers if low <= rise < high]
        kinds = ", ".join(f"{words!r} {sum(flags[i] for flags in told)}" for i, words in enumerate(WORDS))
        if told:
            print(f"failure to {low:g} to {high:g} times: told {share([any(f) for f in told])}: {kinds}")


if __name__ == "__main__":
    main()
