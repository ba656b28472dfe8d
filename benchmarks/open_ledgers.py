"""Random cages with every input at once: each ends, in finite numbers, and closes its ledger of energy.

    python benchmarks/open_ledgers.py [--cages 1000] [--first 0]

As many in the plane as in space (tests/physics/cages.py), 16 runs each from 0.3 m/s. A cage whose
ledger leaves more than 1e-2 of the work done open is printed with its outcomes. Some minutes on two cores.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from pathlib import Path

import numpy as np

from separatrix.cage import run_ensemble
from separatrix.study.study import StabilitySettings

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "physics"))
from cages import random_cage

SETTINGS = StabilitySettings(kicks=(0.3,), runs=16, duration=1e-3)
OPEN = 1e-2
"""Share of the work done that is worth a line."""


def ledger(seed: int, space: bool) -> tuple[float, str]:
    """Largest open part of one cage, and its line; raises where a number is not finite."""
    cage = random_cage(np.random.default_rng((31, seed, space)), space)
    found = run_ensemble(cage, SETTINGS)
    for field in fields(found):
        if (values := getattr(found, field.name)) is not None and not np.all(np.isfinite(values)):
            raise ArithmeticError(f"{seed} {cage.motion.value}: {field.name} is not finite")
    left = float(found.energy_imbalance.max())
    counts = np.bincount(found.outcome.ravel(), minlength=5).tolist()
    return left, (
        f"{seed:5d} {cage.motion.value:5s} {left:.1e}; settle, whirl, drift, unresolved, roll {counts}; "
        f"land {found.largest_land_force.max():.0f} N, pocket {found.largest_contact_force.max():.0f} N"
    )


def main() -> None:
    """Print what is open, and the quantiles of all."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("cages", 1000), ("first", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    asked = parser.parse_args()
    seeds = range(asked.first, asked.first + asked.cages)
    for space in (False, True):
        begun = time.perf_counter()
        with ThreadPoolExecutor(2) as pool:
            found = list(pool.map(lambda seed, s=space: ledger(seed, s), seeds))
        for left, line in found:
            if left > OPEN:
                print(line)
        opens = np.array([left for left, _ in found])
        quantiles = ", ".join(f"{q:g}: {np.quantile(opens, q):.1e}" for q in (0.5, 0.9, 0.99, 1.0))
        took = time.perf_counter() - begun
        print(
            f"{'space' if space else 'plane'}: {len(found)} cages in {took:.0f} s; open {quantiles}",
            flush=True,
        )


if __name__ == "__main__":
    main()
