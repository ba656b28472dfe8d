"""Critical pocket friction at a few restitution factors, with its band and the linear limit."""

from dataclasses import replace

from separatrix.chain import cage_state
from separatrix.stability import stability_curve
from separatrix.study_file import read_study

study = read_study("cryogenic-turbopump")
# a small ensemble, for a quick look: 12 runs of 0.05 s from two kicks
settings = replace(
    study.stability, kicks=(0.5, 2.0), runs=12, duration=0.05, restitution_factors=(0.3, 0.6, 0.9)
)
found = stability_curve(cage_state(study).cage, settings, jobs=2)

for point, limit in zip(found.curve, found.linear_limit, strict=True):
    print(
        f"eta {point.restitution_factor:.2f}: f = {point.critical_friction:.3f} "
        f"(band {point.critical_friction_low:.3f} to {point.critical_friction_high:.3f}), "
        f"linear {limit.critical_friction:.3f}"
    )

frictions = [point.critical_friction for point in found.curve]
