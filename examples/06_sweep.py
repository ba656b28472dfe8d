"""Vary one input over many cases: film thickness against restitution factor."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("momentum-wheel")
cases = [{"film.thickness": t} for t in np.geomspace(2e-7, 2e-6, 6)]
table = separatrix.sweep(study, cases, runner=separatrix.Runner(jobs=2)).to_dataframe()
print(table[["film.thickness", "slope_inner", "race_damping", "restitution_factor"]])

factors = table["restitution_factor"].tolist()
figure, axes = plt.subplots(layout="constrained")
axes.semilogx(1e6 * table["film.thickness"], factors, "o-")
axes.set(xlabel="film thickness [um]", ylabel="restitution factor [-]")
