"""Provenance of an answer: every resolved input with its origin, the question, the files, the versions."""

from __future__ import annotations

import base64
import hashlib
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import separatrix
from separatrix.friction.file import FrictionTest
from separatrix.ground.errors import InputError
from separatrix.ground.input_files import MOST_BYTES, MOST_FILES, Reading, checksum_of_name, refuse_unsafe
from separatrix.ground.units import unit_of
from separatrix.study.candidates import cage_candidate, environment_of
from separatrix.study.distribution import Distribution, described
from separatrix.study.keys import study_numbers
from separatrix.study.reading.document import SECTIONS as EVERY_SECTION
from separatrix.study.study import (
    SECTIONS,
    CageDesign,
    Film,
    Friction,
    Material,
    RankingQuestion,
    Study,
    Wear,
    with_models,
)

_SCALED = "2.5 x cage speed x half the pocket clearance, at least 0.05 m/s"

_WITHOUT = {
    "bearing.bore": "not given; only the DN figure needs it",
    "operation.moment": "not given: the rings are held and carry any moment",
    "operation.tilt": "default: the rings are held parallel",
    "film.material": "default: bare races",
    "film.thickness": "default: bare races",
    "film.wear": "default: not worn",
    "cage.ball_cage_stiffness": "default: Hertz, ball in pocket, at the impact speed",
    "cage.impact_speed": f"default: {_SCALED}",
    "cage.ball_cage_friction": "default: that of its material in [ranking] environment",
    "cage.pocket_axial_clearance": "not given: that of the shape",
    "cage.pocket_angles": "default: evenly spaced",
    "cage.land_clearance": "not given: no land",
    "ranking.environment": "not given, and none fits the bearing",
    "stability.kicks": "default: 0.2, 1 and 4 times the reference kick",
    "stability.reference_kick": f"default: {_SCALED}",
    "stability.restitution_factors": "default: chosen where the curve bends",
    "cage.mass": "not given: that of the ring's shape",
    "cage.moment_of_inertia": "default: of the ring's shape, or a thin ring at the pitch diameter",
    "cage.transverse_inertia": "default: of the ring's shape, or half that about the axis",
    "cage.land_diameter": "default: of the ring's shape, or the pitch diameter",
}
"""Meaning of an absent value, where it is more than "not given"."""


def resolved(study: Study) -> dict[str, Any]:
    """Resolved inputs as plain nested dicts: numbers, text, lists and None only.

    Each quantity is ``{"value": ..., "unit": ..., "origin": ...}``, in SI. The origin is the place and text
    in the study file, or ``"default"``. An uncertain one has its mean as value, and a ``"distribution"``;
    ``"uncertain_inputs"`` lists them all. Each material has its source, its confidence and its whole record
    in the library, with the checksum of the file: a later change of the library changes nothing here.
    """
    known = study_numbers(study) if study.distributions else {}
    uncertain = [
        {"name": key, "unit": known[key].unit or None, **_distribution(one, known[key].unit)}
        for key, one in study.distributions.items()
    ]
    return {
        "name": study.name,
        "title": study.title,
        **{name: _section(study, name) for name in SECTIONS},
        "kinematics": {"model": _with_origin(study, "kinematics.model", {"value": study.kinematics.value})},
        "ranking": None if study.ranking is None else _ranking(study, study.ranking),
        "uncertain_inputs": uncertain,
    }


def inputs_of(found: Mapping[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield section, key and entry of every input of a resolved study that has an origin."""
    for section in EVERY_SECTION:
        for key, entry in (found[section] or {}).items():
            if isinstance(entry, dict) and "origin" in entry:
                yield section, key, entry


def _section(study: Study, section: str) -> dict[str, object] | None:
    record = getattr(study, section)
    if record is None:
        return None
    names = [f.name for f in fields(record) if f.name != "material_name"]
    values: dict[str, object] = {name: _value(study, record, section, name) for name in names}
    if isinstance(record, Film):
        values["is_bare"] = record.material is None
        if record.wear is not None:
            del values["wear"]
            names = [f.name for f in fields(Wear)]
            values |= {f"wear.{name}": _value(study, record.wear, "film.wear", name) for name in names}
    if isinstance(record, CageDesign):  # whose friction the cage has, where it has not its own
        candidate = None if record.ball_cage_friction is not None else cage_candidate(study)
        values["ball_cage_friction"] = {
            **_value(study, record, section, "ball_cage_friction"),
            "candidate": candidate.name if candidate else None,
            "environment": environment_of(study.ranking) if study.ranking and candidate else None,
        }
    return values


def _value(study: Study, record: object, section: str, name: str) -> dict[str, object]:
    value, unit, key = getattr(record, name), unit_of(type(record), name), f"{section}.{name}"
    if isinstance(value, Material):
        inside = f"{section if section == 'film' else key}."
        own = {name.removeprefix(inside): one for name, one in study.distributions.items()}
        return _with_origin(study, key, _material(value, own))
    plain = value.value if isinstance(value, Enum) else list(value) if isinstance(value, tuple) else value
    item = {"value": plain, **({"unit": unit} if unit else {})}
    if key in study.records:
        item["record"] = study.records[key]
    if key in study.distributions:
        item["distribution"] = _distribution(study.distributions[key], unit)
    return _with_origin(study, key, item)


def _distribution(one: Distribution, unit: str) -> dict[str, object]:
    names = ("kind", "mean", "standard_deviation", "low", "high")
    item = {name: getattr(one, name) for name in names}
    return {**item, "words": described(one, unit), "written": one.text or None}


def _with_origin(study: Study, key: str, item: Mapping[str, object]) -> dict[str, object]:
    """The item with its origin; a study without any was built in Python."""
    origin = study.origins.get(key)
    if origin is None:
        origin = "default" if study.origins else "given in Python"
        if item.get("value", 0) in (None, []):
            origin = _WITHOUT.get(key, "not given")
            if key == "operation.tilt" and not study.operation.is_tilt_held:
                origin = "free: the inner ring tilts until the balls balance the moment"
    return {**item, "origin": origin}


def _material(material: Material, distributions: Mapping[str, Distribution]) -> dict[str, object]:
    numbers: dict[str, dict[str, object]] = {}
    for name in ("elastic_modulus", "poisson_ratio", "density", "compressive_strength", "thermal_expansion"):
        unit = unit_of(Material, name)
        numbers[name] = {"value": getattr(material, name), "unit": unit}
        if name in distributions:
            numbers[name]["distribution"] = _distribution(distributions[name], unit)
    return {
        "name": material.name,
        **numbers,
        "source": material.source,
        "confidence": material.confidence,
        "cautions": list(material.cautions),
        "record": None if material.record is None else dict(material.record),
    }


def _ranking(study: Study, question: RankingQuestion) -> dict[str, object]:
    from separatrix.friction.fit import TestedFriction

    candidates = [
        {
            "name": candidate.name,
            "friction": {env: f and _friction(f) for env, f in candidate.friction.items()},
            "material": candidate.material and _material(candidate.material, {}),
        }
        for candidate in question.candidates
    ]
    laws = [f.law for one in question.candidates for f in one.friction.values() if f is not None]
    tests = next((law.tests for law in laws if isinstance(law, TestedFriction)), ())
    ranked = {candidate.name for candidate in question.candidates}
    item = {
        "environments": list(question.environments),
        "environment": _value(study, question, "ranking", "environment"),
        "candidates": candidates,
        "friction_scatter": _value(study, question, "ranking", "friction_scatter"),
        "table": study.records.get("ranking.friction"),
        # of the materials that are not ranked: the scatter is pooled over all tests of the file
        "other_tests": [_test(test) for test in tests if test.material not in ranked],
    }
    key = "ranking.candidates" if "ranking.candidates" in study.origins else "ranking.friction"
    return _with_origin(study, key, item)


def _friction(friction: Friction) -> dict[str, object]:
    """A friction, and every test behind it if it comes from a friction file."""
    from separatrix.friction.fit import TestedFriction

    names = ("mean", "standard_deviation", "count", "source", "confidence")
    item: dict[str, object] = {name: getattr(friction, name) for name in names}
    if isinstance(friction.law, TestedFriction):
        item["tests"] = [_test(test) for test in friction.law.own]
    return item


def _test(test: FrictionTest) -> dict[str, object]:
    """A friction test in SI units; pairs are the lowest and the highest value."""
    values = ((f.name, getattr(test, f.name)) for f in fields(test))
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values}


KEPT, ASKED = "provenance.files", "provenance.command"
"""Records of a study: the files that it was read from, and the question."""

SHIPPED = "shipped:"
"""Before the name of a file that comes with the package: its checksum is kept, not its content."""

ELSEWHERE = "elsewhere-"
"""Before the number of a folder that is named by an absolute path."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """Files of a study by relative names with slashes, or the reason why there are none."""

    entry: str | None = None
    files: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    links: Mapping[str, str] = field(default_factory=dict)
    """Name of each absolute path that a file names."""

    reason: str | None = None
    as_read: Study | None = None
    """The study as its files have it."""


def keep(study: Study, path: Path, reading: Reading) -> Study:
    """Return a study with the files that it was just read from."""
    return replace(study, records={**study.records, KEPT: _kept(path, reading, study)})


def _kept(path: Path, reading: Reading, study: Study) -> Kept:
    own: dict[Path, bytes] = {}
    shipped = {name: {"sha256": checksum} for name, checksum in _checksums("study/library/data").items()}
    for file, content in reading.files.items():
        if name := _shipped_name(file):
            shipped[name] = {"sha256": _sha256(content)}
        else:
            own[file] = content
    if len(own) > MOST_FILES or sum(map(len, own.values())) > MOST_BYTES:
        most = f"{MOST_FILES}, or larger than {MOST_BYTES >> 20} MB"
        return Kept(reason=f"The files of the study are more than {most}.", as_read=study)
    if entry := _shipped_name(path):
        return Kept(entry=entry, files=shipped, as_read=study)
    try:
        names = _Names(path, own, reading.absolute)
        files = {names.of(file): _content(content) for file, content in own.items()}
        links = {checksum_of_name(name): names.of(Path(name)) for name in reading.absolute}
        entry = names.of(path)
        for name in files:
            refuse_unsafe(name)
    except ValueError as error:  # InputError is one
        apart = "The files of the study have no folder in common."
        return Kept(reason=f"{error}" if isinstance(error, InputError) else apart, as_read=study)
    return Kept(entry=entry, files={**files, **shipped}, links=links, as_read=study)


class _Names:
    """Relative names of files, by which they name each other as they do in their folders.

    The root is the deepest folder of all but the files that are named by an absolute path elsewhere. Raises
    ValueError if there is no such folder but that of the whole drive.
    """

    def __init__(self, entry: Path, files: Iterable[Path], absolute: Iterable[str]) -> None:
        home = _absolute(entry).parent
        far = {_absolute(Path(name)).parent for name in absolute}
        far = {one for one in far if not any(one != two and one.is_relative_to(two) for two in far)}
        paths = [_absolute(file) for file in files]
        near = [one for one in paths if one.is_relative_to(home) or not any(map(one.is_relative_to, far))]
        self.root = Path(os.path.commonpath([home, *(one.parent for one in near)]))
        if self.root.parent == self.root != home:
            raise ValueError
        self.far = sorted(one for one in far if not one.is_relative_to(self.root))

    def of(self, file: Path) -> str:
        """Name of a file or folder."""
        path = _absolute(file)
        if path.is_relative_to(self.root):
            return path.relative_to(self.root).as_posix()
        for number, folder in enumerate(self.far, start=1):
            if path.is_relative_to(folder):
                return f"{ELSEWHERE}{number}/{path.relative_to(folder).as_posix()}"
        raise ValueError


def _absolute(path: Path) -> Path:
    """Path without ``..``; a link on the way must not change its target."""
    found = Path(os.path.abspath(path))
    if found != path and not (found.exists() and found.samefile(path)):
        raise ValueError
    return found


def _content(raw: bytes) -> dict[str, str]:
    """Content of a file as JSON can have it, byte for byte."""
    try:
        return {"sha256": _sha256(raw), "text": raw.decode("utf-8")}
    except UnicodeDecodeError:
        return {"sha256": _sha256(raw), "base64": base64.b64encode(raw).decode("ascii")}


def _sha256(raw: bytes) -> str:
    return hashlib.sha256(raw).hexdigest()


_PACKAGE = Path(separatrix.__file__).resolve().parent


def _shipped_name(path: Path) -> str | None:
    is_shipped = path.resolve().parent in (_PACKAGE / "examples", _PACKAGE / "study/library/data")
    return f"{SHIPPED}{path.name}" if is_shipped else None


@cache
def _checksums(folder: str) -> dict[str, str]:
    paths = sorted((_PACKAGE / folder).glob("*.toml"))
    return {f"{SHIPPED}{path.name}": _sha256(path.read_bytes()) for path in paths}


def shipped_checksums() -> dict[str, str]:
    """Checksum of every shipped file of this version by its name in an answer."""
    return _checksums("study/library/data") | _checksums("examples")


def asked_by(
    study: Study, verb: str, question: Mapping[str, object], reading: Reading | None = None
) -> Study:
    """Return the study with the options of a verb as they were given, for `provenance_of`.

    `reading` has the files that were read to answer, such as a table of cases.
    """
    given, files = dict(question), dict[str, Mapping[str, str]]()
    table = given.get("cases")
    if isinstance(table, Path):
        content = None if reading is None else reading.files.get(table)
        name = f"cases/{table.name}"
        given["cases"] = name
        files = {} if content is None else {name: _content(content)}
    return replace(study, records={**study.records, ASKED: (verb, given, files)})


def provenance_of(study: Study, verb: str) -> dict[str, object]:
    """Return, as plain data, all that is needed to compute an answer of a verb again."""
    _, question, more = study.records.get(ASKED, (verb, {}, {}))
    origins = {name: study.origins.get(f"cage.{name}", "").partition(" ") for name in ("motion", "ball")}
    # those that the command line chose in place of those of the study
    models = {name: value for name, (option, _, value) in origins.items() if option == f"--{name}"}
    found: Kept | None = study.records.get(KEPT)
    if found is None:
        found = Kept(reason="The study was made in Python, not read from a file.")
    elif found.as_read is not None and found.reason is None:
        expected = with_models(found.as_read, models) if models else found.as_read
        if expected != study:
            found = Kept(reason="The study was changed in Python after it was read.")
    return {
        "command": {"verb": verb, "question": question, "models": models},
        "entry": found.entry,
        "files": dict(found.files) | (dict(more) if found.entry else {}),
        "links": dict(found.links),
        "reason": found.reason,
        "versions": versions(),
    }


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages that compute, without separatrix."""
    return {"python": platform.python_version()} | {one: version(one) for one in ("numpy", "scipy", "numba")}
