"""What the races do to a ball that is pushed along its orbit: an effective mass and a law of traction."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from separatrix import _check
from separatrix.errors import InputError
from separatrix.units import Array, Kilogram, MetrePerSecond, Newton, NewtonSecondPerMetre

MOST_ELEMENTS = 4
"""Elements of a law, at most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BallTraction:
    r"""A ball pushed along its orbit: :math:`m_e \dot u = N - F(u)` with saturating elements.

    :math:`F(u) = \sum_i C_i u / (1 + (u/v_i)^n)^{1/n}`, where u is the speed beyond its free orbit. The law
    is odd and rises with u; an element of infinite speed is a damper.

    Parameters
    ----------
    mass : float
        Effective mass m_e: of the ball with the spin that follows it at once [kg].
    slopes, speeds : tuple of float
        C_i [N s/m] and v_i [m/s] of at most `MOST_ELEMENTS` elements.
    sharpness : int
        n, 2 or 4: how sharp the knee is from creep to sliding [-].

    Raises
    ------
    InputError
        A number is not above zero, or slopes and speeds do not pair.
    """

    mass: Kilogram
    slopes: Annotated[tuple[NewtonSecondPerMetre, ...], ("element",)]
    speeds: Annotated[tuple[MetrePerSecond, ...], ("element",)]
    sharpness: int = 2

    def __post_init__(self) -> None:
        _check.settle(_check.positive(self, "mass", 1e-12, 1e3), _refused_elements(self))

    @property
    def slope(self) -> NewtonSecondPerMetre:
        """Damping of a slow push, dF/du at rest."""
        return sum(self.slopes)

    @property
    def capacity(self) -> Newton:
        """Largest force of the law, at infinite speed; infinite with a damper."""
        return sum(c * v for c, v in zip(self.slopes, self.speeds, strict=True))

    def stiffened(self, ratio: float) -> BallTraction:
        """Return the law with slopes this many times as large, of the same capacity and mass."""
        return replace(
            self,
            slopes=tuple(c * ratio for c in self.slopes),
            speeds=tuple(v / ratio for v in self.speeds),
        )

    def force(self, speed: Array) -> Array:
        """F(u) at speeds beyond the free orbit, same shape [N]."""
        u = np.asarray(speed, dtype=np.float64)[..., None]
        slopes, speeds = np.array(self.slopes), np.array(self.speeds)
        root = (1.0 + (u / speeds) ** self.sharpness) ** (1.0 / self.sharpness)
        return np.asarray(np.sum(slopes * u / root, axis=-1))


def _refused_elements(law: BallTraction) -> Iterator[InputError]:
    """Slopes and speeds pair, and are above zero; a speed may be infinite."""
    if not 0 < len(law.slopes) == len(law.speeds) <= MOST_ELEMENTS:
        rule = f"must be 1 to {MOST_ELEMENTS} numbers, as many as slopes"
        yield InputError("BallTraction.speeds", rule, str(len(law.speeds)))
    if not all(0.0 < c < math.inf for c in law.slopes):
        yield InputError("BallTraction.slopes", "must each be finite and > 0 [N s/m]", str(law.slopes))
    if not all(v > 0.0 for v in law.speeds):
        yield InputError("BallTraction.speeds", "must each be > 0 [m/s]", str(law.speeds))
    if law.sharpness not in (2, 4):
        yield InputError("BallTraction.sharpness", "must be 2 or 4 [-]", str(law.sharpness))
