"""Follow one run of the cage and plot it yourself: orbit of the centre and kinetic energy."""

import warnings
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("momentum-wheel")
study = replace(study, cage=replace(study.cage, ball_cage_friction=0.30))  # dry phenolic
with warnings.catch_warnings(action="ignore"):  # the notes are printed below
    answer = separatrix.simulate(study, kick="0.5 m/s")
history = answer.history

outcome = separatrix.RunOutcome(history.outcome).name
offset = np.hypot(*history.position.T)
pocket, land = np.abs(history.contact_force).max(), history.land_force.max()
print(f"{outcome}: offset up to {1e6 * offset.max():.0f} um")
print(f"force at a pocket up to {pocket:.0f} N, on the land {land:.0f} N")
print(*answer.notes, sep="\n")

figure, (orbit, energy) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
orbit.plot(*(1e6 * history.position.T), linewidth=0.5)
orbit.set(xlabel="x [um]", ylabel="y [um]", aspect="equal")
energy.semilogy(1e3 * history.time, 1e3 * history.kinetic_energy)
energy.set(xlabel="time [ms]", ylabel="kinetic energy [mJ]")
