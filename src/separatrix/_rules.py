"""Rules that tie several fields, or several records of a study, together; `study` asks them."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from separatrix import _cage_rules, _check
from separatrix.errors import InputError
from separatrix.units import format_quantity, shown, unit_of

if TYPE_CHECKING:
    from separatrix.study import (
        BallBearing,
        CageDesign,
        Candidate,
        Operation,
        RankingQuestion,
        Study,
    )


LANDLESS = "has no meaning for a cage guided by its balls"


def balls_that_do_not_fit(bearing: BallBearing) -> _check.Problems:
    """More balls than the pitch circle holds: D must be less than the chord d_m sin(pi/Z)."""
    if bearing.ball_gap > 0.0:
        return
    most = 0
    if bearing.ball_diameter < bearing.pitch_diameter:
        most = math.ceil(math.pi / math.asin(bearing.ball_diameter / bearing.pitch_diameter)) - 1
    rule = f"must be at most {most}: more balls do not fit on the pitch circle"
    cure = "Check ball_count, ball_diameter and pitch_diameter."
    if most < 3:
        rule = "leaves no room: the balls are too large for the pitch circle"
    yield _check.problem(bearing, "ball_count", rule, cure)


def bore_too_wide(bearing: BallBearing) -> _check.Problems:
    """The bore lies inside the groove of the inner ring."""
    widest = bearing.pitch_diameter - bearing.ball_diameter
    if bearing.bore is not None and bearing.bore >= widest:
        rule = f"must be smaller than the groove bottom of the inner ring, {format_quantity(widest, 'm')}"
        yield _check.problem(bearing, "bore", rule)


def moment_and_tilt(operation: Operation) -> _check.Problems:
    """A moment frees the ring to tilt; a held tilt takes any moment."""
    if operation.tilt is not None and operation.moment is not None:
        yield _check.problem(operation, "tilt", "and moment exclude each other", "Give one of the two.")


def nothing_presses(operation: Operation) -> _check.Problems:
    """Without any load there is no contact to compute; a tilt alone leaves the inner ring afloat."""
    if not any((operation.axial_load, operation.radial_load, operation.moment)):
        rule = "must be > 0 when there is no radial load or moment: nothing presses the balls"
        yield _check.problem(operation, "axial_load", rule, "Give the preload.")


def land(cage: CageDesign) -> _check.Problems:
    """A land needs its play, and a cage guided by its balls has no land."""
    if cage.guidance.value == "ball" and cage.land_clearance is not None:
        cure = 'Give guidance = "outer" or "inner", or leave the land out.'
        yield _check.problem(cage, "land_clearance", LANDLESS, cure)
    if cage.guidance.value == "ball" and cage.land_out_of_round != 0.0:
        yield _check.problem(cage, "land_out_of_round", LANDLESS)
    if cage.guidance.value == "ball" and cage.land_count == 2:
        yield _check.problem(cage, "land_count", LANDLESS)
    if cage.guidance.value != "ball" and cage.land_clearance is None:
        where = "CageDesign.land_clearance"
        yield InputError(
            where, f"is missing: a cage with {cage.guidance.value} guidance needs its diametral play"
        )


def rising(
    record: object, field: str, low: float, high: float, *, least: int = 1, most: int, hint: str = ""
) -> _check.Problems:
    """Refuse a tuple that is too short or long, or not strictly inside the limits or increasing."""
    values, where = getattr(record, field), f"{type(record).__name__}.{field}"
    unit = unit_of(type(record), field)
    of_unit = f" [{unit}]" if unit != "-" else ""
    if not least <= len(values) <= most:
        yield InputError(where, f"must hold {least} to {most} values", str(len(values)))
    outside = [value for value in values if not _check.is_number(value) or not low < value < high]
    if outside:
        rule = f"must each be a finite number > {low:g} and < {high:g}{of_unit}"
        yield InputError(where, rule, str(outside[0]), hint)
    falls = [f"{b:g} after {a:g}" for a, b in pairwise(values) if not outside and a >= b]
    if falls:
        yield InputError(where, f"must be strictly increasing{of_unit}", falls[0])


def nothing_measured(candidate: Candidate) -> _check.Problems:
    """A candidate has at least one measured friction."""
    if all(value is None for value in candidate.friction.values()):
        yield InputError("Candidate.friction", f'of "{candidate.name}" holds no measured value')


def environment_of_a_candidate(question: RankingQuestion) -> _check.Problems:
    """The bearing's environment is one in which candidates were measured."""
    if question.environment is not None and question.environment not in question.environments:
        cure = f"Known: {'; '.join(question.environments)}."
        rule = "must be one in which candidates were measured"
        yield InputError("RankingQuestion.environment", rule, shown(question.environment), cure)


def named_twice(question: RankingQuestion) -> _check.Problems:
    """Names are what results are keyed by."""
    for field_name, names in (
        ("candidates", [candidate.name for candidate in question.candidates]),
        ("environments", list(question.environments)),
    ):
        if not names:
            yield InputError(f"RankingQuestion.{field_name}", "must not be empty")
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield InputError(f"RankingQuestion.{field_name}", "must have different names", f'"{name}" twice')


def unknown_environments(question: RankingQuestion) -> _check.Problems:
    """Every friction belongs to an environment of the question."""
    for candidate in question.candidates:
        for name in sorted(set(candidate.friction) - set(question.environments)):
            rule = f'of "{candidate.name}" must be in the environments of the question'
            yield InputError("RankingQuestion.candidates", rule, f'"{name}"')


def free_kinematics_without_friction(study: Study) -> _check.Problems:
    """Without race control it is friction that turns the balls."""
    if study.kinematics.value == "free" and study.film.race_friction == 0.0:
        cure = "Without friction nothing turns the balls; choose a race control model."
        yield InputError("Film.race_friction", 'must be > 0 for the "free" kinematics', "0", cure)


def pockets_that_overlap(study: Study) -> _check.Problems:
    """A pocket's play is less than the gap between balls, or no bar is left between pockets."""
    if study.cage is not None and study.cage.pocket_clearance >= study.bearing.ball_gap:
        rule = f"must be smaller than the gap between balls, {format_quantity(study.bearing.ball_gap, 'm')}"
        yield _check.problem(
            study.cage, "pocket_clearance", rule, "It is the play of one ball, stop to stop."
        )


def pockets_for_balls(study: Study) -> _check.Problems:
    """Uneven pockets: one for each ball, and a bar between any two."""
    cage, bearing = study.cage, study.bearing
    room = 0.0 if cage is None else (bearing.ball_diameter + cage.pocket_clearance) / bearing.pitch_diameter
    if cage is None or not 0.0 < room < math.sin(math.pi / bearing.ball_count):
        return  # overlapping already when even
    needed = 2.0 * math.asin(room)
    pitch = 2.0 * math.pi / bearing.ball_count
    most = (1.0 - needed / pitch) / 2.0
    if cage.pocket_spacing_scatter >= most:
        rule = (
            f"must be < {most:.4g}, where two neighbours that come close leave no bar between their pockets"
        )
        yield _check.problem(cage, "pocket_spacing_scatter", rule, "Fewer balls leave more room.")
    yield from _cage_rules.angles_for(cage, bearing.ball_count)
    if len(cage.pocket_angles) == bearing.ball_count:
        yield from _bars(cage, needed)


def _bars(cage: CageDesign, needed: float) -> _check.Problems:
    """Pockets at given angles stand farther apart than a ball with its play is wide."""
    step, i = _cage_rules.least_step(cage.pocket_angles)
    if step <= needed:
        rule = (
            f"leave no bar between pockets {i + 1} and {(i + 1) % len(cage.pocket_angles) + 1}: "
            f"must stand more than {format_quantity(needed, 'rad')} apart"
        )
        yield InputError("CageDesign.pocket_angles", rule, format_quantity(step, "rad"))


def land_wider_than_a_ball(study: Study) -> _check.Problems:
    """A cage that can move by a ball's radius would lose its balls before it met its land."""
    widest, cage = study.bearing.ball_diameter, study.cage
    if cage is not None and cage.land_clearance is not None and cage.land_clearance >= widest:
        rule = f"must be smaller than a ball, {format_quantity(widest, 'm')}"
        cure = 'It is the diametral play; for a cage without a land give guidance = "ball".'
        yield _check.problem(cage, "land_clearance", rule, cure)


def unbalance_beyond_the_cage(study: Study) -> _check.Problems:
    """The centre of mass lies inside the cage."""
    if study.cage is None:
        return
    most = study.cage.mass * study.bearing.pitch_diameter / 2.0
    if study.cage.unbalance >= most:
        rule = f"must be smaller than mass times pitch radius, {format_quantity(most, 'kg m')}"
        yield _check.problem(study.cage, "unbalance", rule, "It is mass times eccentricity.")


def stiffness_of_unknown_origin(study: Study) -> _check.Problems:
    """Without a stiffness, the cage or every candidate needs a material, for the modulus of the pocket."""
    cage, candidates = study.cage, study.ranking.candidates if study.ranking else ()
    if cage is None or cage.ball_cage_stiffness is not None or cage.material is not None:
        return
    bare = [candidate.name for candidate in candidates if candidate.material is None]
    if bare or not candidates:
        who = f'the candidate "{bare[0]}"' if bare else "the cage"
        rule = f"is missing, and {who} has no material to compute it from"
        yield InputError("CageDesign.ball_cage_stiffness", rule, cure="Give the stiffness or the material.")


def no_density(study: Study) -> _check.Problems:
    """A turning ball needs its density, for the centrifugal force."""
    turns = study.operation.inner_speed != 0.0 or study.operation.outer_speed != 0.0
    if turns and study.bearing.ball_material.density is None:
        rule = "needs a density, for the centrifugal force of the balls"
        yield InputError("BallBearing.ball_material", rule, cure='Add density = "7650 kg/m3" or the like.')
