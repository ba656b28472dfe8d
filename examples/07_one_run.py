"""Follow one run of the cage and plot it yourself: orbit of the centre and kinetic energy."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("momentum-wheel")
cage = separatrix.solve(study).cage_with(0.30)  # the friction of dry phenolic
history = separatrix.simulate(cage, kick=0.5, duration=study.stability.duration)

outcome = separatrix.RunOutcome(history.outcome).name
offset = np.hypot(*history.position.T)
pocket, land = np.abs(history.contact_force).max(), history.land_force.max()
print(f"{outcome}: offset up to {1e6 * offset.max():.0f} um")
print(f"force at a pocket up to {pocket:.0f} N, on the land {land:.0f} N")

figure, (orbit, energy) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
orbit.plot(*(1e6 * history.position.T), linewidth=0.5)
orbit.set(xlabel="x [um]", ylabel="y [um]", aspect="equal")
energy.semilogy(1e3 * history.time, 1e3 * history.kinetic_energy)
energy.set(xlabel="time [ms]", ylabel="kinetic energy [mJ]")
