"""One contact without a bearing: force against creep with the exact theory, bare and coated."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

steel = separatrix.solid(205e9, 0.25)
film = separatrix.Layer(thickness=2e-6, solid=separatrix.solid(8e9, 0.4))
ball = separatrix.Body(base=steel)
races = {"bare": ball, "film of 2 um": separatrix.Body(base=steel, layers=(film,))}

modulus = steel.shear_modulus / (1.0 - steel.poisson_ratio)  # E* of two bodies of one steel
radius = 10e-3
ellipse = separatrix.contact_ellipse(150.0, 1 / radius, 1 / radius, modulus)  # a ball of 10 mm on a flat
friction = separatrix.FrictionLaw(coefficient=0.1)
creeps = np.append(1e-6, np.linspace(2e-4, 3e-3, 8))

figure, axes = plt.subplots(layout="constrained")
found = {}
for name, race in races.items():
    problem = separatrix.ContactProblem(ellipse=ellipse, bodies=(ball, race), friction=friction)
    contact = separatrix.rolling_contact(problem, columns=28, rows=28)
    slips = [separatrix.rigid_slip(contact.grid, longitudinal=creep) for creep in creeps]
    found[name] = separatrix.solve_each(contact, slips)
    axes.plot(100 * creeps, [one.traction_coefficient for one in found[name]], "o-", label=name)
    share = found[name][4].stick_share
    print(f"{name}: {100 * share:.0f} % of the area sticks at a creep of {100 * creeps[4]:.2f} %")
    half, _ = separatrix.creep_of_force(contact, -0.5)  # the force is stated
    print(f"  half the force of sliding at a creep of {100 * half:.3f} %")
axes.set(xlabel="creep [%]", ylabel="traction coefficient [-]")
axes.legend()

area = ellipse.semi_major * ellipse.semi_minor
# Kalker's C11 of a circle
c11 = -found["bare"][0].force / (steel.shear_modulus * area * creeps[0])
