"""From a tribometer log to the steady friction of its test; 05_ranking.py ranks a material by one."""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import separatrix

# a made-up test: running-in from 0.30 to 0.12 over 5 minutes, then 55 minutes steady
time = np.arange(0.0, 3600.0, 2.0)
noise = np.random.default_rng(1).normal(0.0, 0.004, time.size)
friction = 0.12 + 0.18 * np.exp(-time / 60.0) + noise
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "my-compound.csv"
    rows = (f"{t:.0f},{f:.5f}" for t, f in zip(time, friction, strict=True))
    path.write_text("Time [s],COF\n" + "\n".join(rows), encoding="utf-8")
    test = separatrix.tribometer(path).tests[0]
print(f"friction {test.friction:.4f} +- {test.half_width:.4f}, running-in ends at {test.run_in_end:.0f} s")

steady = test.friction
figure, axes = plt.subplots(layout="constrained")
axes.plot(time, friction, linewidth=0.5)
axes.axhline(test.friction, color="black", label="steady friction")
axes.axvline(test.run_in_end, color="black", linestyle="--", label="end of running-in")
axes.set(xlabel="time [s]", ylabel="friction [-]")
axes.legend()
