"""What the cage takes of a pushed ball: of one state, a mass and a law of traction; free, two slip fields."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.schema import Fault, Faults, check, key, positive, record
from separatrix.ground.units import (
    Array,
    Kilogram,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonSecondPerMetre,
    PerSecond,
    Ratio,
)


@record
class BallTraction:
    r"""A ball of one state: :math:`m_e \dot u = N - F(u)`, :math:`F(u) = C u / (1 + (u/v)^4)^{1/4}`.

    u is the speed beyond its free orbit. The slip fields of bearings have the knee of this power within 1 to
    2 % of the capacity (docs/theory/mobility.md).
    """

    mass: Kilogram = key(positive(1e-12, 1e3))  # m_e, of the ball with the spin that follows it at once
    slope: NewtonSecondPerMetre = key(positive(1e-12, 1e12))  # C
    speed: MetrePerSecond  # v, above which the races slide; infinite for a damper

    @property
    def capacity(self) -> Newton:
        """Largest force of the law, at infinite speed; infinite with a damper."""
        return self.slope * self.speed

    def stiffened(self, ratio: float) -> BallTraction:
        """Return the law with a slope this many times as large, of the same capacity and mass."""
        return replace(self, slope=self.slope * ratio, speed=self.speed / ratio)

    def force(self, speed: Array) -> Array:
        """F(u) at speeds beyond the free orbit, same shape [N]."""
        u = np.asarray(speed, dtype=np.float64)
        return np.asarray(self.slope * u / (1.0 + (u / self.speed) ** 4) ** 0.25)


@check(BallTraction)
def _knee_above_rest(speed: MetrePerSecond) -> Faults:
    """The knee is at a speed above zero; it may be infinite."""
    if not speed > 0.0:
        yield Fault("speed", "must be > 0 [m/s]")


@dataclass(frozen=True, slots=True, kw_only=True)
class SlipField:
    """One race at a free ball in steady rolling, seen from the ball."""

    normal_axial: Ratio  # direction from the ball's centre to the contact, along the axis
    normal_radial: Ratio  # and outward
    limit: Newton  # friction times load
    semi_major: Metre  # half the ellipse across the groove
    axis_ratio: Ratio  # its other half over it
    slip: MetrePerSecond  # of the middle along the orbit
    pivoting: MetrePerSecond  # half the ellipse times the pivoting speed
    heathcote: MetrePerSecond  # slip of the ellipse's ends against its middle, as the pressed surface curves
    elastic_slip: MetrePerSecond  # slip that elastic creep makes of full friction

    def stiffened(self, ratio: float) -> SlipField:
        """Return the race that has the same tractions at slips this many times smaller."""
        slips = ("slip", "pivoting", "heathcote", "elastic_slip")
        return replace(self, **{name: getattr(self, name) / ratio for name in slips})


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeBall:
    """A ball with its mass, both races' slip fields, and the fastest rate of its small motions."""

    mass: Kilogram  # of the ball
    inertia: KilogramMetre2  # moment of inertia of the ball
    inner: SlipField  # slip field of the inner race
    outer: SlipField  # slip field of the outer race
    fastest_rate: PerSecond  # of the ball's small motions

    @property
    def capacity(self) -> Newton:
        """Largest force that both races hold, f_BT (Q_i + Q_o) [N]."""
        return self.inner.limit + self.outer.limit

    def stiffened(self, ratio: float) -> FreeBall:
        """Return the ball between races that have the same tractions at slips this many times smaller."""
        races = {name: getattr(self, name).stiffened(ratio) for name in ("inner", "outer")}
        return replace(self, **races, fastest_rate=self.fastest_rate * ratio)

    def __post_init__(self) -> None:
        if not all(
            math.isfinite(x) and x > 0.0 for x in (self.mass, self.inertia, self.capacity, self.fastest_rate)
        ):
            raise InputError("FreeBall", "must have a mass, an inertia, loads and rates above zero")
