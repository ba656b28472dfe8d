"""Linear motion of a pushed ball about its equilibrium: M x' = S x + e_1 F by its rates and shares."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.ground.units import Array

REAL = 1e-9
"""Imaginary part of a rate over its size below which it is rounding."""


class Modes(NamedTuple):
    """Modes by rising rate, shape (4,): complex rates and shares of 1/C_eff.

    `right` and `left` hold the slowest mode's pattern in x and the row that measures it, shape (4,); both are
    None where it is not overdamped.
    """

    slopes: Array
    masses: Array
    rates: NDArray[np.complex128]
    shares: NDArray[np.complex128]
    right: Array | None
    left: Array | None

    @property
    def relaxed(self) -> float:
        """C_eff: force of a slow push over its speed, every mode relaxed [N s/m]."""
        return 1.0 / float(np.sum(self.shares).real)

    @property
    def locked(self) -> float:
        """The same with spin held [N s/m]."""
        return float(-self.slopes[0, 0])

    @property
    def held(self) -> float:
        """The same with the slowest mode held, C_f [N s/m]."""
        if self.right is None:
            return self.relaxed
        return 1.0 / float(np.sum(self.shares[1:]).real)

    @property
    def mass(self) -> float:
        """Effective mass of the motion that the slowest mode does not follow, C_f over the next rate [kg]."""
        return self.held / float(np.abs(self.rates[0 if self.right is None else 1]))


def modes(slopes: Array, masses: Array) -> Modes:
    """Modes of M x' = S x from S and M, shape (4, 4) each."""
    found, patterns = np.linalg.eig(np.linalg.solve(masses, slopes))
    order = np.argsort(np.abs(found), kind="stable")
    rates, patterns = -found[order], patterns[:, order]
    measures = np.linalg.inv(patterns)
    pushed = np.linalg.solve(masses, np.eye(len(masses))[0])
    shares = patterns[0] * (measures @ pushed) / rates
    is_real = abs(rates[0].imag) <= REAL * abs(rates[0])
    return Modes(
        slopes=slopes,
        masses=masses,
        rates=rates.astype(complex),
        shares=shares.astype(complex),
        right=patterns[:, 0].real if is_real else None,
        left=measures[0].real if is_real else None,
    )
