"""A Hertz contact from numbers alone, without a study: a ball on a flat, against the closed form."""

from separatrix.hertz import contact_ellipse, contact_modulus
from separatrix.study import Material

steel = Material(name="440C", elastic_modulus=200e9, poisson_ratio=0.28)
ceramic = Material(name="Si3N4", elastic_modulus=310e9, poisson_ratio=0.27)
modulus = contact_modulus(steel, ceramic)

load, radius = 200.0, 4e-3
found = contact_ellipse(load, 1.0 / radius, 1.0 / radius, modulus)
closed = (3.0 * load * radius / (4.0 * modulus)) ** (1.0 / 3.0)
print(f"a = {1e6 * found.semi_major:.2f} um, closed form {1e6 * closed:.2f} um")
print(f"largest pressure {1e-9 * found.max_pressure:.2f} GPa, approach {1e6 * found.approach:.2f} um")

ratio = found.semi_major / closed
