"""What stands beside the verdicts: what decides them, where the motion leaves the range of its model.

And what else moves a critical friction: the same cage with one thing put in or left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from separatrix.cage.closed_forms import linear_whirl_frequency
from separatrix.cage.disturbance import with_kicks
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.chain.heat_balance import land_fluid
from separatrix.chain.impact_restitution import SOLID_LUBRICATION_LIMIT, hertz_coefficient
from separatrix.chain.pocket_friction import contact_radius, pocket_speed
from separatrix.chain.solution import Solution
from separatrix.ground.units import (
    Hertz,
    Kilogram,
    Metre,
    Newton,
    NewtonPerMetre,
    Pascal,
    Ratio,
    format_quantity,
)
from separatrix.study.study import (
    BallBearing,
    BallModel,
    CageDesign,
    Guidance,
    Material,
    MotionModel,
    PocketShape,
    Study,
)
from separatrix.verdict.judgement import Judgement, Verdict, transmitted_force
from separatrix.verdict.reasons import BEYOND_LAND
from separatrix.verdict.stability_curve import RestitutionThreshold

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


STRONG: Ratio = 1.0
"""Kick over the pocket speed beyond which a cage with round pockets tilts (docs/theory/cage.md)."""


STIFF: Ratio = 3.0
"""First bending frequency of a ring over that of the whirl from which it counts as rigid."""

SOFTEST: Ratio = 0.18
"""The same of the softest ring whose bending was computed: 800 Hz of 4.4 kHz (docs/theory/cage.md)."""

YIELDS: Ratio = 1.6
"""Largest pressure of a ball on a flat over the strength in simple compression, at which the flat begins to
yield (Johnson, Contact Mechanics, 1985, section 6.1)."""


class Moved(NamedTuple):
    """Whose cage moved, and the largest pocket force and offset in any run."""

    name: str
    largest_contact_force: Newton
    largest_offset: Metre


def beyond_motion(solution: Solution, rows: Sequence[Moved]) -> Iterator[str]:
    """Sentences on the rows of the bearing's own environment: pocket forces, and what happens on the land."""
    if not rows:
        return
    most, limit = max(row.largest_contact_force for row in rows), transmitted_force(solution)
    design = solution.design
    if most > limit and design.ball_model is BallModel.DAMPER:
        yield (
            f"The largest pocket force, {format_quantity(most, 'N', 3)}, exceeds f_BT (Q_i + Q_o) = "
            f"{format_quantity(limit, 'N', 3)}, the most that the races can transmit to a ball: beyond it "
            "the ball slides, and the linear race damping is outside its range. It then returns too much "
            "speed to the cage: `--model full` gives the answer with the ball's inertia and traction."
        )
    if design.motion_model is MotionModel.PLANE and design.pocket_shape is not PocketShape.SQUARE:
        yield from _tilts(solution)
    yield from _beyond_strength(solution.study, rows)
    yield from _bends(solution)
    yield from _fluid(solution)
    gap = (design.land_clearance or math.inf) / 2.0 if design.guidance is not Guidance.BALL else math.inf
    far = [row for row in rows if row.largest_offset > BEYOND_LAND * gap]
    if far:
        worst = max(row.largest_offset for row in far)
        names = "All" if len(far) == len(rows) > 1 else ", ".join(row.name for row in far)
        yield (
            f"{names}: the cage centre reaches {format_quantity(worst, 'm', 3)}, beyond the land at "
            f"{format_quantity(gap, 'm', 3)} by more than {100 * (BEYOND_LAND - 1):.0f} %. The land's "
            "stiffness decides such numbers, a real cage may break first: they are bounds."
        )


def _tilts(solution: Solution) -> Iterator[str]:
    """A sentence where a cage with round pockets is kicked so hard that it tilts."""
    speed = abs(solution.bearing.cage_speed) * solution.design.pocket_clearance / 2.0
    at = pocket_speed(solution.bearing.cage_speed, solution.design.pocket_clearance)
    kick = max(with_kicks(solution.study.stability, at).kicks)
    if kick > STRONG * speed:
        yield (
            f"The pockets are round, and the strongest disturbance, {kick:.3g} m/s, exceeds {speed:.3g} "
            "m/s, the "
            "speed of a cage half a pocket clearance off the axis. So disturbed a cage tilts, and may "
            "whirl in space at up to half less friction: `--model full`."
        )


def pocket_pressure(bearing: BallBearing, wall: Material, force: Newton) -> Pascal:
    """Largest pressure of a ball that is pressed on a flat pocket wall (Hertz); a bore shares it out [Pa]."""
    K = hertz_coefficient(bearing.ball_diameter, bearing.ball_material, wall)
    return 1.5 * force / (math.pi * contact_radius(force, K, bearing.ball_diameter) ** 2)


def _beyond_strength(study: Study, rows: Sequence[Moved]) -> Iterator[str]:
    """A sentence on the pockets that yield, of candidates, or a cage beside them, whose strength is known."""
    walls = {one.name: one.material for one in (study.ranking.candidates if study.ranking else ())}
    own = study.cage.material if study.cage else None
    weak = []
    for row in rows:
        wall, force = walls.get(row.name, own), row.largest_contact_force
        if wall is None or wall.compressive_strength is None or force == 0.0:
            continue
        pressure, limit = pocket_pressure(study.bearing, wall, force), YIELDS * wall.compressive_strength
        if pressure > limit:
            both = (format_quantity(each, "Pa", 2) for each in (pressure, limit))
            weak.append(f"{row.name} {' against '.join(both)}")
    if weak:
        yield (
            f"The largest pocket force presses a ball into a flat pocket wall beyond {YIELDS:g} times its "
            f"compressive strength, where it begins to yield: {', '.join(weak)}. The pocket dents and wears; "
            "its elastic stiffness is outside its range."
        )


def bending_frequency(design: CageDesign, material: Material | None) -> Hertz | None:
    r"""First bending of the cage's ring in its plane, pockets not counted; None without a shape.

    :math:`\omega^2 = n^2 (n^2 - 1)^2/(n^2 + 1)\, EI/(\rho A R^4)` with n = 2 waves round a thin ring that
    does not stretch.
    """
    outer, inner, wall = design.outer_diameter, design.inner_diameter, material or design.material
    if outer is None or inner is None or wall is None or wall.density is None:
        return None
    thickness, radius = 0.5 * (outer - inner), 0.25 * (outer + inner)
    squared = 7.2 * wall.elastic_modulus * thickness**2 / (12.0 * wall.density * radius**4)
    return math.sqrt(squared) / (2.0 * math.pi)


def _bends(solution: Solution) -> Iterator[str]:
    """A sentence where the ring of the cage bends nearly as fast as it would whirl."""
    material = solution.candidate.material if solution.candidate else None
    first = bending_frequency(solution.design, material)
    if first is None:
        return
    whirl = linear_whirl_frequency(moving_cage(solution, 0.0))
    if first < STIFF * whirl:
        then = "a safety factor from 0.85 to 1.14 does not decide."
        if first < SOFTEST * whirl:
            then = "a softer ring was not computed, and the verdict is that of a rigid one."
        yield (
            f"The ring of the cage first bends at {format_quantity(first, 'Hz', 2)} (solid, without its "
            f"pockets), {first / whirl:.2g} times the {format_quantity(whirl, 'Hz', 2)} at which it would "
            f"whirl without clearance. The model takes it as rigid, which needs {STIFF:g} times. Rings at "
            f"{SOFTEST:g} to 0.45 times moved the critical friction of a turbopump's cage by -12 to +18 %: "
            f"{then}"
        )


def _fluid(solution: Solution) -> Iterator[str]:
    """A sentence where the gap of the land has fluid that would count, and the study states none."""
    study, design, mass = solution.study, solution.design, solution.inertia.mass
    found = None if design.added_mass else land_fluid(study, design, solution.bearing.cage_speed)
    if found is not None and found.added_mass > MOVED * mass:
        more = 100.0 * (math.sqrt(1.0 + found.added_mass / mass) - 1.0)
        yield (
            f"The fluid in the gap of the land is not counted. It would move with the cage as "
            f"{format_quantity(found.added_mass, 'kg', 2)} beside its {format_quantity(mass, 'kg', 2)}, and "
            f"raise the critical friction by some {more:.0f} % (closed law). To count it: [cage] "
            f'added_mass = "{1e3 * found.added_mass:.2g} g", fluid_damping = "{found.damping:.2g} N s/m".'
        )


PAPER_STATEMENT = (
    f"The paper (section 5): a restitution factor below {SOLID_LUBRICATION_LIMIT:g} "
    "is too low to be reached using solid lubrication."
)
NOT_FINISHED = "interrupted before this was computed"


def not_measured(environment: str) -> str:
    """Return the reason of a missing measurement."""
    return f"not measured in {environment}" if environment else "not measured in any environment"


def not_finite(judgement: Judgement) -> str:
    """Return the reason of a verdict that is not given, as a number of its evidence is not finite; or ""."""
    values = ((f.name, getattr(judgement, f.name)) for f in fields(judgement))
    bad = [
        f"{name} is {value}"
        for name, value in values
        if isinstance(value, float) and not math.isfinite(value)
    ]
    if not bad:
        return ""
    return f"no verdict: {bad[0].replace('_', ' ')}. The inputs are far from those of a bearing"


def reason(threshold: RestitutionThreshold, judgement: Judgement) -> str:
    """Return what decides a verdict in words; friction, threshold and margin are beside it as numbers."""
    stable = judgement.verdict is Verdict.STABLE
    always = "Stable at any" if stable else "Pocket friction starts no whirl at any"
    ends = {0.0: "Stable at no restitution factor above 0.", 1.0: f"{always} restitution factor."}
    return " ".join(part for part in (ends.get(threshold.value), judgement.reason) if part)


class Pocket(NamedTuple):
    """What the cages of candidates differ in besides friction; 0 without a land."""

    mass: Kilogram
    stiffness: NewtonPerMetre
    clearance: Metre
    land: Metre


def pocket_of(solution: Solution) -> Pocket:
    """Mass, stiffness and running clearances of the cage."""
    design, land = solution.design, solution.design.land_clearance or 0.0
    return Pocket(solution.inertia.mass, solution.ball_cage_stiffness, design.pocket_clearance, land)
