"""Two saved simulations, or two rankings, side by side: records of what is compared, and their text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from separatrix.present.text.tables import (
    ABSENT,
    facts,
    heading,
    number,
    paragraph,
    quantity,
    section,
    significant,
    table,
)
from separatrix.present.walk import field_units
from separatrix.units import Joule, Metre, MetrePerSecond, Newton, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """Which saved answer it is."""

    path: str
    title: str
    seed: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Run(Named):
    """Single numbers of a saved simulation; None for one that it lacks."""

    kick: MetrePerSecond | None
    run: int | None
    end_energy: Joule | None
    largest_offset: Metre | None
    largest_contact_force: Newton | None
    outcome: str | None
    largest_land_force: Newton


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """A material in a ranking."""

    verdict: str | None = None
    margin: Ratio | None = None
    probability_stable: Ratio | None = None
    friction: Ratio | None = None
    restitution_threshold: Ratio | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """A material in both rankings; None in one that lacks it."""

    name: str
    first: Standing | None
    second: Standing | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Environment:
    """The materials of both rankings in one environment."""

    name: str
    materials: tuple[Pair, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """An input that differs: a number with its unit, a text, or a list of them; None where it is absent."""

    key: str
    first: object
    second: object
    unit: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRuns:
    """Two simulations."""

    runs: tuple[Run, Run]
    differences: tuple[Difference, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRankings:
    """Two rankings."""

    rankings: tuple[Named, Named]
    environments: tuple[Environment, ...]
    differences: tuple[Difference, ...]


WORDS = {
    "kick": "kick",
    "end_energy": "energy at the end",
    "largest_offset": "largest offset",
    "largest_contact_force": "largest pocket force",
    "largest_land_force": "largest land force",
}
COLUMNS = ("friction", "margin", "P(stable)", "verdict")
HEADERS = ("material", *(f"{name}\nfirst" if i == 0 else "\nsecond" for name in COLUMNS for i in (0, 1)))


def compare(found: ComparedRuns | ComparedRankings, folder: Path | None) -> str:
    """Return the two answers in columns, and the inputs that differ."""
    if isinstance(found, ComparedRuns):
        units = field_units(Run)
        rows = [
            [words, *(quantity(getattr(run, name), units[name]) for run in found.runs)]
            for name, words in WORDS.items()
        ]
        rows += [
            [name, *(ABSENT if (one := getattr(run, name)) is None else str(one) for run in found.runs)]
            for name in ("run", "seed", "outcome")
        ]
        titles = heading(" / ".join(run.title for run in found.runs))
        blocks = [titles, section("Runs", table(("", "first", "second"), rows))]
    else:
        pair = zip(("first", "second"), found.rankings, strict=True)
        named = [(which, f"{one.title} ({one.path}, seed {one.seed})") for which, one in pair]
        tables = [
            section(one.name, table(HEADERS, [_ranked(row) for row in one.materials]))
            for one in found.environments
        ]
        blocks = [heading("Two rankings"), facts(named), *tables]
    rows = [[at.key, _value(at.first, at.unit), _value(at.second, at.unit)] for at in found.differences]
    differ = table(("", "first", "second"), rows) if rows else paragraph("None.")
    blocks.append(section("Inputs that differ", differ))
    if folder is not None:
        what = "Figure and data" if isinstance(found, ComparedRuns) else "Text and data"
        blocks.append(f"{what} are in {folder}/")
    return "\n\n".join(blocks) + "\n"


def _ranked(row: Pair) -> list[str]:
    pair = [row.first or Standing(), row.second or Standing()]
    return [
        row.name,
        *(number(one.friction) for one in pair),
        *(ABSENT if one.margin is None else f"{one.margin:+.2f}" for one in pair),
        *(number(one.probability_stable, 2) for one in pair),
        *(one.verdict or ABSENT for one in pair),
    ]


def _value(value: object, unit: str | None) -> str:
    if isinstance(value, list):
        return (
            ", ".join(_value(one, unit or "-") if isinstance(one, float) else str(one) for one in value)
            or ABSENT
        )
    if isinstance(value, float):
        return quantity(value, unit) if unit else significant(value)
    return ABSENT if value is None else str(value)
