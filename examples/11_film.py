"""Films that keep a bearing below a restitution factor: thickness and friction of the film."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
films = separatrix.solve(study).lubrication

figure, axes = plt.subplots(layout="constrained")
for friction, factors in zip(films.race_friction, films.restitution_factor, strict=True):
    good = films.film_thickness[factors <= 0.5]
    every = good.size == films.film_thickness.size
    needed = "any thickness" if every else f"{1e6 * good.min():.2f} um or more"
    print(f"race friction {friction:.2f}: eta below 0.5 with a film of {needed}")
    axes.semilogx(1e6 * films.film_thickness, factors, "o-", label=f"race friction {friction:g}")
axes.axhline(0.5, color="black", linestyle="--")
axes.set(xlabel="film thickness [um]", ylabel="restitution factor [-]")
axes.legend()

highest = [float(np.max(factors)) for factors in films.restitution_factor]
