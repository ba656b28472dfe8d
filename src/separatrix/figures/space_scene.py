"""The cage in space as a film and a page draw it: true sizes, small movements enlarged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from separatrix.figures.motion import land_boundary
from separatrix.figures.scene import BAR_SHARE, turned_by
from separatrix.figures.style import study_of
from separatrix.units import Array

THICK, WIDE, RIM = 0.28, 1.35, 0.88
"""Half the radial thickness of the cage over the ball's diameter; its width over that, if it is not given;
largest size of a pocket along the axis over the cage's width."""

FARTHEST = 0.25
"""Largest movement in the picture over the pitch radius."""

AROUND = 24
"""Points around a pocket."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpaceScene:
    """Sizes [m], and movements at each moment, true, in the frame of the ball set.

    Attributes
    ----------
    radius, ball, half_width, half_thickness : float
        Of the pitch circle, a ball, and the cage.
    angles, plays : ndarray
        Of each pocket [rad], and half its clearance along the orbit [m].
    axial_play : float
        Half the clearance of a pocket along the axis [m].
    is_square : bool
        Whether pockets have corners.
    land, side, heights, gap : float, int, tuple, float
        Radius of the surface of the cage at the land, 1 outside or -1 inside (0: no land), heights of the
        lands over the pockets, radial clearance.
    centre, lean, axial, rotation : ndarray
        Shapes (time, 2), (time, 2), (time,), (time,).
    lead, ball_axial, force : ndarray
        Of each ball, shape (time, ball); the force is the largest since the moment before.
    largest_force : float
        Of all samples of the run [N].
    frame : ndarray
        Angle by which the ball set has turned [rad].
    enlarged : float
        How many times too large movements and clearances are drawn at first.
    """

    radius: float
    ball: float
    half_width: float
    half_thickness: float
    angles: Array
    plays: Array
    axial_play: float
    is_square: bool
    land: float
    side: int
    heights: tuple[float, ...]
    gap: float
    centre: Array
    lean: Array
    axial: Array
    rotation: Array
    lead: Array
    ball_axial: Array
    force: Array
    largest_force: float
    frame: Array
    enlarged: float

    def moved(self, points: Array, moment: int) -> Array:
        """Return points of the cage, shape (..., 3), where it is at a moment, movements enlarged."""
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        (cx, cy), (lx, ly), turn = self.centre[moment], self.lean[moment], self.rotation[moment]
        step = np.stack(
            [cx + lx * z - turn * y, cy + ly * z + turn * x, self.axial[moment] - lx * x - ly * y], axis=-1
        )
        return np.asarray(points + self.enlarged * step)

    def ball_places(self, moment: int) -> Array:
        """Return the centre of each ball, shape (ball, 3)."""
        angle = self.angles + self.enlarged * self.lead[moment] / self.radius
        across = [self.radius * np.cos(angle), self.radius * np.sin(angle)]
        return np.stack([*across, self.enlarged * self.ball_axial[moment]], axis=-1)

    def faces(self) -> Array:
        """Return the faces of the cage at rest around its pockets, shape (face, 4, 3)."""
        found, count = [], self.angles.size
        ends = np.append(self.angles, self.angles[0] + 2.0 * np.pi)
        middles = 0.5 * (ends[:-1] + ends[1:])
        lows = np.roll(middles, 1)
        lows[0] -= 2.0 * np.pi
        for j in range(count):
            hole, frame = self._pocket(j), _frame(middles[j], lows[j], self.half_width)
            hole[:, 0] += self.angles[j]
            for side in (-1.0, 1.0):
                inner, outer = (self._on(side, one) for one in (hole, frame))
                quads = [inner, np.roll(inner, -1, axis=0), np.roll(outer, -1, axis=0), outer]
                found.append(np.stack(quads, axis=1))
        return np.concatenate(found)

    def _pocket(self, j: int) -> Array:
        """Return angle and height of the edge of a pocket, its clearance enlarged, shape (point, 2)."""
        around = 2.0 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
        along = (self.ball + self.enlarged * self.plays[j]) / self.radius
        across = min(self.ball + self.enlarged * self.axial_play, RIM * self.half_width)
        c, s = np.cos(around), np.sin(around)
        corner = np.maximum(np.abs(c), np.abs(s)) if self.is_square else 1.0
        return np.stack([along * c / corner, across * s / corner], axis=1)

    def _on(self, side: float, flat: Array) -> Array:
        """Return points at angle and height on the outer or the inner surface, shape (point, 3)."""
        r = self.radius + side * self.half_thickness
        return np.stack([r * np.cos(flat[:, 0]), r * np.sin(flat[:, 0]), flat[:, 1]], axis=1)

    @property
    def land_radius(self) -> float:
        """Radius of the land in the picture, its clearance enlarged [m]."""
        return self.land + self.side * self.enlarged * self.gap


def _frame(high: float, low: float, half_width: float) -> Array:
    """Return the edge of a pocket's share of the cage, a point for each of the pocket's, shape (point, 2)."""
    around = 2.0 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    c, s = np.cos(around), np.sin(around)
    corner = np.maximum(np.abs(c), np.abs(s))
    middle, half = 0.5 * (high + low), 0.5 * (high - low)
    return np.stack([middle + half * c / corner, half_width * s / corner], axis=1)


def _enlargement(data: xr.Dataset, ball: float, half_width: float, across: float | None) -> float:
    """Return how many times movements are enlarged: bars stay between pockets, the cage in the picture."""
    radius, play = float(data["cage_pitch_radius"]), data["half_play"].values
    pitch = 2.0 * np.pi * radius / max(3, data.sizes["ball"])
    tilted = radius * float(np.hypot(*data["lean"].values.T).max(initial=0.0))
    far = max(tilted, float(np.hypot(*data["centre"].values.T).max(initial=0.0)))
    far = max(far, float(np.abs(data["position"].values[:, 2]).max(initial=0.0)))
    most = [0.5 * (1.0 - BAR_SHARE) * (pitch - 2.0 * ball) / play.max()] if play.max() > 0.0 else []
    most += [(RIM * half_width - ball) / across] if across else []
    most += [FARTHEST * radius / far] if far > 0.0 else []
    return float(f"{max(1.0, min(most, default=1.0)):.2g}")


def space_scene(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> SpaceScene:
    """Return sizes and movements of a run at some samples.

    Movements are enlarged so that a wall meets its ball when it does so: as much as leaves bars between the
    pockets, and the cage in the picture, on two digits; at least 1.
    """
    from separatrix.figures.space import axial_play

    every, largest = data["contact_force"].values, float(data["contact_force"].max())
    before = np.concatenate([[moments[0]], moments[:-1] + 1])
    pairs = zip(before, moments, strict=True)
    force = np.array([every[min(a, b) : b + 1].max(axis=0) for a, b in pairs])
    data = data.isel(time=moments)
    radius, play = float(data["cage_pitch_radius"]), data["half_play"].values.astype(float)
    ball = 0.5 * float(data["cage_space_ball_diameter"])
    study = study_of(data).get("cage", {})
    wide = study.get("width", {}).get("value") if isinstance(study.get("width"), dict) else None
    half_width = max(0.5 * float(wide) if wide else 0.0, WIDE * ball)
    across = axial_play(data)
    enlarged = _enlargement(data, ball, half_width, across)
    land, thickness = land_boundary(data), 2.0 * THICK * ball
    side = 0 if land is None else (-1 if str(data["cage_guidance"].values) == "inner" else 1)
    heights = np.atleast_1d(data["cage_space_land_heights"].values if side else np.zeros(0))
    return SpaceScene(
        radius=radius,
        ball=ball,
        half_width=half_width,
        half_thickness=thickness,
        angles=data["pocket_angle"].values.astype(float),
        plays=play,
        axial_play=across or 0.0,
        is_square=str(data["cage_pocket_shape"].values) == "square",
        land=radius + side * thickness,
        side=side,
        heights=tuple(float(h) for h in heights),
        gap=0.0 if land is None else float(land.max()),
        centre=data["centre"].values,
        lean=data["lean"].values,
        axial=data["position"].values[:, 2],
        rotation=data["rotation"].values,
        lead=data["ball_lead"].values,
        ball_axial=data["ball_axial"].values,
        force=force,
        largest_force=largest,
        frame=turned_by(data) if fixed else np.zeros(data.sizes["time"]),
        enlarged=enlarged,
    )
