"""Follow one run of the cage and plot it yourself: orbit of the centre and kinetic energy."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("momentum-wheel")
study = replace(study, cage=replace(study.cage, ball_cage_friction=0.30))  # dry phenolic
answer = separatrix.simulate(study, kick="0.5 m/s")
history = answer.history

outcome = history.outcome.name
print(f"{outcome}: offset up to {1e6 * history.largest_offset:.0f} um")
print(f"whirl at {history.whirl_frequency:.0f} Hz, the centre at {answer.analysis.whirl_speed:.2f} m/s")
print(*answer.notes, sep="\n")

figure, (orbit, energy) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
orbit.plot(*(1e6 * history.position.T), linewidth=0.5)
orbit.set(xlabel="x [um]", ylabel="y [um]", aspect="equal")
energy.semilogy(1e3 * history.time, 1e3 * history.kinetic_energy)
energy.set(xlabel="time [ms]", ylabel="kinetic energy [mJ]")
