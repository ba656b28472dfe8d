"""P(stable) of bearings whose pocket clearance and cage mass are not known exactly."""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import separatrix

TEXT = """
extends = "cryogenic-turbopump"
[cage]
mass = "25 g +- 10 %"
pocket_clearance = "0.6 mm +- 20 %"
[stability]
kicks = ["0.5 m/s"]
runs = 32
duration = "20 ms"
restitution_factors = [0.3, 0.6, 0.9]
[ranking]
friction = "pin-on-disk-77K"
materials = ["Armalon", "PEEK 450 GL 30"]
"""
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "uncertain.toml"
    path.write_text(TEXT, encoding="utf-8")
    found = separatrix.rank(separatrix.read_study(path), jobs=2).ranking

figure, axes = plt.subplots(layout="constrained")
probabilities = {}
for row in found.environments[-1].materials:  # that of the bearing
    drawn = row.over_inputs  # the verdict over the uncertain inputs
    share, low, high = drawn.probability_stable, drawn.probability_low, drawn.probability_high
    probabilities[row.name] = share
    print(f"{row.name}: P(stable) {share:.2f} ({low:.2f} to {high:.2f})")
    axes.errorbar(row.name, share, yerr=[[share - low], [high - share]], fmt="o", capsize=4)
axes.set(ylabel="P(stable), 95 % interval [-]", ylim=(-0.05, 1.05))
