"""The verb `compare`: two saved answers of `simulate`, or two of `rank`, side by side."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.console import answer
from separatrix.errors import InputError
from separatrix.plain_text import harmless
from separatrix.staged import staged, writable_folder

if TYPE_CHECKING:
    import xarray as xr

    from separatrix.present.text.compare import ComparedRankings, ComparedRuns, Difference, Environment

VERBS = ("simulate", "rank")
DRAWN: dict[str, int] = {
    **dict.fromkeys(("outcome", "kick", "largest_offset"), 0),
    **dict.fromkeys(("time", "land_force", "kinetic_energy", "spring_energy", "land_energy"), 1),
    **dict.fromkeys(("pocket_angle", "half_play"), 1),
    **dict.fromkeys(("position", "velocity", "contact_force"), 2),
}
"""What a comparison of simulations takes from each: variable and number of its dimensions."""

TABLED = ("verdict", "margin", "probability_stable", "friction", "restitution_threshold")
WANTED: dict[str, dict[str, int]] = {
    "simulate": DRAWN,
    "rank": {
        "material": 1,
        "environment": 1,
        **{f"overall_{name}": 1 for name in TABLED},
        **{f"material_{name}": 2 for name in TABLED},
    },
}
TEXTS = ("outcome", "material", "environment", "overall_verdict", "material_verdict")
"""What an answer of each verb must have, with number of dimensions, and which of it are texts."""

MOST = 1e30
"""Magnitude from which a number cannot be drawn; no run comes near it."""

FRICTION = "cage.ball_cage_friction"
"""Key of the pocket friction, which a study may leave to its candidates."""

OVERALL = "Overall: mean friction over the measured environments"
BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""

Inputs = Iterator[tuple[str, tuple[Any, str | None]]]
"""Names of inputs, each with its value and unit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Saved:
    """One saved answer: where it was found, its data, its verb and title, and the resolved study in it."""

    path: Path
    data: xr.Dataset
    verb: str
    title: str
    study: Mapping[str, Any]

    @property
    def named(self) -> dict[str, Any]:
        """Which answer it is."""
        return {"path": str(self.path), "title": self.title, "seed": int(self.data.attrs["seed"])}


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
    from separatrix import __version__, figures
    from separatrix.present import plain
    from separatrix.present.text.compare import compare as in_words

    a, b = read(first), read(second)
    if a.verb != b.verb:
        raise InputError(str(second), f"must be an answer of {a.verb}, as {first} is", got=b.verb)
    found = _runs(a, b) if a.verb == "simulate" else _rankings(a, b)
    document = {"separatrix_version": __version__, "verb": "compare", "of": a.verb, **plain(found)}
    text = json.dumps(document, indent=1, allow_nan=False) + "\n"
    folder = out or (None if as_json else Path("compare"))
    if folder is not None:
        with writable_folder(folder), staged(folder) as stage:
            (stage / "compare.json").write_text(text, encoding="utf-8")
            (stage / "compare.txt").write_text(harmless(in_words(found, folder)), encoding="utf-8")
            if a.verb == "simulate":
                names = (str(first), str(second)) if a.title == b.title else ("", "")  # else by their titles
                figures.save_all(figures.draw("compare", a.data, b.data, names=names), stage)
    answer(text if as_json else in_words(found, folder))
    return 0


def read(path: Path) -> Saved:
    """Return a saved answer of `simulate` or `rank` that has all that such an answer has."""
    from separatrix.figures.space import in_plane
    from separatrix.present import load

    here = [file for verb in VERBS if (file := path / f"{verb}.nc").exists()] if path.is_dir() else [path]
    if not here or not here[0].exists():
        cure = "Make one with: separatrix simulate STUDY --out DIR, or separatrix rank STUDY --out DIR."
        raise InputError(str(path), "does not contain a saved simulation or ranking", cure=cure)
    data = in_plane(load(here[0]))
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


def _runs(first: Saved, second: Saved) -> ComparedRuns:
    from separatrix.present.text.compare import ComparedRuns, Run

    def run(one: Saved) -> Run:
        names = ("kick", "run", "end_energy", "largest_offset", "largest_contact_force", "outcome")
        known = {name: _single(one.data, name) for name in names}
        return Run(**one.named, **known, largest_land_force=float(abs(one.data["land_force"]).max()))

    return ComparedRuns(runs=(run(first), run(second)), differences=tuple(differences(first, second)))


def _single(data: xr.Dataset, name: str) -> Any:
    return _or_none(data[name].item()) if name in data and data[name].size == 1 else None


def _or_none(value: Any) -> Any:
    """Return a value that was there: no NaN for a number, no empty text for a verdict."""
    is_absent = value == "" or (isinstance(value, float) and not math.isfinite(value))
    return None if is_absent else value


def _rankings(first: Saved, second: Saved) -> ComparedRankings:
    """Return the materials of two rankings, overall and in each environment that either has."""
    from separatrix.present.text.compare import ComparedRankings, Environment, Named, Pair, Standing

    def rows(data: xr.Dataset, prefix: str) -> dict[str, Standing]:
        columns = {name: data[prefix + name].values.tolist() for name in TABLED}
        return {
            str(material): Standing(**{name: _or_none(column[i]) for name, column in columns.items()})
            for i, material in enumerate(data["material"].values)
        }

    tables = []
    for data in (first.data, second.data):
        names = [str(name) for name in data["environment"].values]
        here = {name: rows(data.isel(environment=i), "material_") for i, name in enumerate(names)}
        tables.append({OVERALL: rows(data, "overall_")} | here)
    environments: list[Environment] = []
    for name in {**tables[0], **tables[1]}:
        one, other = (table.get(name, {}) for table in tables)
        pairs = [Pair(name=key, first=one.get(key), second=other.get(key)) for key in {**one, **other}]
        environments.append(Environment(name=name, materials=tuple(pairs)))
    return ComparedRankings(
        rankings=(Named(**first.named), Named(**second.named)),
        environments=tuple(environments),
        differences=tuple(differences(first, second)),
    )


def differences(first: Saved, second: Saved) -> Iterator[Difference]:
    """Yield each input that differs: keys of the study, then options of the command."""
    from separatrix.present.text.compare import Difference

    one, other = (dict(_all_inputs(saved)) for saved in (first, second))
    for key in {**one, **other}:
        a, b = one.get(key, (None, None)), other.get(key, (None, None))
        if a[0] != b[0]:
            yield Difference(key=key, first=a[0], second=b[0], unit=a[1] or b[1])


def _all_inputs(saved: Saved) -> Inputs:
    """Yield every input of an answer; of a simulation also kick and run, and the friction that it took."""
    yield from sorted(_inputs(saved.study), key=lambda pair: pair[0])
    taken = (("--kick", "kick", "m/s"), ("--run", "run", None), (FRICTION, "cage_ball_cage_friction", "-"))
    for key, name, unit in taken if saved.verb == "simulate" else ():
        if name in saved.data and saved.data[name].size == 1:
            yield key, (_single(saved.data, name), unit)


def _inputs(node: Mapping[str, Any], path: str = "") -> Inputs:
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


def _frictions(candidates: list[Any]) -> Inputs:
    for one in (one for one in candidates if isinstance(one, Mapping)):
        at = f"friction of {one.get('name')}"
        friction = one.get("friction")
        for environment, measured in friction.items() if isinstance(friction, Mapping) else ():
            if isinstance(measured, Mapping):
                yield f"{at} in {environment}", (measured.get("mean"), "-")
        if isinstance(one.get("material"), Mapping):
            yield from _inputs(one["material"], f"material of {one.get('name')}")
