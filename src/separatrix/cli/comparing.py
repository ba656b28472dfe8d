"""The verb `compare`: two saved simulations side by side."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.console import answer
from separatrix.cli.files import staged, writable_folder
from separatrix.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

VERB = "simulate"
NUMBERS = ("kick", "run", "energy_growth", "largest_offset", "largest_contact_force", "outcome")
"""What a saved simulation says of itself in one value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Saved:
    """One saved simulation: where it was found, and its data."""

    path: Path
    data: xr.Dataset

    @property
    def title(self) -> str:
        """Title of its study."""
        return str(self.data.attrs.get("title", self.path.stem))


def compare(first: Path, second: Path, out: Path | None, *, as_json: bool) -> int:
    """Compare two saved simulations, draw them together, and return the exit status.

    Parameters
    ----------
    first, second : Path
        Folder of an answer of `simulate`, or its netCDF file.
    out : Path or None
        Folder of the figure; without it none is drawn where a document is asked for.
    as_json : bool
        Whether to print the document instead of the table.

    Raises
    ------
    InputError
        One of them is no saved simulation, or the folder cannot be written.
    """
    from separatrix.report.compare import compare as in_words

    pair = read(first), read(second)
    found = document(*pair)
    folder = out or (None if as_json else Path("compare"))
    if folder is not None:
        with writable_folder(folder):
            _draw(pair, found, folder)
    answer(json.dumps(found, indent=1, allow_nan=False) + "\n" if as_json else in_words(found, folder))
    return 0


def read(path: Path) -> Saved:
    """Return a saved simulation.

    Raises
    ------
    InputError
        There is none, or it answers another question.
    """
    from separatrix import results

    file = path / f"{VERB}.nc" if path.is_dir() else path
    if not file.exists():
        cure = f"Make it with: separatrix {VERB} STUDY --out DIR."
        raise InputError(str(path), "holds no saved simulation", cure=cure)
    data = results.load(file)
    if data.attrs.get("verb") != VERB:
        raise InputError(str(path), f"must be an answer of {VERB}", value=str(data.attrs.get("verb", "none")))
    return Saved(path=path, data=data)


def document(first: Saved, second: Saved) -> dict[str, Any]:
    """Return what each simulation says of itself, and the inputs in which their studies differ."""
    from separatrix import __version__

    return {
        "separatrix_version": __version__,
        "verb": "compare",
        "runs": [_in_numbers(first), _in_numbers(second)],
        "differences": list(differences(first.data, second.data)),
    }


def _in_numbers(saved: Saved) -> dict[str, Any]:
    values = {name: saved.data[name].item() for name in NUMBERS if name in saved.data}
    finite = {name: None if value != value else value for name, value in values.items()}
    return {"path": str(saved.path), "title": saved.title, "seed": int(saved.data.attrs["seed"])} | finite


def differences(first: xr.Dataset, second: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Yield each input of the two studies that differs, by its name in a study file."""
    one, other = (dict(_inputs(json.loads(data.attrs["study"]))) for data in (first, second))
    for key in sorted({*one, *other}):
        a, b = one.get(key, (None, None)), other.get(key, (None, None))
        if a[0] != b[0]:
            yield {"key": key, "first": a[0], "second": b[0], "unit": a[1] or b[1]}


def _inputs(node: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, tuple[Any, str | None]]]:
    """Yield name, value and unit of every input of a resolved study."""
    if "value" in node:
        yield path, (node["value"], node.get("unit"))
        return
    for key, item in node.items():
        if isinstance(item, Mapping):
            yield from _inputs(item, f"{path}.{key}" if path else key)


def _draw(pair: tuple[Saved, Saved], found: Mapping[str, Any], folder: Path) -> None:
    """Write figure, document and text, all or none."""
    from separatrix import figures
    from separatrix.report.compare import compare as in_words

    names = _names(pair)
    with staged(folder) as stage:
        (stage / "compare.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        (stage / "compare.txt").write_text(in_words(found, folder), encoding="utf-8")
        figure = figures.compared(pair[0].data, pair[1].data, names)
        for suffix in (".png", ".svg"):
            figures.save(figure, stage / f"comparison{suffix}")


def _names(pair: tuple[Saved, Saved]) -> tuple[str, str]:
    """Names for the legend: the titles, or where they were found if those are the same."""
    first, second = pair
    if first.title != second.title:
        return first.title, second.title
    return str(first.path), str(second.path)
