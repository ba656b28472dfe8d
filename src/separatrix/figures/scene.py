"""The cage among its balls as films and pages draw it: true shapes, small movements enlarged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from separatrix.figures.motion import axial_play, is_in_space, land_boundary, land_heights, ring
from separatrix.figures.style import stated, study_of
from separatrix.units import Array

BAR_SHARE, FARTHEST = 0.4, 0.25
"""Least share of the bar in the room between two balls; largest movement drawn over the pitch radius."""

THICK, WIDE, RIM = 0.28, 1.35, 0.88
"""Half the radial thickness of the cage over the ball's diameter; its width over that, if it is not stated;
largest size of a pocket along the axis over the cage's width."""

POCKET_POINTS, BAR_POINTS = 24, 6
"""Points around a pocket; pieces of a bar between two pockets, in the plane of the balls."""

VIEWS = ((0.5 * np.pi, 0.0), tuple(np.deg2rad([28.0, -62.0])))
"""Height of the eye over the plane of the bearing, and angle around it [rad]: in the plane, in space."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """Sizes [m], and movements at each moment, true, in the frame of the ball set."""

    radius: float  # of the pitch circle
    ball: float  # radius
    half_width: float  # of the cage
    half_thickness: float  # of the cage
    angles: Array  # of each pocket [rad]
    plays: Array  # half the clearance of each pocket along the orbit
    axial_play: float  # half the clearance of a pocket along the axis
    is_square: bool  # whether pockets have corners
    land: float  # radius of the surface of the cage at the land
    side: int  # 1 for a land outside the cage, -1 inside, 0 without one
    heights: tuple[float, ...]  # of the lands over the pockets
    gap: float  # radial clearance of the lands
    in_space: bool  # whether the cage tilts and moves along the axis
    centre: Array  # shape (time, 2)
    lean: Array  # shape (time, 2) [rad]
    axial: Array  # shape (time,)
    rotation: Array  # shape (time,) [rad]
    lead: Array  # of each ball, shape (time, ball)
    ball_axial: Array  # shape (time, ball)
    force: Array  # largest of each ball since the moment before, shape (time, ball) [N]
    land_force: Array  # the same of the lands, shape (time,) [N]
    largest: tuple[float, float]  # forces of a pocket and of the lands, of all samples of the run [N]
    frame: Array  # angle by which the ball set has turned; 0 where the picture turns with it [rad]
    enlarged: float  # factor by which movements and clearances are drawn too large at first

    @property
    def view(self) -> tuple[float, float]:
        """Height of the eye, and the angle around the axis [rad]."""
        return VIEWS[self.in_space]

    @property
    def land_radius(self) -> float:
        """Radius of the land in the picture, its clearance enlarged [m]."""
        return self.land + self.side * self.enlarged * self.gap

    def moved(self, points: Array, moment: int) -> Array:
        """Return points of the cage, shape (..., 3), where it is at a moment, movements enlarged."""
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        (cx, cy), (lx, ly), turn = self.centre[moment], self.lean[moment], self.rotation[moment]
        step = [cx + lx * z - turn * y, cy + ly * z + turn * x, self.axial[moment] - lx * x - ly * y]
        return np.asarray(points + self.enlarged * np.stack(step, axis=-1))

    def ball_places(self, moment: int) -> Array:
        """Return the centre of each ball, shape (ball, 3)."""
        angle = self.angles + self.enlarged * self.lead[moment] / self.radius
        return np.column_stack([ring(self.radius, angle), self.enlarged * self.ball_axial[moment]])

    def reaches(self) -> Array:
        """Return half the angle of each enlarged pocket, where a radial wall touches its ball [rad]."""
        return np.arcsin(np.clip((self.ball + self.enlarged * self.plays) / self.radius, 0.0, 1.0))

    def faces(self) -> Array:
        """Return the faces of the cage at rest, shape (face, 4, 3).

        Both surfaces around the pockets come first, then the bars between them in the plane of the balls.
        """
        around = 2.0 * np.pi * (np.arange(POCKET_POINTS) + 0.5) / POCKET_POINTS
        c, s = np.cos(around), np.sin(around)
        square = np.maximum(np.abs(c), np.abs(s))
        corner = square if self.is_square else 1.0
        across = min(self.ball + self.enlarged * self.axial_play, RIM * self.half_width)
        ends, reach = np.append(self.angles, self.angles[0] + 2.0 * np.pi), self.reaches()
        middles = 0.5 * (ends[:-1] + ends[1:])
        lows, radii = np.roll(middles, 1), self.radius + self.half_thickness * np.array([-1.0, 1.0])
        lows[0] -= 2.0 * np.pi
        found = []
        for angle, along, low, high in zip(self.angles, reach, lows, middles, strict=True):
            hole = angle + along * c / corner, across * s / corner
            share = 0.5 * (high + low) + 0.5 * (high - low) * c / square, self.half_width * s / square
            for r in radii:
                inner, outer = (np.column_stack([ring(r, at), height]) for at, height in (hole, share))
                quads = [inner, np.roll(inner, -1, axis=0), np.roll(outer, -1, axis=0), outer]
                found.append(np.stack(quads, axis=1))
        for start, end in zip(self.angles + reach, ends[1:] - np.roll(reach, -1), strict=True):
            at = np.linspace(start, max(start, end), BAR_POINTS + 1)
            low, high = (np.column_stack([ring(r, at), np.zeros(at.size)]) for r in radii)
            found.append(np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1))
        return np.concatenate(found)


def scene(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Scene:
    """Return sizes and movements of a run at some samples, in the frame of the balls or a fixed one.

    Movements are enlarged so that a wall touches its ball when it does so: as much as leaves a bar between
    two pockets, the pockets within the cage, and the cage in the picture.
    """
    peaks = [np.asarray(data[name].values, dtype=float) for name in ("contact_force", "land_force")]
    before = np.concatenate([[moments[0]], moments[:-1] + 1])
    pairs = [(min(a, b), b + 1) for a, b in zip(before, moments, strict=True)]
    force, land_force = (np.array([one[a:b].max(axis=0) for a, b in pairs]) for one in peaks)
    in_space, data = is_in_space(data), data.isel(time=moments)
    count, balls = data.sizes["time"], data.sizes["ball"]
    radius, plays = float(data["cage_pitch_radius"]), data["half_play"].values.astype(float)
    pitch = 2.0 * np.pi * radius / max(3, balls)
    ball = 0.5 * (float(data["cage_ball_diameter"]) or 0.75 * pitch)
    wide = stated(study_of(data), "cage", "width")
    half_width = max(0.5 * float(wide) if wide else 0.0, WIDE * ball)
    centre, lean = data["position"].values, data["lean"].values if in_space else np.zeros((count, 2))
    axial = data["axial_place"].values if in_space else np.zeros(count)
    across, land, turned = axial_play(data) if in_space else 0.0, land_boundary(data), turned_by(data)
    side = 0 if land is None else (-1 if str(data["cage_guidance"].values) == "inner" else 1)
    far = max(
        float(np.abs(one).max(initial=0.0))
        for one in (np.hypot(*centre.T), radius * np.hypot(*lean.T), axial)
    )
    limits = [
        (0.5 * (1.0 - BAR_SHARE) * (pitch - 2.0 * ball), float(plays.max())),
        (RIM * half_width - ball, across),
        (FARTHEST * radius, far),
    ]
    most = [largest / size for largest, size in limits if size > 0.0]
    return Scene(
        radius=radius,
        ball=ball,
        half_width=half_width,
        half_thickness=2.0 * THICK * ball,
        angles=data["pocket_angle"].values.astype(float),
        plays=plays,
        axial_play=across,
        is_square=str(data["cage_pocket_shape"].values) == "square",
        land=radius + side * 2.0 * THICK * ball,
        side=side,
        heights=tuple(float(h) for h in land_heights(data)),
        gap=0.0 if land is None else float(land.max()),
        in_space=in_space,
        centre=centre,
        lean=lean,
        axial=axial,
        rotation=data["rotation"].values,
        lead=data["ball_lead"].values,
        ball_axial=data["ball_axial"].values if in_space else np.zeros((count, balls)),
        force=force,
        land_force=land_force,
        largest=(float(peaks[0].max()), float(peaks[1].max())),
        frame=turned if fixed else np.zeros(count),
        enlarged=float(f"{max(1.0, min(most, default=1.0)):.2g}"),
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
