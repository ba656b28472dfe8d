"""Where the contacts of a solved bearing leave what races bear and what the model holds: a sentence each."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.equilibrium.balance import LEAST_SHARE
from separatrix.chain.hertz import ContactEllipse
from separatrix.ground.units import Pascal, Radian, Ratio, format_quantity
from separatrix.study.study import BallBearing, KinematicModel, Race

STATIC_PRESSURE: Pascal = 4.2e9
"""ISO 76:2006, static load rating of ball bearings: dents of about 1e-4 of a ball diameter."""

SHOULDER: Ratio = 0.2
"""Height of a race's shoulder over the ball diameter: assumed, for a study does not state it."""


def beyond_contacts(
    bearing: BallBearing, found: Equilibrium, ellipses: dict[Race, ContactEllipse], *, turns: bool
) -> Iterator[str]:
    """Sentences to warn with, from the equilibrium and the ellipses of the most loaded ball."""
    race, most = max(((r, e.max_pressure) for r, e in ellipses.items()), key=lambda pair: pair[1])
    if most > STATIC_PRESSURE:
        yield (
            f"The contact pressure of {format_quantity(most, 'Pa', 3)} at the {race.value} race exceeds "
            f"{format_quantity(STATIC_PRESSURE, 'Pa', 2)}, the static limit of ISO 76: the races take "
            "permanent dents."
        )
    yield from _over_the_shoulder(bearing, found, ellipses)
    if turns:
        yield from _skidding(found)


def shoulder_angle(bearing: BallBearing, race: Race) -> Radian:
    """Angle from the bottom of a groove to its shoulder of assumed height."""
    inner = race is Race.INNER
    conformity = bearing.inner_conformity if inner else bearing.outer_conformity
    return math.acos(1.0 - SHOULDER / conformity)


def _over_the_shoulder(
    bearing: BallBearing, found: Equilibrium, ellipses: dict[Race, ContactEllipse]
) -> Iterator[str]:
    """The far end of the most loaded ball's ellipse, as an angle on the ball, against the shoulder."""
    ends = {}
    for race, ellipse in ellipses.items():
        angle = abs(float(getattr(found, f"contact_angle_{race.value}")[found.most_loaded]))
        ends[race] = angle + math.asin(min(2.0 * ellipse.semi_major / bearing.ball_diameter, 1.0))
    race = max(ends, key=lambda r: ends[r] - shoulder_angle(bearing, r))
    limit = shoulder_angle(bearing, race)
    if ends[race] > limit:
        yield (
            f"The contact at the {race.value} race ends {math.degrees(ends[race]):.0f} deg from the bottom "
            f"of its groove, beyond a shoulder at {math.degrees(limit):.0f} deg (assumed height: "
            f"{SHOULDER:g} of the ball diameter): the edge raises the pressure above the computed one."
        )


def _skidding(found: Equilibrium) -> Iterator[str]:
    """Balls that the inner race hardly touches; without race control it turns them as if it did."""
    hardly = found.load_inner < LEAST_SHARE * found.load_outer
    if not hardly.any():
        return
    share, limit = (
        100.0 * float(np.min(found.load_inner[hardly] / found.load_outer[hardly])),
        100 * LEAST_SHARE,
    )
    free = found.model is KinematicModel.FREE
    taken = f"for {limit:g} % of it" if free else "as at the first touch"
    yield (
        f"{hardly.sum()} of {hardly.size} balls are almost unloaded: the inner race carries as little as "
        f"{share:.2g} % of the outer load, below the limit of {limit:g} %. Such balls skid; their speeds are "
        f"computed {taken}."
    )
