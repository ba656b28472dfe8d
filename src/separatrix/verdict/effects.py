"""What else moves a critical friction: the same cage with one thing put in or left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from separatrix.cage.moving_cage import MovingCage
from separatrix.chain.land_fluid import land_fluid
from separatrix.chain.solution import Solution
from separatrix.ground.units import Ratio, format_quantity

WIDE: Ratio = 1.6
"""Clearance of a wide land over that of the pocket: there the pockets stop the cage, not the land."""

MOVED: Ratio = 0.05
"""Mass of the fluid in a land's gap over the cage's from which it counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Effect:
    """Critical friction of the reference cage with one thing changed."""

    name: str  # wide_land, fluid, equal_balls or even_orbits
    change: str  # with what, in words
    own_critical_friction: Ratio | None  # null beyond the search
    own_critical_friction_low: Ratio  # of its 95 % interval, from the number of runs
    own_critical_friction_high: Ratio | None  # upper end of it


@dataclass(frozen=True, slots=True)
class Change:
    """What an effect changes of a cage: in words, and other values of its fields."""

    words: str
    values: Mapping[str, Any]


def effects_on(solution: Solution, cage: MovingCage) -> Iterator[tuple[str, Change]]:
    """What the inputs of a study allow to put in or leave out, each with its name."""
    if 0.0 < 2.0 * cage.land_gap < cage.pocket_clearance:
        wide = WIDE * cage.pocket_clearance
        yield (
            "wide_land",
            Change(f"a land clearance of {format_quantity(wide, 'm', 3)}", {"land_clearance": wide}),
        )
    if cage.added_mass > MOVED * cage.mass:
        words = f"no fluid that moves with the cage, of {format_quantity(cage.added_mass, 'kg', 2)} stated"
        yield "fluid", Change(words, {"added_mass": 0.0, "fluid_damping": 0.0})
    found = land_fluid(solution.study, solution.design, cage.cage_speed)
    if cage.added_mass == 0.0 and found and found.added_mass > MOVED * cage.mass:
        gap, body = (format_quantity(one, "kg", 2) for one in (found.added_mass, cage.mass))
        values = {"added_mass": found.added_mass, "fluid_damping": found.damping}
        values["fluid_speed"] = 0.5 * (cage.cage_speed + cage.guiding_ring_speed)
        yield "fluid", Change(f"the fluid in the gap of the land, {gap} beside a cage of {body}", values)
    if cage.ball_diameter_scatter > 0.0:
        equal = {"ball_diameter_scatter": 0.0, "orbit_by_diameter": 0.0, "balls_at_walls": False}
        yield "equal_balls", Change("balls of equal diameter", equal)
    if cage.orbital_cosines:
        even: dict[str, Any] = {"orbital_cosines": (), "orbital_sines": ()}
        yield "even_orbits", Change("balls that neither lead nor lag under radial load or moment", even)
