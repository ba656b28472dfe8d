"""A contact file in TOML: every dimensional value is text with its unit, as in a study file."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

from separatrix.chain.hertz import ContactEllipse, ellipse_of_axes, ellipse_of_curvatures
from separatrix.chain.traction.exact.bound import FrictionLaw
from separatrix.chain.traction.exact.contact import LARGEST_CREEP, LARGEST_SIDE, SMALLEST_SIDE, ContactProblem
from separatrix.chain.traction.exact.flexibility import NEARLY_INCOMPRESSIBLE, Body, Layer, Solid, solid
from separatrix.chain.traction.exact.grid import cell_counts
from separatrix.chain.traction.profile import Profile
from separatrix.contact_file.question import ContactQuestion, ContactSetup, Motion, cases_of, refuse_extremes
from separatrix.errors import InputError, ValidityWarning, noted, together
from separatrix.library import beside, with_files
from separatrix.study_file.values import named_material, using
from separatrix.toml_files import (
    Kind,
    Places,
    Reader,
    Values,
    choice,
    label_of,
    list_of,
    nearest,
    places_of,
    quantity,
    ratio,
    read_toml,
    text,
    truth,
    whole,
)
from separatrix.units import NUMBER, format_quantity, parse, printable, shown

Number = TypeVar("Number", float, int)
Made = TypeVar("Made")

FILE = Kind(noun="a contact file", empty="docs/how-to/contact.md has one to start from.")
MOST_CASES, MOST_LAYERS = 2000, 4
LARGEST_MODULUS = 1e13  # [Pa]
LARGEST_STEEPNESS = 0.3  # of the surfaces at the edge of the contact, for which bodies are half-spaces

_PER = re.compile(rf"({NUMBER}) ?(?:rad|1)/([a-z]+)([2²]?)")


def per_length(power: int) -> Reader[float]:
    """Read an inverse length to a power, like "0.2 1/mm", "0.2 rad/mm" or "3 1/mm2", in SI units."""
    unit = "1/mm" if power == 1 else "1/mm2"

    def read(value: object, where: str) -> float:
        found = _PER.fullmatch(value.strip()) if isinstance(value, str) and len(value) <= 60 else None
        if found is None or bool(found[3]) != (power == 2):
            cure = f'Write it like "0.2 {unit}".'
            raise InputError(where, f"must be a number in {unit}", shown(value), cure)
        return float(found[1]) / parse(f"1 {found[2]}", "m", where) ** power

    return read


def or_list(reader: Reader[Made]) -> Reader[tuple[Made, ...]]:
    """Read one value or a list of them: a batch."""

    def read(value: object, where: str) -> tuple[Made, ...]:
        if not isinstance(value, list):
            return (reader(value, where),)
        if not 1 <= len(value) <= MOST_CASES:
            raise InputError(where, f"must have 1 to {MOST_CASES} values", f"{len(value)}")
        return list_of(reader)(value, where)

    return read


def within(
    reader: Reader[Number], low: float, high: float, unit: str, *, open_low: bool = False
) -> Reader[Number]:
    """Read a number between two bounds."""

    def read(value: object, where: str) -> Number:
        found = reader(value, where)
        if not low <= found <= high or (open_low and found == low):
            ends = f"be above {low:g} and at most {high:g}" if open_low else f"lie from {low:g} to {high:g}"
            raise InputError(where, f"must {ends} [{unit}]", shown(value))
        return found

    return read


_LENGTH = within(quantity("m"), 0.0, 1e3, "m", open_low=True)
_MODULUS = within(quantity("Pa"), 0.0, LARGEST_MODULUS, "Pa", open_low=True)
_CREEP = or_list(within(ratio, -LARGEST_CREEP, LARGEST_CREEP, "-"))
_COEFFICIENT = within(ratio, 0.0, 100.0, "-")
_CELLS = within(whole, SMALLEST_SIDE, LARGEST_SIDE, "-")
_SOLID: dict[str, Reader[object]] = {
    "material": text,
    "elastic_modulus": _MODULUS,
    "shear_modulus": _MODULUS,
    "poisson_ratio": within(ratio, 0.0, 0.5, "-"),
}
BODY = _SOLID | {"layers": lambda value, _: value}
LAYER: Mapping[str, Reader[object]] = _SOLID | {
    "thickness": _LENGTH,
    "poisson_ratio": within(ratio, 0.0, NEARLY_INCOMPRESSIBLE, "-"),
}
SECTIONS: Mapping[str, Mapping[str, Reader[object]]] = {
    "contact": {
        "load": within(quantity("N"), 0.0, 1e12, "N", open_low=True),
        **dict.fromkeys(
            ("semi_axis_rolling", "semi_axis_lateral", "radius_rolling", "radius_lateral"), _LENGTH
        ),
    },
    "body_1": BODY,
    "body_2": BODY,
    "friction": {
        "coefficient": _COEFFICIENT,
        "across": list_of(quantity("m")),
        "coefficients": list_of(_COEFFICIENT),
        "cohesion": within(quantity("Pa"), 0.0, LARGEST_MODULUS, "Pa"),
        "shear_strength": _MODULUS,
    },
    "film": {
        "thickness": within(quantity("m"), 0.0, 1e3, "m"),
        "across": list_of(quantity("m")),
        "thicknesses": list_of(within(quantity("m"), 0.0, 1e3, "m")),
        "shear_modulus": _MODULUS,
        "roughness": within(quantity("m"), 0.0, 1e-3, "m"),
    },
    "motion": {"kind": choice(Motion)},
    "grid": {"columns": _CELLS, "rows": _CELLS},
    "pressure": {"own": truth, "coupled": truth, "two_way": truth},
}
"""Sections of a contact file and how each key is read; the keys of [motion] depend on its kind."""

_SHIFT = or_list(within(quantity("m"), -1e3, 1e3, "m"))
_ROLLS = {
    "kind": choice(Motion),
    "longitudinal": _CREEP,
    "lateral": _CREEP,
    "spin": or_list(per_length(1)),
    "curvature": or_list(per_length(2)),
}
MOTIONS: Mapping[Motion, Mapping[str, Reader[object]]] = {
    Motion.ROLLING: _ROLLS | {"slope": truth},
    Motion.TRANSIENT: _ROLLS | {"distance": or_list(_LENGTH)},
    Motion.SHIFT: {
        "kind": choice(Motion),
        "longitudinal": _SHIFT,
        "lateral": _SHIFT,
        "spin": or_list(within(quantity("rad"), -1e3, 1e3, "rad")),
    },
}


@dataclass(slots=True)
class _File:
    """Sections of the file, read key by key; faults are collected."""

    data: dict[str, object]
    places: Places
    problems: list[InputError] = field(default_factory=list)

    def section(self, name: str, readers: Mapping[str, Reader[object]], *, needed: bool = False) -> Values:
        """Values of a section that could be read; None is a value that was refused."""
        given = self.data.get(name, {} if not needed else None)
        if not isinstance(given, dict):
            rule = "is missing" if given is None else f"must be one section, headed [{name}]"
            self.problems.append(InputError(f"[{name}]", rule, "" if given is None else shown(given)))
            return {}
        return self.table(given, f"[{name}] ", readers, f"[{name}]")

    def table(
        self, given: Mapping[str, object], prefix: str, readers: Mapping[str, Reader[object]], what: str
    ) -> Values:
        """Values of a table, which a refusal calls `what`."""
        found: Values = {}
        for key, value in given.items():
            at = f"{prefix}{printable(key)}"
            with noted(self.problems):
                if key not in readers:
                    raise InputError(at, f"is not a valid key of {what}", cure=nearest(key, readers))
                found[key] = None
                found[key] = readers[key](value, at)
        return found

    def refuse(self) -> None:
        """Raise everything that is wrong, each fault in its place."""
        if self.problems:
            raise together([one.at(self.places.locate(one.path)) for one in self.problems])


def read_contact_toml(path: Path) -> ContactQuestion:
    """Read a contact file; a refusal has everything that is wrong, a line each."""
    data, lines = read_toml(path, FILE)
    file = _File(data, places_of(label_of(path), data, lines))
    for name in data:
        if name not in SECTIONS and name != "title":
            known = nearest(name, (*SECTIONS, "title"))
            at = f"[{printable(name)}]" if isinstance(data[name], dict | list) else printable(name)
            file.problems.append(InputError(at, "is not a section of a contact file", cure=known))
    title = path.stem
    with noted(file.problems):
        title = text(data.get("title", path.stem), "title")
    with using(with_files(beside(path.parent, besides=path)), None, path.parent):
        bodies = _body(file, "body_1"), _body(file, "body_2")
    friction, (film, roughness) = _friction(file), _film(file)
    grid = file.section("grid", SECTIONS["grid"])
    pressure = file.section("pressure", SECTIONS["pressure"])
    ellipse = _ellipse(file, bodies)
    motion, moves, slope = _motion(file)
    file.refuse()
    if ellipse is None or bodies[0] is None or bodies[1] is None or friction is None:
        raise InputError(label_of(path), "is not complete")
    problem = ContactProblem(
        ellipse=ellipse,
        bodies=(bodies[0], bodies[1]),
        friction=friction,
        film_compliance=film,
        roughness=roughness,
        own_pressure=pressure.get("own", False),
        coupled=pressure.get("coupled", False),
    )
    is_two_way = pressure.get("two_way", False)
    if is_two_way and not (problem.own_pressure and problem.coupled and motion is Motion.ROLLING):
        rule = "needs own = true, coupled = true and steady rolling"
        file.problems.append(InputError("[pressure] two_way", rule))
    b, a = ellipse.semi_minor, ellipse.semi_major
    columns, rows = cell_counts(grid.get("columns"), grid.get("rows"), semi_minor=b, semi_major=a)
    setup = ContactSetup(problem=problem, columns=columns, rows=rows, is_two_way=is_two_way)
    with noted(file.problems):
        refuse_extremes(problem, moves)
    file.refuse()
    return ContactQuestion(name=path.stem, title=title, cases=cases_of(setup, motion, moves), slope=slope)


def _solid(file: _File, given: Values, where: str, kind: str) -> Solid | None:
    """Elastic solid of a body or a layer; None where it was refused."""
    if None in given.values():
        return None
    keys = sorted(given)
    with noted(file.problems):
        if keys == ["material"]:
            found = named_material(given["material"], kind, f"{where} material")
            return solid(found.elastic_modulus, found.poisson_ratio)
        if keys == ["poisson_ratio", "shear_modulus"]:
            return Solid(**given)
        if keys == ["elastic_modulus", "poisson_ratio"]:
            return solid(**given)
        rule = "needs material, or poisson_ratio with either elastic_modulus or shear_modulus"
        raise InputError(where, rule, ", ".join(keys) or "none of them")
    return None


def _body(file: _File, name: str) -> Body | None:
    given = file.section(name, SECTIONS[name], needed=True)
    before = len(file.problems)
    listed = given.pop("layers", [])
    base = None
    if isinstance(file.data.get(name), dict):
        base = _solid(file, given, f"[{name}]", "bearing material")
    is_list = isinstance(listed, list) and all(isinstance(item, dict) for item in listed)
    if not is_list or len(listed) > MOST_LAYERS:
        rule = f"must be at most {MOST_LAYERS} tables, headed [[{name}.layers]], the outermost first"
        file.problems.append(InputError(f"[{name}] layers", rule))
        return None
    layers = []
    for i, item in enumerate(listed, 1):
        where = f"[{name}] layers[{i}]"
        found = file.table(item, f"{where}.", LAYER, "a layer")
        thickness = found.pop("thickness", 0.0)
        if thickness == 0.0:
            file.problems.append(InputError(where, "lacks: thickness"))
        made = _solid(file, found, where, "film")
        if made is not None and thickness:
            with noted(file.problems):
                layers.append(Layer(thickness=thickness, solid=made))
    return None if base is None or len(file.problems) > before else Body(base=base, layers=tuple(layers))


def _profile(file: _File, given: Values, section: str, one: str, many: str) -> float | Profile | None:
    """A number, or a profile across the contact; None where it was refused or there is none."""
    if one in given and not {"across", many} & set(given):
        return float(given[one]) if given[one] is not None else None
    if one in given or ("across" in given) != (many in given):
        rule = f"needs either {one}, or across and {many}"
        file.problems.append(InputError(f"[{section}]", rule, ", ".join(given)))
    elif many in given and given["across"] is not None and given[many] is not None:
        try:
            return Profile(across=given["across"], values=given[many])
        except InputError as error:
            file.problems.append(error.at(f"[{section}] across"))
    return None


def _friction(file: _File) -> FrictionLaw | None:
    given = file.section("friction", SECTIONS["friction"], needed=True)
    limits = {key: given.pop(key) for key in ("cohesion", "shear_strength") if key in given}
    if not given:
        if isinstance(file.data.get("friction"), dict):
            file.problems.append(InputError("[friction]", "lacks: coefficient"))
        return None
    mu = _profile(file, given, "friction", "coefficient", "coefficients")
    if mu is None or None in limits.values():
        return None
    return FrictionLaw(coefficient=mu, **limits)


def _film(file: _File) -> tuple[float | Profile, float]:
    """Compliance L = h/G of a film in series [m/Pa], and length of roughness [m]; 0 without."""
    given = file.section("film", SECTIONS["film"])
    roughness = given.pop("roughness", 0.0) or 0.0
    if not given:
        return 0.0, roughness
    modulus = given.pop("shear_modulus", 0.0)
    if modulus == 0.0:
        file.problems.append(InputError("[film]", "lacks: shear_modulus"))
    if not given:
        file.problems.append(InputError("[film]", "lacks: thickness"))
    h = _profile(file, given, "film", "thickness", "thicknesses") if given else None
    if h is None or not modulus:
        return 0.0, roughness
    if isinstance(h, Profile):
        return Profile(across=h.across, values=tuple(one / modulus for one in h.values)), roughness
    return h / modulus, roughness


def _ellipse(file: _File, bodies: tuple[Body | None, Body | None]) -> ContactEllipse | None:
    given = file.section("contact", SECTIONS["contact"], needed=True)
    if isinstance(written := file.data.get("contact"), dict) and "load" not in written:
        file.problems.append(InputError("[contact]", "lacks: load"))
    shape = sorted(key for key in given if key != "load")
    names = [[f"{name}_{side}" for side in ("lateral", "rolling")] for name in ("semi_axis", "radius")]
    if given and shape not in names:
        rule = "needs semi_axis_rolling and semi_axis_lateral, or radius_rolling and radius_lateral"
        file.problems.append(InputError("[contact]", rule, ", ".join(shape) or "none of them"))
        return None
    first, second = bodies
    if "load" not in given or None in given.values() or first is None or second is None:
        return None
    softness = [(1.0 - body.base.poisson_ratio) / (2.0 * body.base.shear_modulus) for body in (first, second)]
    modulus, (lateral, rolling) = 1.0 / sum(softness), (given[key] for key in shape)
    with noted(file.problems):
        if shape == names[0]:
            found = ellipse_of_axes(given["load"], rolling, lateral, modulus)
        else:
            found = ellipse_of_curvatures(given["load"], 1.0 / rolling, 1.0 / lateral, modulus)
        if not found.max_pressure < modulus:
            value = format_quantity(found.max_pressure, "Pa", 3)
            cure = f"The modulus of the pair is {format_quantity(modulus, 'Pa', 3)}."
            raise InputError("[contact]", "needs a pressure below the modulus of the pair", value, cure)
        along, across = (
            found.semi_minor * found.curvature_rolling,
            found.semi_major * found.curvature_transverse,
        )
        if (steepest := max(along, across)) > LARGEST_STEEPNESS:
            said = f"a half axis of the contact is {steepest:.2g} of the radius of the gap there; "
            limit = f"half-spaces describe the bodies to about {LARGEST_STEEPNESS:g}."
            warnings.warn(said + limit, ValidityWarning, stacklevel=2)
        return found
    return None


def _motion(file: _File) -> tuple[Motion, dict[str, tuple[float, ...]], bool]:
    """Kind of motion; its values, lists of one length or of one value; whether the slope is wanted."""
    raw = file.data.get("motion")
    try:
        kind = choice(Motion)(
            raw.get("kind", "rolling") if isinstance(raw, dict) else "rolling", "[motion] kind"
        )
    except InputError as error:
        file.problems.append(error)
        return Motion.ROLLING, {}, False
    given = file.section("motion", MOTIONS[kind], needed=True)
    given.pop("kind", None)
    slope = bool(given.pop("slope", False))
    moves = {key: value for key, value in given.items() if value is not None}
    if kind is Motion.TRANSIENT and "distance" not in given:
        file.problems.append(InputError("[motion]", "lacks: distance"))
    if isinstance(raw, dict) and not given:
        file.problems.append(InputError("[motion]", "lacks: longitudinal, lateral or spin"))
    counts = {len(value) for key, value in moves.items() if len(value) > 1}
    if len(counts) > 1:
        rule = "must have as many values in each list"
        file.problems.append(InputError("[motion]", rule, ", ".join(map(str, sorted(counts)))))
    if slope and any(len(moves.get(key, ())) > 1 for key in ("spin", "curvature")):
        file.problems.append(InputError("[motion] slope", "needs one spin and one curvature, not lists"))
    distance = moves.get("distance", ())
    if any(b <= a for a, b in pairwise(distance)):
        file.problems.append(InputError("[motion] distance", "must be strictly increasing"))
    return kind, moves, slope
