"""A film that wears off in its track: restitution factor against the width of the bare band."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
shares = [0.0, 0.05, 0.1, 0.2, 0.5, 1.0]

figure, axes = plt.subplots(layout="constrained")
found = {}
for model in separatrix.TractionModel:
    found[model.value] = []
    for share in shares:
        wear = separatrix.Wear(share=share, friction=0.3)
        worn = replace(
            study,
            film=replace(study.film, wear=wear),
            traction=separatrix.TractionSettings(model=model),
        )
        found[model.value].append(separatrix.solve(worn).restitution.restitution_factor)
    axes.plot(shares, found[model.value], "o-", label=model.value)
axes.set(xlabel="width of the bare band over the contact's [-]", ylabel="restitution factor [-]", ylim=(0, 1))
axes.legend()

for share, strips, exact in zip(shares, found["strips"], found["exact"], strict=True):
    print(
        f"bare over {share:.0%} of the contact: eta {strips:.3f} by strips, {exact:.3f} by the exact contact"
    )
farthest = max(abs(a - b) for a, b in zip(found["strips"], found["exact"], strict=True))
