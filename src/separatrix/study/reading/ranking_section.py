"""The section [ranking]; the candidate and the environment of the study's own cage."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from math import exp, log
from os.path import isfile
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.friction.file import CONDITIONS, read_friction
from separatrix.friction.law import StatedFriction
from separatrix.friction.prediction import refuse_scatter_about_zero
from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.input_files import place
from separatrix.ground.toml import Reader, Values, build, folded, nearest, ratio, table, text, whole
from separatrix.ground.units import shown
from separatrix.study.candidates import NAMELESS
from separatrix.study.distribution import Normal
from separatrix.study.library.records import FrictionTable
from separatrix.study.reading.document import Document, Unfinished
from separatrix.study.reading.sections import record_of
from separatrix.study.reading.uncertain import Uncertain, friction_deviation, gathered, number, unwrapped
from separatrix.study.reading.values import context, known_name, material
from separatrix.study.study import CageDesign, Candidate, Friction, RankingQuestion

if TYPE_CHECKING:
    from separatrix.friction.fit import TestedFriction

MOST_CANDIDATES = 1000
DEFAULT_SCATTER = RankingQuestion.__dataclass_fields__["friction_scatter"].default
"""Relative standard deviation that an unrepeated test is assumed to have [-]."""

FROM_LOGS = " The friction file of your own logs (.toml) is written by `separatrix tribometer`."
FROM_BEARING = "that of [operation] fluid and of [bearing] ball_material or ring_material"


def ranking(document: Document, given: Values) -> RankingQuestion:
    """Build the question of a ranking from the converted keys of its section."""
    if any(key not in given for key in document.sections["ranking"]):
        raise Unfinished
    if "candidates" in given:
        environments, candidates = _in_place(document, given["candidates"])
    elif "friction" in given:
        environments, candidates = _of_tests(document, given)
    else:
        raise InputError("[ranking]", "lacks: friction (or candidates)")
    question: Values = {key: given[key] for key in ("friction_scatter", "environment") if key in given}
    if "environment" in given:
        known = {folded(name): name for name in environments}
        question["environment"] = known.get(folded(given["environment"]), given["environment"])
    question |= {"environments": environments, "candidates": candidates}
    return record_of(document, RankingQuestion, question)


def _of_tests(document: Document, given: Values) -> tuple[tuple[str, ...], tuple[Candidate, ...]]:
    """Environments and candidates of a friction file beside the study, or of a table of the library."""
    name, scatter = given["friction"], float(given.get("friction_scatter", DEFAULT_SCATTER))
    frictions: Mapping[str, Mapping[str, Friction | None]]
    if name.endswith(".toml"):
        environments, frictions = _of_file(place(document.friction_folder, name), given, scatter)
    else:
        name = known_name(name, "friction table", "[ranking] friction", FROM_LOGS)
        found = context().library.friction_table(name).content
        environments = found.columns
        frictions = {
            name: {env: f and _stated(f, env, found, scatter) for env, f in row.items()}
            for name, row in found.rows.items()
        }
    library, kind = context().library, "cage material"
    temperature, known = context().temperature, library.names(kind)
    candidates = [
        Candidate(
            name=material,
            friction=frictions[material],
            material=library.material(kind, material, temperature) if material in known else None,
        )
        for material in _chosen(given, tuple(frictions), name)
    ]
    return environments, tuple(candidates)


def _of_file(
    path: Path, given: Values, scatter: float
) -> tuple[tuple[str, ...], dict[str, dict[str, Friction | None]]]:
    """Environments and frictions of a friction file, in the order in which they are first tested."""
    from separatrix.friction.fit import TestedFriction  # which imports numpy: only for such studies

    if not isfile(path):
        rule = "names no file beside the study"
        cure = "`separatrix tribometer FILES --out friction.toml` makes one from logs."
        raise InputError("[ranking] friction", rule, shown(given["friction"]), cure)
    tests = read_friction(path)
    tested = tuple(dict.fromkeys((test.material, test.environment) for test in tests))
    known = tuple(dict.fromkeys(material for material, _ in tested))
    chosen = _chosen(given, known, given["friction"])
    environments = tuple(dict.fromkeys(env for material, env in tested if material in chosen))
    checksum = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
    frictions: dict[str, dict[str, Friction | None]] = {name: dict.fromkeys(environments) for name in known}
    for name, env in tested:
        if name in chosen:
            law = TestedFriction(material=name, environment=env, tests=tests, default_scatter=scatter)
            frictions[name][env] = _mean_of(law, f"{path.name}, sha256 {checksum}")
    return environments, frictions


def _chosen(given: Values, known: tuple[str, ...], name: str) -> tuple[str, ...]:
    """Materials that the study ranks, in any spelling; by default all known ones."""
    by_spelling = {folded(one): one for one in known}
    chosen = [by_spelling.get(folded(one), one) for one in given.get("materials", known)]
    if absent := [one for one in chosen if one not in known]:
        rule, cure = f"names a material that {name} lacks", nearest(absent[0], known)
        raise InputError("[ranking] materials", rule, shown(absent[0]), cure)
    return tuple(chosen)


def _mean_of(law: TestedFriction, source: str) -> Friction:
    """Mean over the tests, until the law predicts the friction at the conditions of the pocket."""
    own = law.serving(context().temperature)
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


def _stated(friction: Friction, environment: str, table: FrictionTable, scatter: float) -> Friction:
    """Friction of a table with the conditions under which the table was measured."""
    medium, comma, _ = environment.partition(", ")
    law = StatedFriction(
        mean=friction.mean,
        standard_deviation=friction.standard_deviation,
        count=friction.count,
        ranges={key: limits for key, limits in table.conditions.items() if key in CONDITIONS},
        medium=medium if comma else None,
        default_scatter=scatter,
    )
    return replace(friction, law=law)


def _in_place(document: Document, items: object) -> tuple[tuple[str, ...], tuple[Candidate, ...]]:
    if not isinstance(items, list) or not 0 < len(items) <= MOST_CANDIDATES:
        rule = f"must be 1 to {MOST_CANDIDATES} tables, each under [[ranking.candidates]]"
        raise InputError("[ranking] candidates", rule, shown(items))
    before = len(document.problems)
    candidates = []
    for i, item in enumerate(items, 1):
        with document.noting():
            candidates.append(_candidate(document, item, f"[ranking] candidates[{i}]"))
    if len(document.problems) > before:
        raise Unfinished
    environments = tuple(dict.fromkeys(env for item in candidates for env in item.friction))
    return environments, tuple(
        replace(item, friction={env: item.friction.get(env) for env in environments}) for item in candidates
    )


def _candidate(document: Document, item: object, at: str) -> Candidate:
    given, found = gathered(table(item, at, _CANDIDATE, ("name", "friction")))
    for key, one in found.items():
        document.distributions[f"ranking.{given['name']}.{key.removeprefix('friction.')}"] = one
    candidate = build(Candidate, given, at)
    if candidate.material is None or candidate.material.name != NAMELESS:
        return candidate
    return replace(candidate, material=replace(candidate.material, name=candidate.name))


def place_of_candidate(document: Document, name: str) -> str:
    """Return the path of an uncertain number, named by its candidate and its environment or property."""
    candidates = document.sections["ranking"]["candidates"]
    for i, item in enumerate(candidates if isinstance(candidates, list) else (), 1):
        places = {environment: f'friction."{environment[:60]}"' for environment in item["friction"]}
        if isinstance(item.get("material"), dict):
            places |= {place: place for place in (f"material.{key}" for key in item["material"])}
        if found := [place for inside, place in places.items() if name == f"{item['name']}.{inside}"]:
            return f"[ranking] candidates[{i}].{found[0]}"
    raise KeyError(name)


def _frictions(value: object, at: str) -> Uncertain:
    if not isinstance(value, dict) or not 0 < len(value) <= MOST_CANDIDATES:
        cure = 'Write it like { "liquid nitrogen, 440C" = 0.11 }.'
        got = f"{len(value)} of them" if isinstance(value, dict) else shown(value)
        rule = f"must be a table from environment to friction, with 1 to {MOST_CANDIDATES} entries"
        raise InputError(at, rule, got, cure)
    frictions: dict[str, Friction | Uncertain] = {}
    problems: list[InputError] = []
    for name, item in value.items():
        with noted(problems):
            environment = text(name, f"{at}, name of an environment,")
            frictions[environment] = _friction(item, f'{at}."{environment[:60]}"')
    if problems:
        raise together(problems)
    return Uncertain(*gathered(frictions))


def _friction(value: object, where: str) -> Friction | Uncertain:
    """Read a friction: a number, a table with mean, standard_deviation and count, or a distribution."""
    if isinstance(value, dict) and not {"between", "samples"} & set(value):
        readers: dict[str, Reader[object]] = {"mean": ratio, "standard_deviation": ratio, "count": whole}
        given = {**value, "standard_deviation": friction_deviation(value, where)}
        kept = {key: item for key, item in given.items() if key in value}
        stated = table(kept, where, {**readers, "source": text}, ("mean",))
        return refuse_scatter_about_zero(build(Friction, stated, where), where)
    mean, found = unwrapped(number("-")(value, where))
    if not found:
        return build(Friction, {"mean": mean}, where)
    deviation = found[""].standard_deviation
    known = build(Friction, {"mean": mean, "standard_deviation": deviation}, where)
    if isinstance(found[""], Normal):
        refuse_scatter_about_zero(known, where)
    return Uncertain(known, found)


_CANDIDATE: dict[str, Reader[object]] = {
    "name": text,
    "friction": _frictions,
    "material": material("cage material"),
}


def name_cage(document: Document, parts: Values) -> None:
    """Give the cage the candidate of its name."""
    cage: CageDesign | None = parts.get("cage")
    question: RankingQuestion | None = parts.get("ranking")
    given = document.sections.get("cage", {}).get("material")
    if cage is None or given is None or (question is None and "ranking" in document.sections):
        return
    name = given if isinstance(given, str) else cage.material.name if cage.material else ""
    known = {folded(candidate.name): candidate for candidate in question.candidates} if question else {}
    candidate = known.get(folded(name))
    if candidate is not None:
        material = candidate.material if isinstance(given, str) else None
        parts["cage"] = replace(cage, material=material or cage.material, material_name=candidate.name)
    elif cage.material is None:
        names = ", ".join(candidate.name for candidate in known.values())
        more = f" Candidates are {names}." if names else ""
        known_name(name, "cage material", "[cage] material", more)


def name_environment(parts: Values) -> bool:
    """Give the ranking the one environment that fits the bearing; return whether there is one.

    It is the environment of the bearing's fluid and balls, else of fluid and rings.
    """
    question, operation, bearing = (parts.get(name) for name in ("ranking", "operation", "bearing"))
    if question is None or operation is None or bearing is None or question.environment is not None:
        return False
    if len(question.environments) == 1 or operation.fluid is None:
        return False
    for surface in (bearing.ball_material.name, bearing.ring_material.name):
        found = [name for name in question.environments if _fits(name, operation.fluid, surface)]
        if len(found) == 1:
            parts["ranking"] = replace(question, environment=found[0])
            return True
    return False


def _fits(environment: str, fluid: str, surface: str) -> bool:
    """Whether an environment, "medium, counterface", has this fluid and, if it names one, this surface."""
    medium, comma, counterface = environment.partition(",")
    alike = not comma or _alike(counterface, surface, "bearing material")
    return alike and _alike(medium, fluid, "fluid")


def _alike(one: str, other: str, kind: str) -> bool:
    """Whether two names are of the same record, or the same where the library has no record."""
    library = context().library
    first, second = (library.named(kind, name.strip()) or folded(name) for name in (one, other))
    return first == second
