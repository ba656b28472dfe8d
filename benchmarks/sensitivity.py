"""Speed of `sensitivity` on the shipped study and on one with uncertain film and cage; agreement with `rank`.

Run it when nothing else runs: `python benchmarks/sensitivity.py`. Kernels are compiled first.
"""

from __future__ import annotations

import argparse
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

from separatrix.cli.answers import Work
from separatrix.cli.sensitivity import sensitivity
from separatrix.ranking import rank
from separatrix.study_file import read_study

UNCERTAIN = """
extends = "cryogenic-turbopump"
title = "Uncertain film, load and cage"

[film]
thickness = { between = ["0.2 um", "1 um"] }
race_friction = "0.1 +- 20 %"

[cage]
mass = "25 g +- 10 %"
pocket_clearance = { between = ["0.45 mm", "0.75 mm"] }
land_clearance = "1 mm +- 20 %"
land_friction = { between = [0.05, 0.15] }

[operation]
axial_load = "300 daN +- 10 %"
"""


def timed(study, samples, jobs):
    """Answer of one study, wall and processor time, and when each stage ended."""
    start, used, steps = time.perf_counter(), time.process_time(), {}

    def progress(done, _total):
        if done in (350, 600, 850, 900):
            steps.setdefault(done, round(time.perf_counter() - start, 1))

    answer = sensitivity(study, Work(jobs=jobs, progress=progress), samples)
    return answer, (time.perf_counter() - start, time.process_time() - used), steps


def agreement(study, answer, jobs):
    """Count the rows whose nominal verdict is that of `rank`, and return those that are not."""
    ranking = rank(study, jobs=jobs)
    parts = [(one.name, one.materials) for one in ranking.environments] + [("overall", ranking.overall)]
    theirs = {(name, row.name): row for name, rows in parts for row in rows if row.verdict}
    parts = [(one.name, one.materials) for one in answer.ranking.environments]
    parts += [("overall", answer.ranking.overall)]
    ours = {(name, row.name): row for name, rows in parts for row in rows if row.verdict}
    counts, apart = Counter(), []
    for key, row in ours.items():
        same = row.verdict == theirs[key].verdict
        counts["same" if same else "other"] += 1
        if not same:
            apart.append((*key, row.friction, row.verdict, theirs[key].verdict, row.probability_stable,
                          row.probability_unstable))  # fmt: skip
    widest = max(abs(ours[k].nominal_threshold - theirs[k].restitution_threshold) for k in ours)
    return counts, apart, widest


def main():
    """Print times, errors and agreement."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=4096)
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "uncertain.toml"
        path.write_text(UNCERTAIN)
        studies = [read_study("cryogenic-turbopump"), read_study(str(path))]
    sensitivity(studies[0], Work(jobs=asked.jobs, progress=None), 64)
    for study in studies:
        answer, took, steps = timed(study, asked.samples, asked.jobs)
        said = f"{took[0]:.1f} s, processor {took[1]:.1f} s"
        print(f"{study.title}: {asked.samples} samples, {answer.ranking.runs} runs, {said}")
        print(f"  boundary, its fit, chain and verdicts done at {steps} (progress in thousandths: s)")
        for one in answer.ranking.boundaries:
            error = one.surrogate
            print(f"  boundary known to {error.error:.3f} (misfit {error.misfit:.3f}), {one.parameters}")
    answer, _, _ = timed(studies[0], 64, asked.jobs)
    counts, apart, widest = agreement(studies[0], answer, asked.jobs)
    print(f"nominal verdicts against rank: {dict(counts)}; largest difference of a threshold {widest:.3f}")
    for row in apart:
        print("  ", *row)


if __name__ == "__main__":
    main()
