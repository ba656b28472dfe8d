"""Options of the verb `simulate`: which run, from which kick, and an animation of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.cli.console import progress_bar
from separatrix.cli.mapping import kick_speed
from separatrix.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from separatrix.answers import SimulationAnswer
    from separatrix.runner import Runner
    from separatrix.study import Study

KINDS = ("gif", "mp4")
LAST_RUN = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulateOptions:
    """What follows `simulate STUDY`."""

    kick: str | None = None
    run: int = 0
    animate: str | None = None

    def check(self, *, writes: bool) -> None:
        """Refuse what cannot be done, before anything is read.

        Raises
        ------
        InputError
            An option is wrong, or an animation has no folder to go to.
        """
        if not 0 <= self.run <= LAST_RUN:
            raise InputError("--run", f"must lie between 0 and {LAST_RUN}", got=str(self.run))
        if self.kick is not None:
            kick_speed(self.kick)
        if self.animate is None:
            return
        if self.animate not in KINDS:
            raise InputError("--animate", f"must be {' or '.join(KINDS)}", got=f'"{self.animate}"')
        if not writes:
            raise InputError("--animate", "needs a folder with --json", cure="Give --out DIR.")
        if self.animate == "mp4":
            from separatrix.figures.animation import video_encoder

            video_encoder()

    def compute(self, study: Study, runner: Runner) -> SimulationAnswer:  # noqa: ARG002
        """Follow the run."""
        from separatrix.verbs import simulate

        return simulate(study, kick=None if self.kick is None else kick_speed(self.kick), run=self.run)

    def draw(self, data: xr.Dataset, folder: Path, *, quiet: bool) -> None:
        """Write the animation, if one is asked for."""
        if self.animate is None:
            return
        from separatrix.figures.animation import animate

        with progress_bar("animation", quiet=quiet) as progress:
            animate(data, folder / f"simulation.{self.animate}", kind=self.animate, progress=progress)
