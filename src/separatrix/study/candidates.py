"""Candidates of a ranking and its environments: the schema of [ranking]; which of them the cage has."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import exp, log
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from separatrix.friction.friction_file import CONDITIONS, LEAST_FRICTION, FrictionFile
from separatrix.friction.friction_law import SCATTER_CURE, SCATTER_RULE, Friction, StatedFriction
from separatrix.ground.errors import InputError
from separatrix.ground.reader import Elsewhere, Reading, Refused, read_text
from separatrix.ground.schema import Fault, Faults, between, check, key, one_of, record
from separatrix.ground.toml import KeyPath, folded, label_of, nearest
from separatrix.ground.units import Kelvin, Ratio, shown
from separatrix.study.ball_bearing import NAMELESS, Material
from separatrix.study.library import FrictionTable, Library
from separatrix.study.uncertain import NORMAL, deviation_of, helper_of, number, temperature_of

if TYPE_CHECKING:
    from separatrix.friction.friction_fit import TestedFriction
    from separatrix.study.study import Study

FROM_LOGS = " The friction file of your own logs (.toml) is written by `separatrix tribometer`."
MOST_CANDIDATES = 1000


def read_friction_value(raw: Any, path: KeyPath, reading: Reading) -> Friction:
    """A friction: a number, a table with mean, standard_deviation and count, or a distribution."""
    if isinstance(raw, dict) and "between" not in raw:
        given, width = dict(raw), raw.get("standard_deviation")
        if isinstance(width, str) and "%" in width:
            given["standard_deviation"] = deviation_of(width, raw.get("mean"), "-")
        stated = reading.record(Friction, given, path)
        return _above_zero(stated)
    mean, found = number(raw, "-")
    if found is None:
        return reading.record(Friction, {"mean": mean}, path)
    known = reading.record(Friction, {"mean": mean, "standard_deviation": found.standard_deviation}, path)
    reading.distributions[path] = found
    return _above_zero(known) if found.kind == NORMAL else known


def _above_zero(friction: Friction) -> Friction:
    if friction.standard_deviation and friction.mean < LEAST_FRICTION:
        raise InputError(".mean", SCATTER_RULE, f"{friction.mean:g}", SCATTER_CURE)
    return friction


@record
class Candidate:
    """A candidate cage material with its friction in each environment; None where it was not measured."""

    name: str = key(example='"My compound"')
    friction: Mapping[str, Friction | None] = key(
        item=read_friction_value,
        length=(1, MOST_CANDIDATES),
        hint='Write it like { "liquid nitrogen, 440C" = 0.11 }.',
        example='{ "liquid nitrogen, 440C" = 0.12 }',
    )
    """By environment, "medium, counterface"."""

    material: Material | None = key(default=None, named="cage material")


@check(Candidate)
def _something_was_measured(name: str, friction: Mapping[str, Friction | None]) -> Faults:
    if all(value is None for value in friction.values()):
        yield Fault("friction", f'of "{name}" has no measured value', got="")


@record
class RankingQuestion:
    """Which candidates to rank, in which environments."""

    environments: tuple[str, ...]
    candidates: tuple[Candidate, ...]
    environment: str | None = None
    """The bearing's own: the headline of a ranking, and the column of the cage's friction."""

    friction_scatter: Ratio = key(between(1e-3, 1.0), default=0.09, certain=True, hint="0.09 is 9 %.")
    """Standard deviation that an unrepeated test is assumed to have, as a share of its mean: a guess."""


@check(RankingQuestion)
def _names_differ(candidates: tuple[Candidate, ...], environments: tuple[str, ...]) -> Faults:
    """Results are keyed by names."""
    for name, found in (("candidates", [one.name for one in candidates]), ("environments", [*environments])):
        if not found:
            yield Fault(name, "must not be empty", got="")
        for twice in sorted({one for one in found if found.count(one) > 1}):
            yield Fault(name, "must have different names", got=f'"{twice}" twice')


@check(RankingQuestion)
def _environments_are_measured(
    environments: tuple[str, ...], candidates: tuple[Candidate, ...], environment: str | None
) -> Faults:
    for candidate in candidates:
        for name in sorted(set(candidate.friction) - set(environments)):
            rule = f'of "{candidate.name}" must be in the environments of the question'
            yield Fault("candidates", rule, got=f'"{name}"')
    if environment is not None and environment not in environments:
        cure = f"Known: {'; '.join(environments)}."
        yield Fault("environment", "must be one in which candidates were measured", cure)


@record
class RankingSection:
    """Which cage materials to rank, by measured frictions: a table, a file, or stated here."""

    RULES: ClassVar = (one_of(("friction", "materials"), "candidates", required=True),)

    friction: str | None = key(default=None, example='"pin-on-disk-77K"', without="not given: candidates are")
    """A friction table of the library, or a friction file."""

    environment: str | None = key(default=None, without="not given, and none fits the bearing")
    """Of this bearing; by default the one that fits its fluid and its steel."""

    materials: tuple[str, ...] = key(
        default=(),
        length=(1, MOST_CANDIDATES),
        without="all of the table",
        needs=("friction", "there is nothing to choose from"),
    )
    """Those of the table that are ranked."""

    friction_scatter: Ratio = key(between(1e-3, 1.0), default=0.09, certain=True, hint="0.09 is 9 %.")
    """Standard deviation that an unrepeated test is assumed to have, as a share of its mean: a guess."""

    candidates: tuple[Candidate, ...] = key(default=(), length=(1, MOST_CANDIDATES))
    """Your own, instead of friction and materials."""


def read_ranking(raw: Any, path: KeyPath, reading: Reading) -> RankingQuestion:
    """Question of the section: a table or file of frictions becomes candidates."""
    section = reading.record(RankingSection, raw, path)
    if section.friction is not None:
        environments, candidates = _tested(section, (*path, "friction"), reading)
    else:
        environments = tuple(dict.fromkeys(env for one in section.candidates for env in one.friction))
        candidates = tuple(_in_place(one, environments) for one in section.candidates)
    environment, known = section.environment, {folded(name): name for name in environments}
    if environment is not None:
        environment = known.get(folded(environment), environment)
    values = {
        "environments": environments,
        "candidates": candidates,
        "environment": environment,
        "friction_scatter": section.friction_scatter,
    }
    return reading.checked(RankingQuestion, values, path)


def _in_place(candidate: Candidate, environments: Sequence[str]) -> Candidate:
    """The candidate in every environment; its material has its name where it has none."""
    material = candidate.material
    if material is not None and material.name == NAMELESS:
        material = replace(material, name=candidate.name)
    friction = {env: candidate.friction.get(env) for env in environments}
    return replace(candidate, friction=friction, material=material)


def _tested(
    section: RankingSection, path: KeyPath, reading: Reading
) -> tuple[tuple[str, ...], tuple[Candidate, ...]]:
    """Environments and candidates of a friction file beside the study, or of a table of the library."""
    helper, name, temperature = helper_of(reading), section.friction or "", temperature_of(reading)
    at = path
    frictions: Mapping[str, Mapping[str, Friction | None]]
    try:
        if name.endswith(".toml"):
            content = reading.document.file(path, name, FrictionFile.FILE)
            environments, frictions = _of_file(content, section, temperature)
        else:
            name = helper.known(name, "friction table", FROM_LOGS)
            found = helper.library.record("friction table", name).content
            environments = found.columns
            frictions = {
                row: {env: f and _stated(f, env, found, section.friction_scatter) for env, f in each.items()}
                for row, each in found.rows.items()
            }
        at = (*path[:-1], "materials")
        chosen = _chosen(section, tuple(frictions), name)
    except InputError as error:
        reading.refuse(at, error)
        raise Refused from None
    library, kind = helper.library, "cage material"
    known = library.names(kind)
    materials = {one: library.material(kind, one, temperature) for one in chosen if one in known}
    candidates = (Candidate(name=one, friction=frictions[one], material=materials.get(one)) for one in chosen)
    return environments, tuple(candidates)


def _of_file(
    content: str | None, section: RankingSection, temperature: Kelvin | None
) -> tuple[tuple[str, ...], dict[str, dict[str, Friction | None]]]:
    """Environments and frictions of a friction file, in the order in which they are first tested."""
    from separatrix.friction.friction_fit import TestedFriction  # which imports numpy: only for such studies

    label = label_of(Path(section.friction or ""))
    if content is None:
        cure = "`separatrix tribometer FILES --out friction.toml` makes one from logs."
        raise InputError("", "names no file beside the study", shown(section.friction), cure)
    try:
        tests = read_text(FrictionFile, content, label).value.test
    except InputError as error:
        raise Elsewhere(error) from None
    tested = tuple(dict.fromkeys((test.material, test.environment) for test in tests))
    known = tuple(dict.fromkeys(material for material, _ in tested))
    wanted = {folded(one) for one in section.materials or known}
    chosen = [one for one in known if folded(one) in wanted]
    environments = tuple(dict.fromkeys(env for material, env in tested if material in chosen))
    source = f"{label}, sha256 {hashlib.sha256(content.encode()).hexdigest()[:16]}"
    frictions: dict[str, dict[str, Friction | None]] = {name: dict.fromkeys(environments) for name in known}
    for name, env in tested:
        if name in chosen:
            scatter = section.friction_scatter
            law = TestedFriction(material=name, environment=env, tests=tests, default_scatter=scatter)
            frictions[name][env] = _mean_of(law, source, temperature)
    return environments, frictions


def _chosen(section: RankingSection, known: tuple[str, ...], name: str) -> tuple[str, ...]:
    """Materials that the study ranks, in any spelling; by default all known ones."""
    by_spelling = {folded(one): one for one in known}
    chosen = [by_spelling.get(folded(one), one) for one in section.materials or known]
    if absent := [one for one in chosen if one not in known]:
        rule, cure = f"names a material that {name} lacks", nearest(absent[0], known)
        raise InputError("", rule, shown(absent[0]), cure)
    return tuple(chosen)


def _mean_of(law: TestedFriction, source: str, temperature: Kelvin | None) -> Friction:
    """Mean over the tests, until the law predicts the friction at the conditions of the pocket."""
    own = law.serving(temperature)
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


def candidate_named(study: Study, given: object) -> str | None:
    """Name of the candidate that [cage] material, as the file has it, names in any spelling; or None."""
    own = study.cage.material if study.cage else None
    name = given if isinstance(given, str) else own.name if own is not None else ""
    candidates = study.ranking.candidates if study.ranking else ()
    return {folded(one.name): one.name for one in candidates}.get(folded(name))


def fitting_environment(study: Study, library: Library) -> str | None:
    """The one environment that fits the bearing's fluid and balls, else its fluid and rings; or None."""
    question, fluid = study.ranking, study.operation.fluid
    if question is None or question.environment is not None or fluid is None:
        return None

    def alike(one: str, other: str, kind: str) -> bool:
        first, second = (library.named(kind, name.strip()) or folded(name) for name in (one, other))
        return first == second

    for surface in (study.bearing.ball_material.name, study.bearing.ring_material.name):
        found = []
        for name in question.environments:
            medium, comma, counterface = name.partition(",")
            is_surface = not comma or alike(counterface, surface, "bearing material")
            if is_surface and alike(medium, fluid, "fluid"):
                found.append(name)
        if len(found) == 1:
            return found[0]
    return None


def cage_candidate(study: Study) -> Candidate | None:
    """Candidate that [cage] material names, else the only one; None if the study states none."""
    candidates = study.ranking.candidates if study.ranking else ()
    name = _name(study)
    if not name and len(candidates) == 1:
        return candidates[0]
    return next((candidate for candidate in candidates if candidate.name == name), None)


def reference_candidate(study: Study, question: RankingQuestion) -> Candidate:
    """Candidate whose eta and curve are the bearing's in a ranking: the cage's, else the first one."""
    return cage_candidate(study) or question.candidates[0]


def other_than_candidates(study: Study, question: RankingQuestion) -> str:
    """Sentence on a cage whose material is not a candidate: the curve is another's; else empty."""
    given = study.cage.material if study.cage else None
    if given is None or cage_candidate(study) is not None:
        return ""
    name = "[cage] material" if given.name == NAMELESS else f"[cage] material {given.name}"
    shown_for = question.candidates[0].name
    return f"{name} is none of the candidates: the curve, and the eta beside it, are those of {shown_for}."


def environment_of(question: RankingQuestion) -> str | None:
    """Return the stated environment, else the only one; None if the study states none."""
    alone = question.environments[0] if len(question.environments) == 1 else None
    return question.environment or alone


def required_environment(study: Study, question: RankingQuestion) -> str:
    """Return the environment of the bearing."""
    found = environment_of(question)
    if found is None:
        at, fluid = study.bearing, study.operation.fluid or "(none)"
        steels = " or ".join(dict.fromkeys((at.ball_material.name, at.ring_material.name)))
        rule = f"is missing: none, or more than one, matches [operation] fluid {fluid} and {steels}"
        names = " or ".join(f'"{name}"' for name in question.environments)
        where = f"{study.place('ranking.friction', 'ranking.candidates')}: [ranking] environment"
        raise InputError(where, rule, cure=f"Write environment = {names}.")
    return found


def require_friction(study: Study) -> None:
    """Refuse a study whose cage has no known friction, with the missing key and its alternatives."""
    if study.cage is not None and study.cage.ball_cage_friction is not None:
        return
    where = f"{study.place('cage.material', 'cage.pocket_clearance')}: [cage] ball_cage_friction"
    if study.ranking is None:
        raise InputError(where, "is missing", cure="Give it, or [ranking] with measured frictions.")
    candidate, named = cage_candidate(study), _name(study)
    if candidate is None:
        who = f"{shown(named)} is not a candidate" if named else "[cage] material does not name a candidate"
        names = ", ".join(one.name for one in study.ranking.candidates)
        cure = f"Give it, or name a candidate as [cage] material: {names}."
        raise InputError(where, f"is missing, and {who}", cure=cure)
    environment = required_environment(study, study.ranking)
    if candidate.friction.get(environment) is None:
        rule = f"is missing: {candidate.name} was not measured in {environment}"
        raise InputError(where, rule, cure="Give it.")


def _name(study: Study) -> str:
    """Name of the cage's material; empty without one."""
    if study.cage is None:
        return ""
    material = study.cage.material
    return study.cage.material_name or (material.name if material and material.name != NAMELESS else "")


def ranking_question(study: Study) -> RankingQuestion:
    """Return the question of [ranking], or refuse a study without candidates."""
    if study.ranking is None or not study.ranking.candidates:
        cure = 'Write friction = "pin-on-disk-77K" there, or [[ranking.candidates]].'
        raise InputError(study.name, "lacks the section [ranking] with candidate materials", cure=cure)
    return study.ranking
