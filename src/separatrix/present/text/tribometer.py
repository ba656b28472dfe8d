"""Text of the verb `tribometer`: what was read, the tests, and the friction of each material."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from separatrix.friction.law import in_words
from separatrix.friction.logs import described
from separatrix.present.text.tables import ABSENT, heading, paragraph, quantity, section, table

if TYPE_CHECKING:
    from separatrix.friction.fit import FrictionFit
    from separatrix.friction.reduction import TestFriction
    from separatrix.friction.tribometer import ReducedLogs

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
AXIS_UNITS = {"time": "s", "distance": "m", "cycles": "-"}
WORDS = {"slip_speed": "slip speed", "pressure": "pressure", "pressure_velocity": "pV"}
UNITS = {"slip_speed": "m/s", "pressure": "Pa"}


def tribometer(found: ReducedLogs, *, written: str | None, plots: str | None) -> str:
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
        end = quantity(test.run_in_end, AXIS_UNITS[test.run_in_axis], 3)
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
        shares = (
            f"{100.0 * error / at.mean:.1f} %" for error in (at.standard_error, at.standard_deviation or 0.0)
        )
        rows.append(
            [material, environment, str(len(one.tests)), f"{at.mean:.4f}", *shares, one.scatter_source]
        )
        notes += [f"{material}, {environment}: {note}." for note in one.covariates.notes]
    lines = ["", *(paragraph(line, first="  ", indent="      ") for line in notes)]
    legend = "\n" + paragraph(FIT_LEGEND)
    return section("Friction of the materials", table(FIT_HEADERS, rows, left=2), legend, *lines)


def _slopes(fit: FrictionFit) -> Iterator[str]:
    for (material, environment), one in fit.groups.items():
        for name, slope in one.slopes.items():
            limits = one.ranges[name]
            span = f" from {in_words(limits, UNITS[name])}" if name in UNITS and limits else ""
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
