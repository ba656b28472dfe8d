"""Interrupt a long job and resume it: finished runs are kept in a file."""

import tempfile
from dataclasses import replace

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
quick = replace(study, stability=replace(study.stability, duration=0.02))
plane = "cage.pocket_clearance=0.3..0.6mm:3", "ball_cage_friction=0..0.5:6"
how = {"kick": "0.5 m/s", "runs": 8}


def stop(done: float, total: float) -> None:
    """Press Ctrl-C once half of the points are done."""
    if done > 0.5 * total:
        raise KeyboardInterrupt


with tempfile.TemporaryDirectory() as folder:
    try:
        separatrix.map(quick, *plane, **how, folder=folder, progress=stop)
    except separatrix.Interrupted as interrupted:
        part = interrupted.finished
    resumed = separatrix.map(quick, *plane, **how, folder=folder)

print(f"complete: {part.map.complete}, then {resumed.map.complete}")
same = resumed.map == separatrix.map(quick, *plane, **how).map
figure = resumed.plot()
