"""What the equilibrium returns, and the Hertz contacts of a solved bearing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from separatrix.chain.hertz import ContactEllipse, contact_ellipse, contact_modulus, race_curvatures
from separatrix.ground.units import Array, Metre, Newton, NewtonMetre, Radian
from separatrix.study.study import BallBearing, KinematicModel, Race


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Equilibrium:
    """Loads, angles and speeds of every ball, and where the inner ring stands; arrays have shape (ball,).

    `azimuth` is counted from the radial load, turning as the +x axis says; x is the bearing axis along
    positive axial load. Angles [rad], loads [N], speeds [rad/s] or [m/s]. `ball_spin`, shape (ball, 3), is
    the spin in the frame that turns with the ball's orbit: along x, outward, and along the orbit [rad/s].
    `pitch_angle` leans the spin axis in the plane of the ball, positive as a contact angle is; `yaw_angle`
    out of it, along the orbit. `spin_roll_ratio_*` are the paper's Eq. 16, `rolling_speed_*` the mean speed
    of both surfaces through the contact. `gyroscopic_moment` is a magnitude [N m].

    A contact that carries nothing has `inner_contact` or `outer_contact` False and load 0. Its angle is
    nominal: that of the line from the ball to the centre of the groove, turned towards the radial direction
    as the gap opens, and within 90 degrees; orbit and spin are those of the first touch.
    `axial_displacement` counts from first contact at the free angle. `moment` is what the balls carry: the
    load, or the reaction to rings that are held (`is_tilt_held`, parallel or at a given tilt); positive loads
    the balls at azimuth 0, as positive `tilt` does. `cross_tilt` (about the radial load) and
    `transverse_displacement` lie across the plane of the radial load. `residual` is the unbalanced force of
    the ring [N]. `race_control` says which race Jones's criterion would let control the ball.
    """

    model: KinematicModel  # what fixes the ball's spin axis
    azimuth: Annotated[Array, "rad", ("ball",)]
    contact_angle_inner: Annotated[Array, "rad", ("ball",)]
    contact_angle_outer: Annotated[Array, "rad", ("ball",)]
    load_inner: Annotated[Array, "N", ("ball",)]
    load_outer: Annotated[Array, "N", ("ball",)]
    inner_contact: Annotated[NDArray[np.bool_], ("ball",)]  # whether the ball touches the inner race
    outer_contact: Annotated[NDArray[np.bool_], ("ball",)]  # whether it touches the outer race
    orbital_speed: Annotated[Array, "rad/s", ("ball",)]
    pitch_angle: Annotated[Array, "rad", ("ball",)]
    yaw_angle: Annotated[Array, "rad", ("ball",)]  # of the spin axis out of the plane of ball and axis
    ball_spin: Annotated[Array, "rad/s", ("ball", "axis")]  # own rotation: axial, outward, along the orbit
    spin_roll_ratio_inner: Annotated[Array, "-", ("ball",)]
    spin_roll_ratio_outer: Annotated[Array, "-", ("ball",)]
    rolling_speed_inner: Annotated[Array, "m/s", ("ball",)]  # mean speed of both surfaces through the contact
    rolling_speed_outer: Annotated[Array, "m/s", ("ball",)]  # the same at the outer race
    centrifugal_force: Annotated[Array, "N", ("ball",)]  # of a ball
    gyroscopic_moment: Annotated[Array, "N m", ("ball",)]  # of a ball
    race_control: Annotated[tuple[Race, ...], ("ball",)]
    """Race that controls the ball's spin by Jones's criterion."""
    axial_displacement: Metre
    radial_displacement: Metre
    transverse_displacement: Metre  # of the inner ring across axis and radial load
    tilt: Radian
    is_tilt_held: bool  # whether the rings are held, parallel or at a given tilt
    cross_tilt: Radian  # of the inner ring about the radial load
    moment: NewtonMetre
    iterations: int  # steps of the solver
    residual: Newton  # unbalanced force on the inner ring

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
