"""Two answers of one verb compared."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from separatrix.comparing.inputs import FRICTION, all_inputs, differences, of_study
from separatrix.comparing.records import Comparison, Named
from separatrix.comparing.results import differing, of_dataset, of_document, order
from separatrix.comparing.saved import VERBS, Saved
from separatrix.errors import InputError
from separatrix.units import printable

MOST_ROWS = 2000


def pair_of(first: Mapping[str, Saved], second: Mapping[str, Saved]) -> tuple[Saved, Saved, tuple[str, ...]]:
    """Answers of the first verb that both have, and the other verbs that they share.

    Raises
    ------
    InputError
        They share no verb.
    """
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
        They are of different verbs, or one has only its document and the other only its dataset.
    """
    verb = first.verb
    if verb != second.verb:
        raise InputError(second.path, f"must be an answer of {verb}, as {first.path} is", got=second.verb)
    studies = [_study(one) for one in (first, second)]
    if first.document is not None and second.document is not None:
        nodes = [of_document(one.document or {}) for one in (first, second)]
    elif first.data is not None and second.data is not None:
        nodes = [of_dataset(one.data) for one in (first, second) if one.data is not None]
    else:
        cure = "Name the folders, or two files of one kind."
        raise InputError(second.path, f"must have a {'document' if first.document else 'dataset'}", cure=cure)
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
        rows=tuple(others[:MOST_ROWS]),
        unchanged=len(found) - len(rows),
        left_out=max(0, len(others) - MOST_ROWS) + max(0, len(verdicts) - MOST_ROWS),
        also=also,
        environment=own if isinstance(own, str) and nodes[1].get((), {}).get("environment") == own else None,
    )


def _study(saved: Saved) -> dict[str, Any]:
    """Return the resolved study of an answer."""
    try:
        given = saved.document["study"] if saved.document is not None else _attribute(saved, "study")
        study = dict(given)
        if dict(of_study(study)):
            return study
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, RecursionError):
        pass
    raise InputError(saved.path, "contains a study that separatrix did not write")


def _attribute(saved: Saved, name: str) -> Any:
    return json.loads(saved.data.attrs.get(name, "null")) if saved.data is not None else None


def _head(saved: Saved) -> Mapping[str, Any]:
    if saved.document is not None:
        return saved.document
    return saved.data.attrs if saved.data is not None else {}


def _named(saved: Saved) -> Named:
    head = _head(saved)
    try:
        seed = int(head["seed"])
    except (KeyError, TypeError, ValueError, OverflowError):
        raise InputError(saved.path, "lacks its seed") from None
    title = head.get("title")
    if not isinstance(title, str) or not title.strip():
        raise InputError(saved.path, "lacks its title")
    return Named(path=saved.path, title=printable(title, 200), seed=seed)


def _inputs(saved: Saved, study: Mapping[str, Any]) -> dict[str, tuple[Any, str | None]]:
    """Inputs of an answer; of a simulation also kick and run, and the friction that it took."""
    if saved.verb == "simulate":
        known = {key: _single(saved, key) for key in ("kick", "run")}
        taken = {f"--{key}": (value, "m/s" if key == "kick" else None) for key, value in known.items()}
        return all_inputs(study, {}, {**taken, FRICTION: (_single(saved, "ball_cage_friction", "cage"), "-")})
    try:
        kept = saved.document.get("provenance") if saved.document else _attribute(saved, "provenance")
    except ValueError:
        kept = None
    command = kept.get("command") if isinstance(kept, dict) else None
    options = command.get("question") if isinstance(command, dict) else None
    return all_inputs(study, options if isinstance(options, dict) else {}, {})


def _single(saved: Saved, name: str, section: str = "") -> Any:
    """Return one number of an answer; None if it lacks it."""
    if saved.document is not None:
        node = saved.document.get(section, {}) if section else saved.document
        return node.get(name) if isinstance(node, dict) else None
    key = f"{section}_{name}" if section else name
    has = saved.data is not None and key in saved.data and saved.data[key].size == 1
    return saved.data[key].item() if has and saved.data is not None else None
