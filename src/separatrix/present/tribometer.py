"""Answer of `tribometer` as plain data and text, and each test as labelled arrays for its page of plots."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from separatrix.friction import steady
from separatrix.friction.friction_fit import FrictionFit
from separatrix.friction.friction_law import in_words as range_words
from separatrix.friction.log_series import ReducedLogs
from separatrix.friction.logs import described
from separatrix.friction.logs.names import MEANINGS
from separatrix.friction.reduction import Reduction, TestFriction
from separatrix.ground.plain_data import Document, Leaf, plain
from separatrix.ground.units import Array
from separatrix.present.dataset import variable
from separatrix.told.tables import ABSENT, heading, paragraph, quantity, section, table

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


def document(found: ReducedLogs, *, written: str | None) -> Document:
    """Return the answer as plain data: SI units, None for absent values; `written` is the friction file."""
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
    """Return the data of the page of plots of one test; small, whatever the length of the log."""
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
    """Return the mean of each column that begins at these rows; NaN where all its values are absent."""
    there = np.isfinite(values)
    counts = np.add.reduceat(there.astype(float), starts)
    sums = np.add.reduceat(np.where(there, values, 0.0), starts)
    means = np.divide(sums, counts, out=np.full(sums.size, np.nan), where=counts > 0)
    return np.asarray(means, dtype=float)


HEADERS = (
    *("test", "material", "medium, counterface", "slip\nspeed", "mean\npressure", "friction\n(95 %)"),
    *("running-in\nends", "flags"),
)
FIT_HEADERS = (
    *("material", "environment", "tests", "friction", "standard\nerror", "scatter of\na sample", "rests on"),
)
LEGEND = "friction: mean of the steady part, with its 95 % interval, allowing for autocorrelation."
FIT_LEGEND = (
    "friction: of the material, at the middle of its tested conditions. standard error: of that. scatter: "
    "standard deviation of a new sample about it."
)
WORDS = {"slip_speed": "slip speed", "pressure": "pressure", "pressure_velocity": "pV"}
UNITS = {"slip_speed": "m/s", "pressure": "Pa"}


def in_words(found: ReducedLogs, *, written: str | None, plots: str | None) -> str:
    """Return the answer as text; `written` is the friction file, `plots` the folder of the pages."""
    tests, count = found.tests, len(found.tests)
    flags = list(dict.fromkeys(flag for test in tests for flag in test.flags))
    meant = [paragraph(flag, first=f"  {i}: ", indent="     ") for i, flag in enumerate(flags, 1)]
    rows = [_row(test, flags) for test in tests]
    read = ("\n".join(described(log)) + "\n" for log in found.logs)
    shown = [table(HEADERS, rows, left=3), *(["", *meant] if meant else []), "\n" + paragraph(LEGEND)]
    lines = [paragraph(note) for note in found.notes]
    lines += [f"{written} is written; a study reads it with [ranking] friction."] if written else []
    lines += [f"A page of plots for each test is in {plots}/"] if plots else []
    lines += [] if written else ["Nothing written; use --out friction.toml"]
    several = "s"[: count != 1]
    blocks = [
        heading(f"Read {count} test{several} from {count} log{several}"),
        section("What was read", *read),
        section("Tests", *shown),
        *([] if found.fit is None or not found.fit.groups else [_fits(found.fit)]),
        "\n".join(lines),
    ]
    return "\n\n".join(blocks) + "\n"


def _row(test: TestFriction, flags: list[str]) -> list[str]:
    known, (low, high), end = test.conditions, test.interval, f"{test.run_in_end:.4g} cycles"
    if test.run_in_axis != "cycles":
        end = quantity(test.run_in_end, MEANINGS[test.run_in_axis], 3)
    return [
        test.source,
        known.material or ABSENT,
        f"{known.medium or ABSENT}, {known.counterface or ABSENT}",
        quantity(known.slip_speed, "m/s"),
        quantity(known.pressure, "Pa"),
        f"{test.friction:.4f} ({low:.4f} to {high:.4f})",
        end,
        ", ".join(str(flags.index(flag) + 1) for flag in test.flags) or ABSENT,
    ]


def _fits(fit: FrictionFit) -> str:
    rows, notes = [], [*_slopes(fit), _components(fit)]
    for (material, environment), one in fit.groups.items():
        at = one.at()
        errors = at.standard_error, at.standard_deviation or 0.0
        shares = [f"{100.0 * error / at.mean:.1f} %" for error in errors]
        cells = [material, environment, str(len(one.tests)), f"{at.mean:.4f}", *shares, one.scatter_source]
        rows.append(cells)
        notes += [f"{material}, {environment}: {note}." for note in one.covariates.notes]
    lines = ["", *(paragraph(line, first="  ", indent="      ") for line in notes)]
    legend = "\n" + paragraph(FIT_LEGEND)
    return section("Friction of the materials", table(FIT_HEADERS, rows, left=2), legend, *lines)


def _slopes(fit: FrictionFit) -> Iterator[str]:
    for (material, environment), one in fit.groups.items():
        for name, slope in one.slopes.items():
            limits = one.ranges[name]
            span = f" from {range_words(limits, UNITS[name])}" if name in UNITS and limits else ""
            yield (
                f"{material}, {environment}: friction goes as {WORDS[name]} to the power "
                f"{slope.value:.3f} ({slope.low:.3f} to {slope.high:.3f}){span}."
            )


def _components(fit: FrictionFit) -> str:
    """Return scatter between samples and between tests, where anything was repeated."""
    found = fit.components()
    if found is None:
        share = 100.0 * fit.default_scatter
        return f"No test was repeated: each is assumed to scatter by {share:.3g} % of its mean, a guess."
    between = f"{100.0 * found.between_samples:.1f} %"
    if found.between_tests is None:
        return f"Scatter of samples over all materials, by restricted maximum likelihood: {between}."
    tests = f"{100.0 * found.between_tests:.1f} %"
    return (
        f"Scatter over all materials, by restricted maximum likelihood: between samples {between}, between "
        f"tests of one sample {tests}."
    )
