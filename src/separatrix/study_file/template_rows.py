"""Keys of a study and what is said about each, read from the commented template."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from separatrix.study_file.shipped import template

_HEADER = re.compile(r"(# )?\[\[?([a-z_.]+)\]\]?\s*(?:#\s*(.*))?")
_KEY = re.compile(r"(# )?([a-z_]+) = (.*)")


@dataclass(frozen=True, slots=True, kw_only=True)
class TemplateKey:
    """One key of the template."""

    section: str
    """Empty above the first section."""
    key: str
    example: Any
    is_on: bool
    """Whether the template gives it, or only shows it in a comment."""
    meaning: str


_REQUIRED = {
    "bearing": (
        *("ball_diameter", "pitch_diameter", "ball_count", "contact_angle", "inner_conformity"),
        *("outer_conformity", "ball_material", "ring_material"),
    ),
    "operation": ("inner_speed", "axial_load"),
    "film": ("race_friction",),
    "cage": ("mass", "pocket_clearance"),
}
_PLACE_OF_NAME = "a name of the library, or rows for its elastic_modulus, poisson_ratio and density"
_WHOLE = {
    "bearing.pitch_diameter": "of the circle through the centres of the balls",
    "bearing.contact_angle": "without load; or instead of it radial_clearance",
    "bearing.radial_clearance": "diametral play; gives the angle acos(1 - play / (2 (f_i + f_o - 1) D))",
    "bearing.ball_material": _PLACE_OF_NAME,
    "bearing.ring_material": _PLACE_OF_NAME,
    "operation.tilt": "default 0: the rings are held parallel, or at this angle. Or instead of it moment",
    "operation.ramp_time": "default 0: steady. Start-up: all speeds rise in this time, from ramp_start on",
    "operation.ramp_start": "default 0.1; share of the speeds at which the ramp begins",
    "film.material": "a name of the library, or instead of it elastic_modulus and poisson_ratio",
    "film.elastic_modulus": "in place of a name",
    "film.poisson_ratio": "in place of a name",
    "cage.ball_cage_stiffness": "default: from Hertz, ball in pocket, with the modulus of the material",
    "cage.material": "only for that stiffness; in a ranking each candidate has its own",
    "cage.pocket_angles": "where the balls and their pockets stand; default: even; one for each ball, rising",
    "cage.pocket_spacing_scatter": "default 0; or: pockets and balls off by up to this share of a pitch",
    "cage.land_out_of_round": "default 0; amplitude: half of highest less lowest radius",
    "cage.land_lobes": "of the land that is out of round; default 2, an oval",
    "ranking.friction": "a friction table of the library; or your own candidates on the sheet candidates",
    "ranking.materials": "default: all in the table",
}
"""What the template says across the lines of two keys, for each by itself."""


@cache
def template_keys() -> tuple[TemplateKey, ...]:
    """Return the keys of the template in its order."""
    return tuple(_keys(template()))


@cache
def section_remarks() -> dict[str, str]:
    """Return what the template says of a section as a whole."""
    found = (_HEADER.fullmatch(line) for line in template().splitlines())
    return {match[2]: match[3] for match in found if match and match[3] and not match[1]}


def meaning(one: TemplateKey) -> str:
    """Return what a row says of its key: the template's words, whole where they run over two keys there."""
    return _WHOLE.get(f"{one.section}.{one.key}", one.meaning)


def is_required(one: TemplateKey) -> bool:
    """Whether a section cannot be without the key."""
    return one.key in _REQUIRED.get(one.section, ())


def _keys(text: str) -> Iterator[TemplateKey]:
    section, above = "", ""
    for line in text.splitlines():
        header, key = _HEADER.fullmatch(line), _KEY.fullmatch(line)
        if header:
            section, above = header[2], ""
        elif key:
            written, meaning = _split(key[3])
            said = " ".join(part for part in (above, meaning) if part)
            yield TemplateKey(
                section=section, key=key[2], example=_value(written), is_on=key[1] is None, meaning=said
            )
            above = ""
        elif section and line.startswith("# "):
            above = f"{above} {line[2:].strip()}".strip()


def _split(text: str) -> tuple[str, str]:
    """Return the value and the comment behind it."""
    value, _, comment = text.partition(" #")
    return value.strip(), comment.strip(" #")


def _value(written: str) -> Any:
    return tomllib.loads(f"value = {written}")["value"]
