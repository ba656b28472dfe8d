"""Cages in space from which the tests start, and a run from a start of one's own."""

import math
from dataclasses import dataclass, replace

import numpy as np
from cages import AT_REST, TURNING
from separatrix.cage.space.ensemble import kick_speeds
from separatrix.cage.space.history import MOTIONS, SOURCES, row_length
from separatrix.cage.space.inputs import land_strips, numbers, parts_of
from separatrix.cage.space.records import Books, Parts, books_for
from separatrix.cage.space.run import FIRST_LEAD, follow_run
from separatrix.cage.space_body import SpaceBody

from separatrix.cage import PlanarCage
from separatrix.cage.closed_forms import moving_mass, time_unit
from separatrix.pocket_shape import PocketShape
from separatrix.units import Array

PITCH = math.radians(25.44303)
CRYO = {
    "ball_spin": (-4083.218, 1942.614, -3.53),
    "ball_diameter": 11.1125e-3,
    "groove_damping": 766.0,
    "groove_stiffness": 5.05e6,
}
IN_PLANE = {
    "ball_spin": (-4e15, 0.0, 0.0),
    "ball_diameter": 11.1125e-3,
    "friction_lever": 0.0,
    "is_tilt_held": True,
    "is_axially_held": True,
}
"""Held in the plane, with a spin so fast that its direction alone decides that of the friction."""


def in_space(plane: PlanarCage, **body: object) -> PlanarCage:
    """Return the cage with a body in space, half as inert about a diameter as about its axis."""
    given = CRYO | {"transverse_inertia": 0.5 * plane.moment_of_inertia} | body
    return replace(plane, space=SpaceBody(**given))


ROUND = in_space(
    replace(TURNING, race_damping=356.58, ball_cage_friction=0.2, pocket_shape=PocketShape.CYLINDRICAL)
)
"""A turbopump's cage with bores, without a land."""


def ring(friction: float, *, clearance: float = 3e-4, eta: float = 0.8, **body: object) -> PlanarCage:
    """Return the thin ring of dynamics3d's E9 and E10, in a ball set at rest."""
    damping_ratio = -math.log(eta) / math.hypot(math.pi, math.log(eta))
    damping = math.sqrt(AT_REST.ball_cage_stiffness * AT_REST.mass) / (2.0 * damping_ratio)
    plane = replace(
        AT_REST,
        race_damping=damping,
        pocket_clearance=clearance,
        ball_cage_friction=friction,
        pocket_shape=PocketShape.CYLINDRICAL if clearance else PocketShape.SQUARE,
    )
    spin = (-4500.0 * math.cos(PITCH), 4500.0 * math.sin(PITCH), 0.0)
    given = {"ball_spin": spin, "ball_diameter": 0.0111, "friction_lever": 0.0, "groove_damping": 370.0}
    return in_space(plane, **(given | body))


@dataclass(frozen=True, kw_only=True)
class Course:
    """A run, sampled: time [s], motion in metres with tilts times R, their rates, leads, and the rest."""

    time: Array
    motion: Array
    rates: Array
    kinetic: Array
    held: Array
    work: Array
    lead: Array
    axial: Array
    land_force: Array
    gross: float
    hits: int
    filled: int
    steps: float
    parts: Parts
    books: Books
    unit: float

    @property
    def imbalance(self) -> float:
        """Energy that no source explains, over the work done [-]."""
        gained = self.kinetic[-1] + self.held[-1] - self.kinetic[0] - self.held[0]
        return float(abs(gained - self.work[-1].sum()) / (self.gross + self.kinetic[0]))


def course(
    cage: PlanarCage,
    duration: float,
    *,
    kick: float = 0.5,
    direction: float = 0.3,
    tilt_way: float = 0.0,
    lead: Array | None = None,
    more: Array | None = None,
    samples: int = 31,
) -> Course:
    """Follow a run from a start of one's own."""
    Z, p, parts, books = cage.ball_count, numbers(cage, kick), parts_of(cage), books_for(1)
    start = np.zeros(FIRST_LEAD + 3 * Z)
    start[:FIRST_LEAD] = direction, tilt_way, 1.0
    start[FIRST_LEAD:] = np.concatenate(
        [np.zeros(Z) if lead is None else lead, np.zeros(Z) if more is None else more, cage.ball_angles]
    )
    T, M = time_unit(cage), moving_mass(cage)
    times, at = np.linspace(0.0, duration, samples), MOTIONS + len(SOURCES)
    rows = np.zeros((samples, row_length(cage)))
    hits = np.zeros(Z, np.int64)
    filled = follow_run(
        p, parts, start, kick_speeds(cage, kick), cage.pocket_axial_offset, books, times / T, np.inf, rows,
        hits, np.zeros(Z),
    )  # fmt: skip
    energy = M / T**2
    return Course(
        time=times,
        motion=rows[:, :6],
        rates=rows[:, 6:12] / T,
        kinetic=rows[:, 12] * energy,
        held=rows[:, 13] * energy,
        work=rows[:, MOTIONS:at] * energy,
        lead=rows[:, at : at + Z],
        axial=rows[:, at + Z : at + 2 * Z],
        land_force=rows[:, at + 2 * Z : at + 2 * Z + land_strips(cage)[0].size] * energy,
        gross=np.asarray(books.works)["gross"][0] * energy,
        hits=int(hits.sum()),
        filled=int(filled),
        steps=np.asarray(books.looks)["steps"][0],
        parts=parts,
        books=books,
        unit=T,
    )
