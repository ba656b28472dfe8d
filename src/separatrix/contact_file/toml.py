"""A contact file in TOML: every dimensional value is text with its unit, as in a study file."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from separatrix.chain.hertz import ContactEllipse, ellipse_of_axes, ellipse_of_curvatures
from separatrix.chain.traction.exact.bound import FrictionLaw
from separatrix.chain.traction.exact.contact import LARGEST_CREEP, LARGEST_SIDE, ContactProblem
from separatrix.chain.traction.exact.flexibility import Body, Layer, Solid, solid
from separatrix.chain.traction.exact.grid import cell_counts
from separatrix.chain.traction.exact.normal import film_strain
from separatrix.chain.traction.profile import Profile
from separatrix.contact_file.keys import LAYER, MOTIONS, SECTIONS
from separatrix.contact_file.question import ContactCase, ContactQuestion, ContactSetup, Motion
from separatrix.errors import InputError, ValidityWarning, noted, together
from separatrix.library import beside, with_files
from separatrix.study_file.values import named_material, using
from separatrix.toml_files import Kind, Places, Reader, choice, label_of, nearest, places_of, read_toml, text
from separatrix.units import format_quantity, printable, shown

FILE = Kind(noun="a contact file", empty="docs/how-to/contact.md has one to start from.")
MOST_LAYERS = 4
LARGEST_STEEPNESS = 0.3  # of the surfaces at the edge of the contact, for which bodies are half-spaces
LARGEST_STEPS = 5000  # columns rolled in a transient


@dataclass(slots=True)
class _File:
    """Sections of the file, read key by key; what is wrong is collected."""

    data: dict[str, Any]
    places: Places
    problems: list[InputError] = field(default_factory=list)

    def section(
        self, name: str, readers: Mapping[str, Reader[object]], *, needed: bool = False
    ) -> dict[str, Any]:
        """Values of a section that could be read; None is a value that was refused."""
        given = self.data.get(name, {} if not needed else None)
        if not isinstance(given, dict):
            rule = "is missing" if given is None else f"must be one section, headed [{name}]"
            self.problems.append(InputError(f"[{name}]", rule, "" if given is None else shown(given)))
            return {}
        return self.table(given, f"[{name}] ", readers, f"[{name}]")

    def table(
        self, given: Mapping[str, Any], prefix: str, readers: Mapping[str, Reader[object]], what: str
    ) -> dict[str, Any]:
        """Values of a table, whose keys are `what`'s."""
        found: dict[str, Any] = {}
        for key, value in given.items():
            at = f"{prefix}{printable(key)}"
            with noted(self.problems):
                if key not in readers:
                    raise InputError(at, f"is not a valid key of {what}", cure=nearest(key, readers))
                found[key] = None
                found[key] = readers[key](value, at)
        return found

    def lacks(self, where: str, *keys: str) -> None:
        """Note that keys are missing."""
        self.problems.append(InputError(where, f"lacks: {', '.join(keys)}"))

    def refuse(self) -> None:
        """Raise everything that is wrong, each fault in its place."""
        if self.problems:
            raise together([one.at(self.places.locate(one.path)) for one in self.problems])


def read_contact_toml(path: Path) -> ContactQuestion:
    """Read a contact file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: place, rule, value, cure.
    """
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
        _check_size(problem, moves)
    file.refuse()
    return ContactQuestion(name=path.stem, title=title, cases=_cases(setup, motion, moves), slope=slope)


def _solid(file: _File, given: Mapping[str, Any], where: str, kind: str) -> Solid | None:
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
    if (
        not isinstance(listed, list)
        or len(listed) > MOST_LAYERS
        or not all(isinstance(x, dict) for x in listed)
    ):
        rule = f"must be at most {MOST_LAYERS} tables, headed [[{name}.layers]], the outermost first"
        file.problems.append(InputError(f"[{name}] layers", rule))
        return None
    layers = []
    for i, item in enumerate(listed, 1):
        where = f"[{name}] layers[{i}]"
        found = file.table(item, f"{where}.", LAYER, "a layer")
        thickness = found.pop("thickness", 0.0)
        if thickness == 0.0:
            file.lacks(where, "thickness")
        made = _solid(file, found, where, "film")
        if made is not None and thickness:
            with noted(file.problems):
                layers.append(Layer(thickness=thickness, solid=made))
    return None if base is None or len(file.problems) > before else Body(base=base, layers=tuple(layers))


def _profile(file: _File, given: dict[str, Any], section: str, one: str, many: str) -> float | Profile | None:
    """A number, or a profile across the contact; None where it was refused or there is none."""
    if one in given and not {"across", many} & set(given):
        number: float | None = given[one]
        return number
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
            file.lacks("[friction]", "coefficient")
        return None
    mu = _profile(file, given, "friction", "coefficient", "coefficients")
    if mu is None or None in limits.values():
        return None
    return FrictionLaw(coefficient=mu, **limits)


def _film(file: _File) -> tuple[float | Profile, float]:
    """Compliance L = h/G of a film in series [m/Pa], and length of roughness [m]; 0 without."""
    given = file.section("film", SECTIONS["film"])
    roughness = given.pop("roughness", 0.0) or 0.0
    return (_compliance(file, given) if given else 0.0), roughness


def _compliance(file: _File, given: dict[str, Any]) -> float | Profile:
    modulus = given.pop("shear_modulus", 0.0)
    if modulus == 0.0:
        file.lacks("[film]", "shear_modulus")
    if not given:
        file.lacks("[film]", "thickness")
    h = _profile(file, given, "film", "thickness", "thicknesses") if given else None
    if h is None or not modulus:
        return 0.0
    if isinstance(h, Profile):
        return Profile(across=h.across, values=tuple(one / modulus for one in h.values))
    return h / float(modulus)


def _ellipse(file: _File, bodies: tuple[Body | None, Body | None]) -> ContactEllipse | None:
    given = file.section("contact", SECTIONS["contact"], needed=True)
    if isinstance(file.data.get("contact"), dict) and "load" not in file.data["contact"]:
        file.lacks("[contact]", "load")
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
        steepest = max(
            found.semi_minor * found.curvature_rolling, found.semi_major * found.curvature_transverse
        )
        if steepest > LARGEST_STEEPNESS:
            said = f"a half axis of the contact is {steepest:.2g} of the radius of the gap there; "
            limit = f"half-spaces describe the bodies to about {LARGEST_STEEPNESS:g}."
            warnings.warn(said + limit, ValidityWarning, stacklevel=2)
        return found
    return None


def _motion(file: _File) -> tuple[Motion, dict[str, tuple[float, ...]], bool]:
    """Kind of motion; its values, lists of one length or of one value; whether the slope is wanted."""
    raw = file.data.get("motion")
    kind = Motion.ROLLING
    if isinstance(raw, dict) and "kind" in raw:
        try:
            kind = choice(Motion)(raw["kind"], "[motion] kind")
        except InputError as error:
            file.problems.append(error)
            return kind, {}, False
    given = file.section("motion", MOTIONS[kind], needed=True)
    given.pop("kind", None)
    slope = bool(given.pop("slope", False))
    moves = {key: value for key, value in given.items() if value is not None}
    if kind is Motion.TRANSIENT and "distance" not in given:
        file.lacks("[motion]", "distance")
    if isinstance(raw, dict) and not given:
        file.lacks("[motion]", "longitudinal, lateral or spin")
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


def _check_size(problem: ContactProblem, moves: Mapping[str, tuple[float, ...]]) -> None:
    """Refuse spin that slips too fast, rolling without end, and films that are crushed."""
    ellipse = problem.ellipse
    reach = max(ellipse.semi_minor, ellipse.semi_major)
    for key, power in (("spin", 1), ("curvature", 2)):
        largest = max((abs(one) for one in moves.get(key, ())), default=0.0) * reach**power
        if largest > LARGEST_CREEP:
            rule = f"must make a creep of at most {LARGEST_CREEP:g} at the edge of the contact [-]"
            raise InputError(f"[motion] {key}", rule, f"{largest:.3g}")
    longest = max(moves.get("distance", (0.0,)))
    if longest > LARGEST_STEPS * 2.0 * ellipse.semi_minor / LARGEST_SIDE:
        most = f"{LARGEST_STEPS * 2e3 * ellipse.semi_minor / LARGEST_SIDE:.3g} mm"
        cure = "Beyond a few lengths of the contact rolling is steady."
        raise InputError("[motion] distance", f"must not exceed {most}", f"{1e3 * longest:.3g} mm", cure)
    strain = film_strain(problem.bodies, ellipse.max_pressure)
    if strain > 1.0 and not problem.own_pressure:
        cure = (
            "Set own = true in [pressure] to have the lower pressure of the coated bodies, or use less load."
        )
        raise InputError("[contact] load", "compresses a layer by more than itself", f"{strain:.2g}", cure)


def _cases(
    setup: ContactSetup, kind: Motion, moves: Mapping[str, tuple[float, ...]]
) -> tuple[ContactCase, ...]:
    count = max(map(len, moves.values()))
    each = {key: value * count if len(value) == 1 else value for key, value in moves.items()}
    names = {"longitudinal": "longitudinal_creep", "lateral": "lateral_creep"}
    if kind is Motion.SHIFT:
        names = {"longitudinal": "longitudinal_shift", "lateral": "lateral_shift", "spin": "turn"}
    rolled = each.pop("distance", ())
    cases = []
    for i in range(count):
        given: dict[str, Any] = {names.get(key, key): value[i] for key, value in each.items()}
        if rolled:
            before = rolled[i - 1] if i > 0 else 0.0
            given |= {"distance": rolled[i] - before, "continues": i > 0}
        cases.append(ContactCase(number=i + 1, setup=setup, motion=kind, **given))
    return tuple(cases)
