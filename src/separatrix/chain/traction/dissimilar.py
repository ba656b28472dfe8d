"""What is left out when ball and race differ: the coupling of pressure and shear displacement."""

from __future__ import annotations

from separatrix.study import Material
from separatrix.units import Ratio


def dundurs_coupling(first: Material, second: Material) -> Ratio:
    """Dundurs' constant beta of two half-planes [-]: 0 for equal bodies; neglected in `traction_curve`.

    beta = [(1 - 2 nu1)/G1 - (1 - 2 nu2)/G2] / (2 [(1 - nu1)/G1 + (1 - nu2)/G2]). Pressure p then strains the
    two surfaces apart by 2 beta p/E*, as a creep of beta/mu saturation creeps would
    (docs/theory/traction.md).
    """
    G1, G2 = (0.5 * m.elastic_modulus / (1.0 + m.poisson_ratio) for m in (first, second))
    n1, n2 = first.poisson_ratio, second.poisson_ratio
    difference = (1.0 - 2.0 * n1) / G1 - (1.0 - 2.0 * n2) / G2
    return 0.5 * difference / ((1.0 - n1) / G1 + (1.0 - n2) / G2)
