"""The chain from a study to its cage: every stage once, every intermediate kept.

Each verb asks for one link of it; a link holds the link before. What is dear to solve is remembered by the
value of the records that it depends on, so that no verb solves it twice. The contacts of the most loaded
ball set the race damping: load raises the restitution factor, so this is the unfavourable ball.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np

from separatrix.cage import PlanarCage, settings_for
from separatrix.cage.ensemble import REFERENCE, pocket_speed, with_kicks
from separatrix.cage_choice import NAMELESS, cage_candidate
from separatrix.cage_choice import known_friction as known_friction
from separatrix.cage_choice import pocket_friction as pocket_friction
from separatrix.contact_limits import beyond_contacts
from separatrix.creep import Creep, contact_creep
from separatrix.equilibrium import Equilibrium, contact, equilibrium
from separatrix.errors import InputError, ValidityWarning
from separatrix.hertz import ContactEllipse
from separatrix.lubrication import LubricationCurve, lubrication_curve
from separatrix.orbit import mean_speed, orbital_waves
from separatrix.restitution import (
    Restitution,
    ball_pocket_stiffness,
    contact_damping,
    hertz_coefficient_for,
    restitution,
)
from separatrix.study import (
    BallBearing,
    CageDesign,
    Film,
    KinematicModel,
    Material,
    Operation,
    PocketContact,
    Race,
    StabilitySettings,
    Study,
)
from separatrix.traction import TractionCurve, film_compliance, traction_curve
from separatrix.units import (
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    NewtonPerMetre1_5,
    Radian,
    RadianPerSecond,
    Ratio,
    format_quantity,
)

REMEMBERED = 1024
"""Solutions of a stage that are kept, by the records it takes."""

Solved = TypeVar("Solved", Equilibrium, TractionCurve)

NO_STIFFNESS = "Give [cage] ball_cage_stiffness, or a cage material (or candidate) with its elastic_modulus."


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceContact:
    """Contact of the most loaded ball with one race."""

    ball: int
    contact_angle: Radian
    load: Newton
    ellipse: ContactEllipse
    creep: Creep
    spin_roll_ratio: Ratio
    rolling_speed: MetrePerSecond


@dataclass(frozen=True, slots=True, kw_only=True)
class BearingState:
    """Equilibrium of the bearing, the contacts of its most loaded ball, and where they leave their model."""

    equilibrium: Equilibrium
    inner: RaceContact
    outer: RaceContact
    notes: tuple[str, ...] = ()

    @property
    def cage_speed(self) -> RadianPerSecond:
        """Mean orbital speed of the balls [rad/s]."""
        return mean_speed(self.equilibrium.orbital_speed)


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionState:
    """Traction curves of the most loaded ball's contacts."""

    bearing: BearingState
    inner: TractionCurve
    outer: TractionCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionState:
    """Restitution factor of the cage's impacts, and where the pocket's stiffness comes from."""

    traction: TractionState
    restitution: Restitution
    stiffness_source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CageState:
    """The cage that moves in the plane, after everything before it.

    `stability` has numbers for the kicks where the study has defaults. `orbital_share` is the share of the
    variance of the balls' orbital speeds that the cage's harmonics hold [-]; None where all balls run alike,
    as under an axial load.
    """

    restitution: RestitutionState
    cage: PlanarCage
    stability: StabilitySettings
    orbital_share: Ratio | None = None


def bearing_state(study: Study) -> BearingState:
    """Equilibrium and contacts of a study's bearing.

    Warns
    -----
    ValidityWarning
        A contact leaves what races bear or what the model holds: `contact_limits`.
    """
    state = _bearing(study.bearing, study.operation, study.kinematics, study.film.race_friction)
    for sentence in state.notes:
        warnings.warn(sentence, ValidityWarning, stacklevel=2)
    return state


@lru_cache(maxsize=REMEMBERED)
def _bearing(
    bearing: BallBearing, operation: Operation, kinematics: KinematicModel, race_friction: Ratio
) -> BearingState:
    found = _unchangeable(equilibrium(bearing, operation, kinematics, race_friction))
    inner, outer = (_race_contact(bearing, found, race) for race in Race)
    ellipses = {Race.INNER: inner.ellipse, Race.OUTER: outer.ellipse}
    turns = operation.inner_speed != 0.0 or operation.outer_speed != 0.0
    notes = tuple(beyond_contacts(bearing, found, ellipses, turns=turns))
    return BearingState(equilibrium=found, inner=inner, outer=outer, notes=notes)


def _race_contact(bearing: BallBearing, found: Equilibrium, race: Race) -> RaceContact:
    ball = found.most_loaded

    def of_ball(quantity: str) -> float:
        return float(getattr(found, f"{quantity}_{race.value}")[ball])

    angle, ratio = of_ball("contact_angle"), of_ball("spin_roll_ratio")
    return RaceContact(
        ball=ball,
        contact_angle=angle,
        load=of_ball("load"),
        ellipse=contact(found, bearing, race, ball),
        creep=contact_creep(bearing, race, angle, ratio),
        spin_roll_ratio=ratio,
        rolling_speed=of_ball("rolling_speed"),
    )


def traction_state(study: Study) -> TractionState:
    """Traction curves of both races.

    Raises
    ------
    InputError
        The bearing does not roll, or its races have no friction.
    """
    require_rolling(study)
    bearing_state(study)
    return _traction(study.bearing, study.operation, study.kinematics, study.film)


@lru_cache(maxsize=REMEMBERED)
def _traction(
    bearing: BallBearing, operation: Operation, kinematics: KinematicModel, film: Film
) -> TractionState:
    state = _bearing(bearing, operation, kinematics, film.race_friction)
    inner, outer = (
        traction_curve(
            at.ellipse,
            at.creep,
            race_friction=film.race_friction,
            film_compliance=film_compliance(film),
            film_thickness=film.thickness or 0.0,
        )
        for at in (state.inner, state.outer)
    )
    return TractionState(bearing=state, inner=_unchangeable(inner), outer=_unchangeable(outer))


def _unchangeable(solved: Solved) -> Solved:
    """The same record, into whose arrays nobody can write: the next caller gets it, too."""
    for value in (getattr(solved, field.name) for field in fields(solved)):
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
    return solved


def require_rolling(study: Study) -> None:
    """Refuse a bearing that does not roll: traction and restitution have no meaning there."""
    if study.operation.inner_speed == study.operation.outer_speed:
        cure = "Without rolling only the verb bearing has an answer."
        raise InputError("[operation] inner_speed", "must differ from outer_speed for traction", cure=cure)
    if study.film.race_friction <= 0.0:
        raise InputError(
            "[film] race_friction",
            "must be > 0 for traction [-]",
            f"{study.film.race_friction:g}",
            "Without friction the races hold no ball.",
        )


def restitution_state(study: Study, *, material: Material | None = None) -> RestitutionState:
    """Restitution factor of a study.

    Parameters
    ----------
    study : Study
        With a [cage].
    material : Material, optional
        Of the cage, if not the study's: a candidate of a ranking.
    """
    design = cage_design(study)
    links = traction_state(study)
    stiffness, source = pocket_stiffness(study, links.bearing.cage_speed, material)
    damping = (
        contact_damping(curve.slope, at.load, at.rolling_speed)
        for curve, at in ((links.inner, links.bearing.inner), (links.outer, links.bearing.outer))
    )
    inner, outer = damping
    found = restitution(inner, outer, ball_cage_stiffness=stiffness, cage_mass=design.mass)
    return RestitutionState(traction=links, restitution=found, stiffness_source=source)


def lubrication(study: Study, state: RestitutionState) -> LubricationCurve | None:
    """Restitution factor against film thickness and race friction; None without a film material."""
    if study.film.material is None:
        return None
    return lubrication_curve(
        state.traction.bearing.inner,
        state.traction.bearing.outer,
        study.film.material,
        ball_cage_stiffness=state.restitution.ball_cage_stiffness,
        cage_mass=state.restitution.cage_mass,
    )


def cage_design(study: Study) -> CageDesign:
    """Return the cage of a study.

    Raises
    ------
    InputError
        It has none.
    """
    if study.cage is None:
        cure = "Give at least its mass, pocket_clearance, and ball_cage_stiffness or material."
        raise InputError(study.name, "lacks the section [cage]", cure=cure)
    return study.cage


def impact_speed(study: Study, cage_speed: RadianPerSecond) -> MetrePerSecond:
    """Speed of an impact at which a Hertz pocket's stiffness is taken: the study's, or 2.5 pocket speeds.

    It is a property of the bearing, whatever the kicks are.
    """
    design = cage_design(study)
    if design.impact_speed is not None:
        return design.impact_speed
    return REFERENCE * pocket_speed(cage_speed, design.pocket_clearance)


def stability_settings(study: Study) -> StabilitySettings:
    """Return the study's settings with numbers for its kicks; without a cage there is nothing to kick."""
    speed = pocket_speed(bearing_state(study).cage_speed, cage_design(study).pocket_clearance)
    return with_kicks(study.stability, speed)


def pocket_stiffness(
    study: Study, cage_speed: RadianPerSecond, material: Material | None = None
) -> tuple[NewtonPerMetre, str]:
    """k_BC and where it comes from: the study, or Hertz with the modulus of the cage's material.

    Raises
    ------
    InputError
        Neither is known.
    """
    design = cage_design(study)
    if design.ball_cage_stiffness is not None:
        return design.ball_cage_stiffness, "given in the study"
    own = cage_candidate(study)
    wall = material or design.material or (own.material if own else None)
    if wall is None:
        raise InputError(
            "[cage] ball_cage_stiffness", "is missing, and no cage material is known", cure=NO_STIFFNESS
        )
    speed = impact_speed(study, cage_speed)
    stiffness = ball_pocket_stiffness(
        study.bearing.ball_diameter,
        study.bearing.ball_material,
        wall,
        cage_mass=design.mass,
        impact_speed=speed,
    )
    name = "[cage] material" if wall.name == NAMELESS else wall.name
    return stiffness, f"Hertz, ball on a flat wall of {name} at {speed:.3g} m/s"


def cage_state(study: Study, *, material: Material | None = None, friction: Ratio | None = None) -> CageState:
    """Build the cage in the plane, with the chain's race damping and this pocket friction or the study's.

    The ball set turns at the balls' mean orbital speed; under a radial load or a moment each ball runs faster
    and slower around as the equilibrium says. A cage without a stated inertia is a thin ring.

    Warns
    -----
    ValidityWarning
        The balls lead and lag by more than half their play, so that the pockets push them round.
    """
    pocket = pocket_friction(study) if friction is None else friction  # refused before anything is computed
    links = restitution_state(study, material=material)
    design, found = cage_design(study), links.traction.bearing.equilibrium
    radius = study.bearing.pitch_diameter / 2.0
    waves = orbital_waves(found.orbital_speed, found.azimuth, radius)
    inertia = design.mass * radius**2 if design.moment_of_inertia is None else design.moment_of_inertia
    cage = PlanarCage(
        moment_of_inertia=inertia,
        ball_count=study.bearing.ball_count,
        pitch_radius=radius,
        cage_speed=links.traction.bearing.cage_speed,
        inner_speed=study.operation.inner_speed,
        outer_speed=study.operation.outer_speed,
        ball_cage_stiffness=links.restitution.ball_cage_stiffness,
        race_damping=links.restitution.race_damping,
        ball_cage_friction=pocket,
        hertz_coefficient=_hertz_coefficient(study, links),
        orbital_cosines=waves.cosines,
        orbital_sines=waves.sines,
        ramp_time=study.operation.ramp_time,
        ramp_start=study.operation.ramp_start,
        **_as_designed(design),
    )
    _say_if_pushed_round(cage)
    settings = settings_for(study.stability, cage)
    return CageState(restitution=links, cage=cage, stability=settings, orbital_share=waves.share)


_NOT_COPIED = {
    *("moment_of_inertia", "ball_cage_stiffness", "ball_cage_friction"),  # the chain computes these
    *("material", "material_name", "pocket_contact", "impact_speed"),  # they are in the pocket's stiffness
}


def _as_designed(design: CageDesign) -> dict[str, Any]:
    """What the cage in the plane takes from the design as it is: all other fields, under the same names."""
    return {f.name: getattr(design, f.name) for f in fields(design) if f.name not in _NOT_COPIED}


def _hertz_coefficient(study: Study, links: RestitutionState) -> NewtonPerMetre1_5 | None:
    """Hertz's K behind the chain's stiffness: equal energy and depth in an impact at the impact speed.

    A stiffness that came from a material by Hertz at that speed gives the material's own K back.
    """
    design = cage_design(study)
    if design.pocket_contact is PocketContact.LINEAR:
        return None
    speed = impact_speed(study, links.traction.bearing.cage_speed)
    return hertz_coefficient_for(links.restitution.ball_cage_stiffness, design.mass, speed)


def _say_if_pushed_round(cage: PlanarCage) -> None:
    if cage.lead_amplitude > cage.half_play:
        lead, play = (format_quantity(x, "m", 3) for x in (cage.lead_amplitude, cage.half_play))
        warnings.warn(
            f"Left to themselves the balls would lead and lag by up to {lead} under this load, more than "
            f"half their play in a pocket, {play}: the cage pushes them round, which costs force and wear.",
            ValidityWarning,
            stacklevel=3,
        )
