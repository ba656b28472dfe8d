"""Save an answer as JSON, load it later as labelled arrays, and draw a plot of your own from it."""

import json
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
study = replace(study, operation=replace(study.operation, radial_load=500.0))
answer = separatrix.bearing(study)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "bearing.json"  # as `separatrix bearing` writes it
    path.write_text(json.dumps(answer.document()))
    data = separatrix.load(path)

print(data[["load_inner", "load_outer", "orbital_speed"]])
spread = float(data["orbital_speed"].max() - data["orbital_speed"].min())

figure, axes = plt.subplots(subplot_kw={"projection": "polar"}, layout="constrained")
for race in ("inner", "outer"):
    axes.plot(data["azimuth"], data[f"load_{race}"], "o-", label=f"{race} race")
axes.set_title(f"ball loads [N], orbital speeds differ by {spread:.2f} rad/s")
axes.set_theta_zero_location("N")
axes.set_rmin(0)
axes.set_xticks(np.linspace(0, 2 * np.pi, 8, endpoint=False))
axes.legend()
