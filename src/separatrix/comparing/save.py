"""The files of a comparison: its document, its text, and both answers drawn together."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix import figures
from separatrix.comparing.records import Comparison
from separatrix.comparing.saved import Saved
from separatrix.comparing.text import in_words
from separatrix.errors import InputError
from separatrix.figures.space import in_plane
from separatrix.messages import harmless
from separatrix.present import plain

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

RUN: dict[str, int] = {
    **dict.fromkeys(("outcome", "kick", "largest_offset"), 0),
    **dict.fromkeys(("time", "land_force", "kinetic_energy", "spring_energy", "land_energy"), 1),
    **dict.fromkeys(("pocket_angle", "half_play"), 1),
    **dict.fromkeys(("position", "velocity", "contact_force"), 2),
}
CURVE = dict.fromkeys(("restitution_factor", "critical_friction", "scatter_low", "scatter_high"), 1)
NEEDED: Mapping[str, Mapping[str, int]] = {
    "simulate": RUN,
    "stability": CURVE,
    "rank": CURVE
    | dict.fromkeys(("material", "environment"), 1)
    | {f"material_restitution_{name}": 2 for name in ("factor", "threshold")}
    | {f"material_restitution_threshold_{end}": 2 for end in ("low", "high")},
}
"""What a picture takes from each: variable and number of its dimensions."""

TEXTS = ("outcome", "material", "environment")

MOST = 1e30
"""Magnitude from which a number cannot be drawn; no run comes near it."""


def pictures(first: Saved, second: Saved) -> Iterator[tuple[str, Figure]]:
    """Yield name and figure of each picture of two answers; none for a verb or an answer without arrays.

    Raises
    ------
    InputError
        An array cannot be drawn.
    """
    pair = [one.data for one in (first, second) if one.data is not None]
    if len(pair) < 2 or first.verb not in NEEDED:
        return
    if first.verb == "simulate":
        pair = [in_plane(one) for one in pair]
    elif any("restitution_factor" not in one.sizes for one in pair):  # an interrupted one has no curve
        return
    for data, saved in zip(pair, (first, second), strict=True):
        _check(data, saved)
    titles = [str(one.attrs.get("title", "")) for one in pair]
    names = (first.path, second.path) if titles[0] == titles[1] else ("", "")  # else by their titles
    yield from figures.draw("compare", *pair, names=names)


def _check(data: xr.Dataset, saved: Saved) -> None:
    """Refuse an answer whose arrays cannot be drawn."""
    for name, dimensions in NEEDED[saved.verb].items():
        if name not in data or data[name].ndim != dimensions or data[name].size == 0:
            raise InputError(saved.path, f"lacks {name}, which an answer of {saved.verb} has")
        if name in TEXTS:
            continue
        if data[name].dtype.kind not in "iuf":
            raise InputError(saved.path, f"must have numbers in {name}", got=str(data[name].dtype))
        largest = float(abs(data[name]).max(skipna=saved.verb != "simulate"))
        if largest >= MOST or (saved.verb == "simulate" and not largest < MOST):
            raise InputError(saved.path, f"must have finite numbers below {MOST:g} in {name}")


def comparison_document(found: Comparison) -> dict[str, object]:
    """Return a comparison as plain data, as ``--json`` prints it."""
    from separatrix import __version__
    from separatrix.present.json import null_if_not_finite

    with null_if_not_finite():
        return {"separatrix_version": __version__, "verb": "compare", **plain(found)}


def save_comparison(folder: Path, found: Comparison, first: Saved, second: Saved) -> None:
    """Write compare.json, compare.txt with every row, and the figures, where both have their arrays."""
    text = json.dumps(comparison_document(found), indent=1, allow_nan=False) + "\n"
    (folder / "compare.json").write_text(text, encoding="utf-8")
    (folder / "compare.txt").write_text(harmless(in_words(found, full=True)), encoding="utf-8")
    figures.save_all(pictures(first, second), folder)
