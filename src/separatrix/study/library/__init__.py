"""Materials, fluids, friction tables and bearings by name, each number with source, conditions, confidence.

The shipped data are the TOML files in `data/`; libraries of the user have the same form
(docs/reference/materials.md). A `Library` has the shipped records, and over them those of the user's files.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from separatrix.friction.friction_file import LEAST_FRICTION
from separatrix.friction.friction_law import GIVEN, SCATTER_CURE, SCATTER_RULE, Friction
from separatrix.ground import reader
from separatrix.ground.errors import DataError, InputError
from separatrix.ground.schema import Fault, Faults, Open, between, check, key, keys_of, one_of, record
from separatrix.ground.toml import Kind, folded, label_of, nearest, read_text
from separatrix.ground.units import (
    Kelvin,
    MetrePerSecond,
    Newton,
    Pascal,
    format_quantity,
    printable,
    shown,
)
from separatrix.study.ball_bearing import MOST_BALLS, ROOM, Expansion, Material

KINDS = ("bearing material", "cage material", "film", "fluid", "friction table", "bearing")
"""Kinds of records; in a file the section is the same word with an underscore."""

CONFIDENCES = ("measured", "maker", "literature", "handbook", "guess")
"""Kinds of source: an own test, a maker's data sheet, a publication, several public tables, a guess."""

NEAR: Kelvin = 10.0
"""A datum with one temperature serves this far to either side of it."""

LONG = (1, 1000)
BLANK = "What is not known is left out, never given as 0."


@record
class Datum:
    """One number with its source and its conditions; what is not known is None."""

    value: Open = key()
    range: tuple[Open, ...] | None = key(default=None, length=(2, 2))
    """Where the true value is expected."""

    temperature: tuple[Kelvin, Kelvin] | None = key(between(1e-3, 5000.0), default=None)
    """Lowest and highest temperature of the source; both are the same where it states one."""

    pressure: Pascal | None = key(between(1e-9, 1e11), default=None)
    medium: str | None = key(default=None, letters=LONG)
    form: str | None = key(default=None, letters=LONG)
    source: str = key(letters=(3, 1000), hint="Give who measured or printed it, and where.")
    confidence: str = key(letters=LONG, hint='A guess is allowed and marked: "guess".')

    def serves_at(self, temperature: Kelvin) -> bool:
        """Whether its stated temperatures include this one."""
        if self.temperature is None:
            return False
        low, high = self.temperature
        margin = NEAR if low == high else 0.0
        return low - margin <= temperature <= high + margin

    def plain(self, unit: str) -> dict[str, object]:
        """Return it as plain data with every condition, None where it is not known."""
        values = {name: getattr(self, name) for name in keys_of(Datum)}
        values = {name: list(one) if isinstance(one, tuple) else one for name, one in values.items()}
        return {"value": values.pop("value"), "unit": unit, **values}


@check(Datum)
def _value_in_its_range(value: Open, range: tuple[Open, ...]) -> Faults:
    if not range[0] <= value <= range[1]:
        yield Fault("range", "must have the value between its ends, the lower one first")


Data = tuple[Datum, ...]
"""One datum of a property, or several under different conditions."""

_EXAMPLE = '{ value = "5 GPa", source = "our test 12", confidence = "measured" }'


def data(low: float, high: float, **properties: Any) -> Any:
    """Key of a property: the range of real values."""
    properties = {"hint": f"Check the unit. {BLANK}", "example": _EXAMPLE, "length": (1, 100), **properties}
    conditions = ("temperature", "pressure", "medium", "form")
    return key(between(low, high), single=True, distinct=conditions, **properties)


@record
class Solid:
    """A material of balls, rings or cage, or a film."""

    elastic_modulus: Annotated[Data, "Pa"] = data(1e5, 5e12)
    poisson_ratio: Annotated[Data, "-"] = data(0.001, 0.499)
    density: Annotated[Data, "kg/m3"] = data(1.0, 1e5, default=())
    compressive_strength: Annotated[Data, "Pa"] = data(1e4, 1e11, default=())
    thermal_expansion: Annotated[Data, "m/m/K"] = data(-1e-4, 1e-3, default=())
    """Mean from 293 K."""

    wear_coefficient: Annotated[Data, "m3/(N m)"] = data(1e-24, 1e-6, default=())
    """Worn volume over load and sliding distance, on steel; `form` has the rig."""

    aliases: tuple[str, ...] = key(default=(), length=(1, 20))
    composition: str | None = key(default=None, letters=LONG)
    remark: str | None = key(default=None, letters=LONG)
    replaces: bool = key(default=False)
    """Whether it hides a shipped record of its name."""


@record
class Fluid:
    """A liquid or a gas, with the name of its substance in CoolProp."""

    substance: str = key()
    phase: Literal["liquid", "gas"] = key()
    coolprop: str | None = key(default=None)
    triple_temperature: Annotated[Data, "K"] = data(0.1, 5000.0, default=())
    boiling_temperature: Annotated[Data, "K"] = data(0.1, 5000.0, default=())
    critical_temperature: Annotated[Data, "K"] = data(0.1, 5000.0, default=())
    critical_pressure: Annotated[Data, "Pa"] = data(1.0, 1e9, default=())
    density: Annotated[Data, "kg/m3"] = data(1e-6, 1e5, default=())
    viscosity: Annotated[Data, "Pa s"] = data(1e-8, 1e3, default=())
    heat_capacity: Annotated[Data, "J/kg/K"] = data(1.0, 1e6, default=())
    latent_heat: Annotated[Data, "J/kg"] = data(1.0, 1e8, default=())
    surface_tension: Annotated[Data, "N/m"] = data(1e-6, 1e2, default=())
    vapour_density: Annotated[Data, "kg/m3"] = data(1e-6, 1e5, default=())
    """Beside the boiling liquid."""

    aliases: tuple[str, ...] = key(default=(), length=(1, 20))
    remark: str | None = key(default=None, letters=LONG)
    replaces: bool = key(default=False)


@check(Fluid)
def _coolprop_is_a_pure_fluid(coolprop: str) -> Faults:
    if not (coolprop.isascii() and coolprop.replace("-", "").isalnum()):
        yield Fault("coolprop", "must be the plain name of a pure fluid, letters and digits")


@record
class Bearing:
    """Geometry of a bearing under its designation, as far as a source states it."""

    RULES: ClassVar = (one_of("contact_angle", "radial_clearance"),)

    bore: Annotated[Data, "m"] = data(1e-6, 100.0, default=())
    ball_count: Annotated[Data, "-"] = data(3.0, MOST_BALLS)
    ball_diameter: Annotated[Data, "m"] = data(1e-5, 10.0)
    pitch_diameter: Annotated[Data, "m"] = data(1e-5, 100.0)
    contact_angle: Annotated[Data, "rad"] = data(0.0, 1.57, default=())
    radial_clearance: Annotated[Data, "m"] = data(0.0, 1e-2, default=())
    inner_conformity: Annotated[Data, "-"] = data(0.5, 0.6, default=())
    outer_conformity: Annotated[Data, "-"] = data(0.5, 0.6, default=())
    aliases: tuple[str, ...] = key(default=(), length=(1, 20))
    remark: str | None = key(default=None, letters=LONG)
    replaces: bool = key(default=False)


UNITS = {
    name: one.unit
    for owner in (Solid, Fluid, Bearing)
    for name, one in keys_of(owner).items()
    if one.hint == Data
}
"""SI unit of each property."""


@record
class FrictionTable:
    """Measured ball/cage friction of several materials in several environments."""

    title: str = key(letters=LONG)
    source: str = key(letters=LONG)
    confidence: str = key(letters=LONG)
    environments: tuple[str, ...] = key(default=(), length=(1, 2000))
    """Their order, if not that of the frictions."""

    friction: Mapping[str, Mapping[str, Friction]] = key(
        length=(1, 2000), hint='Write a section [friction_table."NAME".friction."MATERIAL"] for each.'
    )
    temperature: tuple[Kelvin, Kelvin] | None = key(between(1e-3, 5000.0), default=None)
    slip_speed: tuple[MetrePerSecond, MetrePerSecond] | None = key(between(1e-9, 1e4), default=None)
    normal_force: tuple[Newton, Newton] | None = key(between(1e-9, 1e9), default=None)
    pressure: tuple[Pascal, Pascal] | None = key(between(1e-3, 1e12), default=None)
    remark: str | None = key(default=None, letters=LONG)
    replaces: bool = key(default=False)

    @property
    def columns(self) -> tuple[str, ...]:
        """Environments in their order."""
        return self.environments or tuple(dict.fromkeys(env for row in self.friction.values() for env in row))

    @property
    def rows(self) -> dict[str, dict[str, Friction | None]]:
        """Friction of each material in each environment; None where it was not measured."""
        return {
            name: {env: self._sourced(row[env]) if env in row else None for env in self.columns}
            for name, row in self.friction.items()
        }

    def _sourced(self, one: Friction) -> Friction:
        """A friction of the table with the table's source, if it states none of its own."""
        source = self.source if one.source == GIVEN else one.source
        return replace(one, source=source, confidence=self.confidence)

    @property
    def conditions(self) -> dict[str, tuple[float, float]]:
        """Lowest and highest value of each condition that is known, in SI."""
        return {name: limits for name in CONDITIONS if (limits := getattr(self, name)) is not None}


CONDITIONS = {name: one.unit for name, one in keys_of(FrictionTable).items() if one.unit}
"""SI unit of each condition of a friction table."""


@check(FrictionTable)
def _environments_of_the_rows(
    environments: tuple[str, ...], friction: Mapping[str, Mapping[str, Friction]]
) -> Faults:
    if len(set(environments)) < len(environments):
        yield Fault("environments", "names an environment twice")
    unknown = [env for row in friction.values() for env in row if environments and env not in environments]
    if unknown:
        rule, cure = "lacks an environment that the table uses", nearest(unknown[0], environments)
        yield Fault("environments", rule, cure, shown(unknown[0]))


@check(FrictionTable)
def _frictions_above_zero(friction: Mapping[str, Mapping[str, Friction]]) -> Faults:
    for at, one in (
        (("friction", a, b, "mean"), one) for a, row in friction.items() for b, one in row.items()
    ):
        if one.mean == 0.0:
            yield Fault(at, "must be above 0", BLANK)
        elif one.standard_deviation and one.mean < LEAST_FRICTION:
            yield Fault(at, SCATTER_RULE, SCATTER_CURE)


@check(Datum, FrictionTable)
def _confidence_is_known(confidence: str) -> Faults:
    if confidence.partition(";")[0].strip() not in CONFIDENCES:
        rule = f"must be one of {', '.join(CONFIDENCES)}, perhaps with a remark after a semicolon"
        yield Fault("confidence", rule, 'A guess is allowed and marked: "guess".')


@record
class Content:
    """The keys of a library file."""

    FILE: ClassVar = Kind(
        noun="a library of materials",
        most_bytes=1024 * 1024,
        empty="`separatrix materials show 440C` shows what a record holds.",
    )

    title: str | None = key(default=None, letters=LONG)
    bearing_material: Mapping[str, Solid] = key(default={})
    cage_material: Mapping[str, Solid] = key(default={})
    film: Mapping[str, Solid] = key(default={})
    fluid: Mapping[str, Fluid] = key(default={})
    friction_table: Mapping[str, FrictionTable] = key(default={})
    bearing: Mapping[str, Bearing] = key(default={})


@check(Content)
def _has_a_record(content: Content) -> Faults:
    if not any(getattr(content, kind.replace(" ", "_")) for kind in KINDS):
        yield Fault("", 'has no record: it needs a section such as [cage_material."My compound"]', got="")


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryFile:
    """The file that a record was read from."""

    file: str
    """Its name."""

    sha256: str
    shipped: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A material, fluid or friction table under its name, and where it is from."""

    kind: str
    name: str
    content: Any
    """`Solid`, `Fluid`, `FrictionTable` or `Bearing`, by the kind."""

    file: LibraryFile
    place: str
    """File and line."""

    @property
    def data(self) -> dict[str, Data]:
        """Data of each property that is known; of a friction table none."""
        return {name: data for name in UNITS if (data := getattr(self.content, name, ()))}

    @property
    def aliases(self) -> tuple[str, ...]:
        """Other names of it."""
        return getattr(self.content, "aliases", ())

    def plain(self) -> dict[str, object]:
        """Return the whole record as plain data."""
        content, words = self.content, {"kind": self.kind, "name": self.name, "library": asdict(self.file)}
        if isinstance(content, FrictionTable):
            return {
                **words,
                **{name: getattr(content, name) for name in ("title", "remark", "source", "confidence")},
                "conditions": {
                    name: {"value": getattr(content, name) and list(getattr(content, name)), "unit": unit}
                    for name, unit in CONDITIONS.items()
                },
                "environments": list(content.columns),
                "friction": {
                    material: {
                        env: one and {n: getattr(one, n) for n in ("mean", "standard_deviation", "count")}
                        for env, one in row.items()
                    }
                    for material, row in content.rows.items()
                },
            }
        facts = ("substance", "phase", "coolprop") if isinstance(content, Fluid) else ()
        return {
            **words,
            **{name: getattr(content, name, None) for name in ("remark", "composition", *facts)},
            "aliases": list(content.aliases) or None,
            "data": {name: [one.plain(UNITS[name]) for one in data] for name, data in self.data.items()},
        }


_NOWHERE = (1e9, 2e9)
"""Temperatures of a datum whose source states none: it serves last."""


class Choice(NamedTuple):
    """The datum that serves at a temperature, and the caution about it; None if there is none."""

    datum: Datum
    caution: str | None


def choose(data: Sequence[Datum], temperature: Kelvin | None, words: str) -> Choice:
    """Datum for a temperature: that with the narrowest stated range around it.

    None is interpolated or extrapolated. Where no range includes the temperature, the nearest datum serves
    and the caution states it; without a temperature the first one serves.
    """
    if temperature is None:
        return Choice(data[0], None)
    spans = [(datum, *(datum.temperature or _NOWHERE)) for datum in data]
    if fitting := [one for one in spans if one[0].serves_at(temperature)]:
        return Choice(min(fitting, key=lambda one: one[2] - one[1])[0], None)
    nearest, low, high = min(spans, key=lambda one: max(one[1] - temperature, temperature - one[2], 0.0))
    at = format_quantity(temperature, "K")
    if nearest.temperature is None:
        return Choice(nearest, f"{words}: its source states no temperature, taken at {at}")
    first, last = format_quantity(low, "K"), format_quantity(high, "K")
    stated = first if first == last else f"{first} to {last}"
    return Choice(nearest, f"{words}: not stated at {at}, the value at {stated} is used")


def contradictions(record: Mapping[str, Any], temperature: Kelvin) -> Iterator[str]:
    """Sentences on a fluid whose temperature rules out the phase in its name at any pressure.

    A liquid exists between the triple and the critical temperature. A gas exists at any temperature, but
    below the triple point only as thin vapour over the solid. Between, the pressure decides, which a study
    does not state.
    """
    name, phase, at = record["name"], record["phase"], format_quantity(temperature, "K")
    data = record["data"]
    critical, triple = (
        data[key][0]["value"] if data.get(key) else None
        for key in ("critical_temperature", "triple_temperature")
    )
    cure = "Correct the fluid or the temperature."
    if phase == "liquid" and critical is not None and temperature > critical:
        limit = f"the critical temperature is {format_quantity(critical, 'K')}"
        yield f"{name}: at {at} there is no liquid at any pressure, {limit}. {cure}"
    if triple is not None and temperature < triple:
        limit = f"the triple point is {format_quantity(triple, 'K')}"
        yield f"{name}: at {at} it is solid, or a thin vapour; {limit}. {cure}"


# --- the library ----------------------------------------------------------------------------------
SHIPPED_FILES = {
    "bearing material": ("bearing_materials.toml",),
    "cage material": ("cage_materials.toml",),
    "film": ("films.toml",),
    "fluid": ("fluids.toml",),
    "friction table": ("pin-on-disk-77K.toml", "friction-in-vacuum.toml"),
    "bearing": ("bearings.toml",),
}
"""Shipped files of each kind; they are read when they are first used."""

BESIDE = "materials.toml"
"""Name of a library that is read where it is beside a study."""

Records = Mapping[str, Record]

WORDS = {
    "elastic_modulus": "modulus",
    "poisson_ratio": "Poisson's ratio",
    "density": "density",
    "compressive_strength": "compressive strength",
}
"""Properties of which one datum serves, in words; of the thermal expansion all serve, at any temperature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Library:
    """The shipped records and, over them, those of the user's files."""

    files: tuple[LibraryFile, ...] = ()
    """Files of the user."""

    own: Mapping[str, Records] = field(default_factory=dict)
    """Records of the user by kind and name."""

    def records(self, kind: str) -> Records:
        """Records of one kind by name, the shipped ones first."""
        return {**shipped_records(kind), **self.own.get(kind, {})}

    def names(self, kind: str) -> tuple[str, ...]:
        """Names of one kind, in the order of the files."""
        return tuple(self.records(kind))

    def material(self, kind: str, name: str, temperature: Kelvin | None = None) -> Material:
        """One solid by its exact name, with the data that serve at a temperature."""
        return as_material(self.record(kind, name), temperature)

    def record(self, kind: str, name: str) -> Record:
        """One record by its exact name."""
        if name not in (known := self.records(kind)):
            raise DataError(f'no {kind} "{printable(name)}"; the library has {", ".join(known)}')
        return known[name]

    def named(self, kind: str, name: str) -> str | None:
        """Exact name of a record by its name or another name of it, in any spelling; None if unknown.

        Case of letters, spaces, hyphens and the like do not count.
        """
        records, wanted = self.records(kind), folded(name)
        if name in records:
            return name
        found = [known for known in records if folded(known) == wanted]
        found = found or [one.name for one in records.values() if wanted in map(folded, one.aliases)]
        return found[0] if wanted and len(found) == 1 else None

    def fluid(self, name: str) -> Record | None:
        """Record of a fluid by its name or another name of it, in any spelling; None if unknown."""
        known = self.named("fluid", name)
        return None if known is None else self.record("fluid", known)


def as_material(record: Record, temperature: Kelvin | None = None) -> Material:
    """Solid with the data of a record that serve at a temperature, and the whole record behind it."""
    solid: Solid = record.content
    data = record.data
    chosen = {key: choose(data[key], temperature, words) for key, words in WORDS.items() if key in data}
    sources = [f"{WORDS[key]}: {choice.datum.source}" for key, choice in chosen.items()]
    confidences = [f"{WORDS[key]}: {choice.datum.confidence}" for key, choice in chosen.items()]
    composition = [f"Composition: {solid.composition}"] if solid.composition else []
    remark = [solid.remark.rstrip(".")] if solid.remark else []
    # numbers on which any answer depends
    acting = ("elastic_modulus", "poisson_ratio", *["density"] * (record.kind == "bearing material"))
    taken = {key: data[key].index(choice.datum) for key, choice in chosen.items()}
    if wear := solid.wear_coefficient:
        taken["wear_coefficient"] = wear.index(choose(wear, temperature, "").datum)
    expansions = (
        Expansion(*(d.temperature or (ROOM, ROOM)), d.value, d.confidence) for d in solid.thermal_expansion
    )
    return Material(
        name=record.name,
        expansions=tuple(sorted(expansions)),
        source=". ".join([*composition, *remark, *sources]),
        confidence=", ".join(confidences),
        record={**record.plain(), "taken": taken, "taken_at": temperature},
        cautions=tuple(one.caution for key, one in chosen.items() if one.caution and key in acting),
        **{key: choice.datum.value for key, choice in chosen.items()},
    )


def read_library(path: Path, *, shipped: bool = False) -> tuple[Record, ...]:
    """Records of a library file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: file, line, record, rule, value, cure.
    """
    return library_of_text(read_text(path, Content.FILE), label_of(path), shipped=shipped)


def library_of_text(text: str, label: str, *, shipped: bool = False) -> tuple[Record, ...]:
    """Records of the text of a library file."""
    loaded = reader.read_text(Content, text, label)
    file = LibraryFile(file=label, sha256=hashlib.sha256(text.encode()).hexdigest(), shipped=shipped)
    return tuple(
        Record(kind=kind, name=name, content=content, file=file, place=loaded.places[section, name])
        for kind, section in ((kind, kind.replace(" ", "_")) for kind in KINDS)
        for name, content in getattr(loaded.value, section).items()
    )


def joined(contents: Sequence[Sequence[Record]]) -> Library:
    """Library of files of the user over the shipped records."""
    own: dict[str, dict[str, Record]] = {}
    for records in contents:
        for one in records:
            kind = own.setdefault(one.kind, {})
            _refuse_hiding(kind.get(one.name) or shipped_records(one.kind).get(one.name), one)
            kind[one.name] = one
    for name, of_kind in own.items():
        _refuse_alike({**shipped_records(name), **of_kind}.values())
    return Library(files=tuple(records[0].file for records in contents), own=own)


def _refuse_hiding(old: Record | None, new: Record) -> None:
    """Refuse a record that would replace another without stating so."""
    if old is None and new.content.replaces:
        rule = f"replaces a {new.kind} that is not shipped"
        raise InputError(_header(new), rule, cure="Leave replaces out, or correct the name.")
    if old is not None and not old.file.shipped:
        cure = "Rename or remove one of them."
        raise InputError(_header(new), f"is in {old.place} too", shown(new.name), cure)
    if old is not None and not new.content.replaces:
        cure = "Give it another name, or write replaces = true."
        raise InputError(_header(new), f"has the name of a shipped {new.kind}", shown(new.name), cure)


def _refuse_alike(records: Iterable[Record]) -> None:
    """Refuse a name that an earlier record has, but for capitals and spaces."""
    known: dict[str, Record] = {}
    for one in records:
        for name in (one.name, *one.aliases):
            old = known.setdefault(" ".join(name.casefold().split()), one)
            if old is not one:
                rule = f"has a name of {printable(old.name)} ({old.place})"
                raise InputError(_header(one), rule, shown(name), "Give it another name.")


def _header(record: Record) -> str:
    return f"{record.place}: [{record.kind.replace(' ', '_')}] {printable(record.name)}"


@cache
def shipped_records(kind: str) -> Records:
    """Records of one kind that come with the package, by name."""
    folder = Path(__file__).with_name("data")
    files = (read_library(folder / name, shipped=True) for name in SHIPPED_FILES[kind])
    return {record.name: record for records in files for record in records}


def with_files(paths: Iterable[Path]) -> Library:
    """Shipped library with library files of the user."""
    return joined([read_library(path) for path in dict.fromkeys(path.resolve() for path in paths)])
