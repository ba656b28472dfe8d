"""Traction curves of ball on race, bare and with films of a soft material (the paper's Fig. 7)."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
outer = separatrix.solve(study).bearing.outer
bare = replace(study.film, material=None, thickness=None)
films = {"bare": bare} | {f"{um:g} um": replace(study.film, thickness=um * 1e-6) for um in (0.1, 1.0, 3.0)}

figure, axes = plt.subplots(layout="constrained")
slopes = {}
for name, film in films.items():
    curve = separatrix.traction_curve(
        outer.ellipse,
        outer.creep,
        race_friction=film.race_friction,
        film_compliance=separatrix.film_compliance(film),
    )
    slopes[name] = curve.slope
    print(f"{name:>6}: slope alpha = {curve.slope:.3f} +- {curve.slope_error:.3f}")
    axes.plot(100 * curve.creep_increment, curve.traction_coefficient, label=name)

axes.set(xlabel="creep increment [%]", ylabel="traction coefficient T/N [-]")
axes.legend(title="film on the outer race")
ratio = slopes["3 um"] / slopes["bare"]
