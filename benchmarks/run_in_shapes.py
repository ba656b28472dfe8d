"""How often the 95 % interval holds the steady friction, for shapes of running-in that no method assumes.

    python benchmarks/run_in_shapes.py [LOGS] [SEED]

For each shape of `tests/physics/running_in.py`, with white and with correlated noise: the share of LOGS (200)
whose interval holds the friction that the test ends at, the middle of (end found)/(end of running-in), the
middle half width and the root mean square error over friction.
"""
# ruff: noqa: E402  the makers of logs are found beside the tests

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parent.parent / "tests" / "physics")]

from running_in import LEVEL, SHAPES, made

from separatrix.friction.reduction import reduce_log


def row(name: str, logs: int, rng: np.random.Generator, *, correlated: bool) -> tuple[float, ...]:
    """Share held, end over the true one, half width and error over friction."""
    found = [made(name, rng, correlated=correlated) for _ in range(logs)]
    tests = [(reduce_log(log), length, log.time[-1]) for log, length in found]
    errors = np.array([test.friction - LEVEL for test, _, _ in tests])
    halves = np.array([test.half_width for test, _, _ in tests])
    ends = [test.run_in_end / last / length for test, length, last in tests]
    return (
        float(np.mean(np.abs(errors) <= halves)),
        float(np.median(ends)),
        float(np.median(halves) / LEVEL),
        float(np.sqrt(np.mean(errors**2)) / LEVEL),
    )


def main() -> None:
    """Print the table of friction-tests.md."""
    given = [int(text) for text in sys.argv[1:]]
    logs, seed = [*given, *(200, 20261122)[len(given) :]]
    rng = np.random.default_rng(seed)
    print("| running-in | held | end | half width | error | held | end | half width | error |")
    held = []
    for name in SHAPES:
        cells = []
        for correlated in (False, True):
            share, end, half, error = row(name, logs, rng, correlated=correlated)
            held.append(share)
            cells.append(f"{100 * share:.1f} % | {end:.2f} | {100 * half:.1f} % | {100 * error:.1f} %")
        print(f"| {name} | {' | '.join(cells)} |", flush=True)
    print(f"all: {100 * np.mean(held):.1f} %")


if __name__ == "__main__":
    main()
