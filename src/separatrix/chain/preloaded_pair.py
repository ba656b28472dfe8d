"""Axial loads of two equal bearings that press each other by a preload (docs/theory/equilibrium.md).

The external load of the shaft presses the bearing of the study and relieves the other one. Rigid rings keep
their distance, so that the displacements of both bearings have the same sum at any load and speed; a spring
keeps its force on the other bearing.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from math import sqrt

from separatrix.chain.equilibrium import equilibrium
from separatrix.ground.errors import InputError
from separatrix.ground.units import Metre, Newton, Ratio, format_quantity
from separatrix.study.study import BallBearing, KinematicModel, Operation, PreloadKind

REMEMBERED = 256
"""Pairs that are kept, by the records they are made of."""

FAINT = 1e-6
"""Load over the preload at which a bearing is taken as unloaded: its balls still have a place."""

STRIDE, LEAST_STRIDE = 16.0, 1.001
"""Factor between loads that are tried, and the one at which balls that leave their grooves end the search."""

GAPPED = (
    "The preloaded pair gaps: under this axial_load the other bearing carries nothing, and its balls and "
    "cage are loose. The study is of the bearing that carries the load."
)
GAPS_AT_REST = (
    "At rest this axial_load gaps the preloaded pair: the limit is {}. At speed only the centrifugal force "
    "of its balls loads the other bearing."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PairLoads:
    """Axial loads of a preloaded pair, and the external load that it bears without a gap."""

    preload_kind: PreloadKind  # what keeps the preload
    own_axial_load: Newton  # of the bearing of the study, which the external load presses
    other_axial_load: Newton  # of the other bearing of the pair; 0 if the pair gaps
    ring_offset: Metre
    """Axial displacement of the inner ring of each bearing by the preload at rest."""

    gap_load: Newton | None
    """External axial load at rest at which the other bearing carries nothing; null for a spring, which keeps
    it loaded, and for a pair whose balls leave their grooves first."""

    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@lru_cache(maxsize=REMEMBERED)
def pair_loads(
    bearing: BallBearing, operation: Operation, kinematics: KinematicModel, race_friction: Ratio
) -> PairLoads:
    """Axial loads of both bearings of a pair at speed; the preload is that at rest.

    Raises
    ------
    InputError
        The balls leave their grooves, or the pair loses its preload at speed.
    ConvergenceError
        An equilibrium did not converge.
    """
    preload, external = operation.preload or 0.0, operation.axial_load or 0.0
    turning = with_axial_load(operation, preload)
    still = replace(turning, inner_speed=0.0, outer_speed=0.0)

    def displacement(load: Newton, at: Operation = turning) -> Metre:
        found = equilibrium(bearing, replace(at, axial_load=load), kinematics, race_friction)
        return found.axial_displacement

    offset = displacement(preload, still)
    kind = operation.preload_kind or PreloadKind.RIGID
    other, gap = preload, None
    if kind is PreloadKind.RIGID:
        other = _root(
            lambda load: displacement(load) + displacement(load + external) - 2.0 * offset, FAINT * preload
        )
        with suppress(InputError):
            gap = _root(lambda load: displacement(load, still) - 2.0 * offset, preload)
    if other + external == 0.0:
        rule = "is lost at this speed: the balls press the outer races alone"
        raise InputError("[operation] preload", rule, cure="Raise the preload or lower the speed.")
    notes = [GAPPED] if other == 0.0 else []
    if other > 0.0 and gap is not None and external >= gap:
        notes = [GAPS_AT_REST.format(format_quantity(gap, "N", 3))]
    return PairLoads(
        preload_kind=kind,
        own_axial_load=other + external,
        other_axial_load=other,
        ring_offset=offset,
        gap_load=gap,
        notes=tuple(notes),
    )


def with_axial_load(operation: Operation, load: Newton) -> Operation:
    """The operation of one bearing under this axial load, whatever presses it."""
    return replace(operation, axial_load=load, preload=None, arrangement=None, preload_kind=None)


def _root(excess: Callable[[Newton], float], least: Newton) -> Newton:
    """Load at which a rising function is 0; 0 if it is not below 0 at `least`.

    It is searched upward from there: loads that press balls out of their grooves are refused.
    """
    from scipy.optimize import brentq  # half of the start of a verb that has no pair

    low, stride = least, STRIDE
    if excess(low) >= 0.0:
        return 0.0
    while True:
        try:
            is_above = excess(stride * low) >= 0.0
        except InputError:
            if stride < LEAST_STRIDE:
                raise
            stride = sqrt(stride)
            continue
        if is_above:
            return float(brentq(excess, low, stride * low, xtol=1e-3 * least, rtol=1e-12))
        low *= stride
