"""The verb `map` and its options."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.cli.axes import DEFAULT_X, DEFAULT_Y, checked_points, read_axis
from separatrix.errors import InputError
from separatrix.units import parse

if TYPE_CHECKING:
    from separatrix.answers import MapAnswer
    from separatrix.runner import Runner
    from separatrix.stability.map_records import MapAxis, MapQuestion
    from separatrix.study import Study

MOST_RUNS = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class MapOptions:
    """What follows `map STUDY`, as text."""

    x: str | None = None
    y: str | None = None
    points: int = 100
    runs: int = 16
    kick: str | None = None
    adaptive: bool = False

    def compute(self, study: Study, runner: Runner) -> MapAnswer:
        """Answer the verb.

        Raises
        ------
        InputError
            An option cannot be understood, or no point can be run.
        """
        from separatrix.verbs import stability_map

        return stability_map(map_question(study, self), runner)


def map_question(study: Study, options: MapOptions) -> MapQuestion:
    """Return what is asked, from the text of the options.

    Raises
    ------
    InputError
        One of them is wrong.
    """
    from separatrix.stability.map_records import MapQuestion

    points = checked_points(options.points, "--points")
    if not 1 <= options.runs <= MOST_RUNS:
        raise InputError("--runs", f"must lie between 1 and {MOST_RUNS}", got=str(options.runs))
    x = read_axis(options.x or DEFAULT_X, "--x", points)
    y = read_axis(options.y or DEFAULT_Y, "--y", points)
    _refuse_twice(x, y)
    kick = _kick(options.kick, study, x, y)
    return MapQuestion(study=study, x=x, y=y, kick=kick, runs=options.runs, adaptive=options.adaptive)


def _refuse_twice(x: MapAxis, y: MapAxis) -> None:
    if x.parameter == y.parameter:
        cure = f"Without --x it is {DEFAULT_X}, without --y {DEFAULT_Y}."
        raise InputError("--x and --y", "must be two parameters", got=f"{x.parameter} twice", cure=cure)


def _kick(text: str | None, study: Study, x: MapAxis, y: MapAxis) -> float:
    """Kick of every point; of no meaning where an axis is the kick."""
    if text is None:
        from separatrix.chain import solve

        return solve(study).stability.middle_kick
    if "kick" in (x.parameter, y.parameter):
        raise InputError("--kick", "and an axis kick exclude each other", cure="Give one of the two.")
    return kick_speed(text)


def kick_speed(text: str) -> float:
    """Speed of a kick from the text of ``--kick``.

    Raises
    ------
    InputError
        It is no speed that a study may have.
    """
    from separatrix.study import LEAST_KICK, MOST_KICK, NO_KICK

    speed = parse(text, "m/s", "--kick")
    if not LEAST_KICK < speed < MOST_KICK:
        rule = f"must be > {LEAST_KICK:g} and < {MOST_KICK:g} [m/s]"
        raise InputError("--kick", rule, f"{speed:g}", NO_KICK)
    return speed
