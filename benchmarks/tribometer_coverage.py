"""How often the stated 95 % interval of friction holds the known one, over synthetic logs of every kind.

    python benchmarks/tribometer_coverage.py [--seed SEED] [LOGS] [FORMAT ...]

LOGS logs (1000) are drawn with the seed SEED (20260) from the recipes of tests/physics/synthetic_friction.py
and reduced: as they are, or for each FORMAT (a name of `FORMATS`, or "all") written, read back and reduced,
then of at most 4000 rows. "Held" counts logs whose interval holds the truth: the mean, over the steady part
that the reduction states, of the friction without noise, running-in and modulation. "Flagged" ones carry the
sentence that the interval may be too narrow, or that running-in does not end.
"""
# ruff: noqa: E402  the makers of logs are found beside the tests

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT / "tests" / "physics"), str(ROOT / "tests" / "unit")]

import raw_logs
from synthetic_friction import CORRELATIONS, RUN_INS, Made, Recipe, made, recipes

from separatrix.friction.logs import read_log
from separatrix.friction.logs.column_map import ColumnMap
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction import TestFriction, reduce_log
from separatrix.ground.errors import InputError
from separatrix.verdict.judgement import wilson_interval

SEED = 20260
MOST_ROWS = 4000
"""Of a log that goes through a file."""

WARNED = ("may be too narrow", "does not end")

Answer = tuple[TestFriction, Made, RawLog]
Writer = Callable[[Path, RawLog, float], Path]


def xlsx(folder: Path, log: RawLog, cycle: float) -> Path:
    """Excel workbook."""
    from openpyxl import Workbook

    book = Workbook(write_only=True)
    sheet = book.create_sheet("test")
    sheet.append(["time [s]", "cycles", "COF"])
    for row in zip(log.time.tolist(), (log.time / cycle).tolist(), log.friction.tolist(), strict=True):
        sheet.append(row)
    book.save(folder / "log.xlsx")
    return folder / "log.xlsx"


TEXTS: dict[str, Callable[[RawLog, float], bytes]] = {
    "anton_paar": lambda log, cycle: raw_logs.anton_paar(
        log.friction, log.time, laps=log.time / cycle, decimal=","
    ),
    "rtec": lambda log, cycle: raw_logs.rtec(log.friction, log.time, speed_rpm=60.0 / cycle, total=""),
    "umt": lambda log, _: raw_logs.umt(log.friction, log.time, unit="N"),
    # its writer counts two cycles a second, as the logs made for it do
    "compend": lambda log, _: raw_logs.compend(log.friction, log.time),
    "csv": lambda log, cycle: raw_logs.plain_csv(
        {"time [s]": log.time, "cycles": log.time / cycle, "COF": log.friction}
    ),
    # forces instead of friction
    "tsv": lambda log, _: raw_logs.plain_csv(
        {
            "time [s]": log.time,
            "friction force [N]": 10.0 * log.friction,
            "normal force [N]": np.full_like(log.time, 10.0),
        },
        separator="\t",
        decimal=",",
    ),
}


def text(name: str, folder: Path, log: RawLog, cycle: float) -> Path:
    """File of a format of text."""
    (folder / "log.txt").write_bytes(TEXTS[name](log, cycle))
    return folder / "log.txt"


FORMATS: dict[str, Writer] = {
    **{name: partial(text, name) for name in TEXTS},
    "xlsx": xlsx,
}
CYCLES = {"compend": 0.5}
"""Time of a cycle that a format's writer fixes [s]."""

SAID = ("umt", "tsv")
"""Formats that do not hold the time of a cycle."""

UNKNOWN = "unknown_cycle"
"""Logs as made, but without the time of a cycle."""


def groups(recipe: Recipe) -> Iterator[str]:
    """Names of the groups that a recipe belongs to."""
    run_in = next(value for value in RUN_INS if recipe.run_in <= value)
    correlation = min(CORRELATIONS, key=lambda value: abs(value - recipe.correlation))
    yield f"correlation {100 * correlation:g} %"
    yield f"running-in {100 * run_in:2.0f} %"
    yield f"running-in {100 * run_in:2.0f} %, correlation {100 * correlation:g} %"
    yield "drift" if recipe.drift else "no drift"
    yield "missing rows" if recipe.missing else "no missing rows"
    yield "irregular steps" if recipe.irregular else "regular steps"
    yield f"rows up to {next(most for most in (400, 1400, 6000, 20000) if recipe.rows <= most):5d}"
    yield f"modulation {100 * recipe.modulation / recipe.friction:2.0f} %"
    white = "with white noise" if recipe.white else "without white noise"
    yield white
    yield f"running-in {100 * run_in:2.0f} %, {white}"


def holds(test: TestFriction, known: Made, log: RawLog) -> tuple[float, bool]:
    """Error in standard errors, and whether the interval holds the truth."""
    axis = getattr(log, test.run_in_axis)
    last = float(known.log.time[-1] - known.log.time[0])
    start, end = (
        (place - axis[0]) / (axis[-1] - axis[0]) * last for place in (test.run_in_end, test.steady_end)
    )
    error = test.friction - known.truth(start, end)
    return error / test.standard_error, abs(error) <= test.half_width


class Tally:
    """Counts of one group."""

    def __init__(self) -> None:
        self.errors: list[float] = []
        self.held: list[bool] = []
        self.warned: list[bool] = []
        self.cuts: list[float] = []

    def add(self, test: TestFriction, known: Made, log: RawLog) -> None:
        """Count one test."""
        error, held = holds(test, known, log)
        self.errors.append(error)
        self.held.append(held)
        self.warned.append(any(words in flag for flag in test.flags for words in WARNED))
        self.cuts.append(test.run_in_end / getattr(log, test.run_in_axis)[-1])

    def line(self) -> str:
        """Counts as text."""
        n, k = len(self.held), sum(self.held)
        low, high = wilson_interval(k, n)
        calm = [held for held, warned in zip(self.held, self.warned, strict=True) if not warned]
        return (
            f"{n:5d} logs, held {100 * k / n:5.1f} % ({100 * low:.1f} to {100 * high:.1f}), "
            f"median error {np.median(self.errors):+.2f} standard errors, "
            f"cut {100 * np.median(self.cuts):3.0f} %, "
            f"flagged {100 * np.mean(self.warned):4.1f} %, held of the others {100 * np.mean(calm):5.1f} %"
        )


def report(title: str, answers: Iterable[Answer], *, grouped: bool = True) -> None:
    """Print the counts of every group, or of all logs."""
    tallies: dict[str, Tally] = defaultdict(Tally)
    for test, known, log in answers:
        for name in ("all", *(groups(known.recipe) if grouped else ())):
            tallies[name].add(test, known, log)
    print(f"{title}:")
    for name in sorted(tallies, key=lambda name: (name != "all", name)):
        print(f"  {name:34s} {tallies[name].line()}", flush=True)


def answers(count: int, seed: int, name: str = "") -> Iterator[Answer]:
    """Friction of logs of every kind, as they are or through a file; the same for the same seed."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as folder:
        for recipe in recipes(count, rng):
            known = made(_for_format(recipe, name), rng, knows_cycle=name != UNKNOWN)
            log = _through(name, known, Path(folder)) if name in FORMATS else known.log
            try:
                yield reduce_log(log), known, log
            except InputError as error:
                print(f"  refused: {error}")


def _for_format(recipe: Recipe, name: str) -> Recipe:
    if name not in FORMATS:
        return recipe
    step = CYCLES[name] / recipe.rows_of_a_cycle if name in CYCLES else recipe.step
    return replace(recipe, rows=min(recipe.rows, MOST_ROWS), step=step)


def _through(name: str, known: Made, folder: Path) -> RawLog:
    cycle = known.recipe.rows_of_a_cycle * known.recipe.step
    said = ColumnMap(test={"cycle_time": cycle}) if name in SAID else None
    (log,) = read_log(FORMATS[name](folder, known.log, cycle), said)
    return log


def main() -> None:
    """Report the coverage."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("logs", type=int, nargs="?", default=1000)
    parser.add_argument("formats", nargs="*", help="names of FORMATS, unknown_cycle, found_cycle or all")
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    names = [*FORMATS, UNKNOWN] if given.formats == ["all"] else given.formats
    if not names:
        report("as made", answers(given.logs, given.seed))
    for i, name in enumerate(names, start=1):
        report(name, answers(given.logs, given.seed + i, name), grouped=False)


if __name__ == "__main__":
    main()
