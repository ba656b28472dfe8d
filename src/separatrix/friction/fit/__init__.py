"""Friction from tests: a fit over slip speed and pressure, its scatter, and what the next cage will have.

Nothing here is imported before it is asked for: reading a friction file needs no numpy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.friction.fit.law import StatedFriction, TestedFriction
from separatrix.friction.fit.records import FrictionTest, Prediction

if TYPE_CHECKING:
    from separatrix.friction.fit.fit import DEFAULT_SCATTER, FrictionFit, MaterialFit, fit_friction

__all__ = [
    "DEFAULT_SCATTER",
    "FrictionFit",
    "FrictionTest",
    "MaterialFit",
    "Prediction",
    "StatedFriction",
    "TestedFriction",
    "fit_friction",
]


def __getattr__(name: str) -> object:
    """Import the fit, and with it numpy, when first asked for."""
    if name not in __all__:
        raise AttributeError(name)
    from separatrix.friction.fit import fit

    return getattr(fit, name)
