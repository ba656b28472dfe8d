"""What stands above a picture: the study, its medium and film, and which run was drawn."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from separatrix.units import format_quantity

WIDTH = 122
"""Letters on a line over the width of a page."""

LINE = 0.135
"""Height of a line [inch]."""

RANDOM = ("stability", "map", "rank", "sensitivity", "sweep")
"""Verbs whose answer depends on the seed, besides that of a single run."""


def headed(figure: Figure, data: xr.Dataset) -> Figure:
    """Write above a figure what it was made from; nothing if the dataset does not say it."""
    lines = heading(data)
    if lines:
        width, height = figure.get_size_inches()
        figure.set_size_inches(width, height + LINE * len(lines))
        figure.suptitle("\n".join(lines), x=0.008, ha="left", fontsize=7.0, linespacing=1.35)
    return figure


def heading(data: xr.Dataset, width: int = WIDTH) -> list[str]:
    """Return the title of the study, what it runs in and on, and which run this is; each a line or two.

    Parameters
    ----------
    data : Dataset
        Of any verb, from `literal_texts`; what its attributes do not say is left out.
    width : int
        Most letters of a line.
    """
    study = json.loads(data.attrs.get("study", "{}"))
    around, which, one = list(surroundings(study)), which_run(data, study), "outcome" in data
    parts = [str(data.attrs.get("title", "")), "; ".join([*around, *([] if one or not which else [which])])]
    parts += [which] if one else []
    return [line for part in parts for line in cut(part, width)]


def cut(text: str, width: int) -> list[str]:
    """Return a text on at most two lines."""
    return textwrap.wrap(text, width, max_lines=2, placeholder=" ...")


def surroundings(study: Mapping[str, Any]) -> Iterator[str]:
    """Yield medium, speed and load, and film, as far as the study says them."""
    operation, film = study.get("operation", {}), study.get("film", {})
    fluid, temperature = known(operation, "fluid"), known(operation, "temperature")
    medium = [str(fluid)] if fluid else []
    medium += [format_quantity(temperature, "K")] if temperature else []
    if medium:
        yield ", ".join(medium)
    for key, words in (("inner_speed", "inner ring"), ("outer_speed", "outer ring")):
        if known(operation, key):
            yield f"{words} {format_quantity(known(operation, key), 'rad/s')}"
    for key, words in (("axial_load", "axial"), ("radial_load", "radial")):
        if known(operation, key):
            yield f"{format_quantity(known(operation, key), 'N')} {words}"
    if film.get("is_bare", not film):
        yield from ("bare races",) if film else ()
    else:
        yield f"{name_of(film, 'material')}, {format_quantity(known(film, 'thickness'), 'm')}"


def known(section: Mapping[str, Any], key: str) -> Any:
    """Return a value of a section of a resolved study; None if it is not there."""
    return section.get(key, {}).get("value")


def name_of(section: Mapping[str, Any], key: str) -> str:
    """Return the name of a material in a section; "" without one."""
    record = section.get(key) or {}
    return str(record.get("name") or record.get("value") or "")


OUTCOMES = {
    "SETTLES": "the cage settles",
    "WHIRLS": "the cage whirls",
    "DRIFTS": "the cage drifts off",
    "UNRESOLVED": "unresolved",
}
"""How a run ended, in words."""


def which_run(data: xr.Dataset, study: Mapping[str, Any]) -> str:
    """Return friction, kick, number and seed of a run and how it ended; of an ensemble the seed."""
    seed = f"seed {int(data.attrs['seed'])}" if "seed" in data.attrs else ""
    if "outcome" not in data:
        return seed if data.attrs.get("verb") in RANDOM else ""
    parts = [f"kick {float(data['kick']):g} m/s"]
    if "run" in data:
        parts.append(f"run {int(data['run'])}")
    parts += [seed] if seed else []
    word, length = str(data["outcome"].values), 1e3 * float(data["time"].values[-1])
    end = f"{OUTCOMES.get(word, word)} (run of {length:.4g} ms)"
    return f"{friction(data, study)}{', '.join(parts)}: {end}"


def friction(data: xr.Dataset, study: Mapping[str, Any]) -> str:
    """Return the pocket's friction of a run, and whose it is."""
    if "cage_ball_cage_friction" not in data:
        return ""
    whose = candidate(study) or name_of(study.get("cage", {}), "material")
    value = float(data["cage_ball_cage_friction"])
    return f"pocket friction {value:.3g}{f' ({whose})' if whose else ''}, "


def candidate(study: Mapping[str, Any]) -> str:
    """Return the candidate and the environment that the cage's friction is of; "" if it is given."""
    entry = study.get("cage", {}).get("ball_cage_friction", {})
    whose = entry.get("candidate")
    return f"{whose} in {entry['environment']}" if whose else ""
