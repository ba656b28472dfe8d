"""`map`: verdicts in the plane of two parameters of a study."""

from __future__ import annotations

from dataclasses import replace

from separatrix.cage import settings_for
from separatrix.chain.solution import solve
from separatrix.ground.errors import InputError
from separatrix.ground.units import MetrePerSecond
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    MOST_RUNS,
    cage_of,
    extrapolation_notes,
    kick_speed,
)
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.map_records import KICK, MapQuestion, StabilityMap
from separatrix.verdict.parameter_axes import (
    DEFAULT_X,
    DEFAULT_Y,
    checked_points,
    read_axis,
)
from separatrix.verdict.stability_map import stability_map, value_here


def compute(
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
    cage = cage_of(solution)
    speed = settings_for(study.stability, cage).middle_kick if kick is None else kick_speed(kick)
    across, up = (replace(axis, here=value_here(solution, axis.parameter)) for axis in axes)
    asked = MapQuestion(study=study, x=across, y=up, kick=speed, runs=runs, adaptive=adaptive)
    notes = (*solution.notes, *cage.notes, *extrapolation_notes(solution))

    def made(found: StabilityMap) -> answers.MapAnswer:
        every = (*notes, *(note for point in found.points for note in point.notes))
        return answers.MapAnswer(solution=solution, cage=cage, map=found, notes=every)

    return made_into(
        made,
        lambda: stability_map(asked, runner=runner),
    )
