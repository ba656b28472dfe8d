"""The moving cage as the page draws it: the scene of the animations, at moments that are spread evenly."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from separatrix.figures.scene import scene
from separatrix.figures.style import OUTCOMES
from separatrix.units import Array

MOST_MOMENTS = 1500
DIGITS = 5
"""Significant digits of a place in the picture."""


def motion(data: xr.Dataset) -> dict[str, Any]:
    """Return sizes and moments of a simulated run in the plane, from its dataset.

    Lengths are shares of the pitch radius, as movements are drawn: `enlarged` times too large.
    """
    count = data.sizes["time"]
    pick = np.unique(np.linspace(0, count - 1, min(MOST_MOMENTS, count)).round().astype(int))
    seen = scene(data, pick)
    largest = float(max(seen.force.max(initial=0.0), seen.land_force.max(initial=0.0)))
    return {
        "time": _digits(data["time"].values[pick]),
        "radius": 1.0,
        "ball": seen.ball / seen.radius,
        "half_width": seen.half_width / seen.radius,
        "angles": _digits(seen.angles),
        "walls": _digits(seen.walls),
        "land": None if not np.isfinite(seen.land) else seen.land / seen.radius,
        "offset": _digits(seen.offset / seen.radius),
        "turn": _digits(seen.turn),
        "lead": _digits(seen.lead),
        "force": _digits(np.abs(seen.force)),
        "land_force": _digits(np.abs(seen.land_force)),
        "largest_force": largest,
        "true_offset": _digits(np.hypot(*data["position"].values[pick].T)),
        "enlarged": seen.enlarged,
        "outcome": OUTCOMES.get(str(data["outcome"].values), str(data["outcome"].values)),
    }


def _digits(values: Array) -> Any:
    """Return numbers with few digits: the picture has fewer."""
    scale = 10.0 ** (DIGITS - 1 - np.floor(np.log10(np.maximum(np.abs(values), 1e-12))))
    return (np.round(values * scale) / scale).tolist()
