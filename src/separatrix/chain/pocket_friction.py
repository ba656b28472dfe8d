"""Measured friction of cage on ball as a pocket sees it: at its sliding speed and pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt

from separatrix.chain.pocket_contact import PocketConditions
from separatrix.measured_friction import Friction
from separatrix.study import Operation, Study
from separatrix.units import Ratio


def names_of_fluid(study: Study) -> tuple[str, ...]:
    """The fluid as the study writes it, and its other names in the library: tests may have any of them."""
    record = study.records.get("operation.fluid")
    known = (record["name"], *(record["aliases"] or ())) if record is not None else ()
    return tuple(filter(None, (study.operation.fluid, *known)))


def friction_in_pocket(
    friction: Friction,
    pocket: PocketConditions | None,
    operation: Operation,
    scatter: Ratio,
    media: Sequence[str] = (),
) -> Friction:
    """Friction at the conditions of a pocket.

    Parameters
    ----------
    friction : Friction
        With a law over the conditions, or a number.
    pocket : PocketConditions or None
        None is enough for a friction without a law.
    operation : Operation
        For temperature and fluid.
    scatter : float
        Standard deviation over mean of an unrepeated test [-].
    media : sequence of str
        Names of the fluid, if there are several.
    """
    if friction.law is None or pocket is None:
        return with_scatter(friction, scatter)
    found = friction.law.at(
        slip_speed=pocket.slip_speed or None,
        pressure=pocket.pressure,
        temperature=operation.temperature,
        medium=media or operation.fluid,
    )
    return replace(
        friction,
        mean=found.mean,
        standard_error=found.standard_error,
        standard_deviation=found.standard_deviation,
        assumed_scatter=found.assumed_scatter,
        extrapolation=found.extrapolation,
        widening=found.widening,
    )


def with_scatter(friction: Friction, scatter: Ratio) -> Friction:
    """Return a friction with the scatter that it states; without any, with that of an unrepeated test."""
    error, deviation = standard_error(friction), friction.standard_deviation
    if error is not None:
        deviation = error if deviation is None else deviation
        return replace(friction, standard_error=error, standard_deviation=deviation)
    assumed = scatter * friction.mean
    return replace(friction, standard_error=assumed, standard_deviation=assumed, assumed_scatter=True)


def standard_error(friction: Friction) -> Ratio | None:
    """Of the mean under the conditions tested; without a count the scatter is taken as it is."""
    error, deviation = friction.standard_error, friction.standard_deviation
    return deviation / sqrt(friction.count or 1) if error is None and deviation is not None else error
