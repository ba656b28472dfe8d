"""The cage in space: what it has beyond the cage in the bearing plane."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

from separatrix import _check
from separatrix.cage.planar import PlanarCage
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape
from separatrix.study import Guidance
from separatrix.units import (
    Kilogram,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Radian,
    RadianPerSecond,
    Ratio,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceCage:
    """A cage that moves in space among balls that the races guide.

    The axes are those of the bearing plane, and along the bearing axis; tilts are small.

    Parameters
    ----------
    plane : PlanarCage
        Mass, pockets, land and speeds, as in the bearing plane.
    transverse_inertia : float
        J_t about a diameter through the centre of mass [kg m2]; a thin ring has half the moment of inertia
        about its axis.
    ball_spin : tuple of float
        Spin of a ball relative to its orbit: along the axis, outward, and along the orbit [rad/s].
    ball_diameter : float
        Where on its ball a pocket touches, and the lever of its friction [m].
    friction_lever : float or None
        Distance of the pocket's friction from the pocket's centre [m]; None: half the ball's diameter.
    axial_play : float
        Half the clearance along the axis of a square pocket, and between the flats of an elongated one [m].
    groove_damping, groove_stiffness : float
        Of a ball that is pushed along its grooves: c_g [N s/m] and k_g [N/m]. An infinite damping holds it.
    pivot_speed : float
        Sliding speed below which pivoting lowers the friction of pockets and of the land [m/s].
    land_heights : tuple of float
        Middle of each land over the plane of the pockets [m].
    land_width : float
        Width of each land [m]; 0 is a line.
    axial_gravity : float
        Acceleration along the axis [m/s2].
    dynamic_unbalance : float
        Angle between the axis of the cage and its principal axis [rad], in the plane of the static unbalance.
    added_mass : float
        Of the fluid that moves with the cage across the axis [kg].
    axial_kick, tilt_kick : float
        Share of a run's kick that its start has along the axis, and at the rim by tilting [-].
    is_tilt_held, is_axially_held : bool
        The cage may not tilt, or not move along the axis.

    Raises
    ------
    InputError
        A size is not finite or has the wrong sign, an inertia is one that no body can have, or the plane has
        what the motion in space leaves out.
    """

    plane: PlanarCage
    transverse_inertia: KilogramMetre2
    ball_spin: Annotated[tuple[RadianPerSecond, ...], ("axis",)]
    ball_diameter: Metre
    friction_lever: Metre | None = None
    axial_play: Metre = math.inf
    groove_damping: NewtonSecondPerMetre = math.inf
    groove_stiffness: NewtonPerMetre = 0.0
    pivot_speed: MetrePerSecond = 0.0
    land_heights: Annotated[tuple[Metre, ...], ("land",)] = (0.0,)
    land_width: Metre = 0.0
    axial_gravity: MetrePerSecond2 = 0.0
    dynamic_unbalance: Radian = 0.0
    added_mass: Kilogram = 0.0
    axial_kick: Ratio = 0.0
    tilt_kick: Ratio = 0.0
    is_tilt_held: bool = False
    is_axially_held: bool = False

    def __post_init__(self) -> None:
        _check.settle(
            *(_check.positive(self, name, 1e-18, 1e12) for name in ("transverse_inertia", "ball_diameter")),
            *(_check.between(self, name, 0.0, 1e12) for name in _NOT_NEGATIVE),
            _check.between(self, "axial_gravity", -1e6, 1e6),
            _check.between(self, "dynamic_unbalance", 0.0, 0.1),
            _refused_inertia(self),
            _refused_parts(self),
        )

    @property
    def lever(self) -> Metre:
        """Distance of the pocket's friction from the pocket's centre [m]."""
        return self.ball_diameter / 2.0 if self.friction_lever is None else self.friction_lever

    @property
    def pocket_plays(self) -> tuple[Metre, Metre, Metre]:
        """Radius of a pocket's round part less that of the ball; that part's offset; play of the flats [m].

        A bore is round, with flats nowhere; a square pocket has flats only.
        """
        half = self.plane.pocket_clearance / 2.0
        if self.plane.pocket_shape is PocketShape.CYLINDRICAL:
            return half, 0.0, math.inf
        if self.plane.pocket_shape is PocketShape.ELONGATED:
            around = (self.plane.pocket_axial_clearance or 0.0) / 2.0
            return around, half - around, around
        return half, 0.0, self.axial_play


_NOT_NEGATIVE = ("groove_stiffness", "pivot_speed", "land_width", "added_mass", "axial_kick", "tilt_kick")


def _refused_inertia(cage: SpaceCage) -> Iterator[InputError]:
    """Of any body, no moment of inertia exceeds the sum of the other two."""
    axial, transverse = cage.plane.moment_of_inertia, cage.transverse_inertia
    if axial > 2.0 * transverse * (1.0 + 1e-9):
        rule = f"must be at least half the moment of inertia about the axis, {axial / 2.0:.4g} [kg m2]"
        cure = "A flat ring has half of it, a long one more; no body has less."
        yield _check.problem(cage, "transverse_inertia", rule, cure)


def _refused_parts(cage: SpaceCage) -> Iterator[InputError]:
    """What the motion in space leaves out."""
    plane = cage.plane
    if plane.hertz_coefficient is not None:
        yield InputError("SpaceCage.plane", "must have linear pockets: Hertz pockets move in the plane only")
    if plane.land_out_of_round != 0.0:
        yield InputError("SpaceCage.plane", "must have a round land: lobes are for the plane only")
    if plane.half_play == 0.0 and plane.pocket_shape is not PocketShape.SQUARE:
        yield InputError("SpaceCage.plane", "must have square pockets where they grip their balls")
    if len(cage.ball_spin) != 3:
        yield InputError("SpaceCage.ball_spin", "must be three numbers [rad/s]", str(len(cage.ball_spin)))
    if plane.guidance is not Guidance.BALL and len(cage.land_heights) not in (1, 2):
        yield InputError("SpaceCage.land_heights", "must be one or two [m]", str(len(cage.land_heights)))
