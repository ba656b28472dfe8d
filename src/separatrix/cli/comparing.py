"""The verb `compare`: two saved answers of `simulate`, or two of `rank`, side by side."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.console import answer, harmless
from separatrix.cli.files import staged, writable_folder
from separatrix.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

VERBS = ("simulate", "rank")
NUMBERS = ("kick", "run", "end_energy", "largest_offset", "largest_contact_force", "outcome")
"""Single values of a saved simulation; not every version has each."""

DRAWN: dict[str, int] = {
    **dict.fromkeys(("outcome", "kick", "largest_offset"), 0),
    **dict.fromkeys(("time", "land_force", "kinetic_energy", "spring_energy", "land_energy"), 1),
    **dict.fromkeys(("pocket_angle", "half_play"), 1),
    **dict.fromkeys(("position", "velocity", "contact_force"), 2),
}
"""What a comparison of simulations takes from each: variable and number of its dimensions."""

MOST = 1e30
"""Magnitude from which a number cannot be drawn; no run comes near it."""

RANKED = ("verdict", "margin", "probability_stable", "friction", "restitution_threshold")
"""What a comparison of rankings takes of each material."""

WANTED: dict[str, dict[str, int]] = {
    "simulate": DRAWN,
    "rank": {
        "material": 1,
        "environment": 1,
        **{f"overall_{name}": 1 for name in RANKED},
        **{f"material_{name}": 2 for name in RANKED},
    },
}
TEXTS = ("outcome", "material", "environment", "overall_verdict", "material_verdict")
"""What an answer of each verb must have, with number of dimensions, and which of it are texts."""

FRICTION = "cage.ball_cage_friction"
"""Key of the pocket friction, which a study may leave to its candidates."""

OVERALL = "Overall: mean friction over the measured environments"
BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Saved:
    """One saved answer: where it was found, its data, its verb and title, and the resolved study in it."""

    path: Path
    data: xr.Dataset
    verb: str
    title: str
    study: Mapping[str, Any]


def compare(first: Path, second: Path, out: Path | None, *, as_json: bool) -> int:
    """Compare two saved answers, draw simulations together, and return the exit status.

    Parameters
    ----------
    first, second : Path
        Folder of an answer of `simulate` or `rank`, or its netCDF file.
    out : Path or None
        Folder of the files; without it none is written with `as_json`.
    as_json : bool
        Whether to print the document instead of the table.

    Raises
    ------
    InputError
        One of them is not a saved answer, they answer different questions, or the folder cannot be written.
    """
    from separatrix.present.text.compare import compare as in_words

    pair = read(first), read(second)
    if pair[0].verb != pair[1].verb:
        rule = f"must be an answer of {pair[0].verb}, as {first} is"
        raise InputError(str(second), rule, got=pair[1].verb)
    found = document(*pair)
    folder = out or (None if as_json else Path("compare"))
    if folder is not None:
        with writable_folder(folder):
            _write(pair, found, folder)
    answer(json.dumps(found, indent=1, allow_nan=False) + "\n" if as_json else in_words(found, folder))
    return 0


def read(path: Path) -> Saved:
    """Return a saved answer of `simulate` or `rank`.

    Raises
    ------
    InputError
        There is none, it answers another question, or it lacks something that such an answer has.
    """
    from separatrix.present import load

    here = [file for verb in VERBS if (file := path / f"{verb}.nc").exists()] if path.is_dir() else [path]
    if not here or not here[0].exists():
        cure = "Make one with: separatrix simulate STUDY --out DIR, or separatrix rank STUDY --out DIR."
        raise InputError(str(path), "does not contain a saved simulation or ranking", cure=cure)
    data = load(here[0])
    verb, title = str(data.attrs.get("verb", "none")), str(data.attrs.get("title", ""))
    if verb not in VERBS:
        raise InputError(str(path), f"must be an answer of {' or '.join(VERBS)}", got=verb)
    if not title.strip():
        raise InputError(str(path), "lacks its title")
    try:
        int(data.attrs["seed"])
    except (KeyError, TypeError, ValueError, OverflowError):
        raise InputError(str(path), "lacks its seed") from None
    study = _study(data, path)
    for name, dimensions in WANTED[verb].items():
        if name not in data or data[name].ndim != dimensions or data[name].size == 0:
            raise InputError(str(path), f"lacks {name}, which an answer of {verb} has")
        if name in TEXTS:
            continue
        if data[name].dtype.kind not in "iuf":
            raise InputError(str(path), f"must have numbers in {name}", got=str(data[name].dtype))
        if verb == "simulate" and not float(abs(data[name]).max(skipna=False)) < MOST:
            raise InputError(str(path), f"must have finite numbers below {MOST:g} in {name}")
    return Saved(path=path, data=data, verb=verb, title=title, study=study)


def _study(data: xr.Dataset, path: Path) -> dict[str, Any]:
    """Return the resolved study of an answer; the heading of figures can be read from it."""
    from separatrix.figures.style import heading

    try:
        study = dict(json.loads(data.attrs.get("study", "")))
        heading(data)
        if dict(_inputs(study)):
            return study
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, RecursionError):
        pass
    raise InputError(str(path), "contains a study that separatrix did not write")


def document(first: Saved, second: Saved) -> dict[str, Any]:
    """Return the numbers of each answer, and the inputs that differ."""
    from separatrix import __version__

    found: dict[str, Any] = {"separatrix_version": __version__, "verb": "compare", "of": first.verb}
    pair = first, second
    named = [{"path": str(one.path), "title": one.title, "seed": int(one.data.attrs["seed"])} for one in pair]
    if first.verb == "simulate":
        found["runs"] = [known | _in_numbers(one.data) for known, one in zip(named, pair, strict=True)]
    else:
        found |= {"rankings": named, "environments": list(_side_by_side(first.data, second.data))}
    return found | {"differences": list(differences(first, second))}


def _in_numbers(data: xr.Dataset) -> dict[str, Any]:
    """Return the single numbers of a simulation, and the largest force of its land."""
    values = {name: data[name].item() for name in NUMBERS if name in data and data[name].size == 1}
    values["largest_land_force"] = float(abs(data["land_force"]).max())
    return {name: _or_none(value) for name, value in values.items()}


def _or_none(value: Any) -> Any:
    """Return a value that was there: no NaN for a number, no empty text for a verdict."""
    is_absent = value == "" or (isinstance(value, float) and not math.isfinite(value))
    return None if is_absent else value


def _side_by_side(first: xr.Dataset, second: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Yield the materials of two rankings, overall and in each environment that either has."""
    tables = []
    for data in (first, second):
        parts = {str(name): data.isel(environment=i) for i, name in enumerate(data["environment"].values)}
        here = {name: _rows(part, "material_") for name, part in parts.items()}
        tables.append({OVERALL: _rows(data, "overall_")} | here)
    for environment in {**tables[0], **tables[1]}:
        one, other = (table.get(environment, {}) for table in tables)
        names = {**one, **other}
        rows = [{"name": name, "first": one.get(name), "second": other.get(name)} for name in names]
        yield {"name": environment, "materials": rows}


def _rows(data: xr.Dataset, prefix: str) -> dict[str, dict[str, Any]]:
    """Return material -> its numbers; None where a material was not measured."""
    columns = {name: data[prefix + name].values.tolist() for name in RANKED}
    return {
        str(material): {name: _or_none(column[i]) for name, column in columns.items()}
        for i, material in enumerate(data["material"].values)
    }


def differences(first: Saved, second: Saved) -> Iterator[dict[str, Any]]:
    """Yield each input that differs: keys of the study, then options of the command."""
    one, other = (dict(_all_inputs(saved)) for saved in (first, second))
    for key in {**one, **other}:
        a, b = one.get(key, (None, None)), other.get(key, (None, None))
        if a[0] != b[0]:
            yield {"key": key, "first": a[0], "second": b[0], "unit": a[1] or b[1]}


def _all_inputs(saved: Saved) -> Iterator[tuple[str, tuple[Any, str | None]]]:
    """Yield every input of an answer; of a simulation also kick and run, and the friction that it took."""
    yield from sorted(_inputs(saved.study), key=lambda pair: pair[0])
    taken = (("--kick", "kick", "m/s"), ("--run", "run", None), (FRICTION, "cage_ball_cage_friction", "-"))
    for key, name, unit in taken if saved.verb == "simulate" else ():
        if name in saved.data and saved.data[name].size == 1:
            yield key, (_or_none(saved.data[name].item()), unit)


def _inputs(node: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, tuple[Any, str | None]]]:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one what is known."""
    if "value" in node:
        known = node.get("distribution")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        yield path, (words or node["value"], None if words else node.get("unit"))
        return
    if path and isinstance(node.get("name"), str):
        yield path, (node["name"], None)
    for key, item in node.items():
        if isinstance(item, Mapping) and key not in BESIDE:
            yield from _inputs(item, f"{path}.{key}" if path else key)
        elif key == "candidates" and isinstance(item, list):
            yield from _frictions(item)


def _frictions(candidates: list[Any]) -> Iterator[tuple[str, tuple[Any, str | None]]]:
    """Yield the mean friction of each candidate in each environment, and its material."""
    for one in (one for one in candidates if isinstance(one, Mapping)):
        at = f"friction of {one.get('name')}"
        friction = one.get("friction")
        for environment, measured in friction.items() if isinstance(friction, Mapping) else ():
            if isinstance(measured, Mapping):
                yield f"{at} in {environment}", (measured.get("mean"), "-")
        if isinstance(one.get("material"), Mapping):
            yield from _inputs(one["material"], f"material of {one.get('name')}")


def _write(pair: tuple[Saved, Saved], found: Mapping[str, Any], folder: Path) -> None:
    """Write document and text, and the figure of simulations, all or none."""
    from separatrix import figures
    from separatrix.present.text.compare import compare as in_words

    with staged(folder) as stage:
        (stage / "compare.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        (stage / "compare.txt").write_text(harmless(in_words(found, folder)), encoding="utf-8")
        if pair[0].verb == "simulate":
            paths = str(pair[0].path), str(pair[1].path)
            names = paths if pair[0].title == pair[1].title else ("", "")  # else by their titles
            for name, figure in figures.draw("compare", pair[0].data, pair[1].data, names=names):
                for suffix in (".png", ".svg"):
                    figures.save(figure, stage / f"{name}{suffix}")
