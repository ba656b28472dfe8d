"""A comparison as text, as pictures of both answers together, and as files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix import figures
from separatrix.comparing.records import Comparison, Noise, Row, Value, is_number
from separatrix.comparing.results import UNCOUNTED_VERBS
from separatrix.comparing.saved import Saved, arrays
from separatrix.ground.errors import InputError, harmless, json_text
from separatrix.ground.plain_data import plain
from separatrix.ground.units import printable
from separatrix.told.tables import (
    ABSENT,
    facts,
    heading,
    interval,
    paragraph,
    quantity,
    section,
    significant,
    table,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

ON_A_SCREEN = {"inputs": 8, "verdicts": 8, "rows": 15}
"""Most rows of each table, without --full."""

HEADLINES = {"rank": ("margin", "probability_stable"), "sensitivity": ("probability_stable",)}
"""Results that are shown on a screen, of the bearing's own environment; of other verbs all are."""

SHORT = {
    Noise.BEYOND: "MORE",
    Noise.WITHIN: "within",
    Noise.EXACT: "exact",
    Noise.UNJUDGED: "?",
    Noise.CHANGED: "changed",
}
NAMES = {"probability_stable": "P(stable)", "probability_whirl": "P(whirl)"}
CHAIN = ("restitution_factor", "race_damping")
"""Results of the chain that are shown on a screen beside those of runs."""

LONGEST_PLACE = 40
COARSE = 0.02
"""Width of an interval of a pure number from which two decimals are enough."""

LEGEND = (
    "noise: MORE, or within: whether the 95 % interval of the change excludes 0 (shares of runs: Newcombe's "
    "interval). exact: not counted in runs, exact up to the model. ?: from runs, without an interval."
)
EXACT = "No counting: these results are exact up to the model."
ONE_RUN = "One run of each: other runs of the same cages can end differently."
SAME_SEED = "Both draw the same disturbances (seed {}); the intervals take their runs as independent."

RUN: dict[str, int] = {
    **dict.fromkeys(("outcome", "kick", "largest_offset"), 0),
    **dict.fromkeys(("time", "land_force", "kinetic_energy", "stored_energy"), 1),
    **dict.fromkeys(("pocket_angle", "half_play"), 1),
    **dict.fromkeys(("position", "velocity", "contact_force"), 2),
}
CURVE = dict.fromkeys(("restitution_factor", "critical_friction", "scatter_low", "scatter_high"), 1)
NEEDED: Mapping[str, Mapping[str, int]] = {
    "simulate": RUN,
    "stability": CURVE,
    "rank": CURVE
    | dict.fromkeys(("material", "environment"), 1)
    | {f"material_restitution_{name}": 2 for name in ("factor", "threshold")}
    | {f"material_restitution_threshold_{end}": 2 for end in ("low", "high")},
}
"""What a picture takes from each: variable and number of its dimensions."""

TEXTS = ("outcome", "material", "environment")

MOST = 1e30
"""Magnitude from which a number cannot be drawn; no run comes near it."""


def in_words(found: Comparison, *, full: bool = False) -> str:
    """Return what differs: inputs, verdicts, and results with the largest changes first."""
    named = [
        (which, one.title + f" ({printable(one.path, 80)}, seed {one.seed})")
        for which, one in zip(("first", "second"), found.answers, strict=True)
    ]
    blocks = [heading(f"Two answers of {found.of}"), facts(named)]
    rows = [[row.place, row.name, *pair_words(row)] for row in found.verdicts]
    heads: tuple[str, ...] = ("", "", "first", "second")
    none = "None." if found.shared_verdicts else "The two answers have no verdict in common."
    blocks.append(_part("Verdicts that changed", heads, rows, "verdicts", full, left=2, none=none))
    changed, own = list(shown_rows(found, full=full)), "" if full else found.environment or ""
    rows = [result_words(row, own) for row in changed]
    heads = ("", "", "first\n(95 %)", "second\n(95 %)", "change", "noise")
    title = f"Results that differ{own and ' in '}{own}, the largest changes first"
    blocks.append(_part(title, heads, rows, "rows", full, left=2))
    differ = [
        [at.key, input_words(at.first, at.unit), input_words(at.second, at.unit)] for at in found.differences
    ]
    blocks.append(_part("Inputs that differ", ("", "first", "second"), differ, "inputs", full))
    blocks.append("\n".join(paragraph(line) for line in notes_of(found, len(changed))))
    return "\n\n".join(blocks) + "\n"


def _part(
    title: str,
    heads: Sequence[str],
    rows: Sequence[Sequence[str]],
    kind: str,
    full: bool,
    left: int = 1,
    none: str = "None.",
) -> str:
    most = len(rows) if full else ON_A_SCREEN[kind]
    if not rows:
        return section(title, paragraph(none))
    more = [paragraph(f"and {len(rows) - most} more: --full.")] if len(rows) > most else []
    return section(title, table(heads, rows[:most], left=left), *more)


def shown_rows(found: Comparison, *, full: bool = False) -> Iterable[Row]:
    """Return the rows that a reader looks at first; all of them if that is none."""
    wanted, own = HEADLINES.get(found.of, ()), found.environment
    heads = [row for row in found.rows if row.name == "restitution_factor" and not row.place]
    chosen = [row for row in found.rows if row.name in wanted and row.place.startswith(f"{own or ''}")]
    chosen = [row for row in chosen if row.place.count(" / ") < 2]  # not kick by kick
    if full or found.of in UNCOUNTED_VERBS:
        return found.rows
    rest = [row for row in found.rows if not row.place.startswith("chain") or row.name in CHAIN]
    return [*heads, *chosen] if chosen else rest


def notes_of(found: Comparison, shown: int) -> Iterable[str]:
    """Yield what a reader of `shown` results should know of them and of the others."""
    if found.of in UNCOUNTED_VERBS:
        yield EXACT
    elif found.of == "simulate":
        yield ONE_RUN
    else:
        yield LEGEND
        if found.same_seed:
            yield SAME_SEED.format(found.answers[0].seed)
    hidden = len(found.rows) - shown + found.left_out
    others = f" {hidden} more differ: --full, --json." if hidden else ""
    yield f"{found.unchanged} results are equal.{others}"
    if found.also:
        yield f"Both also have answers of {', '.join(found.also)}: name those files to compare them."


def result_words(row: Row, own: str) -> list[str]:
    """Return place, name, both values, change and noise of a result; `own` is a place that is left out."""
    place = row.place.removeprefix(f"{own} / ")
    place = place if len(place) <= LONGEST_PLACE else f"...{place[3 - LONGEST_PLACE :]}"
    change = ABSENT if row.change is None else _number(row.change, row.unit, sign=True)
    return [place, NAMES.get(row.name, row.name), *pair_words(row), change, SHORT[row.noise]]


def pair_words(row: Row) -> list[str]:
    """Return both values of a result with their intervals."""
    return [_value(one, row.unit) for one in (row.first, row.second)]


def _value(one: Value, unit: str | None) -> str:
    text = ABSENT if one.value is None else str(one.value)
    if is_number(one.value):
        text = _number(one.value, unit)
    if one.low is None or one.high is None:
        return text
    if unit == "-" and one.high - one.low > COARSE and is_number(one.value):
        return interval(float(one.value), one.low, one.high)
    return f"{text} ({_number(one.low, unit)} to {_number(one.high, unit)})"


def _number(value: float, unit: str | None, *, sign: bool = False) -> str:
    pure = unit in (None, "-", "")
    text = significant(float(value), 3) if pure else quantity(float(value), str(unit), 3)
    return f"+{text}" if sign and value > 0.0 else text


def input_words(value: object, unit: str | None) -> str:
    """Return the value of an input in one of the answers."""
    if isinstance(value, list):
        given = [input_words(one, unit or "-") if isinstance(one, float) else str(one) for one in value]
        return printable(", ".join(given), 120) or ABSENT
    if isinstance(value, float):
        return quantity(value, unit) if unit else significant(value)
    return ABSENT if value is None else printable(str(value), 120)


def pictures(first: Saved, second: Saved) -> Iterator[tuple[str, Figure]]:
    """Yield name and figure of each picture of two answers; none for a verb or an answer without arrays."""
    if first.verb not in NEEDED:
        return
    pair = [data for one in (first, second) if (data := arrays(one.document, one.path)) is not None]
    if len(pair) < 2:
        return
    has_curves = all("restitution_factor" in one.sizes for one in pair)  # an interrupted one has none
    if first.verb != "simulate" and not has_curves:
        return
    for data, saved in zip(pair, (first, second), strict=True):
        _check(data, saved)
    titles = [str(one.attrs.get("title", "")) for one in pair]
    names = (first.path, second.path) if titles[0] == titles[1] else ("", "")  # else by their titles
    yield from figures.draw("compare", *pair, names=names)


def _check(data: xr.Dataset, saved: Saved) -> None:
    """Refuse an answer whose arrays cannot be drawn."""
    for name, dimensions in NEEDED[saved.verb].items():
        if name not in data or data[name].ndim != dimensions or data[name].size == 0:
            raise InputError(saved.path, f"lacks {name}, which an answer of {saved.verb} has")
        if name in TEXTS:
            continue
        if data[name].dtype.kind not in "iuf":
            raise InputError(saved.path, f"must have numbers in {name}", got=str(data[name].dtype))
        largest = float(abs(data[name]).max(skipna=saved.verb != "simulate"))
        if largest >= MOST or (saved.verb == "simulate" and not largest < MOST):
            raise InputError(saved.path, f"must have finite numbers below {MOST:g} in {name}")


def comparison_document(found: Comparison) -> dict[str, object]:
    """Return a comparison as plain data, as ``--json`` prints it."""
    from separatrix import __version__

    return {"separatrix_version": __version__, "verb": "compare", **plain(found, left_out=[])}


def save_comparison(folder: Path, found: Comparison, first: Saved, second: Saved) -> None:
    """Write compare.json, compare.txt with every row, and the figures, where both have their arrays."""
    text = json_text(comparison_document(found)) + "\n"
    (folder / "compare.json").write_text(text, encoding="utf-8")
    (folder / "compare.txt").write_text(harmless(in_words(found, full=True)), encoding="utf-8")
    figures.save_all(pictures(first, second), folder)
