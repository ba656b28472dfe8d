r"""Where the motion of a run ends, by its energy and by the work of friction, look by look.

A look is some turns of a whirl. What frame and loads can give the cage without friction is its drive energy.
The rules, in their order, after each look; the constants are shares and multiples of the drive energy E
unless they say another:

1. no number any more, or a ball at the edge of its pocket's wall: UNRESOLVED;
2. more energy at any moment than `GROWN` times that of the initial disturbance and E together: WHIRLS;
3. at rest for two looks: SETTLES;
4. above `HIGH` E in ten looks, no lower in the later five, and turned over by friction: WHIRLS;
5. driven: below E for twenty looks, no higher in the later ten, and pockets give less than half: SETTLES;
6. at the end, by the last fifth: below `WEAK` E a motion that the pockets feed ROLLS in them, any other
   SETTLES; above, it WHIRLS if friction feeds it and it does not fall; of those that still fall it SETTLES
   if only the land feeds it, and is UNRESOLVED otherwise.

A run that WHIRLS has the cause LAND_FRICTION if the land feeds it while the pockets take energy from it.
"""

from __future__ import annotations

import math
from enum import IntEnum

from separatrix.cage import rows
from separatrix.ground.compiled import part

GROWN = 100.0
"""Multiple of the energy at the start, with the drive energy, from which few motions come to rest."""

REST, STILL = 3e-3, 1e-4
"""Share of the drive energy at which a cage is at rest (speeds of a twentieth), and of the energy of the
initial disturbance, or of an impact as deep as the clearance if that is less, where nothing drives the
cage."""

HIGH, TEN = 10.0, 10
"""Multiple of the drive energy, and looks, of a whirl that is plain: three times the speed that the frame can
give."""

TURNED_OVER = 3.0
"""How often friction has put in the energy of such a motion: one that only decays slowly has not been fed."""

WEAK = 1.0
"""Multiple of the drive energy below which a motion that lasts is no danger by itself: it ROLLS in its
pockets."""

FALLS = 0.8
"""Mean energy of later looks over that of earlier ones below which a motion falls."""


class RunOutcome(IntEnum):
    """Where the motion of one run ends."""

    SETTLES = 0
    WHIRLS = 1
    DRIFTS = 2
    UNRESOLVED = 3
    ROLLS = 4


class Cause(IntEnum):
    """Why a run is unresolved; `LAND_FRICTION`: what drives one that whirls, instead of its pockets."""

    NONE = 0
    LEFT_POCKET = 1
    NO_CONTACT = 2
    FALLING = 3
    NOT_FINITE = 4
    LAND_FRICTION = 5


SETTLES, WHIRLS, DRIFTS, UNRESOLVED, ROLLS = (int(one) for one in RunOutcome)
UNKNOWN = -1
BY_NOTHING, BY_WALL, NO_CONTACT, FALLING, NOT_FINITE, BY_LAND = (int(one) for one in Cause)

# Columns of a look.
ENERGY, OFFSET = rows.of(rows.ENERGY), rows.of(rows.OFFSET_MEAN)
POCKET, LAND = rows.of(rows.WORK_POCKET), rows.of(rows.WORK_LAND)
BALL, FRAME = rows.of(rows.WORK_BALL), rows.of(rows.WORK_FRAME)

# Limits of a run.
DRIVE, RESTING, GROWS, MOST, LEAST, FROM, IS_ADRIFT, FAR, RAMP_TIME, RAMP_START, TURNS_AT, LIMITS = range(12)


@part
def mean(looks, column, first, last):
    """Mean of a column of the looks from `first` to before `last`."""
    total = 0.0
    for i in range(first, last):
        total += looks[i, column]
    return total / (last - first)


@part
def fed(looks, first, last):
    """Work of pocket friction and of land friction, and all that was put in."""
    pocket = land = ball = frame = 0.0
    for i in range(first, last):
        pocket += looks[i, POCKET]
        land += looks[i, LAND]
        ball += looks[i, BALL]
        frame += looks[i, FRAME]
    return pocket, land, max(0.0, pocket) + max(0.0, land) + max(0.0, ball) + max(0.0, frame)


@part
def stays(looks, first, last):
    """Whether the later half has no less energy than the earlier, but for its scatter."""
    middle = (first + last) // 2
    return mean(looks, ENERGY, middle, last) >= FALLS * mean(looks, ENERGY, first, middle)


@part
def end_of_motion(looks, i, touched, has_grown, limits):
    """Outcome and cause after look i, which ended early if the run `has_grown`; `UNKNOWN` if not plain."""
    energy, drive, end = looks[i, ENERGY], limits[DRIVE], i + 1
    if not math.isfinite(energy):
        return UNRESOLVED, NOT_FINITE
    pocket, land, put_in = fed(looks, max(0, end - TEN), end)
    by_land = land > 0.5 * put_in and pocket <= 0.0
    if has_grown:
        return WHIRLS, BY_LAND if by_land else BY_NOTHING
    seen = end - int(limits[FROM])
    settled = DRIFTS if limits[IS_ADRIFT] > 0.0 else SETTLES
    if touched and seen >= 2:
        if energy < limits[RESTING] and looks[i - 1, ENERGY] < limits[RESTING] and limits[IS_ADRIFT] == 0.0:
            return settled, BY_NOTHING
        if looks[i, OFFSET] > limits[FAR] and energy < drive:
            return DRIFTS, BY_NOTHING
    if touched and seen >= TEN:
        above = True
        for j in range(end - TEN, end):
            above = above and looks[j, ENERGY] > max(HIGH * drive, limits[RESTING])
        over = TURNED_OVER * mean(looks, ENERGY, end - TEN, end)
        is_fed = max(0.0, pocket) + max(0.0, land) > max(over, 0.5 * put_in)
        if above and is_fed and stays(looks, end - TEN, end):
            return WHIRLS, BY_LAND if by_land else BY_NOTHING
    if touched and seen >= 2 * TEN and drive > 0.0 and limits[IS_ADRIFT] == 0.0:
        below = True
        for j in range(end - 2 * TEN, end):
            below = below and looks[j, ENERGY] < drive
        pocket, land, put_in = fed(looks, end - 2 * TEN, end)
        late, early = mean(looks, ENERGY, end - TEN, end), mean(looks, ENERGY, end - 2 * TEN, end - TEN)
        place = mean(looks, OFFSET, end - TEN, end)
        moved = abs(place - mean(looks, OFFSET, end - 2 * TEN, end - TEN))
        if below and pocket < 0.5 * put_in and FALLS * late <= early and moved < 0.05 * place:
            return settled, BY_NOTHING
    if end < limits[MOST]:
        return UNKNOWN, BY_NOTHING
    return end_by_last_fifth(looks, end, touched, settled, limits)


@part
def end_by_last_fifth(looks, end, touched, settled, limits):
    """Outcome and cause of a run that was followed to its end."""
    first = end - max(1, end // 5)
    pocket, land, put_in = fed(looks, first, end)
    last = mean(looks, ENERGY, first, end)
    if not touched:
        return UNRESOLVED, NO_CONTACT
    if last <= limits[RESTING]:
        return settled, BY_NOTHING
    if land > 0.5 * put_in and pocket <= 0.0:
        lasts = land > last > WEAK * limits[DRIVE] and stays(looks, end // 2, end)
        return (WHIRLS, BY_LAND) if lasts else (settled, BY_NOTHING)
    friction = max(0.0, pocket) + max(0.0, land)
    is_fed = friction > 0.5 * put_in and friction > last
    if last <= WEAK * limits[DRIVE]:
        return (ROLLS, BY_NOTHING) if is_fed and settled == SETTLES else (settled, BY_NOTHING)
    if is_fed and stays(looks, end // 2, end):
        return WHIRLS, BY_NOTHING
    return (settled, BY_NOTHING) if limits[DRIVE] == 0.0 and not is_fed else (UNRESOLVED, FALLING)
