"""The chain of the paper from a study to its pocket: every link solved once, every intermediate kept.

The contacts of the most loaded ball set the race damping: load raises the restitution factor, so this is the
unfavourable ball.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from separatrix.chain.ball_mobility import Mobility, free_ball, mobility, shares_of_balls
from separatrix.chain.clearances import Clearances, as_it_runs, running_clearances
from separatrix.chain.contacts import (
    BearingState,
    PairLoads,
    RaceTraction,
    Rolling,
    Waves,
    bearing_state,
    pair_loads,
    race_traction,
    require_rolling,
    waves_around,
    with_axial_load,
)
from separatrix.chain.equilibrium import orbit_by_diameter
from separatrix.chain.hertz import approach_coefficient
from separatrix.chain.impact_restitution import (
    LubricationCurve,
    Restitution,
    ball_pocket_stiffness,
    contact_damping,
    lubrication_curve,
    restitution,
)
from separatrix.chain.pocket_friction import (
    REFERENCE,
    PocketConditions,
    friction_in_pocket,
    names_of_fluid,
    pocket_conditions,
    pocket_speed,
)
from separatrix.chain.race_traction import FreeBall
from separatrix.ground.errors import InputError
from separatrix.ground.units import Kilogram, MetrePerSecond, NewtonPerMetre, PerSecond, format_quantity
from separatrix.study.ball_bearing import NAMELESS
from separatrix.study.cage_body import CageInertia, cage_inertia
from separatrix.study.candidates import cage_candidate, environment_of
from separatrix.study.study import (
    CageDesign,
    CageModel,
    Candidate,
    ClearanceState,
    Friction,
    Material,
    Operation,
    PocketShape,
    Study,
)

NO_STIFFNESS = "Give [cage] ball_cage_stiffness, or a cage material (or candidate) with its elastic_modulus."
WORN_MOBILITY = (
    "The film is worn: the mobility of a ball takes race_friction on the whole track, and the wear only for "
    "its elastic creep."
)
NO_CAGE = "Give at least its mass, pocket_clearance, and ball_cage_stiffness or material."


SHARED = ("pair", "bearing", "traction", "slopes", "clearances", "mobility", "restitution", "inertia")
"""Links that do not depend on the cage's model."""


def solve(study: Study, candidate: Candidate | None = None) -> Solution:
    """Chain of a study, from the bearing's equilibrium to its cage.

    Its links are solved as they are asked for; [cage] is needed from the restitution factor on. The cage has
    the material of the candidate, by default the one that the study's [cage] names.

    Examples
    --------
    >>> import separatrix
    >>> found = separatrix.solve(separatrix.read_study("cryogenic-turbopump"))
    >>> round(found.restitution.restitution_factor, 2)
    0.27
    """
    return Solution(study=study, candidate=candidate)


@dataclass(frozen=True, kw_only=True)
class Solution:
    """Every link of the chain, solved with those before it; `candidate` None is the study's own cage."""

    study: Study
    candidate: Candidate | None = None

    @cached_property
    def paper(self) -> Solution:
        """The same chain with the cage's model of the paper: in the plane, among dampers."""
        _ = self.restitution
        cage = replace(self.stated_design, model=CageModel.PAPER, ball=None, motion=None)
        found = Solution(study=replace(self.study, cage=cage), candidate=self.candidate)
        vars(found).update({name: value for name, value in vars(self).items() if name in SHARED})
        return found

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the links that were solved leave the range of their model, a sentence each."""
        links = (
            vars(self).get(name)
            for name in ("pair", "bearing", "clearances", "traction", "slopes", "mobility")
        )
        notes = [note for one in links if one is not None for note in one.notes]
        return tuple(dict.fromkeys([*notes, *self._on_a_bore()]))

    def _on_a_bore(self) -> Iterator[str]:
        """Yield what a stiffness by Hertz leaves out in a bore: the wall that curves round the ball."""
        if "_stiffness" not in vars(self) or self.stated_design.ball_cage_stiffness is not None:
            return
        D, play = self.study.bearing.ball_diameter, self.design.pocket_clearance
        walls = {PocketShape.CYLINDRICAL: "bore", PocketShape.SPHERICAL: "sphere"}
        name = walls.get(self.stated_design.pocket_shape)
        if name and play > 0.0:
            flat, curved = 2.0 / D, 2.0 / D - 2.0 / (D + play)
            along = curved if name == "sphere" else flat
            flat, bore = (approach_coefficient(*one, 1.0, 0.0)[0] for one in ((flat, flat), (along, curved)))
            yield (
                f"The stiffness of ball and pocket is that of a flat wall. A {name} with a clearance of "
                f"{format_quantity(play, 'm', 3)} is {(bore / flat) ** 0.8:.2g} times as stiff by the same "
                "rule: its restitution factor is lower, and so is its pressure."
            )

    @cached_property
    def pair(self) -> PairLoads | None:
        """Axial loads of a preloaded pair, and notes on its other bearing; None of a single bearing."""
        asked, at = self.study, self.study.operation
        if not at.is_pair:
            return None
        how = asked.kinematics.model, asked.film.race_friction
        found = pair_loads(asked.bearing, at, *how)
        if not 0.0 < found.other_axial_load < found.own_axial_load:
            return found
        other = bearing_state(asked.bearing, with_axial_load(at, found.other_axial_load), *how)
        notes = tuple(f"The other bearing of the pair: {note}" for note in other.notes)
        return replace(found, notes=(*found.notes, *notes))

    @property
    def operation(self) -> Operation:
        """Speeds of the study, and the loads of its one bearing with its share of a preload."""
        asked = self.study.operation
        if asked.preload is None:
            return asked
        alone = asked.preload + (asked.axial_load or 0.0)
        return with_axial_load(asked, self.pair.own_axial_load if self.pair else alone)

    @cached_property
    def bearing(self) -> BearingState:
        """Equilibrium, and the contacts of the most loaded ball."""
        asked = self.study
        return bearing_state(asked.bearing, self.operation, asked.kinematics.model, asked.film.race_friction)

    @cached_property
    def rolling(self) -> Rolling:
        """What the traction of the races depends on.

        Raises
        ------
        InputError
            The bearing does not roll, or its races have no friction.
        """
        asked = self.study
        require_rolling(asked)
        _ = self.bearing  # its notes
        return Rolling(asked.bearing, self.operation, asked.kinematics.model, asked.film, asked.traction)

    @cached_property
    def traction(self) -> RaceTraction:
        """Traction curves of both races; refused as `rolling` is."""
        return race_traction(self.rolling)

    @cached_property
    def slopes(self) -> RaceTraction:
        """Slopes of both traction curves at free rolling, without the curves; refused as `rolling` is."""
        return race_traction(self.rolling, whole=False)

    @property
    def stated_design(self) -> CageDesign:
        """The cage as the study states it; refused where it has none."""
        if self.study.cage is None:
            raise InputError(self.study.name, "lacks the section [cage]", cure=NO_CAGE)
        return self.study.cage

    @property
    def cage_material(self) -> Material | None:
        """Material of the candidate, else of the cage; None where neither is known."""
        own, asked = cage_candidate(self.study), self.candidate.material if self.candidate else None
        return asked or self.stated_design.material or (own.material if own else None)

    @cached_property
    def clearances(self) -> Clearances | None:
        """Clearances at temperature and speed; None where the study states the running ones."""
        if self.study.cage is None or self.stated_design.clearances is ClearanceState.RUNNING:
            return None
        parts = (self.study.bearing, self.study.operation, self.stated_design, self.cage_material)
        return running_clearances(*parts, cage_mass=self.inertia.mass, cage_speed=self.bearing.cage_speed)

    @cached_property
    def design(self) -> CageDesign:
        """The cage with its clearances as it runs."""
        return as_it_runs(self.stated_design, self.clearances)

    @cached_property
    def impact_speed(self) -> MetrePerSecond:
        """Speed of an impact at which a Hertz pocket's stiffness is taken: the study's, or 2.5 pocket speeds.

        It is a property of the bearing, whatever the kicks are.
        """
        design = self.design
        if design.impact_speed is not None:
            return design.impact_speed
        return REFERENCE * pocket_speed(self.bearing.cage_speed, design.pocket_clearance)

    @cached_property
    def _stiffness(self) -> tuple[NewtonPerMetre, str]:
        """k_BC and where it comes from: the study, or Hertz with the modulus of the cage's material."""
        given, wall = self.stated_design.ball_cage_stiffness, self.cage_material
        if given is not None:
            return given, "given in the study"
        if wall is None:
            rule = "is missing, and no cage material is known"
            raise InputError("[cage] ball_cage_stiffness", rule, cure=NO_STIFFNESS)
        bearing, speed, mass = self.study.bearing, self.impact_speed, self.inertia.mass
        stiffness = ball_pocket_stiffness(
            bearing.ball_diameter, bearing.ball_material, wall, cage_mass=mass, impact_speed=speed
        )
        name = "[cage] material" if wall.name == NAMELESS else wall.name
        return stiffness, f"Hertz, ball on a flat wall of {name} at {speed:.3g} m/s"

    @property
    def ball_cage_stiffness(self) -> NewtonPerMetre:
        """k_BC of this pocket; refused where neither it nor a cage material is known."""
        return self._stiffness[0]

    @property
    def stiffness_source(self) -> str:
        """Where k_BC comes from."""
        return self._stiffness[1]

    @cached_property
    def restitution(self) -> Restitution:
        """Restitution factor of the cage's impacts, with the race damping behind it."""
        mass = self.inertia.mass  # refused before anything is computed
        inner = contact_damping(self.slopes.inner.slope, self.bearing.inner)
        outer = contact_damping(self.slopes.outer.slope, self.bearing.outer)
        return restitution(inner, outer, ball_cage_stiffness=self.ball_cage_stiffness, cage_mass=mass)

    @cached_property
    def inertia(self) -> CageInertia:
        """Mass and moments of inertia of the cage: as stated, of its shape, or of a thin ring.

        A shape has the density of the candidate's material where that is known, else of the cage's.
        """
        design, wall = self.stated_design, self.cage_material
        if wall is not None and wall.density is not None:
            design = replace(design, material=wall)
        return cage_inertia(design, self.study.bearing)

    @cached_property
    def mobility(self) -> Mobility:
        """How the races let the most loaded ball be pushed along its orbit; refused as `rolling` is."""
        found = mobility(self.rolling)
        is_whole = self.study.film.wear is None
        return found if is_whole else replace(found, notes=(WORN_MOBILITY, *found.notes))

    @cached_property
    def free_ball(self) -> tuple[FreeBall, tuple[float, float, float]]:
        """The most loaded ball with its slip fields, and its spin, in a bearing that turns forward."""
        return free_ball(self.rolling, float(np.abs(self.mobility.linear.rates).max()))

    @property
    def felt_mass(self) -> Kilogram:
        """What an impact at a pocket feels of the cage, which may turn: half the mass of a thin ring."""
        turning = (self.study.bearing.pitch_diameter / 2.0) ** 2 / self.inertia.moment_of_inertia
        return 1.0 / (1.0 / self.inertia.mass + turning)

    @cached_property
    def lubrication(self) -> LubricationCurve | None:
        """Restitution factor against film thickness and race friction; None without a film material."""
        if self.study.film.body is None:
            return None
        return lubrication_curve(
            self.bearing.inner,
            self.bearing.outer,
            self.study.film.body,
            ball_cage_stiffness=self.ball_cage_stiffness,
            cage_mass=self.inertia.mass,
        )

    @cached_property
    def pocket(self) -> PocketConditions:
        """Sliding speed and pressure of ball on pocket."""
        return pocket_conditions(
            self.bearing.equilibrium,
            ball_diameter=self.study.bearing.ball_diameter,
            ball_cage_stiffness=self.ball_cage_stiffness,
            cage_mass=self.inertia.mass,
            felt_mass=self.felt_mass,
            damping_ratio=self.restitution.damping_ratio,
            impact_speed=self.impact_speed,
        )

    @cached_property
    def frictions(self) -> Mapping[str, Friction | None]:
        """Friction of the candidate on the balls in this pocket, by environment; None where not measured.

        Each is asked for at the sliding speed and pressure of the pocket, the temperature and the fluid of
        the study. It has its standard error, the standard deviation of a new sample, and what was not
        tested; a number without scatter gets that of an unrepeated test.
        """
        asked, candidate = self.study.ranking, self.candidate or cage_candidate(self.study)
        if asked is None or candidate is None:
            return {}
        names = names_of_fluid(self.study)
        at, scatter = self.study.operation, asked.friction_scatter
        return {
            place: one and friction_in_pocket(one, self.pocket if one.law else None, at, scatter, names)
            for place, one in candidate.friction.items()
        }

    @property
    def friction(self) -> Friction | None:
        """Friction of cage on ball: the study's, or that of the candidate in the bearing's environment."""
        given, asked = self.stated_design.ball_cage_friction, self.study.ranking
        if given is not None:
            return Friction(mean=given)
        environment = environment_of(asked) if asked else None
        return self.frictions.get(environment) if environment else None

    @cached_property
    def orbital_waves(self) -> Waves:
        """Speed of the balls along the pitch circle around the bearing [m/s]."""
        found = self.bearing.equilibrium
        return waves_around(self.study.bearing.pitch_diameter / 2.0 * found.orbital_speed, found.azimuth)

    @cached_property
    def held_waves(self) -> tuple[Waves, Waves]:
        """Capacity and slope of the balls' law of traction around, over those of the most loaded ball."""
        _ = self.mobility  # refused where that ball does not touch both races
        capacity, slope = (
            waves_around(share, self.bearing.equilibrium.azimuth) for share in shares_of_balls(self.rolling)
        )
        return capacity, slope

    @cached_property
    def orbit_by_diameter(self) -> PerSecond:
        """How much faster a larger ball runs round its orbit, over what its diameter is larger."""
        asked = self.study
        return orbit_by_diameter(
            asked.bearing, self.operation, asked.kinematics.model, asked.film.race_friction
        )
