"""Answer of the verb `tribometer` as plain data: the files as read, the tests as reduced, the fit to them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from separatrix.friction.fit.fit import FrictionFit, MaterialFit
from separatrix.friction.logs.log import RawLog
from separatrix.friction.logs.reading import described
from separatrix.friction.reduction.reduction import TestFriction
from separatrix.results.plain import plain, plain_record

Document = dict[str, Any]


def tribometer(
    logs: Sequence[RawLog],
    tests: Sequence[TestFriction],
    fit: FrictionFit | None,
    *,
    written: str | None,
    notes: Sequence[str] = (),
) -> Document:
    """Return the answer as plain data: SI units, None where something is absent.

    Parameters
    ----------
    logs, tests : sequence
        The same number of each, in the same order.
    fit : FrictionFit or None
        None where some test does not say what slid on what.
    written : str or None
        Path of the friction file, if one is written.
    notes : sequence of str
        What is to be said of all of them together.
    """
    from separatrix import __version__

    return {
        "separatrix_version": __version__,
        "verb": "tribometer",
        "friction_file": written,
        "notes": list(notes),
        "files": [_file(log) for log in logs],
        "tests": [_test(test) for test in tests],
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
        "columns": [plain_record(column, "column") for column in log.columns],
        "metadata": dict(log.metadata),
        "notes": list(log.notes),
        "described": described(log),
    }


def _test(test: TestFriction) -> Document:
    low, high = test.interval
    return plain_record(test, "test") | {"friction_low": plain(low), "friction_high": plain(high)}


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
        "slopes": {name: plain_record(slope, "slope") for name, slope in fit.slopes.items()},
        "tested": {name: None if limits is None else list(limits) for name, limits in fit.ranges.items()},
        "notes": list(fit.covariates.notes),
    }
