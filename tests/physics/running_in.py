"""Shapes of running-in, none of which the method assumes, and logs of them with known steady friction."""

from collections.abc import Callable

import numpy as np
from synthetic_friction import remembered

from separatrix.friction.logs.log import RawLog

ROWS = 2000
LEVEL = 0.15
SIZES = (0.3, 1.5)
"""Smallest and largest excess over the steady friction."""

LENGTHS = (0.05, 0.1, 0.2, 0.35, 0.5)
"""Lengths of running-in as shares of the test."""

NOISES = (0.01, 0.04, 0.12)
"""Standard deviations of the rows over the steady friction."""

CORRELATION = 0.01
"""Time of correlation of correlated noise, as a share of the test."""


def _bell(x, middle, width):
    return np.exp(-(((x - middle) / width) ** 2))


SHAPES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "none": lambda x: 0.0 * x,
    "exponential": lambda x: np.exp(-3.0 * x),
    "peak": lambda x: np.interp(x, [0.0, 0.15, 1.0], [-0.5, 1.0, 0.0]),
    "double peak": lambda x: np.interp(x, [0.0, 0.1, 0.35, 0.6, 1.0], [-0.5, 1.0, 0.35, 0.7, 0.0]),
    "step": lambda x: 1.0 * (x < 1.0),
    "three steps": lambda x: np.select([x < 0.3, x < 0.6, x < 1.0], [1.0, 0.5, 0.2], 0.0),
    "straight fall": lambda x: np.maximum(0.0, 1.0 - x),
    "straight rise": lambda x: -0.6 * np.maximum(0.0, 1.0 - x),
    "logarithm": lambda x: np.maximum(0.0, 1.0 - np.log1p(30.0 * x) / np.log(31.0)),
    "power law": lambda x: (1.0 + 12.0 * x) ** -1.5,
    "decaying oscillation": lambda x: np.exp(-3.0 * x) * np.cos(5.0 * np.pi * x),
    "slow sigmoid": lambda x: 1.0 / (1.0 + np.exp((x - 0.55) / 0.09)),
    "late spike": lambda x: 0.3 * np.exp(-6.0 * x) + _bell(x, 0.8, 0.06),
    "fall and bump": lambda x: 0.8 * np.exp(-8.0 * x) + 0.4 * _bell(x, 0.75, 0.1),
    "dip": lambda x: -0.7 * _bell(x, 0.5, 0.17),
    "plateau, then a drop": lambda x: np.interp(x, [0.0, 0.8, 1.0], [1.0, 1.0, 0.0]),
}
"""Excess over the steady friction, of size one, over the share of running-in."""


def noise(rng: np.random.Generator, *, correlated: bool) -> np.ndarray:
    """Gaussian noise of standard deviation one, white or forgetting itself exponentially."""
    keep = np.exp(-1.0 / (CORRELATION * ROWS)) if correlated else 0.0
    return remembered(rng.standard_normal(2 * ROWS), np.full(2 * ROWS - 1, keep))[ROWS:]


def made(name: str, rng: np.random.Generator, *, correlated: bool) -> tuple[RawLog, float]:
    """A log of a shape, and the share of the test that its running-in takes."""
    x = (np.arange(ROWS) + 0.5) / ROWS
    length = float(rng.choice(LENGTHS))
    excess = rng.uniform(*SIZES) * SHAPES[name](x / length)
    friction = LEVEL * (1.0 + excess + rng.choice(NOISES) * noise(rng, correlated=correlated))
    return RawLog(source=name, checksum="", format="made", friction=friction, time=x * 3600.0), length
