"""Two answers of one verb compared: inputs, verdicts, results; or, of one question, whether they agree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from separatrix.comparing.records import (
    DIFFERENT,
    EXACT,
    ROUNDED,
    Agreement,
    Comparison,
    Difference,
    Differing,
    Named,
    is_number,
    names_verdict,
)
from separatrix.comparing.results import Nodes, differing, of_document, order
from separatrix.comparing.saved import DAMAGE, VERBS, Saved
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable

MOST_ROWS = 2000

FRICTION = "cage.ball_cage_friction"
"""Key of the pocket friction, which a study may leave to its candidates."""

BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""

Input = tuple[object, str | None]
"""Value of an input, and its unit."""

ROUNDING = 1e-9
"""Relative difference up to which numbers are equal to rounding; a change of an input is far larger."""

MOST_SHOWN = 20
IGNORED = ("separatrix_version", "provenance", "warnings", "units")
"""Keys of a document that are not the answer: warnings name the lines of files."""


def pair_of(first: Mapping[str, Saved], second: Mapping[str, Saved]) -> tuple[Saved, Saved, tuple[str, ...]]:
    """Answers of the first verb that both have, and the other verbs that they share; refused without one."""
    shared = [verb for verb in VERBS if verb in first and verb in second]
    if not shared:
        names = [next(iter(one.values())).path for one in (first, second)]
        rule = f"must be an answer of {' or '.join(first)}, as {names[0]} is"
        raise InputError(names[1], rule, got=", ".join(second))
    return first[shared[0]], second[shared[0]], tuple(shared[1:])


def compared(first: Saved, second: Saved, also: tuple[str, ...] = ()) -> Comparison:
    """Compare two answers of one verb: inputs, verdicts, and each result with its counting noise.

    Raises
    ------
    InputError
        They are of different verbs, or not as separatrix writes them.
    """
    verb = first.verb
    if verb != second.verb:
        raise InputError(second.path, f"must be an answer of {verb}, as {first.path} is", got=second.verb)
    studies = [_study(one) for one in (first, second)]
    nodes = [of_document(one.document) for one in (first, second)]
    found = list(differing(verb, *nodes))
    rows = sorted((row for row in found if row is not None), key=order)
    verdicts = tuple(row for row in rows if row.is_verdict)
    others = [row for row in rows if not row.is_verdict]
    named = (_named(first), _named(second))
    own = nodes[0].get((), {}).get("environment")
    inputs = [_inputs(one, study) for one, study in zip((first, second), studies, strict=True)]
    return Comparison(
        of=verb,
        answers=named,
        same_seed=named[0].seed is not None and named[0].seed == named[1].seed,
        differences=tuple(differences(*inputs)),
        verdicts=verdicts[:MOST_ROWS],
        shared_verdicts=_shared_verdicts(*nodes),
        rows=tuple(others[:MOST_ROWS]),
        unchanged=len(found) - len(rows),
        left_out=max(0, len(others) - MOST_ROWS) + max(0, len(verdicts) - MOST_ROWS),
        also=also,
        environment=own if isinstance(own, str) and nodes[1].get((), {}).get("environment") == own else None,
    )


def _shared_verdicts(first: Nodes, second: Nodes) -> int:
    both = ({(place, name) for place in nodes for name in nodes[place]} for nodes in (first, second))
    return sum(names_verdict(name) for _, name in set.intersection(*both))


def differences(first: Mapping[str, Input], second: Mapping[str, Input]) -> Iterator[Difference]:
    """Yield each input that differs between two sets of them."""
    for key in {**first, **second}:
        a, b = first.get(key, (None, None)), second.get(key, (None, None))
        if a[0] != b[0]:
            yield Difference(key=key, first=a[0], second=b[0], unit=a[1] or b[1])


def of_study(node: Mapping[str, object], path: str = "") -> Iterator[tuple[str, Input]]:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one its distribution."""
    if "value" in node:
        known, unit = node.get("distribution"), node.get("unit")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        is_plain = not words and isinstance(unit, str)
        yield path, (words or node["value"], str(unit) if is_plain else None)
        return
    if path and isinstance(node.get("name"), str):
        yield path, (node["name"], None)
    for key, item in node.items():
        if isinstance(item, Mapping) and key not in BESIDE:
            yield from of_study(item, f"{path}.{key}" if path else key)
        elif key == "candidates" and isinstance(item, list):
            for one in (one for one in item if isinstance(one, Mapping)):
                yield from _of_candidate(one)


def _of_candidate(candidate: Mapping[str, object]) -> Iterator[tuple[str, Input]]:
    friction, material = candidate.get("friction"), candidate.get("material")
    for environment, measured in friction.items() if isinstance(friction, Mapping) else ():
        if isinstance(measured, Mapping):
            yield f"friction of {candidate.get('name')} in {environment}", (measured.get("mean"), "-")
    if isinstance(material, Mapping):
        yield from of_study(material, f"material of {candidate.get('name')}")


def _study(saved: Saved) -> Mapping[str, object]:
    try:
        study = saved.document["study"]
        if isinstance(study, dict) and dict(of_study(study)):
            return study
    except DAMAGE:
        pass
    raise InputError(saved.path, "contains a study that separatrix did not write")


def _named(saved: Saved) -> Named:
    try:
        seed = int(str(saved.document["seed"]))
    except (KeyError, ValueError):
        raise InputError(saved.path, "lacks its seed") from None
    title = saved.document.get("title")
    if not isinstance(title, str) or not title.strip():
        raise InputError(saved.path, "lacks its title")
    return Named(path=saved.path, title=printable(title, 200), seed=seed)


def _inputs(saved: Saved, study: Mapping[str, object]) -> dict[str, Input]:
    """Inputs of an answer; of a simulation also kick and run, and the friction that it took."""
    found = dict(sorted(of_study(study), key=lambda pair: pair[0]))
    if saved.verb == "simulate":
        cage = saved.document.get("cage")
        friction = cage.get("ball_cage_friction") if isinstance(cage, dict) else None
        taken: dict[str, Input] = {
            "--kick": (saved.document.get("kick"), "m/s"),
            "--run": (saved.document.get("run"), None),
            FRICTION: (friction, "-"),
        }
        return found | {key: value for key, value in taken.items() if value[0] is not None}
    kept = saved.document.get("provenance")
    command = kept.get("command") if isinstance(kept, dict) else None
    options = command.get("question") if isinstance(command, dict) else None
    given = options.items() if isinstance(options, dict) else ()
    return found | {f"--{name}": (value, None) for name, value in given}


def agreement(stored: Mapping[str, object], computed: Mapping[str, object]) -> Agreement:
    """Compare two documents, but for the version and the provenance in them."""
    first, second = ({k: v for k, v in one.items() if k not in IGNORED} for one in (stored, computed))
    found = list(_differing(first, second, "", None))
    beyond = [one for one in found if one.relative is None or one.relative > ROUNDING]
    numbers = [one for one in found if one.relative is not None]
    largest = max(numbers, key=lambda one: one.relative or 0.0, default=None)
    return Agreement(
        agreement=DIFFERENT if beyond else ROUNDED if found else EXACT,
        largest_difference=None if largest is None else largest.relative,
        largest_at=None if largest is None else largest.key,
        differences=tuple(beyond[:MOST_SHOWN]),
        count=len(beyond),
    )


def _differing(a: object, b: object, key: str, scale: float | None) -> Iterator[Differing]:
    """Yield what differs; numbers of a list are compared with the largest of that list."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for name in {**a, **b}:
            at = f"{key}.{name}" if key else str(name)
            if name in a and name in b:
                yield from _differing(a[name], b[name], at, None)
            else:
                yield Differing(
                    key=at, stored=_short(a.get(name)), computed=_short(b.get(name)), relative=None
                )
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        size = max((abs(one) for one in (*a, *b) if is_number(one)), default=None)
        for i, (one, other) in enumerate(zip(a, b, strict=True)):
            yield from _differing(one, other, f"{key}[{i}]", size)
    elif a != b or isinstance(a, bool) != isinstance(b, bool):
        relative = None
        if is_number(a) and is_number(b):
            relative = abs(a - b) / (scale or max(abs(a), abs(b)))
        yield Differing(key=key, stored=_short(a), computed=_short(b), relative=relative)


def _short(value: object) -> object:
    if isinstance(value, Mapping):
        return f"{len(value)} keys"
    return f"{len(value)} values" if isinstance(value, list) else value
