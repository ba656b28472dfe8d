"""The animation that `simulate` draws beside its figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.cli.console import progress_bar
from separatrix.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

KINDS = ("gif", "mp4")


def check_animation(kind: str, *, writes: bool) -> None:
    """Refuse an animation that cannot be made, before anything is read.

    Raises
    ------
    InputError
        It is of no kind that there is, has no folder to go to, or its encoder is missing.
    """
    if kind not in KINDS:
        raise InputError("--animate", f"must be {' or '.join(KINDS)}", got=f'"{kind}"')
    if not writes:
        raise InputError("--animate", "needs a folder with --json", cure="Give --out DIR.")
    if kind == "mp4":
        from separatrix.figures.animation import video_encoder

        video_encoder()


def write_animation(data: xr.Dataset, folder: Path, kind: str, *, quiet: bool) -> None:
    """Write the animation of a run."""
    from separatrix.figures.animation import animate

    with progress_bar("animation", quiet=quiet) as progress:
        animate(data, folder / f"simulation.{kind}", kind=kind, progress=progress)
