"""What each verb computes, from a study to the record of its answer."""

from __future__ import annotations

import contextlib
import re
import warnings
from collections.abc import Sequence
from dataclasses import replace
from math import isfinite, nan
from pathlib import Path

from separatrix import answers
from separatrix.cage import MovingCage, analyse, moving_cage, settings_for
from separatrix.cage import simulate as follow
from separatrix.chain.ball_mobility import SlipLaw, linear_mobility
from separatrix.chain.contacts import BearingState, race_tracks
from separatrix.chain.race_curve import beyond_strips
from separatrix.chain.restitution import Restitution
from separatrix.chain.shown_traction import curves_by_ratio, shear, shown_curve
from separatrix.chain.solution import Solution, solve
from separatrix.explore.cases import DEFAULT_X, DEFAULT_Y, Case, asked_cases, checked_points, read_axis
from separatrix.explore.sweep import Sweep
from separatrix.explore.sweep import sweep as run_cases
from separatrix.explore.uncertain import uncertain_study
from separatrix.friction.fit import TestedFriction
from separatrix.ground.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.ground.units import NUMBER, MetrePerSecond, Ratio, format_quantity, parse, printable
from separatrix.limits.curve import stability_curve
from separatrix.limits.map import stability_map, value_here
from separatrix.limits.map_records import KICK, MapQuestion
from separatrix.limits.response import cage_at
from separatrix.ranking.drawn import frictions_to_draw
from separatrix.ranking.rank import rank as rank_materials
from separatrix.ranking.reason import Moved, beyond_motion
from separatrix.study.candidates import (
    cage_candidate,
    environment_of,
    ranking_question,
    reference_candidate,
    require_friction,
    required_environment,
)
from separatrix.study.study import LEAST_KICK, MOST_KICK, NO_KICK, Study
from separatrix.verdict.draws import uncertain_inputs
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.reasons import force_limit
from separatrix.verdict.which_ball import transmitted_force

MOST_RUNS = 1_000_000
SAMPLES, FEWEST_SAMPLES, MOST_SAMPLES = 512, 64, 65_536
"""Bearings that `sensitivity` draws."""

MOST_SHOWN = 20_000
"""Samples of a simulated run, at most: every step of a short one."""


def check(study: Study) -> answers.CheckAnswer:
    """The bearing at standstill, for its contact pressures."""
    _try_predicted_friction(study)
    at_rest = replace(study.operation, inner_speed=0.0, outer_speed=0.0)
    try:
        found = answers.CheckAnswer(static=solve(replace(study, operation=at_rest)).bearing)
    except SeparatrixError as error:
        found = answers.CheckAnswer(static=None, static_reason=str(error))
    try:
        with warnings.catch_warnings():
            # `check` does not report the chain
            warnings.filterwarnings("ignore", "(?!Clearances)", ValidityWarning)
            return replace(found, clearances=solve(study).clearances)
    except SeparatrixError as error:
        return replace(found, clearances_reason=str(error))


def _try_predicted_friction(study: Study) -> None:
    candidates = study.ranking.candidates if study.ranking and study.cage else ()
    if not any(isinstance(one.law, TestedFriction) for c in candidates for one in c.friction.values() if one):
        return
    try:
        # `check` does not report the chain
        with warnings.catch_warnings(action="ignore", category=ValidityWarning):
            uncertain_inputs(study, frictions_to_draw(study))
    except SeparatrixError as error:
        warnings.warn(f"`sensitivity` refuses this study: {error}", ValidityWarning, stacklevel=2)


def bearing(study: Study) -> BearingState:
    """Ball equilibrium and the contacts of the most loaded ball."""
    solution = solve(study)
    return replace(solution.bearing, clearances=solution.clearances)


def traction(study: Study) -> answers.TractionAnswer:
    """Traction curves, and by strips at other pivoting-to-rolling ratios."""
    solution = solve(study)
    _ = solution.slopes  # refused, and warned of, as everything after them
    tracks = race_tracks(study.bearing, study.film, solution.bearing)
    # `outside` states where the strips leave their range
    with warnings.catch_warnings(action="ignore", category=ValidityWarning):
        inner, outer = (shown_curve(track, study.traction) for track in tracks)
        outside = tuple(beyond_strips(tracks, study.traction))
    return answers.TractionAnswer(
        race_friction=study.film.race_friction,
        bearing=solution.bearing,
        inner=inner,
        outer=outer,
        inner_others=curves_by_ratio(tracks[0], inner),
        outer_others=curves_by_ratio(tracks[1], outer),
        inner_shear=shear(tracks[0]),
        outer_shear=shear(tracks[1]),
        outside=outside,
    )


def restitution(study: Study) -> answers.RestitutionAnswer:
    """Restitution factor from the traction slopes, and what other films would give."""
    solution = solve(study)
    _warn_if_overdamped(solution.restitution)
    _ = solution.clearances  # refused, and warned of
    thickness = study.film.thickness or 0.0
    return answers.RestitutionAnswer(
        solution=solution, film_thickness=thickness, lubrication=solution.lubrication
    )


def _warn_if_overdamped(found: Restitution) -> None:
    if found.restitution_factor == 0.0:
        damping, least = (format_quantity(c, "N s/m", 3) for c in (found.race_damping, found.least_damping))
        warnings.warn(
            f"eta = 0: impacts are overdamped, because C_mu = {damping} is below the limit sqrt(k_BC M_C)/2 "
            f"= {least}; every material whose cage has this k_BC and M_C has its full threshold as margin. "
            "C_mu falls as race friction falls and as speed rises. Test experience may differ: "
            "docs/theory/restitution.md.",
            ValidityWarning,
            stacklevel=2,
        )


def mobility(study: Study) -> answers.MobilityAnswer:
    """How the races let a ball be pushed along its orbit."""
    records = (study.bearing, study.operation, study.kinematics.model, study.film, study.traction)
    return answers.MobilityAnswer(
        mobility=solve(study).mobility, rigid=linear_mobility(*records, SlipLaw.RIGID)
    )


def stability(study: Study, runner: Runner) -> answers.StabilityAnswer:
    """Critical friction against restitution factor."""
    solution = solve(study)
    warn_of_extrapolation(solution)
    cage, settings = _cage_of(solution), study.stability
    return made_into(
        lambda curve: answers.StabilityAnswer(solution=solution, cage=cage, curve=curve),
        lambda: stability_curve(cage, settings, runner=runner),
    )


def map(
    study: Study,
    runner: Runner,
    *,
    x: str = DEFAULT_X,
    y: str = DEFAULT_Y,
    points: int = 100,
    runs: int = 16,
    kick: str | MetrePerSecond | None = None,
    adaptive: bool = False,
) -> answers.MapAnswer:
    """Verdicts in the plane of two parameters of a study.

    Parameters
    ----------
    x, y : str
        Axes, each ``PARAM=LOW..HIGH[unit][:N][:log]``.
    points : int
        Points of an axis that states no number.
    runs : int
        Most runs of a point.
    kick : str or float, optional
        Initial disturbance at every point, text with a unit or [m/s]; by default the reference kick.
    adaptive : bool
        Run only points near a change of the answer.
    """
    checked_points(points, "--points")
    if not 1 <= runs <= MOST_RUNS:
        raise InputError("--runs", f"must lie between 1 and {MOST_RUNS}", got=str(runs))
    axes = read_axis(x, "--x", points), read_axis(y, "--y", points)
    names = [axis.parameter for axis in axes]
    if names[0] == names[1]:
        cure = f"Without --x it is {DEFAULT_X}, without --y {DEFAULT_Y}."
        raise InputError("--x and --y", "must be two parameters", got=f"{names[0]} twice", cure=cure)
    if kick is not None and KICK in names:
        raise InputError("--kick", "and an axis kick exclude each other", cure="Give one of the two.")
    solution = solve(study)
    cage = _cage_of(solution)
    speed = settings_for(study.stability, cage).middle_kick if kick is None else kick_speed(kick)
    across, up = (replace(axis, here=value_here(solution, axis.parameter)) for axis in axes)
    asked = MapQuestion(study=study, x=across, y=up, kick=speed, runs=runs, adaptive=adaptive)
    warn_of_extrapolation(solution)
    return made_into(
        lambda found: answers.MapAnswer(solution=solution, cage=cage, map=found),
        lambda: stability_map(asked, runner=runner),
    )


def kick_speed(kick: str | MetrePerSecond) -> MetrePerSecond:
    """Speed of a kick that a study may have, from text with a unit or a number [m/s]."""
    speed = parse(kick, "m/s", "--kick") if isinstance(kick, str) else float(kick)
    if not LEAST_KICK < speed < MOST_KICK:
        rule = f"must be > {LEAST_KICK:g} and < {MOST_KICK:g} [m/s]"
        raise InputError("--kick", rule, f"{speed:g}", NO_KICK)
    return speed


def warn_of_extrapolation(solution: Solution) -> None:
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


def simulate(
    study: Study,
    *,
    kick: str | MetrePerSecond | None = None,
    run: int = 0,
    restitution_factor: str | Ratio | None = None,
) -> answers.SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference kick.

    Parameters
    ----------
    kick : str or float, optional
        Initial disturbance, text with a unit or [m/s].
    run : int
        Which run of the ensemble.
    restitution_factor : str or float, optional
        Damp the races so that eta is this, as at a point of a map; by default that of the study.
    """
    if not 0 <= run <= MOST_RUNS:
        raise InputError("--run", f"must lie between 0 and {MOST_RUNS}", got=str(run))
    given = None if kick is None else kick_speed(kick)
    solution = solve(study)
    require_friction(study)
    cage = _cage_of(solution)
    settings = settings_for(study.stability, cage)
    if restitution_factor is not None:
        text = str(restitution_factor).strip()
        eta = float(text) if re.fullmatch(NUMBER, text) else nan
        if not 0.0 <= eta <= 1.0:
            rule = "must be a number from 0 to 1"
            raise InputError("--restitution-factor", rule, printable(str(restitution_factor)))
        cage = cage_at(cage, eta, cage.ball_cage_friction)
    warn_of_extrapolation(solution)
    speed = settings.middle_kick if given is None else given
    history = follow(
        cage,
        kick=speed,
        run=run,
        seed=settings.seed,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        samples=MOST_SHOWN,
    )
    made_of = cage_candidate(study)
    name = made_of.name if made_of else "The cage"
    moved = [Moved(name, history.largest_contact_force, history.largest_offset)]
    for note in beyond_motion(solution, moved):
        warnings.warn(note, ValidityWarning, stacklevel=2)
    limit = force_limit(cage, transmitted_force(solution))
    return answers.SimulationAnswer(
        solution=solution,
        cage=cage,
        history=history,
        analysis=analyse(cage, history),
        kick=speed,
        run=run,
        force_limit=limit if isfinite(limit) else None,
    )


def rank(study: Study, runner: Runner) -> answers.RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    solution, cage = _reference(study)
    _warn_if_overdamped(solution.restitution)
    return made_into(
        lambda found: answers.RankingAnswer(solution=solution, cage=cage, ranking=found),
        lambda: rank_materials(study, runner=runner),
    )


def _reference(study: Study) -> tuple[Solution, MovingCage]:
    asked = ranking_question(study)
    required_environment(study, asked)
    solution = solve(study, reference_candidate(study, asked))
    return solution, _cage_of(solution)


def _cage_of(solution: Solution) -> MovingCage:
    """Cage of an answer; without friction where none is known."""
    return moving_cage(solution, solution.friction.mean if solution.friction else 0.0)


def sensitivity(study: Study, runner: Runner, *, samples: int = SAMPLES) -> answers.SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate.

    Parameters
    ----------
    samples : int
        Bearings drawn, a power of two.
    """
    if not FEWEST_SAMPLES <= samples <= MOST_SAMPLES or samples.bit_count() != 1:
        near = 1 << max(0, samples - 1).bit_length()
        cure = f"Try {min(max(near, FEWEST_SAMPLES), MOST_SAMPLES)}."
        rule = f"must be a power of two from {FEWEST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("--samples", rule, got=str(samples), cure=cure)
    solution, cage = _reference(study)
    uncertain_inputs(study, frictions_to_draw(study))  # refused before anything is timed
    return made_into(
        lambda found: answers.SensitivityAnswer(
            solution=solution,
            cage=cage,
            uncertain=found,
            film_thickness=study.film.thickness,
            race_friction=study.film.race_friction,
        ),
        lambda: uncertain_study(study, samples, runner=runner),
    )


def sweep(
    study: Study,
    runner: Runner,
    *,
    vary: Sequence[str] = (),
    cases: Path | Sequence[Case] | None = None,
    verdicts: bool = False,
    margins: bool = False,
) -> Sweep:
    """Chain and, if asked, verdict of many cases of a study.

    Parameters
    ----------
    vary : sequence of str
        Ranges, each ``PARAM=LOW..HIGH[unit][:N][:log]``; every value of one with every value of the others.
    cases : Path, or sequence of mapping, optional
        In their place a CSV file, or values by the names of a study file in SI units; with `time_share`
        they are a duty cycle.
    verdicts, margins : bool
        Whether to run the whole ensemble of each case, and to compute its threshold and margin, too.
    """
    asked = asked_cases(vary, cases)
    with contextlib.suppress(SeparatrixError):
        _ = solve(study).clearances  # warns of their guesses; a case warns of nothing
    return run_cases(study, asked, verdicts=verdicts, margins=margins, runner=runner)
