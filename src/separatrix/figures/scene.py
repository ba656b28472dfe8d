"""The cage among its balls as an animation draws it: true shapes, small movements enlarged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from separatrix.figures.motion import ring
from separatrix.figures.style import study_of
from separatrix.units import Array

BAR_SHARE, FARTHEST, RAIL = 0.4, 0.3, 0.36
"""Least share of the bar in the room between two balls; largest offset over the pitch radius; half the radial
width of the cage over the ball's diameter."""

ARC, ROUND = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 2 * np.pi, 181)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """Sizes [m], and each moment's movements times `enlarged`, in the frame of the ball set.

    Attributes
    ----------
    radius, ball, half_width : float
        Of the pitch circle and of a ball; half the radial width of the cage [m].
    angles, walls : ndarray
        Of each pocket, and half its angle from wall to wall with the play enlarged [rad].
    offset, turn, lead, force, land_force : ndarray
        Centre (time, 2) [m], rotation (time,) [rad], angle of each ball ahead (time, ball) [rad], forces [N].
    frame : ndarray
        Angle that the ball set has turned by, if the picture is fixed in space; else 0 [rad].
    enlarged : float
        How many times too large movements and plays are drawn [-].
    land, side : float, int
        Radius of the land in the picture [m], infinite without one; 1 for a land outside the cage, -1 inside.
    edges : tuple
        Radius of the inner and the outer edge of the cage [m]; the guided one with its lobes.
    """

    radius: float
    ball: float
    angles: Array
    walls: Array
    offset: Array
    turn: Array
    lead: Array
    force: Array
    land_force: Array
    frame: Array
    enlarged: float
    land: float
    side: int
    edges: tuple[Array | float, Array | float]
    half_width: float

    @property
    def reach(self) -> float:
        """What the picture must show on either side of the axis [m]."""
        far = float(np.abs(self.offset).max(initial=0.0))
        return self.radius + self.half_width + max(3.0 * self.ball, far)

    def ball_places(self, moment: int) -> Array:
        """Return the centre of each ball, shape (ball, 2)."""
        return ring(self.radius, self.angles + self.lead[moment] + self.frame[moment])

    def placed(self, points: Array, moment: int) -> Array:
        """Return points of the cage where it is at a moment."""
        moved = turned(points, self.turn[moment]) + self.offset[moment]
        return turned(moved, self.frame[moment])

    def bars(self, moment: int) -> list[Array]:
        """Return the outline of each bar of the cage between two pockets."""
        low, high = self.radius - self.half_width, self.radius + self.half_width
        after, outlines = np.append(self.angles[1:], self.angles[0] + 2 * np.pi), []
        for start, end in zip(self.angles + self.walls, after - np.roll(self.walls, -1), strict=True):
            around = start + ARC * max(0.0, end - start)
            outlines.append(np.concatenate([ring(low, around), ring(high, around[::-1])]))
        return [self.placed(outline, moment) for outline in outlines]

    def rails(self, moment: int) -> list[Array]:
        """Return the inner and the outer edge of the cage."""
        return [self.placed(ring(edge, ROUND), moment) for edge in self.edges]

    def pocket_arrows(self, moment: int) -> tuple[Array, Array]:
        """Return foot and direction of the pockets' forces on the cage, as long as the root of their share.

        Without a force the direction is NaN.
        """
        force, largest = self.force[moment], float(np.abs(self.force).max(initial=0.0))
        around = self.angles + self.lead[moment] + self.frame[moment]
        size = -np.sign(force) * np.sqrt(np.abs(force) / (largest or 1.0))
        along = np.stack([-np.sin(around), np.cos(around)], axis=-1)
        return ring(self.radius + 2.0 * self.ball, around), along * np.where(size, size, np.nan)[
            :, np.newaxis
        ]

    def land_arrow(self, moment: int) -> tuple[Array, Array]:
        """Return foot and direction of the land's force on the cage, on its own scale; NaN without one."""
        force, largest = self.land_force[moment], float(self.land_force.max(initial=0.0))
        offset = turned(self.offset[moment], self.frame[moment])
        far = float(np.hypot(*offset))
        if not (force > 0.0 and far > 0.0):
            return np.zeros(2), np.full(2, np.nan)
        return self.side * offset / far * self.land, -offset / far * np.sqrt(force / largest)


def scene(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Scene:
    """Return the sizes and movements of a run at some samples, in the frame of the balls or a fixed one.

    Movements are enlarged so that a wall touches its ball when it does so: as much as leaves a bar between
    the pockets and the cage in the picture, on two digits; at least 1.
    """
    data = data.isel(time=moments)
    radius, play = float(data["cage_pitch_radius"]), data["half_play"].values
    pitch = 2 * np.pi * radius / max(3, data.sizes["ball"])
    diameter = study_of(data).get("bearing", {}).get("ball_diameter", {}).get("value")
    ball = 0.5 * float(0.75 * pitch if diameter is None else diameter)
    far = float(np.hypot(*data["position"].values.T).max(initial=0.0))
    most = [0.5 * (1 - BAR_SHARE) * (pitch - 2 * ball) / play.max()] if play.max() > 0.0 else []
    most += [FARTHEST * radius / far] if far > 0.0 else []
    enlarged = float(f"{max(1.0, min(most, default=1.0)):.2g}")
    guidance, clearance = str(data["cage_guidance"].values), float(data["cage_land_clearance"])
    guided, turn = guidance != "ball" and np.isfinite(clearance), turned_by(data)
    side, half_width = -1 if guidance == "inner" else 1, 2 * RAIL * ball
    wave = enlarged * float(data["cage_land_out_of_round"]) if guided else 0.0
    waved = wave * np.cos(int(data["cage_land_lobes"]) * ROUND)
    inner, outer = (radius + s * (half_width + (waved if s == side else 0.0)) for s in (-1, 1))
    return Scene(
        radius=radius,
        ball=ball,
        angles=data["pocket_angle"].values,
        walls=np.arcsin(np.clip((ball + enlarged * play) / radius, 0.0, 1.0)),
        offset=enlarged * data["position"].values,
        turn=enlarged * data["rotation"].values,
        lead=enlarged * data["ball_lead"].values / radius,
        force=data["contact_force"].values,
        land_force=np.abs(data["land_force"].values),
        frame=turn if fixed else np.zeros_like(turn),
        enlarged=enlarged,
        land=radius + side * (half_width + enlarged * 0.5 * clearance) if guided else np.inf,
        side=side,
        edges=(inner, outer),
        half_width=half_width,
    )


def turned_by(data: xr.Dataset) -> Array:
    """Return the angle by which the ball set has turned at each sample [rad], with its start-up ramp."""
    time, speed = np.asarray(data["time"].values, dtype=float), float(data["cage_cage_speed"])
    ramp, start = float(data["cage_ramp_time"]), float(data["cage_ramp_start"])
    if not ramp > 0.0:
        return np.asarray(speed * time)
    within = np.minimum(time, ramp)
    return np.asarray(speed * (time - (1 - start) * within + (1 - start) * within**2 / (2 * ramp)))


def turned(points: Array, angle: float) -> Array:
    """Return points, shape (..., 2), turned by an angle about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]), dtype=float)
