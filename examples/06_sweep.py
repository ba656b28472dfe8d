"""Vary one input over many cases: film thickness against restitution factor."""

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("momentum-wheel")
table = separatrix.sweep(study, "film.thickness=0.2..2um:6:log", jobs=2).to_dataframe()
print(table[["film.thickness", "slope_inner", "race_damping", "restitution_factor"]])

factors = table["restitution_factor"].tolist()
figure, axes = plt.subplots(layout="constrained")
axes.semilogx(1e6 * table["film.thickness"], factors, "o-")
axes.set(xlabel="film thickness [um]", ylabel="restitution factor [-]")
