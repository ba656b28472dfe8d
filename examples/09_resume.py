"""Interrupt a long job and resume it: finished runs are kept in a file."""

import tempfile
from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("momentum-wheel")
quick = replace(study, stability=replace(study.stability, runs=8, duration=0.02))


def stop(done: float, total: float) -> None:
    """Press Ctrl-C once half of the work is done."""
    if done > 0.5 * total:
        raise KeyboardInterrupt


with tempfile.TemporaryDirectory() as folder:
    try:
        separatrix.rank(quick, folder=folder, progress=stop)
    except separatrix.Interrupted as interrupted:
        part = interrupted.finished
    resumed = separatrix.rank(quick, folder=folder)

print(f"complete: {part.ranking.complete}, then {resumed.ranking.complete}")
same = repr(resumed.ranking) == repr(separatrix.rank(quick).ranking)

rows = resumed.ranking.environments[0].materials
figure, axes = plt.subplots(layout="constrained")
axes.bar([row.name for row in rows], [row.judgement.probability_stable for row in rows])
axes.set_ylabel("P(stable) [-]")
