"""How the balls of a loaded bearing run faster and slower around: orbital speed against azimuth, in waves.

Under a radial load or a moment the balls differ in contact angle, and so in orbital speed. Each ball passes
every azimuth, so it leads and lags the ball set periodically.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.ground.units import Array, Metre, MetrePerSecond, RadianPerSecond, Ratio

HIGHEST = 4
ENOUGH: Ratio = 0.9999
"""Share of the variance of those waves at which the others are left out: speeds to 1 % of their spread."""

ALIKE = 1e-9
"""Orbital speeds that differ by less than this share of their mean do not differ: an axial load."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OrbitalWaves:
    """Speed of a ball at azimuth p beyond the mean: the sum of A_h cos h p + B_h sin h p, h = 1, 2, ...

    Attributes
    ----------
    cosines, sines : tuple of float
        A_h and B_h [m/s]; empty where all balls run alike.
    share : float or None
        Share of the variance between the balls that these harmonics hold [-]; None where there is none.
    """

    cosines: tuple[MetrePerSecond, ...] = ()
    sines: tuple[MetrePerSecond, ...] = ()
    share: Ratio | None = None


def mean_speed(orbital_speed: Array) -> RadianPerSecond:
    """Speed of the ball set, the mean over the balls [rad/s]."""
    return float(np.mean(orbital_speed))


def orbital_waves(orbital_speed: Array, azimuth: Array, pitch_radius: Metre) -> OrbitalWaves:
    """Discrete Fourier transform of the balls' speeds about their mean.

    Parameters
    ----------
    orbital_speed, azimuth : ndarray
        Of each ball, at even azimuths, shape (ball,) [rad/s] and [rad].
    pitch_radius : float
        R, which makes speeds along the circumference of them [m].

    Notes
    -----
    Harmonics up to 4, and below half the balls: what Z balls tell; of these the first ones that hold
    `ENOUGH` of their variance. `share` says how much of the whole is kept.
    """
    beyond = pitch_radius * (orbital_speed - mean_speed(orbital_speed))
    if np.max(np.abs(beyond)) <= ALIKE * abs(mean_speed(orbital_speed)) * pitch_radius:
        return OrbitalWaves()
    orders = np.arange(1, min(HIGHEST, (azimuth.size - 1) // 2) + 1)
    angles = np.outer(orders, azimuth)
    cosines = 2.0 / azimuth.size * (np.cos(angles) @ beyond)
    sines = 2.0 / azimuth.size * (np.sin(angles) @ beyond)
    power = np.cumsum(cosines**2 + sines**2)
    kept = 1 + int(np.searchsorted(power, ENOUGH * power[-1]))
    cosines, sines = cosines[:kept], sines[:kept]
    share = 0.5 * float(power[kept - 1]) / float(np.mean(beyond**2))
    return OrbitalWaves(cosines=tuple(cosines.tolist()), sines=tuple(sines.tolist()), share=min(1.0, share))
