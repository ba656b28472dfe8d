"""Text of the verb `tribometer`: what was read, the tests, and the friction of each material."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.friction.law import in_words
from separatrix.present.text.tables import ABSENT, heading, paragraph, quantity, section, table

Document = Mapping[str, Any]

HEADERS = (
    "test",
    "material",
    "medium, counterface",
    "slip\nspeed",
    "mean\npressure",
    "friction\n(95 %)",
    "running-in\nends",
    "flags",
)
FIT_HEADERS = (
    "material",
    "environment",
    "tests",
    "friction",
    "standard\nerror",
    "scatter of\na sample",
    "rests on",
)
AXIS_UNITS = {"time": "s", "distance": "m", "cycles": "-"}


def tribometer(document: Document, *, plots: str | None) -> str:
    """Return the answer as text."""
    tests, files = document["tests"], document["files"]
    blocks = [
        heading(f"Read {_counted(len(tests), 'test')} from {_counted(len(files), 'log')}"),
        section("What was read", *("\n".join(file["described"]) + "\n" for file in files)),
        section("Tests", _tests(tests), *_flags(tests), LEGEND),
        *_fits(document),
        *_where(document, plots),
    ]
    return "\n\n".join(blocks) + "\n"


LEGEND = "\n" + paragraph(
    "friction: mean of the steady part, with its 95 % interval, allowing for autocorrelation."
)
FIT_LEGEND = "\n" + paragraph(
    "friction: of the material, at the middle of its tested conditions. standard error: of that. scatter: "
    "standard deviation of a new sample about it."
)


def _counted(count: int, name: str) -> str:
    return f"{count} {name}" if count == 1 else f"{count} {name}s"


def _tests(tests: Sequence[Document]) -> str:
    numbered = {flag: i for i, flag in enumerate(_all_flags(tests), 1)}
    return table(HEADERS, [_row(test, numbered) for test in tests], left=3)


def _row(test: Document, numbered: Mapping[str, int]) -> list[str]:
    known = test["conditions"]
    places = [known["medium"] or ABSENT, known["counterface"] or ABSENT]
    axis = test["run_in_axis"]
    end = f"{test['run_in_end']:.4g} cycles"
    return [
        test["source"],
        known["material"] or ABSENT,
        ", ".join(places),
        quantity(known["slip_speed"], "m/s"),
        quantity(known["pressure"], "Pa"),
        f"{test['friction']:.4f} ({test['friction_low']:.4f} to {test['friction_high']:.4f})",
        end if axis == "cycles" else quantity(float(f"{test['run_in_end']:.3g}"), AXIS_UNITS[axis]),
        ", ".join(str(numbered[flag]) for flag in test["flags"]) or ABSENT,
    ]


def _all_flags(tests: Sequence[Document]) -> list[str]:
    return list(dict.fromkeys(flag for test in tests for flag in test["flags"]))


def _flags(tests: Sequence[Document]) -> list[str]:
    """Return what the numbers of flags mean."""
    found = _all_flags(tests)
    lines = [paragraph(flag, first=f"  {i}: ", indent="     ") for i, flag in enumerate(found, 1)]
    return ["", *lines] if lines else []


def _fits(document: Document) -> list[str]:
    """Return the friction of each material in each environment."""
    rows = [_fit(one) for one in document["fits"]]
    if not rows:
        return []
    notes = [
        f"{one['material']}, {one['environment']}: {n}." for one in document["fits"] for n in one["notes"]
    ]
    notes = [*_slopes(document["fits"]), *_components(document), *notes]
    lines = ["", *(paragraph(line, first="  ", indent="      ") for line in notes)] if notes else []
    return [section("Friction of the materials", table(FIT_HEADERS, rows, left=2), FIT_LEGEND, *lines)]


def _fit(one: Document) -> list[str]:
    friction = one["friction"]
    return [
        one["material"],
        one["environment"],
        str(one["tests"]),
        f"{friction:.4f}",
        f"{100.0 * one['standard_error'] / friction:.1f} %",
        f"{100.0 * one['standard_deviation'] / friction:.1f} %",
        one["scatter_source"],
    ]


def _slopes(fits: Sequence[Document]) -> list[str]:
    words = {"slip_speed": "slip speed", "pressure": "pressure", "pressure_velocity": "pV"}
    units = {"slip_speed": "m/s", "pressure": "Pa"}
    found = []
    for one in fits:
        for name, slope in one["slopes"].items():
            span = f" from {in_words(tuple(one['tested'][name]), units[name])}" if name in units else ""
            found.append(
                f"{one['material']}, {one['environment']}: friction goes as {words[name]} to the power "
                f"{slope['value']:.3f} ({slope['low']:.3f} to {slope['high']:.3f}){span}."
            )
    return found


def _components(document: Document) -> list[str]:
    """Return scatter between samples and between tests, where anything was repeated."""
    found = document["components"]
    if found is None:
        share = 100.0 * document["default_scatter"]
        return [f"No test was repeated: each is assumed to scatter by {share:.3g} % of its mean, a guess."]
    between = f"{100.0 * found['between_samples']:.1f} %"
    if found["between_tests"] is None:
        return [f"Scatter of samples over all materials, by restricted maximum likelihood: {between}."]
    tests = f"{100.0 * found['between_tests']:.1f} %"
    return [
        f"Scatter over all materials, by restricted maximum likelihood: between samples {between}, between "
        f"tests of one sample {tests}."
    ]


def _where(document: Document, plots: str | None) -> list[str]:
    written = document["friction_file"]
    lines = [paragraph(note) for note in document["notes"]]
    lines += [f"{written} is written; a study reads it with [ranking] friction."] if written else []
    lines += [f"A page of plots for each test is in {plots}/"] if plots else []
    if not written:
        lines.append("Nothing written; use --out friction.toml")
    return ["\n".join(lines)]
