"""Study files: TOML whose every dimensional value is text with its unit.

Keys and rules are those of the records (`study.Study` is the schema); docs/reference/study-file.md has them.
What is valid, but outside the range of the model or of real bearings, is noted.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from os.path import exists, isfile
from pathlib import Path
from typing import Any

from separatrix.ground.errors import InputError, together
from separatrix.ground.reader import Document, Loaded, document_of, read_document
from separatrix.ground.schema import Made, built, defaults_of
from separatrix.ground.toml import KeyPath, label_of, path_text, read_text
from separatrix.ground.units import Kilogram, format_quantity, printable, shown
from separatrix.study.cage_design import half_play, tilt
from separatrix.study.candidates import candidate_named, environment_of, fitting_environment
from separatrix.study.keys import MOST_DISTRIBUTIONS, settled_in
from separatrix.study.library import BESIDE, Content, Library, contradictions, joined, library_of_text
from separatrix.study.study import CageDesign, CageModel, Guidance, MotionModel, Study, shipped_studies
from separatrix.study.uncertain import Distribution, StudyHelper, written

STEEP = 0.5
"""Sine of the lean of a pocket's contact from which the cage is pushed along the axis as well: 30 deg."""

NAMED = 3
"""Materials with the same caution that are named; `check --full` shows all."""

MOST_DN = 3e6
"""Bore in mm times speed in rpm; the fastest turbopump bearings reach about this."""

MOST_RACE_FRICTION = 1.0
"""Dry metals in vacuum reach it; a solid lubricant stays below 0.3."""

POLYMER = (900.0, 2200.0)
"""Densities from polyethylene to filled PTFE [kg/m3]."""

SECTION = ((0.2, 1.1), (0.7, 2.2))
"""Height and width of a cage's section over the ball diameter: the lightest and the heaviest."""


def cautions(study: Study) -> Iterator[str]:
    """Sentences to warn with."""
    cage, operation = study.cage, study.operation
    yield from _material_cautions(study)
    if study.fluid is not None and operation.temperature is not None:
        for sentence in contradictions(study.fluid, operation.temperature):
            yield f"[operation] fluid {sentence}"
    if cage is not None:
        yield from _cage_cautions(study, cage)
    yield from beyond_bearings(study)


def _material_cautions(study: Study) -> Iterator[str]:
    """One sentence on materials whose sources state another temperature, or none."""
    acting = [study.bearing.ball_material, study.bearing.ring_material, study.film.body]
    if study.cage is not None and study.cage.ball_cage_stiffness is None:
        candidates = study.ranking.candidates if study.ranking is not None else ()
        acting += [study.cage.material, *(candidate.material for candidate in candidates)]
    alike: dict[tuple[str, ...], list[str]] = {}
    for material in acting:
        if material is not None and material.cautions:
            names = alike.setdefault(material.cautions, [])
            names += [] if material.name in names else [material.name]
    said = []
    for sentences, names in alike.items():
        properties: dict[str, list[str]] = {}  # by their caution
        for sentence in sentences:
            name, _, words = sentence.partition(": ")
            properties.setdefault(words, []).append(name)
        short = "; ".join(f"{', '.join(each)}: {words}" for words, each in properties.items())
        more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
        said.append(f"{', '.join(names[:NAMED])}{more} ({short})")
    if said:
        yield f"Data of the library: {'; '.join(said)}. Consider your own."


def _cage_cautions(study: Study, cage: CageDesign) -> Iterator[str]:
    """Sentences on numbers of the land that the study does not state, and on a pocket that leans."""
    assumed = {
        "land_stiffness": format_quantity(cage.land_stiffness, "N/m"),
        "land_restitution": f"{cage.land_restitution:g}",
        "land_friction": f"{cage.land_friction:g}",
    }
    absent = [f"{key} {text}" for key, text in assumed.items() if f"cage.{key}" not in study.origins]
    if absent and cage.guidance is not Guidance.BALL:
        verb = "is assumed: a guess" if len(absent) == 1 else "are assumed: guesses"
        yield f"[cage] {', '.join(absent)} {verb}, on which the motion on the land depends."
    if cage.motion_model is MotionModel.PLANE and abs(tilt(cage)[1]) > STEEP:
        play = format_quantity(half_play(cage), "m", 3)
        yield (
            "[cage] pocket_axial_offset: the contacts lean by more than 30 deg towards the bearing axis; the "
            f"model holds the cage in its plane and keeps only the play along the circumference, +/- {play}."
        )


def beyond_bearings(study: Study) -> Iterator[str]:
    """Sentences on a speed, a race friction or a cage mass that real bearings do not have."""
    bearing, operation, cage, friction = study.bearing, study.operation, study.cage, study.film.race_friction
    rpm = abs(operation.inner_speed - operation.outer_speed) * (30.0 / math.pi)
    if (dn := 1e3 * (bearing.bore or bearing.pitch_diameter) * rpm) > MOST_DN:
        which = "pitch diameter" if bearing.bore is None else "bore"
        yield (
            f"[operation] DN {dn / 1e6:.3g} million ({which} in mm times speed in rpm) exceeds "
            f"{MOST_DN / 1e6:g} million: no ball bearing is known to run so fast."
        )
    if friction > MOST_RACE_FRICTION:
        yield (
            f"[film] race_friction {friction:g} exceeds {MOST_RACE_FRICTION:g}: solid lubricants stay below "
            "0.3, dry metal below about 1."
        )
    low, high = plausible_cage_masses(study)
    if cage is not None and cage.mass is not None and not low <= cage.mass <= high:
        named = cage.material is not None and cage.material.density is not None
        what = f"a ring of {cage.material.name}" if named and cage.material else "a polymer ring"
        (thin, narrow), (thick, wide) = SECTION
        yield (
            f"[cage] mass {format_quantity(cage.mass, 'kg')} does not fit the bearing: {what} around these "
            f"balls, {thin:g} to {thick:g} ball diameters high and {narrow:g} to {wide:g} wide, has "
            f"{format_quantity(low, 'kg', 2)} to {format_quantity(high, 'kg', 2)}."
        )


def plausible_cage_masses(study: Study) -> tuple[Kilogram, Kilogram]:
    """Least and largest mass of a ring around the balls, of its material's density or of a polymer's.

    Its volume is that of a ring at the pitch circle less a hole for each ball.
    """
    material = study.cage.material if study.cage is not None else None
    density = material.density if material is not None else None
    masses, D, bearing = [], study.bearing.ball_diameter, study.bearing
    for rho, (height, width) in zip(POLYMER if density is None else (density, density), SECTION, strict=True):
        full = math.pi * bearing.pitch_diameter * width * D
        volume = max(full - bearing.ball_count * math.pi / 4.0 * D**2, 0.25 * full) * height * D
        masses.append(rho * volume)
    return masses[0], masses[1]


FROM_BEARING = "that of [operation] fluid and of [bearing] ball_material or ring_material"
ONLY = "the only one in which candidates were measured"
LIBRARY = "library "
"""Before the number and the name of a library file that a study keeps: no path of a value begins so."""

DERIVED = (
    ("bearing.radial_clearance", "radial_clearance", ("bearing.contact_angle",)),
    ("bearing.contact_angle", "contact_angle", ("bearing.radial_clearance",)),
    ("film.elastic_modulus", "elastic_modulus", ("film.material",)),
)
"""A key, its name, and what follows from it where it is given."""


def read_study(study: str | Path, model: str | None = None) -> Study:
    """Study of a file, or of the shipped example of that name.

    Parameters
    ----------
    study : str or Path
        Path of the file, or name of the example.
    model : str, optional
        "full" or "paper", in place of that of the file. The study is checked with it.

    Raises
    ------
    InputError
        Everything that is wrong with the file, a line each: place, rule, value, cure. Or the model is not
        known, or there is no cage to have it.
    """
    document = document_of(Study, path := find(study))
    cage, asked = document.data.get("cage"), {}
    if model is not None:
        if model not in (known := [str(one.value) for one in CageModel]):
            raise InputError("--model", f"must be one of {', '.join(known)}", shown(model))
        asked = {"cage.model": f"--model {model}"}
        if isinstance(cage, dict):
            cage["model"] = model
    # a folder of answers has this name: never dots alone
    name = printable(path.stem if path.stem.strip(".") else path.name, 100)
    built_study, notes = _study_of(document, name, library_of(document), asked)
    if model is not None:
        require(built_study, "--model", "cage")
    return built_with(built_study, notes=(*notes, *cautions(built_study)))


def study_again(content: Mapping[str, Any]) -> Study:
    """Study of the content that an answer kept.

    Raises
    ------
    InputError
        The content is not that of a study, or names a file that is not kept.
    """
    files: Mapping[str, str] = content["files"]
    libraries = [(text, name.partition(": ")[2]) for name, text in files.items() if name.startswith(LIBRARY)]
    library = joined([library_of_text(*one) for one in libraries])
    document = Document(content["name"], content["data"], {}, files=dict(files), is_kept=True)
    study, _ = _study_of(document, content["name"], library, {})
    return built_with(study, origins=content["origins"])


def _study_of(
    document: Document, name: str, library: Library, asked: Mapping[str, str]
) -> tuple[Study, tuple[str, ...]]:
    """Study of a document, and notes on what has no effect in it or is left out.

    `asked` has the origins of values that the command line put into the document.
    """
    loaded = read_document(Study, document, StudyHelper(library))
    study = loaded.value
    values: dict[str, Any] = {
        "name": name,
        "title": study.title or name,
        "origins": {**_origins(loaded, document), **asked},
    }
    data = {key: one for key, one in document.data.items() if key not in ("extends", "library")}
    values["content"] = {"name": name, "data": data, "files": document.files, "origins": values["origins"]}
    fluid, table = library.fluid(study.operation.fluid or ""), document.written(("ranking", "friction"))
    values["fluid"] = None if fluid is None else fluid.plain()
    if known := library.named("friction table", table if isinstance(table, str) else ""):
        values["friction_table"] = library.record("friction table", known).plain()
    if study.cage is not None:
        named = candidate_named(study, document.written(("cage", "material")))
        values["cage"] = built_with(study.cage, material_name=named)
    only = environment_of(study.ranking) if study.ranking and study.ranking.environment is None else None
    if environment := only or fitting_environment(study, library):
        values["ranking"] = built_with(study.ranking, environment=environment)
        values["origins"]["ranking.environment"] = ONLY if only else FROM_BEARING
    return _with_distributions(built_with(study, **values), loaded, document), loaded.notes


def built_with(record: Made, **changes: object) -> Made:
    """A record with other values that no check concerns."""
    return built(type(record), {name: getattr(record, name) for name in defaults_of(type(record))} | changes)


def _where(document: Document, path: KeyPath) -> str:
    return f"{document.place(path)}: {document.name(path)}"


def _with_distributions(study: Study, loaded: Loaded[Study], document: Document) -> Study:
    """The study with the distributions of its uncertain numbers, each fitting its place."""
    found = loaded.distributions
    if len(found) > MOST_DISTRIBUTIONS:
        rule = f"has more than {MOST_DISTRIBUTIONS} uncertain numbers"
        cure = "Make those certain that matter least."
        raise InputError(document.label, rule, str(len(found)), cure)
    settled: dict[str, Distribution] = {}
    problems: list[InputError] = []
    for path, one in found.items():
        name = number_name(study, path)
        try:
            if name in settled:
                raise InputError("", "has the name of another uncertain number", name, "Rename a candidate.")
            settled[name] = settled_in(study, name, one)
        except InputError as error:
            problems.append(error.at(_where(document, path)))
    if problems:
        raise together(problems)
    return built_with(study, distributions=settled)


def number_name(study: Study, path: KeyPath) -> str:
    """Name of a number of a study (`study.keys`) by its path in a file."""
    parts = [str(part) for part in path]
    if parts[:2] == ["film", "material"]:
        del parts[1]
    if parts[:2] == ["ranking", "candidates"] and study.ranking is not None:
        rest = parts[4:] if parts[3] == "friction" else parts[3:]
        parts = ["ranking", study.ranking.candidates[int(path[2])].name, *rest]
    return ".".join(parts)


def _origins(loaded: Loaded[Study], document: Document) -> dict[str, str]:
    """Place and text of every given key of a section, and what follows from others."""
    origins: dict[str, str] = {}
    for path, place in loaded.places.items():
        if len(path) != 2 and path[:2] != ("film", "wear"):
            continue
        value = document.written(path)
        is_plain = not isinstance(value, dict | list | None) or path in loaded.distributions
        origins[".".join(map(str, path))] = place + (f": {written(value)}" if is_plain else "")
    for key, name, follows in DERIVED:
        if key in origins:
            origins = dict.fromkeys(follows, f"derived, from {name}, {origins[key]}") | origins
    return origins


def find(study: str | Path) -> Path:
    """Path of a study file, or of the shipped example of that name.

    A regular file of that very name comes first; a folder does not hide a shipped example.
    """
    text = str(study)
    if not text or "\0" in text:
        raise InputError("STUDY", "must be a path or a name", shown(text), _shipped_names(text))
    if isfile(text):
        return Path(text)
    if text in shipped_studies():
        return shipped_studies()[text]
    if not exists(text):
        raise InputError(path_text(Path(text)), "does not exist", cure=_shipped_names(text))
    return Path(text)


def _shipped_names(text: str) -> str:
    names = list(shipped_studies())
    near = get_close_matches(text[:80], names, 1, 0.6)
    return f"Did you mean {near[0]}?" if near else f"Shipped examples: {', '.join(names)}."


def library_of(document: Document) -> Library:
    """Library of a study: the shipped records, and those of a file beside it and of files named in it."""
    paths: list[Path] = []
    for study, data in document.chain:
        ours = study.parent / BESIDE
        if study not in shipped_studies().values() and ours.is_file() and ours.resolve() != study.resolve():
            paths.append(ours)
        given = data.get("library", [])
        for name in given if isinstance(given, list) else [given]:
            if isinstance(name, str) and name.isprintable() and name:  # else the schema refuses it
                if not isfile(study.parent / name):
                    where = f"{document.place(('library',))}: library"
                    cure = "It is taken from the folder of the study."
                    raise InputError(where, "does not name a file", shown(name), cure)
                paths.append(study.parent / name)
    contents = []
    for number, path in enumerate(dict.fromkeys(path.resolve() for path in paths), 1):
        text = read_text(path, Content.FILE)
        document.files[f"{LIBRARY}{number}: {label_of(path)}"] = text
        contents.append(library_of_text(text, label_of(path)))
    return joined(contents)


def require(study: Study, verb: str, *sections: str) -> None:
    """Refuse a study that lacks a section which a verb needs.

    Raises
    ------
    InputError
        Names the missing sections, the verb, and where to see what they look like.
    """
    missing = [f"[{section}]" for section in sections if getattr(study, section) is None]
    if missing:
        rule = f"is missing; `{verb}` needs it" if len(missing) == 1 else f"are missing; `{verb}` needs them"
        raise InputError(f"{study.name}: {' and '.join(missing)}", rule, cure="See `separatrix new`.")
