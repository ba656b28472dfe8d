"""A reduced test as labelled arrays: everything that its page of plots is drawn from."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from separatrix.friction.reduction import steady
from separatrix.friction.reduction.options import AXIS_UNITS
from separatrix.friction.reduction.reduction import Reduction
from separatrix.results.plain import plain
from separatrix.units import Array

COLUMNS = 1200
"""Columns into which the rows of a log are gathered."""

BINS = 60
"""Of a histogram, at most."""

BESIDE = {"normal_force": "N", "temperature": "K", "wear_depth": "m", "slip_speed": "m/s"}
"""Columns that are drawn beside friction if the log has them, and their units."""

NUMBERS = {
    "friction": "-",
    "standard_error": "-",
    "standard_deviation": "-",
    "half_width": "-",
    "effective_count": "-",
    "stick_slip_amplitude": "-",
}
"""Numbers of the test that are kept, and their units; those along the abscissa besides."""


def page_data(reduction: Reduction) -> xr.Dataset:
    """Return what the page of plots of one test is drawn from; small, whatever the length of the log.

    Parameters
    ----------
    reduction : Reduction
        From `separatrix.friction.reduction.reduction.reduction`.
    """
    unit = AXIS_UNITS[reduction.test.run_in_axis]
    variables = _numbers(reduction, unit) | _traces(reduction, unit) | _steady(reduction, unit)
    return xr.Dataset(variables | _spectra(reduction, unit), attrs=_attributes(reduction))


def _attributes(reduction: Reduction) -> dict[str, object]:
    test = reduction.test
    return {
        "verb": "tribometer",
        "title": test.source,
        "checksum": test.checksum,
        "axis": test.run_in_axis,
        "run_in_method": test.run_in_method,
        "conditions": json.dumps(plain(test.conditions)),
        "flags": json.dumps(list(test.flags)),
        "rows": test.rows,
        "steady_rows": test.steady_rows,
        "cycles": test.cycles,
        "degrees_of_freedom": test.degrees_of_freedom,
    }


def _numbers(reduction: Reduction, unit: str) -> dict[str, xr.Variable]:
    test = reduction.test
    found = {name: _scalar(getattr(test, name), NUMBERS[name]) for name in NUMBERS}
    rate = _per(unit)
    return found | {
        "run_in_end": _scalar(test.run_in_end, unit),
        "steady_end": _scalar(test.steady_end, unit),
        "kept_start": _scalar(float(reduction.stretch.along[0]), unit),
        "drift_rate": _scalar(test.drift_rate, rate),
        "drift_error": _scalar(test.drift_error, rate),
        "stick_slip_frequency": _scalar(test.stick_slip_frequency, rate),
    }


def _traces(reduction: Reduction, unit: str) -> dict[str, xr.Variable]:
    """Return least, mean and largest friction, and the means of what else was logged, by columns."""
    log = reduction.log
    starts = np.linspace(0, log.rows, min(COLUMNS, log.rows) + 1).astype(np.int64)[:-1]
    along = np.asarray(getattr(log, reduction.test.run_in_axis), dtype=float)
    found = {"trace": _along("trace", along[starts], unit)}
    reducers: tuple[tuple[str, Callable[[Array], Array]], ...] = (
        ("low", lambda values: np.minimum.reduceat(values, starts)),
        ("mean", lambda values: _means(values, starts)),
        ("high", lambda values: np.maximum.reduceat(values, starts)),
    )
    for name, reduce in reducers:
        found[f"trace_{name}"] = _along("trace", reduce(log.friction), "-")
    for name, own in BESIDE.items():
        column = getattr(log, name)
        if column is not None:
            found[f"trace_{name}"] = _along("trace", _means(np.asarray(column, dtype=float), starts), own)
    return found


def _steady(reduction: Reduction, unit: str) -> dict[str, xr.Variable]:
    """Return means of spans of the steady part, and how rows and cycles are distributed."""
    spans, stretch = reduction.spans, reduction.stretch
    places = np.array([stretch.place(float(centre)) for centre in spans.centres])
    rows = reduction.steady_friction
    edges = np.histogram_bin_edges(rows, min(BINS, max(8, int(rows.size**0.5))))
    found = {
        "span": _along("span", places, unit),
        "span_mean": _along("span", spans.means, "-"),
        "edge": _along("edge", edges, "-"),
        "row_share": _along("bin", np.histogram(rows, edges)[0] / rows.size, "-"),
        "span_cycles": _scalar(spans.width if reduction.cycle_means.size else 0.0, "-"),
    }
    if reduction.cycle_means.size:
        shares = np.histogram(reduction.cycle_means, edges)[0] / reduction.cycle_means.size
        found["cycle_share"] = _along("bin", shares, "-")
    return found


def _spectra(reduction: Reduction, unit: str) -> dict[str, xr.Variable]:
    """Return the correlation of the spans, their cosines with what fits, and the spectrum of the rows."""
    mean, test = reduction.mean, reduction.test
    count = mean.power.size
    fit = steady.spectrum(np.arange(1.0, count + 1.0), mean.corner, mean.floor)
    lag, correlation = autocorrelation(reduction.spans.means)
    width = (test.steady_end - test.run_in_end) / reduction.spans.means.size
    return {
        "lag": _along("lag", lag * width, unit),
        "correlation": _along("lag", correlation, "-"),
        "correlation_length": _scalar(mean.correlation * (test.steady_end - test.run_in_end), unit),
        "cosine": _along("cosine", np.arange(1.0, count + 1.0), "-"),
        "cosine_power": _along("cosine", mean.power, "-"),
        "cosine_fit": _along("cosine", mean.density * fit, "-"),
        "cosines_used": _scalar(mean.degrees_of_freedom + 1, "-"),
        "frequency": _along("frequency", reduction.oscillation.frequencies, _per(unit)),
        "density": _along("frequency", reduction.oscillation.density, unit),
    }


def autocorrelation(values: Array) -> tuple[Array, Array]:
    """Return lags and autocorrelation of a series around its straight line, up to a quarter of its length."""
    n = values.size
    x = np.arange(n) - (n - 1) / 2
    level = values - values.mean()
    level = level - x * (x @ level) / (x @ x)
    lags = np.arange(max(2, n // 4))
    total = float(level @ level) or 1.0
    return np.asarray(lags, dtype=float), np.array(
        [float(level[: n - lag] @ level[lag:]) / total for lag in lags.tolist()]
    )


def _means(values: Array, starts: NDArray[np.int64]) -> Array:
    """Return the mean of each column that begins at these rows; absent where none of its values is there."""
    there = np.isfinite(values)
    counts = np.add.reduceat(there.astype(float), starts)
    sums = np.add.reduceat(np.where(there, values, 0.0), starts)
    means = np.divide(sums, counts, out=np.full(sums.size, np.nan), where=counts > 0)
    return np.asarray(means, dtype=float)


def _scalar(value: float, unit: str) -> xr.Variable:
    return xr.Variable((), value, attrs={"units": unit})


def _along(dimension: str, values: Array, unit: str) -> xr.Variable:
    return xr.Variable((dimension,), values, attrs={"units": unit})


def _per(unit: str) -> str:
    return "-" if unit == "-" else "Hz" if unit == "s" else f"1/{unit}"
