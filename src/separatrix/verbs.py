"""What each verb computes, from a study to the record of its answer."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np

from separatrix.answers import (
    CheckAnswer,
    MapAnswer,
    RankingAnswer,
    RestitutionAnswer,
    SensitivityAnswer,
    SimulationAnswer,
    StabilityAnswer,
    TractionAnswer,
)
from separatrix.cage import History, PlanarCage, linear_whirl_frequency
from separatrix.cage import simulate as follow
from separatrix.cage_choice import (
    cage_candidate,
    environment_of,
    reference_candidate,
    required_environment,
)
from separatrix.chain import BearingState, RaceContact, Solution, solve
from separatrix.draws import uncertain_inputs
from separatrix.errors import SeparatrixError, ValidityWarning
from separatrix.explore import uncertain_study
from separatrix.explore.expected import expected_curve, expected_map, expected_ranking, expected_uncertain
from separatrix.friction_fit import TestedFriction
from separatrix.ranking import rank as rank_materials
from separatrix.ranking import ranking_question
from separatrix.ranking.drawn import frictions_to_draw
from separatrix.ranking.plausible import Moved, beyond_motion
from separatrix.restitution import Restitution
from separatrix.runner import Runner, made_into
from separatrix.stability import stability_curve
from separatrix.stability.map import stability_map as find_map
from separatrix.stability.map import value_here
from separatrix.stability.map_records import MapQuestion
from separatrix.study import Study
from separatrix.traction import ShearField, TractionCurve, film_compliance, shear_field, traction_curve
from separatrix.units import MetrePerSecond, format_quantity

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""

STRIPS = 5
"""Strips in which the shear is shown."""

SAMPLES_A_WHIRL = 15
"""Samples of a simulated run in a period of the linear whirl."""

MOST_SAMPLES = 20_000


def check(study: Study) -> CheckAnswer:
    """The bearing at standstill, for its contact pressures.

    Warns
    -----
    ValidityWarning
        `sensitivity` refuses the friction that tests predict in the pocket: its line.
    """
    _try_predicted_friction(study)
    at_rest = replace(study.operation, inner_speed=0.0, outer_speed=0.0)
    try:
        return CheckAnswer(static=solve(replace(study, operation=at_rest)).bearing)
    except SeparatrixError as error:
        return CheckAnswer(static=None, static_reason=str(error))


def _try_predicted_friction(study: Study) -> None:
    """Warn where `sensitivity` refuses the friction that tests predict in the pocket."""
    candidates = study.ranking.candidates if study.ranking and study.cage else ()
    if not any(isinstance(one.law, TestedFriction) for c in candidates for one in c.friction.values() if one):
        return
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ValidityWarning)  # the chain was not asked for
            uncertain_inputs(study, frictions_to_draw(study))
    except SeparatrixError as error:
        warnings.warn(f"`sensitivity` refuses this study: {error}", ValidityWarning, stacklevel=2)


def bearing(study: Study) -> BearingState:
    """Ball equilibrium and the contacts of the most loaded ball."""
    return solve(study).bearing


def traction(study: Study) -> TractionAnswer:
    """Traction curves, as they are and at other pivoting-to-rolling ratios."""
    solution = solve(study)
    contacts = solution.bearing
    inner = curves_by_ratio(study, contacts.inner, solution.traction.inner)
    outer = curves_by_ratio(study, contacts.outer, solution.traction.outer)
    return TractionAnswer(
        race_friction=study.film.race_friction,
        bearing=contacts,
        inner=inner[0],
        outer=outer[0],
        inner_others=inner[1:],
        outer_others=outer[1:],
        inner_shear=shear(study, contacts.inner),
        outer_shear=shear(study, contacts.outer),
    )


def curves_by_ratio(study: Study, at: RaceContact, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves of one contact: at its own ratio, then at `SPIN_ROLL_RATIOS` with its sign.

    The creep increments go a quarter beyond those at which the contact's own curve is saturated.
    """
    increments = np.linspace(-1.0, 1.0, 201) * _saturation(study, at, curve)
    own = at.creep.spin
    others = (math.copysign(ratio, own) * at.ellipse.curvature_rolling for ratio in SPIN_ROLL_RATIOS)
    return tuple(
        traction_curve(
            at.ellipse,
            replace(at.creep, spin=spin),
            race_friction=study.film.race_friction,
            film_compliance=film_compliance(study.film),
            creep_increments=increments,
        )
        for spin in (own, *others)
    )


def _saturation(study: Study, at: RaceContact, curve: TractionCurve) -> float:
    """Creep increment a quarter beyond the one at which a curve has its whole friction, either way."""
    widest = float(curve.creep_increment[-1])
    finer = traction_curve(
        at.ellipse,
        at.creep,
        race_friction=study.film.race_friction,
        film_compliance=film_compliance(study.film),
        creep_increments=widest * np.sinh(np.linspace(-6.0, 6.0, 201)) / math.sinh(6.0),
    )
    rising = np.abs(finer.traction_coefficient) < SATURATED * study.film.race_friction
    return min(1.25 * float(np.abs(finer.creep_increment[rising]).max()), widest)


def shear(study: Study, at: RaceContact) -> ShearField:
    """Shear in a few strips of a contact in free rolling (the paper's Fig. 6)."""
    return shear_field(
        at.ellipse,
        at.creep,
        race_friction=study.film.race_friction,
        film_compliance=film_compliance(study.film),
        strips=STRIPS,
    )


def restitution(study: Study) -> RestitutionAnswer:
    """Restitution factor from the traction slopes, and what other films would give.

    Warns
    -----
    ValidityWarning
        The factor is 0: the impact is overdamped.
    """
    solution = solve(study)
    _warn_if_overdamped(solution.restitution)
    return RestitutionAnswer(
        solution=solution, film_thickness=study.film.thickness or 0.0, lubrication=solution.lubrication
    )


def _warn_if_overdamped(found: Restitution) -> None:
    """Warn that eta is 0 and what follows from it."""
    if found.restitution_factor == 0.0:
        damping, least = (format_quantity(c, "N s/m", 3) for c in (found.race_damping, found.least_damping))
        warnings.warn(
            f"eta = 0: impacts are overdamped, because C_mu = {damping} is below the limit sqrt(k_BC M_C)/2 "
            f"= {least}; every material has its full threshold as margin. C_mu falls as race friction falls "
            "and as speed rises. Test experience may differ: docs/theory/restitution.md.",
            ValidityWarning,
            stacklevel=2,
        )


def stability(study: Study, runner: Runner) -> StabilityAnswer:
    """Critical friction against restitution factor."""
    solution = solve(study)
    cage, settings = _shown_cage(solution), solution.stability
    runner.expect(lambda: expected_curve(cage, settings, jobs=runner.jobs, band=True))
    return made_into(
        lambda curve: StabilityAnswer(solution=solution, cage=cage, curve=curve),
        lambda: stability_curve(cage, settings, runner=runner),
    )


def _shown_cage(solution: Solution) -> PlanarCage:
    """Cage of a study in an answer over many frictions; without friction where none is known."""
    friction = solution.friction
    _warn_of_extrapolation(solution)
    return solution.cage_with(friction.mean if friction else 0.0)


def _warn_of_extrapolation(solution: Solution) -> None:
    """Warn where the friction of the cage comes from tests at other conditions."""
    friction, own = solution.friction, cage_candidate(solution.study)
    if friction is not None and own is not None and friction.law is not None and friction.extrapolation:
        place = environment_of(solution.study.ranking) if solution.study.ranking else ""
        warnings.warn(
            f"Pocket friction {friction.mean:.3g} of {own.name} in {place}, extrapolated beyond the "
            f"tests: {'; '.join(friction.extrapolation)}. [cage] ball_cage_friction overrides it.",
            ValidityWarning,
            stacklevel=3,
        )


def stability_map(question: MapQuestion, runner: Runner) -> MapAnswer:
    """Verdicts in the plane of two parameters of a study.

    Raises
    ------
    InputError
        No point can be run.
    """
    solution = solve(question.study)
    cage = _shown_cage(solution)
    x, y = (replace(axis, here=value_here(solution, axis.parameter)) for axis in (question.x, question.y))
    asked = replace(question, x=x, y=y)
    runner.expect(lambda: expected_map(asked, jobs=runner.jobs), at_most=question.adaptive)
    return made_into(
        lambda found: MapAnswer(solution=solution, cage=cage, map=found),
        lambda: find_map(asked, runner=runner),
    )


def simulate(study: Study, kick: MetrePerSecond | None = None, run: int = 0) -> SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference kick."""
    solution = solve(study)
    cage, settings = solution.cage, solution.stability
    _warn_of_extrapolation(solution)
    speed = settings.middle_kick if kick is None else kick
    samples = SAMPLES_A_WHIRL * linear_whirl_frequency(cage) * settings.duration
    history = follow(
        cage,
        kick=speed,
        run=run,
        seed=settings.seed,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        samples=int(min(max(samples, 1000), MOST_SAMPLES)),
    )
    _warn_if_beyond_model(solution, history)
    return SimulationAnswer(solution=solution, cage=cage, history=history, kick=speed, run=run)


def _warn_if_beyond_model(solution: Solution, history: History) -> None:
    """Warn where the run leaves the range of the model or of hardware."""
    made_of = cage_candidate(solution.study)
    force, offset = abs(history.contact_force).max(), (history.position**2).sum(axis=1).max() ** 0.5
    run = Moved(made_of.name if made_of else "The cage", float(force), float(offset))
    for note in beyond_motion(solution, [run]):
        warnings.warn(note, ValidityWarning, stacklevel=3)


def rank(study: Study, runner: Runner) -> RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    solution, cage = _reference(study)
    _warn_if_overdamped(solution.restitution)
    runner.expect(lambda: expected_ranking(study, jobs=runner.jobs))
    return made_into(
        lambda found: RankingAnswer(solution=solution, cage=cage, ranking=found),
        lambda: rank_materials(study, runner=runner),
    )


def _reference(study: Study) -> tuple[Solution, PlanarCage]:
    """Chain and cage of the reference candidate of a ranking; without friction where none is known."""
    asked = ranking_question(study)
    required_environment(study, asked)
    solution = solve(study, reference_candidate(study, asked))
    friction = solution.friction
    return solution, solution.cage_with(friction.mean if friction else 0.0)


def sensitivity(study: Study, samples: int, runner: Runner) -> SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate."""
    solution, cage = _reference(study)
    uncertain_inputs(study, frictions_to_draw(study))  # refused before anything is timed
    runner.expect(lambda: expected_uncertain(study, samples, jobs=runner.jobs))
    return made_into(
        lambda found: SensitivityAnswer(solution=solution, cage=cage, uncertain=found),
        lambda: uncertain_study(study, samples, runner=runner),
    )
