"""A study to fill in, from its schema: the commented file, and what a form shows."""

from __future__ import annotations

import tomllib
import typing
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import Any

from separatrix.ground.schema import Described, OneOf, is_number, is_record, keys_of, meanings_of
from separatrix.ground.units import HABITS, UNITS, format_quantity, shown
from separatrix.study.library import Library
from separatrix.study.study import ORDER, Study

CANDIDATES = "ranking.candidates"
USE = """\
A study for separatrix. Fill in your bearing, then:
  separatrix check THIS_FILE        is it right?
  separatrix rank THIS_FILE         which cage material runs stably?
Every dimensional value is text with its unit: "11.1125 mm", "300 daN". Ratios are plain numbers.
Any of them may be uncertain: "0.5 um +- 20 %" (two standard deviations), a list of samples, or bounds.
A line that starts with # is off: it shows an optional key, with its default or an example.
Names of the library: separatrix materials list
"""
EXAMPLES = {
    "extends": '"base.toml"',
    "library": '"materials.toml"',
    "bearing.designation": '"608"',
    "bearing.radial_clearance": '"10 um"',
    "operation.preload": '"28 N"',
    "operation.arrangement": '"back-to-back"',
    "operation.preload_kind": '"spring"',
    "operation.tilt": '"0 mrad"',
    "operation.moment": '"0 N m"',
    "operation.ramp_time": '"50 ms"',
    "film.elastic_modulus": '"4 GPa"',
    "film.poisson_ratio": "0.38",
    "film.wear": '{ width = "0.2 mm", friction = 0.3 }',
    "film.wear.width": '"0.2 mm"',
    "cage.ball": '"auto"',
    "cage.motion": '"space"',
    "cage.inner_diameter": '"58 mm"',
    "cage.outer_diameter": '"72 mm"',
    "cage.width": '"14 mm"',
    "cage.impact_speed": '"0.5 m/s"',
    "cage.ball_cage_friction": "0.09",
    "cage.pocket_axial_clearance": '"0.4 mm"',
    "cage.pocket_axial_offset": '"0.1 mm"',
    "cage.pocket_angles": '["0 deg", "30 deg", "55 deg", "85 deg", "110 deg", "140 deg", "165 deg", '
    '"195 deg", "220 deg", "250 deg", "275 deg", "305 deg", "330 deg"]',
    "cage.land_out_of_round": '"20 um"',
    "cage.moment_of_inertia": '"26.4 kg mm2"',
    "cage.transverse_inertia": '"13.3 kg mm2"',
    "cage.land_spacing": '"12 mm"',
    "cage.land_diameter": '"72 mm"',
    "cage.fluid_swirl": "0.5",
    "cage.gravity": '"9.81 m/s2"',
    "stability.reference_kick": '"0.5 m/s"',
    "stability.kicks": '["0.1 m/s", "0.5 m/s", "2 m/s"]',
    "stability.restitution_factors": "[0.1, 0.3, 0.5, 0.7, 0.9]",
    "ranking.environment": '"liquid nitrogen, 440C"',
    "ranking.materials": '["Armalon", "Vespel SP 211"]',
    f"{CANDIDATES}.material": '{ elastic_modulus = "5 GPa", poisson_ratio = 0.4 }',
}
"""Values of the bearing of the template for keys that are off there, where the default shows nothing."""


NAMED = {("ranking", "friction"): "friction table", ("bearing", "designation"): "bearing"}
"""Keys that name a record of the library and are read in a form of their own, and its kind."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyKey:
    """A key of a study with what a form shows of it."""

    section: str
    """Empty above the first one."""

    one: Described
    written: str
    """An example as TOML."""

    meaning: str
    """Sentences: what it is, what it excludes or needs, its choices, its default."""

    is_required: bool

    @property
    def name(self) -> str:
        """Its name in the section."""
        return self.one.name

    @property
    def is_on(self) -> bool:
        """Whether the template gives it a value."""
        return self.section != CANDIDATES and (self.one.is_required or self.one.key.example != "")

    @property
    def example(self) -> Any:
        """The value of the example."""
        return tomllib.loads(f"value = {self.written}")["value"]

    @property
    def choices(self) -> tuple[str, ...]:
        """Values to choose from, of which one must be taken if `is_word`."""
        if self.is_word:
            return tuple(str(option.value) for option in self.one.hint)
        kind = NAMED.get((self.section, self.name), self.one.key.named)
        return Library().names(kind) if kind else ()

    @property
    def is_word(self) -> bool:
        """Whether it takes one of some words."""
        return isinstance(self.one.hint, type) and issubclass(self.one.hint, Enum)

    @property
    def is_name(self) -> bool:
        """Whether its value is text even if it looks like a number: steel 52100."""
        return self.one.hint is str or bool(self.choices)


def sections() -> dict[str, Any]:
    """Record of the keys above the sections, of each section in the order of the template, of a candidate."""
    keys = keys_of(Study)
    found = {"": Study} | {name: keys[name].key.form or keys[name].hint for name in ORDER}
    return found | {CANDIDATES: typing.get_args(keys_of(found["ranking"])["candidates"].hint)[0]}


@cache
def study_keys(section: str) -> tuple[StudyKey, ...]:
    """Keys of a section; those of a candidate are in a section of its own."""
    return tuple(keys_in(section, sections()[section]))


def keys_in(path: str, owner: Any) -> Iterator[StudyKey]:
    """Keys of a record at a path of a study."""
    rules = [rule for rule in getattr(owner, "RULES", ()) if isinstance(rule, OneOf)]
    chosen = [group for rule in rules if rule.required for group in rule.groups]
    for name, one in keys_of(owner).items():
        at = f"{path}.{name}" if path else name
        if at in (*ORDER, CANDIDATES):
            continue
        said = meanings_of(owner).get(name, "")
        parts = [said, *_conditions(rules, one), *_values(one, said)]
        if not any(name in group for group in chosen):
            parts.append(_default(one))
        yield StudyKey(
            section=path,
            one=one,
            written=one.key.example or EXAMPLES.get(at) or _example(one),
            meaning=" ".join(f"{part[0].upper()}{part[1:]}".rstrip(".") + "." for part in parts if part),
            is_required=one.is_required or any(name in group for group in chosen[:1]),
        )


def _example(one: Described) -> str:
    """The default as TOML, in a usual unit."""
    if isinstance(one.default, Enum):
        return f'"{one.default.value}"'
    if isinstance(one.default, bool):
        return shown(one.default)
    if one.unit in HABITS:
        number = isinstance(one.default, float) and one.default
        return f'"{format_quantity(one.default, one.unit)}"' if number else f'"0 {HABITS[one.unit]}"'
    return f"{one.default:g}" if isinstance(one.default, int | float) else '""'


def _conditions(rules: Sequence[OneOf], one: Described) -> Iterator[str]:
    """What the key takes the place of, and what it needs."""
    for rule in rules:
        if any(one.name in group for group in rule.groups[1:]):
            yield f"instead of {' and '.join(rule.groups[0])}"
    for only in one.key.only:
        yield f"only with {only.key} {' or '.join(_word(value) for value in only.values)}"
    if one.key.needs:
        yield f"only with {one.key.needs[0]}"


def _values(one: Described, said: str) -> Iterator[str]:
    """Words or names that the key takes, if its meaning does not say them all."""
    words = list(one.hint) if isinstance(one.hint, type) and issubclass(one.hint, Enum) else []
    if any(_word(word) not in said for word in words):
        yield f"one of {', '.join(map(_word, words))}"
    if one.key.named:
        yield f"a {one.key.named} of the library, or its elastic_modulus and poisson_ratio"


def _default(one: Described) -> str:
    """What the key is without a value."""
    if one.is_required or is_record(type(one.default)):
        return "required" if one.is_required else ""
    if one.default in (None, (), ""):
        text, after = one.key.without, one.key.without.removeprefix("not given")
        if text == after or after[:1] == ":":
            return f"default: {after.removeprefix(': ')}" if text else ""
        return after.removeprefix("; ") if after[:1] == ";" else ""
    is_quantity = one.unit in UNITS and one.default
    value = format_quantity(one.default, one.unit) if is_quantity else _word(one.default)
    return f"default {value}, {one.key.without}".rstrip(", ")


def _word(value: Any) -> str:
    if isinstance(value, Enum):
        return f'"{value.value}"'
    return f"{value:g}" if is_number(value) else shown(value)


def remark_of(section: str) -> str:
    """The sentence on a section as a whole."""
    if section == CANDIDATES:
        return meanings_of(sections()["ranking"])["candidates"]
    return (sections()[section].__doc__ or "").partition("\n")[0] if section else ""


def template() -> str:
    """Commented study to fill in; valid as it is."""
    lines = [f"# {line}" for line in USE.splitlines()]
    for section in sections():
        off = "# " if section == CANDIDATES else ""
        head = f"{off}[[{section}]]" if off else f"[{section}]"
        lines += ["", f"{head:<40} # {remark_of(section)}"] if section else []
        for key in study_keys(section):
            code = f"{'' if key.is_on else '# '}{key.name} = {key.written}"
            lines.append(f"{code:<40} # {key.meaning}" if key.meaning else code)
    return "\n".join(lines) + "\n"
