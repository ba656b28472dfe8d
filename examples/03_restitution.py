"""Restitution factor of a ball/cage impact: from the film on the races, and from a formula."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
found = separatrix.solve(study).restitution
print(f"C_mu = {found.race_damping:.0f} N s/m, eta = {found.restitution_factor:.3f}")
print(f"with free ball spin: eta = {found.restitution_factor_free_spin:.3f}")

# twice the friction on the races: the paper's "insufficient lubrication"
dry = separatrix.solve(replace(study, film=replace(study.film, race_friction=0.2))).restitution
print(f"race friction 0.2: eta = {dry.restitution_factor:.3f}")

# the same by hand: 0.05 kg on 3e6 N/m with C_mu = 2000 N s/m
eta = separatrix.restitution_factor(separatrix.damping_ratio(3e6, 0.05, 2000.0))
print(f"by hand: eta = {eta:.4f}")

dampings = np.geomspace(100.0, 1e4, 200)
cage = found.ball_cage_stiffness, found.cage_mass
factors = [separatrix.restitution_factor(separatrix.damping_ratio(*cage, c)) for c in dampings]
figure, axes = plt.subplots(layout="constrained")
axes.semilogx(dampings, factors)
axes.plot(found.race_damping, found.restitution_factor, "o", label="this film")
axes.plot(dry.race_damping, dry.restitution_factor, "s", label="race friction 0.2")
axes.set(xlabel="race damping [N s/m]", ylabel="restitution factor [-]")
axes.legend()
