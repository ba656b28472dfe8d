"""What the equilibrium returns, and the Hertz contacts of a solved bearing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from separatrix.hertz import ContactEllipse, contact_ellipse, contact_modulus, race_curvatures
from separatrix.study import BallBearing, KinematicModel, Race
from separatrix.units import Array, Metre, Newton, NewtonMetre, Radian


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Equilibrium:
    """Loads, angles and speeds of every ball, and displacements of the inner ring; arrays have shape (ball,).

    `azimuth` is counted from the radial load, positive about the +x axis; x is the bearing axis along
    positive axial load. Angles [rad], loads [N], speeds [rad/s] or [m/s]. `ball_spin`, shape (ball, 3), is
    the spin in the frame that turns with the ball's orbit: along x, outward, and along the orbit [rad/s].
    `pitch_angle` leans the spin axis in the plane of the ball, positive as a contact angle is; `yaw_angle`
    out of it, along the orbit. `spin_roll_ratio_*` are the paper's Eq. 16, `rolling_speed_*` the mean speed
    of both surfaces through the contact. `gyroscopic_moment` is a magnitude [N m].

    A contact without load has `inner_contact` or `outer_contact` False and load 0. Its angle is
    nominal: that of the line from the ball to the centre of the groove, turned towards the radial direction
    as the gap opens, and within 90 degrees; orbit and spin are those of the first touch.
    `axial_displacement` counts from first contact at the free angle. `moment` is what the balls carry: the
    load, or the reaction to rings that are held (`is_tilt_held`, parallel or at a given tilt); positive loads
    the balls at azimuth 0, as positive `tilt` does. `cross_tilt` (about the radial load) and
    `transverse_displacement` lie across the plane of the radial load. `residual` is the unbalanced force of
    the ring [N]. `race_control` is the race that controls the ball by Jones's criterion.
    """

    model: KinematicModel
    azimuth: Array
    contact_angle_inner: Array
    contact_angle_outer: Array
    load_inner: Array
    load_outer: Array
    inner_contact: NDArray[np.bool_]
    outer_contact: NDArray[np.bool_]
    orbital_speed: Array
    pitch_angle: Array
    yaw_angle: Array
    ball_spin: Array
    spin_roll_ratio_inner: Array
    spin_roll_ratio_outer: Array
    rolling_speed_inner: Array
    rolling_speed_outer: Array
    centrifugal_force: Array
    gyroscopic_moment: Array
    race_control: tuple[Race, ...]
    axial_displacement: Metre
    radial_displacement: Metre
    transverse_displacement: Metre
    tilt: Radian
    is_tilt_held: bool
    cross_tilt: Radian
    moment: NewtonMetre
    iterations: int
    residual: Newton

    @property
    def most_loaded(self) -> int:
        """Number of the ball with the largest inner load, the outer load deciding where none touches."""
        largest = self.load_inner if self.load_inner.any() else self.load_outer
        return int(np.argmax(np.round(largest / largest.max(), 9)))


def contact(result: Equilibrium, bearing: BallBearing, race: Race, ball: int) -> ContactEllipse:
    """Ellipse of one ball on one race, curvatures at its operating angle; no size where it is unloaded."""
    inner = race is Race.INNER
    load = (result.load_inner if inner else result.load_outer)[ball]
    angle = (result.contact_angle_inner if inner else result.contact_angle_outer)[ball]
    rolling, transverse = race_curvatures(bearing, race, float(angle))
    modulus = contact_modulus(bearing.ball_material, bearing.ring_material)
    return contact_ellipse(float(load), rolling, transverse, modulus)
