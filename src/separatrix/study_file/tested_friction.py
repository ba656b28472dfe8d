"""Candidates of a study whose friction comes from tests: a friction file beside it, or a library table."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from math import exp, log
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.errors import InputError
from separatrix.friction.file import read_friction
from separatrix.friction.law import StatedFriction
from separatrix.friction.records import CONDITIONS, FrictionTest
from separatrix.library import FrictionTable
from separatrix.study import Candidate, Friction, RankingQuestion
from separatrix.study_file import values
from separatrix.study_file.document import Document
from separatrix.toml_values import folded, nearest
from separatrix.units import shown

if TYPE_CHECKING:
    from separatrix.friction.fit import TestedFriction

SUFFIX = ".toml"
DEFAULT_SCATTER = RankingQuestion.__dataclass_fields__["friction_scatter"].default


def tests_file(document: Document, name: str) -> Path | None:
    """Friction file beside the study that names it; None for the name of a library's table.

    Raises
    ------
    InputError
        It names a file that is not there.
    """
    if not name.endswith(SUFFIX) or "\0" in name:
        return None
    path = document.sections["ranking"]["friction"].folder / name
    if not _is_file(path):
        rule = "names no file beside the study"
        cure = "`separatrix tribometer FILES --out friction.toml` makes one from logs."
        raise InputError("[ranking] friction", rule, shown(name), cure)
    return path


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name too long for the file system
        return False


def scatter_of(given: dict[str, Any]) -> float:
    """Relative standard deviation that an unrepeated test is assumed to have [-]."""
    return float(given.get("friction_scatter", DEFAULT_SCATTER))


def question_of_tests(path: Path, given: dict[str, Any]) -> dict[str, Any]:
    """Environments and candidates of a friction file, in the order in which they are first tested."""
    tests = read_friction(path)
    known = tuple(dict.fromkeys(test.material for test in tests))
    chosen = chosen_materials(given, known, given["friction"])
    wanted = [test for test in tests if test.material in chosen]
    environments = tuple(dict.fromkeys(test.environment for test in wanted))
    scatter, source = scatter_of(given), _source(path)
    return {
        "environments": environments,
        "candidates": tuple(_candidate(name, environments, tests, scatter, source) for name in chosen),
    }


def chosen_materials(given: dict[str, Any], known: tuple[str, ...], name: str) -> tuple[str, ...]:
    """Materials that the study ranks, in any spelling; by default all that are known."""
    by_spelling = {folded(material): material for material in known}
    chosen = [by_spelling.get(folded(material), material) for material in given.get("materials", known)]
    for material in chosen:
        if material not in known:
            rule, cure = f"names a material that {name} lacks", nearest(material, known)
            raise InputError("[ranking] materials", rule, shown(material), cure)
    return tuple(chosen)


def _source(path: Path) -> str:
    return f"{path.name}, sha256 {hashlib.sha256(path.read_bytes()).hexdigest()[:16]}"


def _candidate(
    name: str, environments: tuple[str, ...], tests: tuple[FrictionTest, ...], scatter: float, source: str
) -> Candidate:
    from separatrix.friction.fit import TestedFriction  # which imports numpy: only for such studies

    tested = {test.environment for test in tests if test.material == name}
    laws = {
        env: TestedFriction(material=name, environment=env, tests=tests, default_scatter=scatter)
        for env in environments
        if env in tested
    }
    frictions = {env: _friction(laws[env], source) if env in laws else None for env in environments}
    library, kind = values.current_library(), "cage material"
    known = name in library.names(kind)
    elastic = library.material(kind, name, values.current_temperature()) if known else None
    return Candidate(name=name, friction=frictions, material=elastic)


def _friction(law: TestedFriction, source: str) -> Friction:
    """Mean over the tests, until the law predicts that at the pocket's conditions."""
    own = law.serving(values.current_temperature())
    if others := len(law.own) - len(own):
        source += f" ({others} of {len(law.own)} tests, at other temperatures, left out)"
    sources = "; ".join(dict.fromkeys(test.source for test in own if test.source))
    return Friction(
        mean=exp(sum(log(test.friction) for test in own) / len(own)),
        count=len(own),
        law=law,
        source=f"{source}: {sources}"[:2000] if sources else source,
        confidence="measured",
    )


def of_conditions(candidate: Candidate, table: FrictionTable, scatter: float) -> Candidate:
    """Candidate of a table, each friction with the conditions under which the table was measured."""
    return replace(
        candidate,
        friction={env: f and _stated(f, env, table, scatter) for env, f in candidate.friction.items()},
    )


def _stated(friction: Friction, environment: str, table: FrictionTable, scatter: float) -> Friction:
    medium, comma, _ = environment.partition(", ")
    known = {key: limits for key, limits in table.conditions.items() if key in CONDITIONS}
    law = StatedFriction(
        mean=friction.mean,
        standard_deviation=friction.standard_deviation,
        count=friction.count,
        ranges=known,
        medium=medium if comma else None,
        default_scatter=scatter,
    )
    return replace(friction, law=law)
