"""The answer to each question as plain data, under the names that scripts rely on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from separatrix.results.plain import plain, plain_record

if TYPE_CHECKING:
    from separatrix.study import Study

Document = dict[str, Any]


def document(verb: str, record: Any, study: Study, notes: Sequence[str]) -> Document:
    """Return the answer as plain data: SI units, no NaN, None where something is absent.

    Parameters
    ----------
    verb : str
        The question.
    record : record
        What was computed for it.
    study : Study
        What was asked; its resolved inputs go into the answer with their sources.
    notes : sequence of str
        What was said about validity on the way.
    """
    from separatrix import __version__
    from separatrix.study_file import resolved

    head = {
        "separatrix_version": __version__,
        "verb": verb,
        "name": study.name,
        "title": study.title,
        "study": plain(resolved(study), "study"),
        "seed": study.stability.seed,
        "warnings": list(notes),
    }
    return head | DOCUMENTS[verb](record)


def bearing(record: Any) -> Document:
    """Return a row for each ball, the ring's displacements, and the contacts of the most loaded ball."""
    return balls(record.equilibrium) | {"contacts": contacts(record)}


def balls(equilibrium: Any) -> Document:
    """Return an `Equilibrium` with its per-ball arrays turned into rows."""
    flat = plain_record(equilibrium, "equilibrium")
    columns = {name: flat.pop(name) for name, value in list(flat.items()) if isinstance(value, list)}
    rows = [
        {"ball": ball} | dict(zip(columns, values, strict=True))
        for ball, values in enumerate(zip(*columns.values(), strict=True))
    ]
    return {"balls": rows, "most_loaded": int(equilibrium.most_loaded)} | flat


def contacts(bearing_state: Any) -> Document:
    """Return ellipse, speeds and creep of the most loaded ball's contact with each race."""
    return {"inner": contact(bearing_state.inner), "outer": contact(bearing_state.outer)}


def contact(at: Any) -> Document:
    """Return one contact: everything in one level."""
    flat = plain_record(at, "contact")
    ellipse, creep = flat.pop("ellipse"), flat.pop("creep")
    return flat | ellipse | {f"creep_{name}": value for name, value in creep.items()}


def traction(record: Any) -> Document:
    """Return the traction curve of each race with its contact, and the curves at other ratios."""
    state = record.state
    return {
        "inner": _curve(state.bearing.inner, state.inner, record.inner_by_ratio),
        "outer": _curve(state.bearing.outer, state.outer, record.outer_by_ratio),
    }


def _curve(at: Any, curve: Any, others: Sequence[Any] = ()) -> Document:
    by_ratio = {"by_spin_roll_ratio": plain(others, "by_spin_roll_ratio")} if others else {}
    return contact(at) | plain_record(curve, "curve") | by_ratio


def restitution(record: Any) -> Document:
    """Return the restitution factor, the damping behind it, and the contacts with their slopes."""
    links = record.traction
    races = {"inner": links.inner, "outer": links.outer}
    return (
        plain_record(record.restitution, "restitution")
        | {"stiffness_source": record.stiffness_source}
        | {race: contact(getattr(links.bearing, race)) | _slope(curve) for race, curve in races.items()}
    )


def _slope(curve: Any) -> Document:
    names = ("slope", "slope_error", "free_rolling_offset")
    return {name: plain(getattr(curve, name), name) for name in names}


def stability(record: Any) -> Document:
    """Return the stability curve with its band, the linear limit, and the cage they hold for."""
    return plain_record(record.curve, "stability") | cage(record.cage)


def cage(state: Any) -> Document:
    """Return the cage, and what the chain found before it moves."""
    return {"chain": restitution(state.restitution), "cage": plain_record(state.cage, "cage")}


def ranking(record: Any) -> Document:
    """Return verdict, margin, rank and reason of each candidate, with the curve and the chain behind them."""
    return plain_record(record.ranking, "ranking") | cage(record.cage)


def _nothing(record: Any) -> Document:  # noqa: ARG001 - the answer is the study itself
    return {}


DOCUMENTS: Mapping[str, Callable[[Any], Document]] = {
    "check": _nothing,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "stability": stability,
    "rank": ranking,
}
