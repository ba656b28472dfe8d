"""Answer of the verb `tribometer` as plain data, and each test as labelled arrays for its page of plots."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from separatrix.friction.fit import MaterialFit
from separatrix.friction.logs import described
from separatrix.friction.logs.log import MEANINGS, RawLog
from separatrix.friction.reduction import Reduction, TestFriction, steady
from separatrix.friction.tribometer import ReducedLogs
from separatrix.present.json import plain
from separatrix.units import Array

Document = dict[str, Any]

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


def tribometer(found: ReducedLogs, *, written: str | None) -> Document:
    """Return the answer as plain data: SI units, None where something is absent.

    Parameters
    ----------
    found : ReducedLogs
        From `separatrix.friction.tribometer.tribometer`.
    written : str or None
        Path of the friction file, if one is written.
    """
    from separatrix import __version__

    fit = found.fit
    return {
        "separatrix_version": __version__,
        "verb": "tribometer",
        "friction_file": written,
        "notes": list(found.notes),
        "files": [_file(log) for log in found.logs],
        "tests": [_test(test) for test in found.tests],
        "fits": [] if fit is None else [_fit(*key, one) for key, one in fit.groups.items()],
        "components": None if fit is None else plain(fit.components(), "components"),
        "default_scatter": None if fit is None else fit.default_scatter,
    }


def _file(log: RawLog) -> Document:
    return {
        "source": log.source,
        "checksum": log.checksum,
        "format": log.format,
        "rows": log.rows,
        "missing": log.missing,
        "columns": [plain(column, "column") for column in log.columns],
        "metadata": dict(log.metadata),
        "notes": list(log.notes),
        "described": described(log),
    }


def _test(test: TestFriction) -> Document:
    low, high = test.interval
    known: Document = plain(test, "test")
    return known | {"friction_low": plain(low), "friction_high": plain(high)}


def _fit(material: str, environment: str, fit: MaterialFit) -> Document:
    """One material in one environment at the centre of its tested conditions."""
    at = fit.at()
    return {
        "material": material,
        "environment": environment,
        "tests": len(fit.tests),
        "friction": at.mean,
        "standard_error": at.standard_error,
        "standard_deviation": at.standard_deviation,
        "scatter_source": fit.scatter_source,
        "slopes": {name: plain(slope, "slope") for name, slope in fit.slopes.items()},
        "tested": {name: None if limits is None else list(limits) for name, limits in fit.ranges.items()},
        "notes": list(fit.covariates.notes),
    }


def page_data(reduction: Reduction) -> xr.Dataset:
    """Return what the page of plots of one test is drawn from; small, whatever the length of the log.

    Parameters
    ----------
    reduction : Reduction
        From `separatrix.friction.reduction`.
    """
    unit = MEANINGS[reduction.test.run_in_axis]
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
