"""Interrupt a long job and resume it: finished runs are kept in a file."""

import tempfile
from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
settings = replace(study.stability, kicks=(0.5,), runs=8, duration=0.02, restitution_factors=(0.3, 0.6, 0.9))
quick = replace(study, stability=settings)


def stop(done: float, total: float) -> None:
    """Press Ctrl-C once half of the work is done."""
    if done > 0.5 * total:
        raise KeyboardInterrupt


with tempfile.TemporaryDirectory() as folder:
    try:
        separatrix.stability(quick, folder=folder, progress=stop)
    except separatrix.Interrupted as interrupted:
        part = interrupted.finished.curve
    resumed = separatrix.stability(quick, folder=folder).curve

print(f"complete: {part.complete}, then {resumed.complete}")
same = resumed == separatrix.stability(quick).curve

figure, axes = plt.subplots(layout="constrained")
factors = [point.restitution_factor for point in resumed.curve]
axes.plot(factors, [point.critical_friction for point in resumed.curve], "o-")
axes.set(xlabel="restitution factor [-]", ylabel="critical friction [-]")
