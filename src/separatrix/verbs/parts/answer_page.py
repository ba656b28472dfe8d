"""What every page begins and ends with: of what it is, its notes, its inputs with sources, its provenance."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import itemgetter
from typing import Any

from separatrix.ground.plain_data import Part
from separatrix.ground.quantity import Quantity, alone
from separatrix.present.blocks import Block, Column, Heading, Level, Note, Page, Table, facts, text_column
from separatrix.present.figure import Figure, Panel

MOST_NOTES = 3
"""Notes that are shown on a screen; they come with the gravest first."""

INTERRUPTED = "Interrupted: only what was finished is here."
PROPERTIES = ("elastic_modulus", "poisson_ratio", "density", "thermal_expansion")
INPUT = Quantity(label="", digits=7)

Json = Mapping[str, Any]
APPENDIX = Level.REPORT | Level.SHEET


def page_of(
    answer: Part, *blocks: Block, draws: bool = False, appendix: Level = APPENDIX, more: Sequence[str] = ()
) -> Page:
    """Return the page of an answer: what is asked, its blocks, its notes, inputs and provenance.

    `draws` says that the verb draws uncertain inputs; another takes them at their means, and says so.
    `appendix` is where inputs and provenance are shown; `more` is what a screen lacks of the blocks.
    """
    missing = [Note(INTERRUPTED)] if answer.get("complete") is False else []
    uncertain = ", ".join(one["name"] for one in answer.values["study"]["uncertain_inputs"])
    notes = [f"Uncertain inputs are at their means: {uncertain}."] if uncertain and not draws else []
    texts = [*notes, *answer.warnings]
    caveats = [Note(text, "caveat") for text in texts[:MOST_NOTES]]
    caveats += [Note(text, "caveat", Level.LONG) for text in texts[MOST_NOTES:]]
    rest = len(texts) - MOST_NOTES
    hidden = [*more, *([f"{rest} more note{'s' * (rest > 1)}"] if rest > 0 else [])]
    if hidden:
        caveats.append(Note(f"`--full` has {', '.join(hidden)}.", level=Level.BRIEF))
    return Page(
        answer.title,
        f"Study {answer.name}, computed by separatrix {answer.separatrix_version}",
        (*missing, *blocks, *caveats),
        tuple(sources(answer, appendix)),
    )


def sources(answer: Part, level: Level = APPENDIX) -> list[Block]:
    """Return inputs, materials and frictions with where each is from, and how to compute the answer again."""
    from separatrix.study.sources import inputs_of

    study = answer.values["study"]
    known = answer.values.get("provenance") or {}
    entries = tuple(inputs_of(study))
    columns = (
        text_column("input", lambda row: f"{row[0]}: {row[1].replace('_', ' ')}"),
        text_column("value", lambda row: entry_words(row[2])),
        text_column("given in", lambda row: row[2]["origin"]),
    )
    return [
        Heading("Inputs and their sources", level),
        Table("inputs", columns, entries, "Inputs of the study.", level),
        *_materials(study, level),
        *(_frictions(study["ranking"], level) if study.get("ranking") else []),
        Heading("Provenance", level),
        facts(
            ("Command", f"`{command(answer)}`"),
            ("Version of separatrix", answer.separatrix_version),
            ("Seed", str(answer.seed)),
            *((str(name), str(one)) for name, one in (known.get("versions") or {}).items()),
            *((f"SHA-256 of {name}", one.get("sha256")) for name, one in (known.get("files") or {}).items()),
            level=level,
        ),
    ]


def entry_words(entry: Json) -> str:
    """Return the value of an input, a material's name, or a list, with its distribution."""
    words = entry.get("name") or value_words(entry.get("value"), entry.get("unit") or "")
    if "value" in entry and str(entry.get("origin")).startswith("derived"):  # not a text of the study
        words = alone(entry["value"], replace(INPUT, digits=4), entry.get("unit") or "")
    return f"{words} ({entry['distribution']['words']})" if "distribution" in entry else str(words)


def value_words(value: Any, unit: str) -> str:
    """Return the value of an input."""
    if isinstance(value, list):
        if len(value) > 4:
            return f"{value_words(value[0], unit)} ... {value_words(value[-1], unit)} ({len(value)})"
        return ", ".join(value_words(one, unit) for one in value) or "-"
    if value is None or isinstance(value, bool) or not isinstance(value, int | float):
        return "-" if value is None else str(value)
    return f"{value:g}" if unit in ("", "-") else alone(value, INPUT, unit)


def _materials(study: Json, level: Level) -> list[Block]:
    """Return each material with its properties, how sure they are, and where they are from."""
    parts = [study.get(name) or {} for name in ("bearing", "film", "cage")]
    found = [one.get(key) for one in parts for key in ("ball_material", "ring_material", "material")]
    found += [one.get("material") for one in (study.get("ranking") or {}).get("candidates", [])]
    rows = {one["name"]: one for one in found if isinstance(one, dict) and one.get("name")}

    def words(key: str, row: Json) -> str:
        return entry_words(row.get(key) or {})

    properties = (text_column(key.replace("_", " "), partial(words, key)) for key in PROPERTIES)
    columns = (text_column("material", itemgetter("name")), *properties)
    caption = "Materials, at the temperature of the study."
    known = ((name, _source(one)) for name, one in rows.items() if one["source"])
    return [Table("materials", columns, tuple(rows.values()), caption, level), facts(*known, level=level)]


def _source(one: Json) -> str:
    """Return where a number is from, and how sure it is."""
    source, confidence = one["source"], one["confidence"]
    return str(source) if source == confidence else f"{source} ({confidence})"


def _frictions(ranking: Json, level: Level) -> list[Block]:
    frictions = friction_columns(ranking["environments"], itemgetter("friction"))
    columns = (text_column("candidate", itemgetter("name")), *frictions)
    caption = f"Friction of the candidates as measured, with standard deviation. From {ranking['origin']}."
    known = [one for row in ranking["candidates"] for one in row["friction"].values() if one is not None]
    origins = dict.fromkeys(_source(one) for one in known)
    table = Table("frictions", columns, tuple(ranking["candidates"]), caption, level)
    return [table, *(Note(f"Source of the frictions: {one}.", "legend", level) for one in origins)]


def friction_columns(places: Iterable[str], of: Callable[[Any], Json]) -> Iterator[Column]:
    """Return a column of measured frictions for each environment; `of` finds in a row its frictions."""

    def friction(place: str, row: Any) -> str:
        if (found := of(row).get(place)) is None:
            return "not measured"
        spread = found.get("standard_deviation")
        return f"{found['mean']:.3f}" + (f" \N{PLUS-MINUS SIGN} {spread:.2g}" if spread else "")

    return (text_column(place, partial(friction, place)) for place in places)


def command(answer: Part) -> str:
    """Return the command line that computes an answer again."""
    kept = answer.values.get("provenance") or {}
    model = ((answer.values.get("study") or {}).get("cage") or {}).get("model") or {}
    options = [str(model["origin"])] if is_chosen(model) else []
    for key, value in ((kept.get("command") or {}).get("question") or {}).items():
        flag = f"--{key.replace('_', '-')}"
        for one in value if isinstance(value, list) else [value]:
            if one not in (None, False):
                options += [flag] if one is True else [flag, shlex.quote(str(one))]
    return " ".join(["separatrix", answer.verb, shlex.quote(str(answer.name)), *options])


def is_chosen(model: Json) -> bool:
    """Whether the command chose the model of an answer, not its study."""
    return str(model.get("origin", "")).startswith("--")


def figure_heading(answer: Part, *more: str, varied: Sequence[str] = ()) -> tuple[str, ...]:
    """Return what stands above a figure: the title, and the operating point but for the inputs `varied`."""
    study, keys = answer.values["study"], [one.rpartition(".")[2] for one in varied]
    return answer.title, _listed("; ", operation_words(study, keys), coat_words(study, keys), *more)


def figure(
    answer: Part,
    *rows: tuple[Panel, ...],
    height: float,
    more: Sequence[str] = (),
    varied: Sequence[str] = (),
) -> Figure:
    """Return a figure of an answer below its heading."""
    return Figure(rows=rows, heading=figure_heading(answer, *more, varied=varied), height=height)


def _listed(between: str, *words: str | None) -> str:
    return between.join(filter(None, words))


# What the study of a document states, a fact a line.


def stated(study: Json, section: str, key: str, varied: Sequence[str] = ()) -> str:
    """Return an input of a resolved study as text; empty if there is none, if it is 0, or if it is varied."""
    entry = (study.get(section) or {}).get(key) or {}
    return entry_words(entry) if key not in varied and (entry.get("value") or entry.get("name")) else ""


def bearing_facts(answer: Part) -> list[tuple[str, str]]:
    """Return bearing, contact, operating point and film of an answer's study."""
    study = answer.values["study"]
    at = study["bearing"]
    balls = f"{at['ball_count']['value']} balls of {entry_words(at['ball_diameter'])}"
    bore = stated(study, "bearing", "bore")
    ball, ring = (at[f"{part}_material"]["name"] for part in ("ball", "ring"))
    steels = f"balls and rings {ball}" if ball == ring else f"balls {ball}, rings {ring}"
    grooves = ", ".join(f"{entry_words(at[f'{race}_conformity'])} {race}" for race in ("inner", "outer"))
    contact = f"{entry_words(at['contact_angle'])} without load; {steels}; groove radius over ball diameter"
    size = f"pitch diameter {entry_words(at['pitch_diameter'])}"
    traction = (f"{key.replace('_', ' ')} {one['value']}" for key, one in study["traction"].items())
    name = stated(study, "bearing", "designation")
    return [
        ("Bearing", _listed(", ", name, balls, size, bore and f"bore {bore}")),
        ("Contact angle", f"{contact} {grooves}"),
        ("Operation", operation_words(study)),
        ("Film on the races", film_words(study)),
        ("Traction", ", ".join(traction)),
    ]


def operation_words(study: Json, varied: Sequence[str] = ()) -> str:
    """Return speeds, loads and medium of a study, but for the inputs `varied`."""

    def each(*keys: str, words: str = "{1}") -> Iterator[str]:
        for key in keys:
            if text := stated(study, "operation", key, varied):
                yield words.format(key.partition("_")[0], text)

    speeds = each("inner_speed", "outer_speed", words="{0} ring {1}")
    loads = each("preload", "axial_load", "radial_load", "moment", words="{1} {0}")
    pair = each("arrangement", "preload_kind")
    return _listed("; ", ", ".join([*speeds, *loads, *pair]), " at ".join(each("fluid", "temperature")))


def coat_words(study: Json, varied: Sequence[str] = ()) -> str:
    """Return the film on the races; without its thickness if that is `varied`."""
    name = (study["film"].get("material") or {}).get("name") or "film"
    coat = _listed(", ", name, stated(study, "film", "thickness", varied))
    return "bare races" if study["film"]["is_bare"] else coat


def film_words(study: Json) -> str:
    """Return the film and the friction on the races."""
    worn = stated(study, "film", "wear.races")
    where = f"; worn on {'both races' if worn == 'both' else f'the {worn} race'}" if worn else ""
    return f"{coat_words(study)}; friction {entry_words(study['film']['race_friction'])}{where}"
