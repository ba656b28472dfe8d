"""The cage among its balls as films and pages draw it: true shapes, small movements enlarged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from separatrix.figures.motion import land_boundary, ring
from separatrix.figures.style import stated, study_of
from separatrix.units import Array

BAR_SHARE, FARTHEST, RAIL = 0.4, 0.3, 0.36
"""Least share of the bar in the room between two balls; largest offset over the pitch radius; half the radial
width of the cage over the ball's diameter."""

ARC, ROUND = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 2 * np.pi, 181)

THICK, WIDE, RIM = 0.28, 1.35, 0.88
"""Half the radial thickness of the cage over the ball's diameter; its width over that, if it is not stated;
largest size of a pocket along the axis over the cage's width."""

FARTHEST_IN_SPACE = 0.25
"""Largest movement in the picture over the pitch radius."""

POCKET_POINTS = 24
"""Points around a pocket."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """Sizes [m], and each moment's movements times `enlarged`, in the frame of the ball set."""

    radius: float  # of the pitch circle
    ball: float  # radius
    angles: Array  # of each pocket [rad]
    walls: Array  # half the angle of each pocket from wall to wall, with the play enlarged [rad]
    offset: Array  # of the centre, shape (time, 2)
    turn: Array  # rotation of the cage, shape (time,) [rad]
    lead: Array  # angle by which each ball is ahead, shape (time, ball) [rad]
    force: Array  # of each pocket, shape (time, ball) [N]
    land_force: Array  # shape (time,) [N]
    frame: Array  # angle by which the ball set has turned, if the picture is fixed in space; else 0 [rad]
    enlarged: float  # factor by which movements and plays are drawn too large
    land: float  # radius of the land in the picture; infinite without one
    side: int  # 1 for a land outside the cage, -1 inside
    edges: tuple[Array | float, Array | float]  # radii of the cage; the guided one with its lobes
    half_width: float  # half the radial width of the cage

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
    the pockets and the cage in the picture.
    """
    data = data.isel(time=moments)
    radius, play = float(data["cage_pitch_radius"]), data["half_play"].values
    diameter = stated(study_of(data), "bearing", "ball_diameter")
    ball = 0.5 * float(0.75 * _pitch(data) if diameter is None else diameter)
    far = float(np.hypot(*data["position"].values.T).max(initial=0.0))
    enlarged = _enlargement((_room(data, ball), play.max()), (FARTHEST * radius, far))
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


def _pitch(data: xr.Dataset) -> float:
    """Return the length of the pitch circle between two balls [m]."""
    return 2 * np.pi * float(data["cage_pitch_radius"]) / max(3, data.sizes["ball"])


def _room(data: xr.Dataset, ball: float) -> float:
    """Return the largest half play in the picture that leaves a bar of the cage between two balls [m]."""
    return 0.5 * (1 - BAR_SHARE) * (_pitch(data) - 2 * ball)


def _enlargement(*limits: tuple[float, float]) -> float:
    """Return how many times movements are enlarged, from pairs of a largest and a true size: at least 1."""
    most = [largest / size for largest, size in limits if size > 0.0]
    return float(f"{max(1.0, min(most, default=1.0)):.2g}")


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpaceScene:
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
    centre: Array  # shape (time, 2)
    lean: Array  # shape (time, 2) [rad]
    axial: Array  # shape (time,)
    rotation: Array  # shape (time,) [rad]
    lead: Array  # of each ball, shape (time, ball)
    ball_axial: Array  # shape (time, ball)
    force: Array  # largest of each ball since the moment before, shape (time, ball) [N]
    largest_force: float  # of all samples of the run [N]
    frame: Array  # angle by which the ball set has turned [rad]
    enlarged: float  # factor by which movements and clearances are drawn too large at first

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
        return np.column_stack([ring(self.radius, angle), self.enlarged * self.ball_axial[moment]])

    def faces(self) -> Array:
        """Return the faces of the cage at rest around its enlarged pockets, shape (face, 4, 3)."""
        around = 2.0 * np.pi * (np.arange(POCKET_POINTS) + 0.5) / POCKET_POINTS
        c, s = np.cos(around), np.sin(around)
        square = np.maximum(np.abs(c), np.abs(s))
        corner = square if self.is_square else 1.0
        across = min(self.ball + self.enlarged * self.axial_play, RIM * self.half_width)
        ends = np.append(self.angles, self.angles[0] + 2.0 * np.pi)
        middles = 0.5 * (ends[:-1] + ends[1:])
        lows, found = np.roll(middles, 1), []
        lows[0] -= 2.0 * np.pi
        for angle, play, low, high in zip(self.angles, self.plays, lows, middles, strict=True):
            along = (self.ball + self.enlarged * play) / self.radius
            hole = angle + along * c / corner, across * s / corner
            share = 0.5 * (high + low) + 0.5 * (high - low) * c / square, self.half_width * s / square
            for r in (self.radius - self.half_thickness, self.radius + self.half_thickness):
                inner, outer = (np.column_stack([ring(r, at), height]) for at, height in (hole, share))
                quads = [inner, np.roll(inner, -1, axis=0), np.roll(outer, -1, axis=0), outer]
                found.append(np.stack(quads, axis=1))
        return np.concatenate(found)

    @property
    def land_radius(self) -> float:
        """Radius of the land in the picture, its clearance enlarged [m]."""
        return self.land + self.side * self.enlarged * self.gap


def axial_play(data: xr.Dataset) -> float | None:
    """Return half the clearance of the pockets along the axis [m]; None if it is unknown."""
    play = float(data["cage_space_axial_play"])
    return play if np.isfinite(play) and play > 0.0 else None


def space_scene(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> SpaceScene:
    """Return sizes and movements of a run at some samples.

    Movements are enlarged as in `scene`; an edge of a pocket along the axis also remains within the cage.
    """
    every, largest = data["contact_force"].values, float(data["contact_force"].max())
    before = np.concatenate([[moments[0]], moments[:-1] + 1])
    pairs = zip(before, moments, strict=True)
    force = np.array([every[min(a, b) : b + 1].max(axis=0) for a, b in pairs])
    data = data.isel(time=moments)
    radius, play = float(data["cage_pitch_radius"]), data["half_play"].values.astype(float)
    ball = 0.5 * float(data["cage_space_ball_diameter"])
    wide = stated(study_of(data), "cage", "width")
    half_width = max(0.5 * float(wide) if wide else 0.0, WIDE * ball)
    across = axial_play(data) or 0.0
    far = float(np.hypot(*data["centre"].values.T).max(initial=0.0))
    far = max(far, radius * float(np.hypot(*data["lean"].values.T).max(initial=0.0)))
    far = max(far, float(np.abs(data["position"].values[:, 2]).max(initial=0.0)))
    rooms = [(_room(data, ball), play.max()), (RIM * half_width - ball, across)]
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
        axial_play=across,
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
        enlarged=_enlargement(*rooms, (FARTHEST_IN_SPACE * radius, far)),
    )
