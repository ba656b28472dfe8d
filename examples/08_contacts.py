"""A batch of contacts without a study: pressure and traction slope against load, from numbers alone."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

steel = separatrix.Material(name="440C", elastic_modulus=200e9, poisson_ratio=0.28)
ceramic = separatrix.Material(name="Si3N4", elastic_modulus=310e9, poisson_ratio=0.27)
modulus = separatrix.contact_modulus(steel, ceramic)

# against the closed form of a ball of 8 mm on a flat
sphere = separatrix.contact_ellipse(200.0, 1 / 4e-3, 1 / 4e-3, modulus)
ratio = sphere.semi_major / (3 * 200.0 * 4e-3 / (4 * modulus)) ** (1 / 3)

loads = np.geomspace(10.0, 1000.0, 9)
pressures, slopes = [], []
for load in loads:
    contact = separatrix.contact_ellipse(load, 300.0, 10.0, modulus)  # a groove: 1/R_x, 1/R_y [1/m]
    creep = separatrix.Creep(spin=30.0, curvature=-2e4)  # [1/m], [1/m2]
    curve = separatrix.traction_curve(contact, creep, race_friction=0.1, film_compliance=0.0)
    pressures.append(contact.max_pressure)
    slopes.append(curve.slope)
    print(f"{load:6.0f} N: {1e-9 * contact.max_pressure:.2f} GPa, slope {curve.slope:.2f}")

exponent = np.polyfit(np.log(loads), np.log(pressures), 1)[0]  # Hertz: 1/3
figure, axes = plt.subplots(layout="constrained")
axes.loglog(loads, slopes, "o-")
axes.set(xlabel="load [N]", ylabel="slope of the traction curve [-]")
