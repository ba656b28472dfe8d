"""One run of the cage as a moving picture: cage, balls, contact forces, time and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import to_rgb
from PIL import Image

from separatrix.errors import InputError
from separatrix.figures import simulation
from separatrix.figures.frames import DRAWN, pictures
from separatrix.figures.literal import literal_texts
from separatrix.figures.scene import scene
from separatrix.figures.spectrum import fastest_whirl
from separatrix.figures.style import journal
from separatrix.units import Array

KINDS = ("gif", "mp4")
MOST_FRAMES = 360
A_SECOND = 24
"""Frames a second."""

A_TURN = 6
"""Frames in a turn of the fastest strong whirl, at least: fewer would show it turning any way."""

SHADES = 16
"""Steps from each of these colours to white in a GIF."""

Progress = Callable[[int, int], None]


def animate(
    data: xr.Dataset,
    path: Path,
    *,
    kind: str | None = None,
    fixed: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write a run as an animation; an interrupt leaves no file, and an older one as it was.

    Parameters
    ----------
    data : Dataset
        Of a simulation.
    path : Path
        File to write.
    kind : str or None
        "gif", or "mp4", which needs the extra `animation`; by default the ending of the file.
    fixed : bool
        Whether the picture stands still in space; else it turns with the ball set.
    progress : callable, optional
        Called with (done, total) frames.

    Raises
    ------
    InputError
        The kind is unknown, or what writes it is not installed.
    """
    kind = path.suffix[1:].lower() if kind is None else kind
    if kind not in KINDS:
        raise InputError("The kind of an animation", f"must be {' or '.join(KINDS)}", got=f'"{kind}"')
    encoder = video_encoder() if kind == "mp4" else None
    data, moments = literal_texts(data), frame_moments(data)
    with journal(), _beside(path) as part:
        film = _told(pictures(data, scene(data, moments, fixed=fixed), moments), moments.size, progress)
        if encoder is None:
            _write_gif(film, part)
        else:
            _write_mp4(encoder, film, part)


def video_encoder() -> ModuleType:
    """Return the package that brings a video encoder along.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        import imageio_ffmpeg
    except ImportError as error:
        cure = "pip install 'separatrix[animation]', or take a GIF."
        raise InputError("An MP4", "needs the package imageio-ffmpeg", cure=cure) from error
    encoder: ModuleType = imageio_ffmpeg
    return encoder


@contextmanager
def _beside(path: Path) -> Iterator[Path]:
    """Give a file beside the wanted one, and put it in its place if all went well."""
    part = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def frame_moments(data: xr.Dataset, most: int = MOST_FRAMES) -> Array:
    """Return the samples that become frames, rising, with the first and the last.

    Where time is drawn logarithmic they are evenly spaced so. Else they are close enough to show each turn
    of the whirl; if the whole run would take too many, its beginning and its end are shown.
    """
    time = simulation.milliseconds(data)
    first, last = simulation.time_limits(data)
    space = np.geomspace if simulation.is_logarithmic(data) else np.linspace
    wanted = np.searchsorted(time, space(first, last, most)).clip(0, time.size - 1)
    even = np.unique(np.concatenate([[0], wanted]))[-most:]
    step = whirl_step(data)
    if simulation.is_logarithmic(data) or int(np.diff(even).max(initial=1)) <= step:
        return even
    half = np.arange(most // 2) * step
    return np.unique(np.concatenate([half, time.size - 1 - half]))


def whirl_step(data: xr.Dataset) -> int:
    """Return how many samples may lie between frames that show every turn of the whirl."""
    whirl, last = fastest_whirl(data), float(data["time"].values[-1])
    turns = whirl * last
    return max(1, int(data.sizes["time"] / (A_TURN * turns))) if turns > 0.0 else data.sizes["time"]


def _told(film: Iterator[Image.Image], total: int, progress: Progress | None) -> Iterator[Image.Image]:
    """Yield the frames, telling of each."""
    for done, image in enumerate(film, start=1):
        yield image
        if progress is not None:
            progress(done, total)


def _write_gif(film: Iterator[Image.Image], part: Path) -> None:
    """Write the frames as a GIF that repeats, all in the same colours."""
    look: Any = {"palette": palette(), "dither": Image.Dither.NONE}
    images = (image.quantize(**look) for image in film)
    how: Any = {"save_all": True, "duration": 1000 // A_SECOND, "loop": 0}
    with part.open("wb") as file:
        next(images).save(file, "GIF", append_images=images, **how)


def palette() -> Image.Image:
    """Return an image that holds the colours of a film: each one that is drawn, in steps up to white."""
    drawn = 255 * np.array([to_rgb(colour) for colour in DRAWN])
    share = np.linspace(0.0, 1.0, SHADES)[:, np.newaxis, np.newaxis]
    shades = np.round(share * drawn + (1 - share) * 255.0).astype(np.uint8).reshape(-1, 3)
    image = Image.new("P", (1, 1))
    image.putpalette(shades.tobytes())
    return image


def _write_mp4(encoder: ModuleType, film: Iterator[Image.Image], part: Path) -> None:
    """Write the frames as H.264 video."""
    first = next(film)
    try:
        pipe = encoder.write_frames(str(part), first.size, fps=A_SECOND, quality=7, macro_block_size=2)
        pipe.send(None)
        try:
            pipe.send(first.tobytes())
            for image in film:
                pipe.send(image.tobytes())
        finally:
            pipe.close()
    except (OSError, RuntimeError) as error:
        raise InputError("The MP4", "could not be encoded", cure="Take a GIF.") from error
