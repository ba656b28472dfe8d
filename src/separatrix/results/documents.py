"""The answer to each question as plain data, under the names that scripts rely on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from separatrix.results import maps, sensitivity
from separatrix.results.plain import null_if_not_finite, plain, plain_record
from separatrix.results.sweep import sweep

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

    with null_if_not_finite() as left_out:
        body = DOCUMENTS[verb](record)
    head = {
        "separatrix_version": __version__,
        "verb": verb,
        "name": study.name,
        "title": study.title,
        "study": plain(resolved(study), "study"),
        "seed": study.stability.seed,
        "warnings": [*notes, *_overflown(left_out)],
    }
    head["warnings"] += body.pop("warnings", [])
    return head | body


def _overflown(left_out: Sequence[str]) -> list[str]:
    """Return a sentence on the numbers that are not finite, which the answer leaves out."""
    if not left_out:
        return []
    more = f" and {len(left_out) - 1} more" if left_out[1:] else ""
    return [
        f"A number is not finite and is left out: {left_out[0]}{more}. The inputs are far from those of a "
        "bearing, or this is a fault of separatrix."
    ]


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
    return {**flat, **ellipse, **{f"creep_{name}": value for name, value in creep.items()}}


def traction(record: Any) -> Document:
    """Return contact, traction curve, curves at other ratios, and shear of each race."""
    return {
        "race_friction": record.race_friction,
        "inner": _curve(record.bearing.inner, record.inner, record.inner_others, record.inner_shear),
        "outer": _curve(record.bearing.outer, record.outer, record.outer_others, record.outer_shear),
    }


def _curve(at: Any, curve: Any, others: Sequence[Any], shear: Any) -> Document:
    """Return one race; the curves at other ratios are at the same increments as its own."""
    names = ("spin_roll_ratio", "slope", "slope_error", "traction_coefficient")
    by_ratio = [{name: plain(getattr(other, name), name) for name in names} for other in others]
    parts = {"by_spin_roll_ratio": by_ratio, "shear": plain_record(shear, "shear")}
    return contact(at) | plain_record(curve, "curve") | parts


def restitution(record: Any) -> Document:
    """Return the restitution factor with its intermediates, and what other films would give."""
    other = record.lubrication
    curve = {} if other is not None else {"lubrication_reason": "The study names no film material."}
    return (
        before_cage(record.state)
        | {"film_thickness_here": record.film_thickness, "lubrication": plain(other, "lubrication")}
        | curve
    )


def before_cage(record: Any) -> Document:
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
    """Return the cage, and what the chain found before it moves; how balls lead and lag beside their play."""
    orbits = {
        "half_play": plain(state.cage.half_play),
        "lead_amplitude": plain(state.cage.lead_amplitude),
        "orbital_share": plain(state.orbital_share),
    }
    return {"chain": before_cage(state.restitution) | orbits, "cage": plain_record(state.cage, "cage")}


def simulation(record: Any) -> Document:
    """Return the course of one run, how it ended, and the cage."""
    from separatrix.cage.closed_forms import drift_rate_law

    history = record.history
    return (
        {
            "kick": record.kick,
            "run": record.run,
            "outcome_sentence": outcome_sentence(history),
            "largest_offset": plain(np.hypot(*history.position.T).max()),
            "largest_contact_force": plain(np.abs(history.contact_force).max()),
            "drift_rate_law": plain(drift_rate_law(record.cage.cage)),
            "rubbing_power": plain(
                record.cage.cage.land_friction * history.rubbing_force * history.rubbing_speed
            ),
        }
        | plain_record(history, "history")
        | cage(record.cage)
    )


def outcome_sentence(history: Any) -> str:
    """Return where the motion of a run ends, in words."""
    from separatrix.cage.planar import OUTCOME_SENTENCES
    from separatrix.cage.reason import CAUSES

    cause = CAUSES.get(history.cause)
    return OUTCOME_SENTENCES[history.outcome] + (f" Cause: {cause}." if cause else "")


def ranking(record: Any) -> Document:
    """Return verdict, margin, rank and reason of each candidate, with the curve and the chain behind them."""
    answer = plain_record(record.ranking, "ranking")
    return answer | {"warnings": answer.pop("notes")} | cage(record.cage)


def stability_map(record: Any) -> Document:
    """Return a map, with the chain and the cage of the study itself."""
    return maps.stability_map(record.map, cage(record.cage))


def uncertain_ranking(record: Any) -> Document:
    """Return probabilities with their intervals, the main sources of uncertainty, and the cage's chain."""
    return sensitivity.sensitivity(record, cage(record.cage))


def check(record: Any) -> Document:
    """Return the contacts at standstill; the rest of the answer is the study itself."""
    at_rest = None if record.static is None else contacts(record.static)
    return {"static": at_rest, "static_reason": record.static_reason}


DOCUMENTS: Mapping[str, Callable[[Any], Document]] = {
    "check": check,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "stability": stability,
    "map": stability_map,
    "simulate": simulation,
    "rank": ranking,
    "sensitivity": uncertain_ranking,
    "sweep": sweep,
}
