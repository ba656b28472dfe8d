"""The cage among its balls as an animation draws it: true shapes, small movements enlarged."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
import xarray as xr

from separatrix.figures.orbit import half_plays, pocket_angles, ring
from separatrix.units import Array

BAR_SHARE = 0.4
"""Least share of the room between two balls that the cage's bar takes in the picture."""

FARTHEST = 0.3
"""Largest offset in the picture, as a share of the pitch radius."""

RAIL = 0.36
"""Half the radial width of the cage, as a share of the ball's diameter."""

ARC = np.linspace(0.0, 1.0, 9)
ROUND = np.linspace(0.0, 2 * np.pi, 181)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """Sizes [m], and each moment's movements times `enlarged`, in the frame of the ball set.

    Attributes
    ----------
    radius, ball : float
        Of the pitch circle and of a ball [m].
    angles, walls : ndarray
        Of each pocket, and half its angle from wall to wall with the play enlarged [rad].
    offset, turn, lead, force, land_force : ndarray
        Centre (time, 2) [m], rotation (time,) [rad], angle of each ball ahead (time, ball) [rad], forces [N].
    frame : ndarray
        Angle that the ball set has turned by, if the picture stands still; else 0 [rad].
    enlarged : float
        How many times too large movements and plays are drawn [-].
    gap : float
        Offset at which the land is touched, enlarged [m]; infinite without a land.
    wave, lobes, side : float, int, int
        The land's out-of-round, enlarged [m], its lobes; 1 for a land outside the cage, -1 inside.
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
    gap: float
    wave: float
    lobes: int
    side: int

    @property
    def half_width(self) -> float:
        """Half the radial width of the cage [m]."""
        return 2 * RAIL * self.ball

    @property
    def reach(self) -> float:
        """What the picture must show on either side of the axis [m]."""
        return (
            self.radius + self.half_width + max(3.0 * self.ball, float(np.abs(self.offset).max(initial=0.0)))
        )


def scene(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Scene:
    """Return the sizes and movements of a run at some of its samples.

    Parameters
    ----------
    data : Dataset
        Of a simulation.
    moments : ndarray
        Numbers of the samples.
    fixed : bool
        Whether the picture stands still in space, and the ball set turns in it.
    """
    data = data.isel(time=moments)
    radius, ball = float(data["cage_pitch_radius"]), 0.5 * ball_diameter(data)
    enlarged = enlargement(data, ball)
    guidance, clearance = str(data["cage_guidance"].values), float(data["cage_land_clearance"])
    guided = guidance != "ball" and np.isfinite(clearance)
    turned = turned_by(data)
    return Scene(
        radius=radius,
        ball=ball,
        angles=pocket_angles(data),
        walls=np.arcsin(np.clip((ball + enlarged * half_plays(data)) / radius, 0.0, 1.0)),
        offset=enlarged * data["position"].values,
        turn=enlarged * data["rotation"].values,
        lead=enlarged * data["ball_lead"].values / radius,
        force=data["contact_force"].values,
        land_force=np.abs(data["land_force"].values),
        frame=turned if fixed else np.zeros_like(turned),
        enlarged=enlarged,
        gap=enlarged * 0.5 * clearance if guided else np.inf,
        wave=enlarged * float(data.get("cage_land_out_of_round", 0.0)) if guided else 0.0,
        lobes=int(data.get("cage_land_lobes", 2)),
        side=-1 if guidance == "inner" else 1,
    )


def ball_diameter(data: xr.Dataset) -> float:
    """Return the ball's diameter from the study in the attributes [m]; without one 3/4 of a pitch."""
    study = json.loads(data.attrs.get("study", "{}"))
    known = study.get("bearing", {}).get("ball_diameter", {}).get("value")
    pitch = 2 * np.pi * float(data["cage_pitch_radius"]) / max(3, data.sizes["ball"])
    return float(known) if known is not None else 0.75 * pitch


def enlargement(data: xr.Dataset, ball: float) -> float:
    """Return how many times too large movements are drawn: a wall then touches its ball when it does so.

    As large as leaves a bar between the pockets and the cage in the picture, on two digits; at least 1.
    """
    radius = float(data["cage_pitch_radius"])
    room = 2 * np.pi * radius / max(3, data.sizes["ball"]) - 2 * ball
    play, far = float(half_plays(data).max()), float(np.hypot(*data["position"].values.T).max(initial=0.0))
    most = [0.5 * (1 - BAR_SHARE) * room / play] if play > 0.0 else []
    most += [FARTHEST * radius / far] if far > 0.0 else []
    return float(f"{max(1.0, min(most, default=1.0)):.2g}")


def turned_by(data: xr.Dataset) -> Array:
    """Return the angle by which the ball set has turned at each sample [rad], with its start-up ramp."""
    time, speed = np.asarray(data["time"].values, dtype=float), float(data["cage_cage_speed"])
    ramp = float(data.get("cage_ramp_time", 0.0))
    if not ramp > 0.0:
        return np.asarray(speed * time)
    start = float(data.get("cage_ramp_start", 0.1))
    within = np.minimum(time, ramp)
    return np.asarray(speed * (time - (1 - start) * within + (1 - start) * within**2 / (2 * ramp)))


def turned(points: Array, angle: float) -> Array:
    """Return points, shape (..., 2), turned by an angle about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]), dtype=float)


def bars(at: Scene, moment: int) -> list[Array]:
    """Return the outline of each bar of the cage between two pockets."""
    low, high = at.radius - at.half_width, at.radius + at.half_width
    after = np.append(at.angles[1:], at.angles[0] + 2 * np.pi)
    outlines = []
    for start, end in zip(at.angles + at.walls, after - np.roll(at.walls, -1), strict=True):
        around = start + ARC * max(0.0, end - start)
        outlines.append(np.concatenate([ring(low, around), ring(high, around[::-1])]))
    return [_placed(outline, at, moment) for outline in outlines]


def rails(at: Scene, moment: int) -> list[Array]:
    """Return the inner and the outer edge of the cage; the guided one with its lobes."""
    edges = []
    for side in (-1, 1):
        wave = at.wave * np.cos(at.lobes * ROUND) if side == at.side else 0.0
        edges.append(_placed(ring(at.radius + side * (at.half_width + wave), ROUND), at, moment))
    return edges


def _placed(points: Array, at: Scene, moment: int) -> Array:
    """Return points of the cage where it is at a moment."""
    moved = turned(points, at.turn[moment]) + at.offset[moment]
    return turned(moved, at.frame[moment])


def ball_places(at: Scene, moment: int) -> Array:
    """Return the centre of each ball, shape (ball, 2)."""
    return ring(at.radius, at.angles + at.lead[moment] + at.frame[moment])


def land_radius(at: Scene) -> float:
    """Return the radius of the land in the picture [m]."""
    return at.radius + at.side * (at.half_width + at.gap)


def pocket_arrows(at: Scene, moment: int) -> tuple[Array, Array]:
    """Return foot and direction of the pockets' forces on the cage, as long as the root of their share.

    No force is a direction of NaN.
    """
    force, largest = at.force[moment], float(np.abs(at.force).max(initial=0.0))
    around = at.angles + at.lead[moment] + at.frame[moment]
    size = -np.sign(force) * np.sqrt(np.abs(force) / (largest or 1.0))
    along = np.stack([-np.sin(around), np.cos(around)], axis=-1)
    return ring(at.radius + 2.0 * at.ball, around), along * np.where(size, size, np.nan)[:, np.newaxis]


def land_arrow(at: Scene, moment: int) -> tuple[Array, Array]:
    """Return foot and direction of the land's force on the cage, on its own scale; NaN without a force."""
    force, largest = at.land_force[moment], float(at.land_force.max(initial=0.0))
    offset = turned(at.offset[moment], at.frame[moment])
    far = float(np.hypot(*offset))
    if not (force > 0.0 and far > 0.0):
        return np.zeros(2), np.full(2, np.nan)
    normal = offset / far
    return at.side * normal * land_radius(at), -normal * np.sqrt(force / largest)
