"""Kicks that scale with the bearing: settings of an ensemble with numbers in the place of its defaults."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from separatrix.study import StabilitySettings
from separatrix.units import Metre, MetrePerSecond, RadianPerSecond, Ratio

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage

REFERENCE: Ratio = 2.5
"""Reference kick over the pocket speed [-]."""

SPAN: tuple[Ratio, ...] = (0.2, 1.0, 4.0)
"""Kicks over the reference kick: 0.5, 2.5 and 10 times the pocket speed [-]."""

LEAST_POCKET_SPEED: MetrePerSecond = 0.02
"""Pocket speed of a ball set at rest or a pocket without clearance: the reference kick is then 0.05 m/s."""

DIGITS = 3
"""Significant digits of a default kick, so that a reader can repeat it."""


def pocket_speed(cage_speed: RadianPerSecond, pocket_clearance: Metre) -> MetrePerSecond:
    """Cage speed times half the pocket clearance, but not below `LEAST_POCKET_SPEED`.

    The cage centre has this speed in space where it is half a pocket clearance off the axis.
    """
    return max(abs(cage_speed) * 0.5 * pocket_clearance, LEAST_POCKET_SPEED)


def settings_for(settings: StabilitySettings, cage: PlanarCage) -> StabilitySettings:
    """Return the settings with the kicks and the reference kick of this cage; given ones stay."""
    return with_kicks(settings, pocket_speed(cage.cage_speed, cage.pocket_clearance))


def with_kicks(settings: StabilitySettings, speed: MetrePerSecond) -> StabilitySettings:
    """Return the settings with numbers for kicks and reference kick, from the pocket speed [m/s].

    The reference kick is 2.5 times the pocket speed unless it is given, whatever the kicks: thresholds and
    margins belong to the bearing, not to the list. Without kicks they are 0.2, 1 and 4 times it.
    """
    reference = settings.reference_kick or _rounded(REFERENCE * speed)
    spanned = tuple(reference if part == 1.0 else _rounded(part * reference) for part in SPAN)
    return replace(settings, kicks=settings.kicks or spanned, reference_kick=reference)


def with_reference(settings: StabilitySettings) -> StabilitySettings:
    """Return the settings with the reference kick among the kicks; they must have numbers."""
    return replace(settings, kicks=tuple(sorted({*settings.kicks, settings.middle_kick})))


def _rounded(speed: MetrePerSecond) -> MetrePerSecond:
    return float(f"{speed:.{DIGITS}g}")
