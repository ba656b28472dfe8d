"""Map where a cage is stable in the plane of pocket clearance and pocket friction."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("momentum-wheel")
quick = replace(study, stability=replace(study.stability, duration=0.05))
x = separatrix.MapAxis(parameter="cage.pocket_clearance", unit="m", values=(1e-4, 1.5e-4, 2e-4, 2.5e-4, 3e-4))
y = separatrix.MapAxis(
    parameter="ball_cage_friction", unit="-", values=tuple(np.linspace(0.0, 0.5, 11).tolist())
)
question = separatrix.MapQuestion(study=quick, x=x, y=y, kick=0.5, runs=8)
found = separatrix.stability_map(question, runner=separatrix.Runner(jobs=2))

for change in found.changes:
    print(f"clearance {1e3 * change.x:.2f} mm: f = {change.y_low:.2f} to {change.y_high:.2f}")
lowest = [change.y_low for change in found.changes]

shares = np.array([np.nan if p.probability_whirl is None else p.probability_whirl for p in found.points])
figure, axes = plt.subplots(layout="constrained")
clearances = [1e3 * value for value in x.values]
drawn = axes.pcolormesh(clearances, y.values, shares.reshape(5, 11).T, cmap="viridis", vmin=0, vmax=1)
axes.set(xlabel="pocket clearance [mm]", ylabel="pocket friction [-]")
figure.colorbar(drawn, label="share of runs that whirl [-]")
