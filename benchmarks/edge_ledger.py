"""Energy balance of random cages on the edges of their pockets: which open by more than 1e-9, or stall.

python benchmarks/edge_ledger.py [first seed] [last seed]: 100 cages each, 5000 to 5250 in four minutes.
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "physics"))

from space_cages import course
from test_cage_space_two_points import drawn_on_edges


def main(first: int, last: int) -> None:
    """Print every cage that stalls or whose balance is open, and how many ran."""
    began, ran = time.perf_counter(), 0
    for seed in range(first, last):
        rng = np.random.default_rng(seed)
        for draw in range(100):
            cage, start = drawn_on_edges(rng)
            there, ran = course(cage, 2e-3, samples=3, **start), ran + 1
            if there.filled != 3 or not there.imbalance < 1e-9:
                shape = cage.pocket_shape.name.lower()
                print(
                    seed, draw, shape, "stalls" if there.filled != 3 else f"{there.imbalance:.2e}", flush=True
                )
    print(f"{ran} cages in {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main(*(int(each) for each in sys.argv[1:3]) if len(sys.argv) > 2 else (5000, 5250))
