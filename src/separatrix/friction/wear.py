"""Wear coefficient of a sample from the wear depth that a tribometer logged: K = depth/(pressure x way)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from separatrix.friction.logs.column_map import Conditions
from separatrix.friction.logs.log import RawLog
from separatrix.ground.units import Array, Ratio, SpecificWear

STRETCHES = 12
"""Of the steady part, through whose means a straight line goes: its neighbours differ independently."""

SURE = 2.0
"""Growth of the depth over its standard error from which it counts as wear."""

NO_GROWTH = (
    "The wear depth does not grow beyond its noise over the steady part (heat moves it, too): no wear "
    "coefficient."
)

FALLS = (
    "The wear depth falls over the steady part (a pin that warms grows): no wear coefficient. If wear counts "
    "as negative, write `sign = -1` for wear_depth in a column map."
)

NO_PRESSURE = (
    "The wear depth makes no wear coefficient without the pressure: give it, or the pin_diameter or "
    "contact_area, in a column map."
)

NO_WAY = (
    "The wear depth makes no wear coefficient without the way slid: give a distance, or a speed and times."
)
TOO_FEW = "The steady part has too few rows with a wear depth for a wear coefficient."


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleWear:
    """Wear of one test over its steady part, by Archard's law."""

    wear_coefficient: SpecificWear | None  # of the sample; null where depth, way or pressure is not known
    wear_error: SpecificWear | None  # its standard error by the noise of the depth
    wear_share: Ratio | None  # of the way of the log that is the steady part


NO_WEAR = SampleWear(wear_coefficient=None, wear_error=None, wear_share=None)


def slid(log: RawLog, conditions: Conditions) -> Array | None:
    """Way slid at each row [m]: that of the log, else speed times time; None where neither is known."""
    if log.distance is not None:
        return np.asarray(log.distance, dtype=float)
    speed = log.slip_speed
    if speed is not None and log.time is not None and np.isfinite(speed).all():
        steps = 0.5 * np.abs(speed[1:] + speed[:-1]) * np.diff(log.time)
        return np.concatenate(([0.0], np.cumsum(steps)))
    if conditions.slip_speed is not None and log.time is not None:
        return np.asarray(conditions.slip_speed * log.time)
    return None


def sample_wear(log: RawLog, conditions: Conditions, steady: slice) -> SampleWear:
    """Wear coefficient of a test at its mean pressure; none where it is not known or depth does not grow."""
    way, pressure = slid(log, conditions), conditions.pressure
    if log.wear_depth is None or way is None or pressure is None:
        return NO_WEAR
    depth, along = np.asarray(log.wear_depth)[steady], way[steady]
    there = np.isfinite(depth) & np.isfinite(along)
    if there.sum() < 2 * STRETCHES:
        return NO_WEAR
    x, y = (
        np.array([part.mean() for part in np.array_split(each[there], STRETCHES)]) for each in (along, depth)
    )
    across = float(((x - x.mean()) ** 2).sum())
    if across == 0.0:
        return NO_WEAR
    slope = float(((x - x.mean()) * y).sum()) / across
    rest = y - y.mean() - slope * (x - x.mean())
    error = float(np.sqrt((rest**2).sum() / (STRETCHES - 2) / across))
    if slope <= SURE * error:
        return NO_WEAR
    share = float(np.nanmax(along) - np.nanmin(along)) / float(np.nanmax(way) - np.nanmin(way))
    return SampleWear(wear_coefficient=slope / pressure, wear_error=error / pressure, wear_share=share)


def why_none(log: RawLog, conditions: Conditions, steady: slice) -> str:
    """Why a log with a wear depth has no wear coefficient, a sentence."""
    way = slid(log, conditions)
    if way is None or log.wear_depth is None:
        return NO_WAY
    if conditions.pressure is None:
        return NO_PRESSURE
    depth = np.asarray(log.wear_depth)
    if np.isfinite(depth[steady] + way[steady]).sum() < 2 * STRETCHES:
        return TOO_FEW
    falls = sample_wear(replace(log, wear_depth=-depth), conditions, steady).wear_coefficient
    return FALLS if falls else NO_GROWTH
