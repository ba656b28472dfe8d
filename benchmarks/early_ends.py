"""How many outcomes change because a run ends as soon as its end is known.

    python benchmarks/early_ends.py

The shipped cage and others made of it: 16 runs from each kick at 6 restitution factors and 6 frictions, once
as the stability curve counts them and once followed to the end (what has grown to 10 000 times the energy
scale ends there too). About five minutes on two cores.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from separatrix.cage import PlanarCage, RunOutcome, ensemble, run_ensemble
from separatrix.chain import cage_state
from separatrix.stability import cage_at
from separatrix.study import Guidance, StabilitySettings
from separatrix.study_file import read_study

FACTORS = (0.1, 0.3, 0.5, 0.7, 0.85, 0.95)
FRICTIONS = (0.03, 0.06, 0.1, 0.14, 0.2, 0.3)
KICKS = (0.1, 0.5, 2.0)
RUNS = 16
TO_THE_END = {"GROWN": 1e4, "GROWS_ON": math.inf, "GROWS_AT_ONCE": math.inf, "DEAD": 0.0, "DIES_OUT": -1.0}


def cages(shipped: PlanarCage) -> dict[str, tuple[PlanarCage, Sequence[float]]]:
    """Cages with their kicks [m/s]."""
    free = replace(shipped, guidance=Guidance.BALL, land_clearance=None)
    ring = shipped.inner_speed
    at_rest = {"cage_speed": 0.0, "inner_speed": ring, "outer_speed": -ring}
    slow = {name: 0.1 * getattr(shipped, name) for name in ("cage_speed", "inner_speed", "outer_speed")}
    light = {name: 0.3 * getattr(shipped, name) for name in ("mass", "moment_of_inertia")}
    return {
        "as shipped": (shipped, KICKS),
        "without a land": (free, KICKS),
        "without a land, at rest": (replace(free, **at_rest), KICKS),
        "without a land, at rest, weak kicks": (replace(free, **at_rest), (0.004, 0.02)),
        "on its land, at rest": (replace(shipped, **at_rest), KICKS),
        "at a tenth of the speed, with gravity": (replace(shipped, **slow, gravity=9.81), KICKS),
        "outer guided": (replace(shipped, guidance=Guidance.OUTER), KICKS),
        "a tenth of the play": (replace(shipped, pocket_clearance=0.1 * shipped.pocket_clearance), KICKS),
        "unbalanced by 20 um": (replace(shipped, unbalance=2e-5 * shipped.mass), KICKS),
        "a third of the mass": (replace(shipped, **light), KICKS),
        "friction 0.3 on the land": (replace(shipped, land_friction=0.3), KICKS),
        "Hertzian pockets": (replace(shipped, hertz_coefficient=1e10), KICKS[1:2]),
    }


def grows(cage: PlanarCage, kicks: Sequence[float], settings: StabilitySettings) -> NDArray[np.bool_]:
    """Whether each run grows."""
    found = [
        run_ensemble(cage_at(cage, eta, f), settings, kicks=kicks, growth_only=True, jobs=2).outcome
        for eta, f in product(FACTORS, FRICTIONS)
    ]
    return np.array(found) == RunOutcome.GROWS


def timed(
    cage: PlanarCage, kicks: Sequence[float], settings: StabilitySettings, limits: dict[str, float]
) -> tuple[NDArray[np.bool_], float]:
    """Which runs grow under these limits of early ends, and the time it takes [s]."""
    for name, value in limits.items():
        setattr(ensemble, name, value)
    begun = time.perf_counter()
    return grows(cage, kicks, settings), time.perf_counter() - begun


def main() -> None:
    """Count over all cages."""
    study = read_study("cryogenic-turbopump")
    settings, as_counted = replace(study.stability, runs=RUNS), {n: getattr(ensemble, n) for n in TO_THE_END}
    runs = changed = 0
    grows(cage_state(study).cage, KICKS, replace(settings, runs=1))  # compiles
    for name, (cage, kicks) in cages(cage_state(study).cage).items():
        early, short = timed(cage, kicks, settings, as_counted)
        late, long = timed(cage, kicks, settings, TO_THE_END)
        runs, changed = runs + early.size, changed + np.count_nonzero(early != late)
        to, back = np.count_nonzero(early & ~late), np.count_nonzero(late & ~early)
        print(
            f"{name}: {early.size} runs, {100 * late.mean():.0f} % grow; {to} turn to growth, "
            f"{back} from it; {long / short:.1f} times faster",
            flush=True,
        )
    print(f"in all {changed} of {runs} outcomes changed")


if __name__ == "__main__":
    main()
