"""Answer of the verb `tribometer` as plain data, and each test as labelled arrays for its page of plots."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from separatrix.friction.logs import described
from separatrix.friction.logs.log import MEANINGS
from separatrix.friction.reduction import Reduction, steady
from separatrix.friction.tribometer import ReducedLogs
from separatrix.present.arrays import variable
from separatrix.present.json import plain
from separatrix.present.walk import Leaf
from separatrix.units import Array

Node = dict[str, Leaf]

COLUMNS, BINS = 1200, 60
"""Columns into which the rows of a log are gathered, and bins of a histogram at most."""

BESIDE = {"normal_force": "N", "temperature": "K", "wear_depth": "m", "slip_speed": "m/s"}
"""Columns that are drawn beside friction if the log has them, and their units."""

NUMBERS = (
    *("friction", "standard_error", "standard_deviation", "half_width", "effective_count"),
    "stick_slip_amplitude",
)
"""Numbers of the test that are kept; those along the abscissa besides."""

FACTS = ("run_in_method", "rows", "steady_rows", "cycles", "degrees_of_freedom")


def tribometer(found: ReducedLogs, *, written: str | None) -> dict[str, Any]:
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
    files = [
        {name: plain(getattr(log, name)) for name in ("source", "checksum", "format", "rows", "missing")}
        | {"columns": plain(log.columns), "metadata": dict(log.metadata), "notes": list(log.notes)}
        | {"described": described(log)}
        for log in found.logs
    ]
    tests = [
        plain(test, "test") | dict(zip(("friction_low", "friction_high"), plain(test.interval), strict=True))
        for test in found.tests
    ]
    fits = []
    for (material, environment), one in fit.groups.items() if fit else ():
        at = one.at()  # the centre of its tested conditions
        fits.append(
            {
                "material": material,
                "environment": environment,
                "tests": len(one.tests),
                "friction": at.mean,
                "standard_error": at.standard_error,
                "standard_deviation": at.standard_deviation,
                "scatter_source": one.scatter_source,
                "slopes": plain(one.slopes, "slope"),
                "tested": plain(one.ranges, "tested"),
                "notes": list(one.covariates.notes),
            }
        )
    return {
        "separatrix_version": __version__,
        "verb": "tribometer",
        "friction_file": written,
        "notes": list(found.notes),
        "files": files,
        "tests": tests,
        "fits": fits,
        "components": None if fit is None else plain(fit.components(), "components"),
        "default_scatter": None if fit is None else fit.default_scatter,
    }


def page_data(reduction: Reduction) -> xr.Dataset:
    """Return what the page of plots of one test is drawn from; small, whatever the length of the log.

    Parameters
    ----------
    reduction : Reduction
        From `separatrix.friction.reduction`.
    """
    test, unit = reduction.test, MEANINGS[reduction.test.run_in_axis]
    rate = "-" if unit == "-" else "Hz" if unit == "s" else f"1/{unit}"
    node = {name: Leaf(getattr(test, name), "-") for name in NUMBERS}
    node |= {
        "run_in_end": Leaf(test.run_in_end, unit),
        "steady_end": Leaf(test.steady_end, unit),
        "kept_start": Leaf(float(reduction.stretch.along[0]), unit),
        "drift_rate": Leaf(test.drift_rate, rate),
        "drift_error": Leaf(test.drift_error, rate),
        "stick_slip_frequency": Leaf(test.stick_slip_frequency, rate),
    }
    node |= _traces(reduction, unit) | _steady(reduction, unit) | _spectra(reduction, unit, rate)
    attributes = {
        "verb": "tribometer",
        "title": test.source,
        "checksum": test.checksum,
        "axis": test.run_in_axis,
        "conditions": json.dumps(plain(test.conditions)),
        "flags": json.dumps(list(test.flags)),
        **{name: getattr(test, name) for name in FACTS},
    }
    return xr.Dataset({name: variable(leaf) for name, leaf in node.items()}, attrs=attributes)


def _traces(reduction: Reduction, unit: str) -> Node:
    log, on = reduction.log, ("trace",)
    starts = np.linspace(0, log.rows, min(COLUMNS, log.rows) + 1).astype(np.int64)[:-1]
    along = np.asarray(getattr(log, reduction.test.run_in_axis), dtype=float)
    found = {
        "trace": Leaf(along[starts], unit, on),
        "trace_low": Leaf(np.minimum.reduceat(log.friction, starts), "-", on),
        "trace_mean": Leaf(_means(log.friction, starts), "-", on),
        "trace_high": Leaf(np.maximum.reduceat(log.friction, starts), "-", on),
    }
    for name, own in BESIDE.items():
        if (column := getattr(log, name)) is not None:
            found[f"trace_{name}"] = Leaf(_means(np.asarray(column, dtype=float), starts), own, on)
    return found


def _steady(reduction: Reduction, unit: str) -> Node:
    """Return means of spans of the steady part, and how rows and cycles are distributed."""
    spans, stretch, rows = reduction.spans, reduction.stretch, reduction.steady_friction
    places = np.array([stretch.place(float(centre)) for centre in spans.centres])
    edges = np.histogram_bin_edges(rows, min(BINS, max(8, int(rows.size**0.5))))
    found = {
        "span": Leaf(places, unit, ("span",)),
        "span_mean": Leaf(spans.means, "-", ("span",)),
        "edge": Leaf(edges, "-", ("edge",)),
        "row_share": Leaf(np.histogram(rows, edges)[0] / rows.size, "-", ("bin",)),
        "span_cycles": Leaf(spans.width if reduction.cycle_means.size else 0.0, "-"),
    }
    if reduction.cycle_means.size:
        shares = np.histogram(reduction.cycle_means, edges)[0] / reduction.cycle_means.size
        found["cycle_share"] = Leaf(shares, "-", ("bin",))
    return found


def _spectra(reduction: Reduction, unit: str, rate: str) -> Node:
    """Return the correlation of the spans, their cosines with what fits, and the spectrum of the rows."""
    mean, oscillation = reduction.mean, reduction.oscillation
    span = reduction.test.steady_end - reduction.test.run_in_end
    numbers = np.arange(1.0, mean.power.size + 1.0)
    lag, correlation = autocorrelation(reduction.spans.means)
    fit = mean.density * steady.spectrum(numbers, mean.corner, mean.floor)
    return {
        "lag": Leaf(lag * (span / reduction.spans.means.size), unit, ("lag",)),
        "correlation": Leaf(correlation, "-", ("lag",)),
        "correlation_length": Leaf(mean.correlation * span, unit),
        "cosine": Leaf(numbers, "-", ("cosine",)),
        "cosine_power": Leaf(mean.power, "-", ("cosine",)),
        "cosine_fit": Leaf(fit, "-", ("cosine",)),
        "cosines_used": Leaf(mean.degrees_of_freedom + 1, "-"),
        "frequency": Leaf(oscillation.frequencies, rate, ("frequency",)),
        "density": Leaf(oscillation.density, unit, ("frequency",)),
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
