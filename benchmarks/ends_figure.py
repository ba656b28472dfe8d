"""Energy and friction power of six runs against time: docs/images/where-motion-ends.png.

python benchmarks/ends_figure.py [FILE]
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import numpy as np

from separatrix.cage import moving_cage, simulate
from separatrix.cage.closed_forms import drive_energy
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study

mpl.use("Agg")
import matplotlib.pyplot as plt

HOME = Path(__file__).parents[1] / "docs" / "images" / "where-motion-ends.png"
RUNS = (
    ("wheel, f 0.30, 0.5 m/s: WHIRLS", "momentum-wheel", 0.30, 0.5, "#c1440e", "-"),
    ("wheel, f 0.30, 4 m/s: WHIRLS", "momentum-wheel", 0.30, 4.0, "#c1440e", "--"),
    ("wheel, f 0.08, 0.5 m/s: SETTLES", "momentum-wheel", 0.08, 0.5, "#1f5a99", "-"),
    ("LOX pump, f 0.08, 0.5 m/s: SETTLES, rides on its land", "lox-turbopump", 0.08, 0.5, "#2a8f6a", "-"),
    ("LOX pump with radial load, f 0.08: SETTLES", "lox-turbopump-radial", 0.08, 0.5, "#8a6fb0", "-"),
    ("turbopump, f 0.05, 0.5 m/s: SETTLES", "cryogenic-turbopump", 0.05, 0.5, "#777777", "-"),
)
BINS = 31


def main() -> None:
    """Draw the figure."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2), layout="constrained")
    for label, study, friction, kick, colour, line in RUNS:
        cage = moving_cage(solve(read_study(study)), friction)
        run = simulate(cage, kick=kick, samples=60_000)
        edges = np.geomspace(0.5e-3, run.time[-1], BINS)
        places = np.searchsorted(run.time, edges)
        spans = [slice(a, max(a + 2, b)) for a, b in pairwise(places)]
        middle = np.sqrt(edges[:-1] * edges[1:])
        energy = np.array([run.kinetic_energy[span].mean() for span in spans])
        work = np.diff(np.interp(edges, run.time, run.work["pocket_friction"]))
        left.loglog(1e3 * middle, energy / drive_energy(cage), line, color=colour, label=label)
        rate = work / np.diff(edges) / energy
        right.semilogx(1e3 * middle, rate, line, color=colour)
    left.axhline(1.0, color="black", linewidth=0.8)
    left.set_ylabel("kinetic energy / drive energy (-)")
    left.set_ylim(1e-6, 1e7)
    left.legend(fontsize=7, loc="upper right")
    right.axhline(0.0, color="black", linewidth=0.8)
    right.set_yscale("symlog", linthresh=1.0)
    right.set_ylabel("power of pocket friction / kinetic energy (1/s)")
    for axes in (left, right):
        axes.set_xlabel("time (ms)")
    figure.savefig(Path(sys.argv[1]) if len(sys.argv) > 1 else HOME, dpi=150)


if __name__ == "__main__":
    main()
