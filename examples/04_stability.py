"""Critical pocket friction at a few restitution factors, with its band and the linear limit."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
# a small ensemble, for a quick look: 12 runs of 0.05 s from two kicks
settings = replace(
    study.stability, kicks=(0.5, 2.0), runs=12, duration=0.05, restitution_factors=(0.3, 0.6, 0.9)
)
cage = separatrix.moving_cage(separatrix.solve(study), friction=0.1)  # the curve replaces it
found = separatrix.stability_curve(cage, settings, runner=separatrix.Runner(jobs=2))

for point, limit in zip(found.curve, found.linear_limit, strict=True):
    print(
        f"eta {point.restitution_factor:.2f}: f = {point.critical_friction:.3f} "
        f"(band {point.critical_friction_low:.3f} to {point.critical_friction_high:.3f}), "
        f"linear {limit.critical_friction:.3f}"
    )

frictions = [point.critical_friction for point in found.curve]
factors = [point.restitution_factor for point in found.curve]
low = [point.critical_friction_low for point in found.curve]
high = [point.critical_friction_high for point in found.curve]
figure, axes = plt.subplots(layout="constrained")
axes.fill_between(factors, low, high, alpha=0.3, label="the kick decides")
axes.plot(factors, frictions, "o-", label="half of the runs whirl")
axes.plot(factors, [limit.critical_friction for limit in found.linear_limit], "--", label="linear limit")
axes.set(xlabel="restitution factor [-]", ylabel="pocket friction [-]")
axes.legend()
