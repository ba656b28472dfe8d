"""Map where a cage is stable in the plane of pocket clearance and pocket friction."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("momentum-wheel")
quick = replace(study, stability=replace(study.stability, duration=0.05))
x, y = "cage.pocket_clearance=0.1..0.3mm:5", "ball_cage_friction=0..0.5:11"
found = separatrix.map(quick, x, y, kick="0.5 m/s", runs=8, jobs=2).map

for change in found.changes:
    print(f"clearance {1e3 * change.x:.2f} mm: f = {change.y_low:.2f} to {change.y_high:.2f}")
lowest = [change.y_low for change in found.changes]

shares = np.array([np.nan if p.probability_whirl is None else p.probability_whirl for p in found.points])
figure, axes = plt.subplots(layout="constrained")
clearances = [1e3 * value for value in found.x.values]
drawn = axes.pcolormesh(clearances, found.y.values, shares.reshape(5, 11).T, cmap="viridis", vmin=0, vmax=1)
axes.set(xlabel="pocket clearance [mm]", ylabel="pocket friction [-]")
figure.colorbar(drawn, label="share of runs that whirl [-]")
