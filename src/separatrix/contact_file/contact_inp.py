r"""Input files of CONTACT (E. Vollebregt), module 3, as far as this program computes the same thing.

Control digits are those of its user guide. Its units are N, mm and rad; forces act on body 1, and a positive
creep has a negative force, as here; its spin is Kalker's, with the opposite sign to ours.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from separatrix.chain.hertz import ContactEllipse, curvature_ratio, ellipse_of_axes, ellipse_of_curvatures
from separatrix.chain.traction.exact.bound import FrictionLaw
from separatrix.chain.traction.exact.contact import LARGEST_SIDE, ContactProblem
from separatrix.chain.traction.exact.flexibility import Body, Solid
from separatrix.contact_file.inp_lines import InpLines
from separatrix.contact_file.question import (
    ContactCase,
    ContactQuestion,
    ContactSetup,
    ExtraSlip,
    Gap,
    Motion,
)
from separatrix.errors import InputError
from separatrix.toml_files import Kind, label_of, read_text
from separatrix.units import Array

MM = 1e-3
MPA = 1e6
FILE = Kind(noun="an input file of CONTACT", most_bytes=4 * 1024 * 1024)
MOST_CASES = 5000
LARGEST_REST = 0.02  # of a column, by which a step in transient rolling may differ from whole ones

WORDS = ("CPBTNFS", "VLDCMZE", "XHGIAOWR")
READ: Mapping[str, tuple[int, ...]] = {
    "P": (0, 2), "B": (0, 2), "T": (0, 1, 2, 3), "N": (0, 1), "F": (0, 1, 2), "S": (0,), "V": (0,),
    "L": (0, 1), "D": (0, 1, 2), "C": (0, 1, 2), "M": (0, 4), "Z": (0, 1, 2), "E": (0, 1, 9), "X": (0,),
    "H": (0,), "G": (0, 1, 2, 3, 4, 5),
}  # fmt: skip
"""Values of the control digits that are read; I, A, O, W and R do not change the answer."""

CURES = {
    "B": "Other bounds belong to simplified theories.",
    "C": "Only half-spaces are computed.",
    "H": "Temperatures are not computed.",
    "L": "Friction that depends on slip or temperature is not computed.",
    "M": "Viscoelastic and simplified materials are not computed.",
    "S": "Stresses inside the bodies are not computed.",
    "V": "Write friction that varies over the contact in a contact file (TOML).",
    "X": "Debug output is not written.",
}
ITERATIONS = {0: 5, 1: 0, 2: 9, 3: 9, 4: 7, 5: 13}
"""Numbers on the solver's lines by digit G; they are read and not used."""


@dataclass(slots=True)
class _Kept:
    """Data of the case before, for a case whose digits do not state them anew."""

    setups: dict[object, ContactSetup] = field(default_factory=dict)
    friction: float | None = None
    rolling: tuple[float, float] | None = None  # CHI and DQ [mm]
    materials: tuple[float, ...] | None = None
    layer: tuple[float, ...] | None = None
    area: tuple[float, ...] | None = None  # IPOTCN and its numbers
    gap: tuple[float, ...] = ()
    extra: Array | None = None  # rigid slip of the elements [-], in a shift [mm], shape (2, row, column)


def read_inp(path: Path) -> ContactQuestion:
    """Read the cases of an input file of CONTACT; refused at the first line that is not computed here."""
    label, text = label_of(path), read_text(path, FILE)
    lines = ((n, line.partition("%")[0].split()) for n, line in enumerate(text.split("\n"), 1))
    at, kept, cases = InpLines(label, iter([one for one in lines if one[1]])), _Kept(), list[ContactCase]()
    while True:
        at.case = len(cases) + 1
        module = at.whole(at.numbers("MODULE")[0], "MODULE")
        if module == 0:
            break
        if module != 3:
            raise at.wrong("MODULE", "must be 3, or 0 at the end", f"{module}", "Wheel on rail is not read.")
        if len(cases) == MOST_CASES:
            raise at.wrong("MODULE", f"begins more than {MOST_CASES} cases")
        cases.append(_case(at, kept))
    if not cases:
        raise InputError(label, "has no case")
    return ContactQuestion(name=path.stem, title=path.stem, cases=tuple(cases), of_contact=True)


def _case(at: InpLines, kept: _Kept) -> ContactCase:
    digit = _control(at)
    at.numbers(*["solver's number"] * ITERATIONS[digit["G"]])
    second, third = (("CKSI", "CETA"), ("FX", "CETA"), ("FX", "FY"))[digit["F"]]
    first = "FN" if digit["N"] else "PEN"
    load, along, across, spin = at.numbers(first, second, third, "CPHI")
    at.refuse_more("SPINXO")
    if load <= 0.0:
        raise at.wrong(first, f"must be > 0 [{'N' if digit['N'] else 'mm'}]", f"{load:g}")
    if digit["F"] and math.hypot(along, across if digit["F"] == 2 else 0.0) >= 1.0:
        raise at.wrong(second, "must be below the force of sliding, 1 [-]", f"{along:g}")
    if digit["L"] == 0:
        kept.friction = _friction(at)
    rolls = digit["T"] >= 2
    if digit["C"] == 2:
        if rolls:
            angle, column, _ = at.numbers("CHI", "DQ", "VELOC")
            kept.rolling = angle, column
        kept.materials = tuple(at.numbers("POISS1", "POISS2", "GG1", "GG2"))
        if digit["M"] == 4:
            kept.layer = tuple(at.numbers("GG3", "LAYTHK", "TAU_C0", "K_TAU"))
            if kept.layer[3] != 0.0:
                raise at.wrong("K_TAU", "must be 0: the film does not harden", f"{kept.layer[3]:g}")
    if digit["D"] == 2:
        kept.area = _area(at)
    if digit["Z"] == 2 and kept.area is not None and kept.area[0] > 0:
        kept.gap = _gap_numbers(at)
    if digit["E"] == 9:
        kept.extra = _extra_slip(at, kept)
    elif digit["E"] == 0:
        kept.extra = None
    chi, step = (kept.rolling or (0.0, 0.0)) if rolls else (0.0, 0.0)
    turned = abs(abs(chi) - math.pi) < 1e-3
    if not turned and abs(chi) > 1e-3:
        raise at.wrong("CHI", "must be 0 or 180d: the bodies roll along x", f"{chi:g} rad")
    if digit["N"] == 0:
        if kept.area is None or kept.area[0] > 0:
            raise at.wrong("control digit N", "must be 1 with a gap on cells", "0", "Prescribe the force.")
        load = -load
    setup = _setup(at, kept, load, is_coated=digit["M"] == 4, turned=turned)
    case = _motion(at, setup, digit, (along, across, spin), step, turned=turned)
    return case if kept.extra is None else replace(case, extra=_placed(at, kept, setup, case.motion))


def _control(at: InpLines) -> dict[str, int]:
    digit: dict[str, int] = {}
    for names in WORDS:
        found = at.digits(names)
        at.refuse_more("number after the control digits")
        for name, value in found.items():
            if name in READ and value not in READ[name]:
                allowed = ", ".join(map(str, READ[name]))
                rule = f"must be one of {allowed}" if len(READ[name]) > 1 else f"must be {allowed}"
                raise at.wrong(f"control digit {name}", rule, f"{value}", CURES.get(name, ""))
        digit |= found
    if digit["C"] and at.case == 1 and digit["C"] != 2:
        raise at.wrong("control digit C", "must be 2 in the first case", f"{digit['C']}")
    return digit


def _friction(at: InpLines) -> float:
    still, moving = at.numbers("FSTAT", "FKIN")
    if still != moving:
        cure = "Friction that depends on slip is not computed."
        raise at.wrong("FKIN", f"must equal FSTAT, {still:g} [-]", f"{moving:g}", cure)
    if not still > 0.0:
        raise at.wrong("FSTAT", "must be > 0 [-]", f"{still:g}")
    return still


def _area(at: InpLines) -> tuple[float, ...]:
    kind = at.whole(at.numbers("IPOTCN")[0], "IPOTCN")
    names = {
        -3: ("AA", "BB", "SCALE"),
        -2: ("A1", "AOB", "SCALE"),
        -1: ("A1", "B1", "SCALE"),
        1: ("XL", "YL", "DX", "DY"),
        2: ("XL", "YL", "XH", "YH"),
        3: ("XC1", "YC1", "DX", "DY"),
        4: ("XC1", "YC1", "XCM", "YCM"),
    }
    if kind not in names:
        raise at.wrong("IPOTCN", "must be one of -3, -2, -1, 1, 2, 3, 4", f"{kind}")
    mx, my, *rest = at.numbers("MX", "MY", *names[kind])
    for name, value in (("MX", mx), ("MY", my)):
        if not 1 <= at.whole(value, name) <= LARGEST_SIDE:
            raise at.wrong(name, f"must lie from 1 to {LARGEST_SIDE}", f"{value:g}")
    positive = names[kind] if kind < 0 else names[kind][2:] if kind in (1, 3) else ()
    for name, value in zip(names[kind], rest, strict=True):
        if name in positive and value <= 0.0:
            raise at.wrong(name, "must be > 0", f"{value:g}")
    if kind == 2:
        rest = [rest[0], rest[1], (rest[2] - rest[0]) / mx, (rest[3] - rest[1]) / my]
    elif kind == 4:
        rest[2:] = [(rest[2] - rest[0]) / max(mx - 1, 1), (rest[3] - rest[1]) / max(my - 1, 1)]
    if kind > 0 and not min(rest[2:]) > 0.0:
        raise at.wrong("IPOTCN", "needs upper ends above the lower ones")
    if kind in (3, 4):
        rest[:2] = [rest[0] - 0.5 * rest[2], rest[1] - 0.5 * rest[3]]
    return (min(kind, 1), mx, my, *rest)


def _gap_numbers(at: InpLines) -> tuple[float, ...]:
    base, plan = at.numbers("IBASE", "IPLAN")
    if base != 1:
        raise at.wrong("IBASE", "must be 1, a quadratic gap", f"{base:g}")
    if plan != 1:
        raise at.wrong("IPLAN", "must be 1, an unrestricted planform", f"{plan:g}")
    return tuple(at.numbers("B1", "B2", "B3", "B4", "B5", "B6"))


def _extra_slip(at: InpLines, kept: _Kept) -> Array:
    """Rigid slip of every element, x fastest, along and across in turn."""
    if kept.area is None:
        raise at.wrong("control digit D", "keeps what no case before has given")
    mx, my = int(kept.area[1]), int(kept.area[2])
    values = at.numbers(*["extra rigid slip"] * (2 * mx * my))
    return np.array(values).reshape(my, mx, 2).transpose(2, 0, 1)


def _placed(at: InpLines, kept: _Kept, setup: ContactSetup, motion: Motion) -> ExtraSlip:
    """The extra slip at the centres of CONTACT's elements, in our units."""
    kind, mx, my, *rest = kept.area or ()
    if kept.extra is None or kept.extra.shape[1:] != (int(my), int(mx)):
        raise at.wrong("control digit E", "keeps slip of another number of elements")
    if kind > 0:
        xl, yl, dx, dy = (value * MM for value in rest)
    else:  # the box of the ellipse, SCALE times as large
        ellipse = setup.problem.ellipse
        a, b = rest[2] * ellipse.semi_minor, rest[2] * ellipse.semi_major
        xl, yl, dx, dy = -a, -b, 2.0 * a / mx, 2.0 * b / my
    return ExtraSlip(
        along=xl + dx * (np.arange(mx) + 0.5),
        across=yl + dy * (np.arange(my) + 0.5),
        slip=kept.extra * (MM if motion is Motion.SHIFT else 1.0),
    )


def _setup(at: InpLines, kept: _Kept, load: float, *, is_coated: bool, turned: bool) -> ContactSetup:
    """The contact of a case, under a load [N], or an approach [mm] with a minus sign.

    The contact of an earlier case is the same object, so that cases start each other.
    """
    missing = {"L": kept.friction, "C": kept.materials, "D": kept.area}
    for name, value in missing.items():
        if value is None:
            raise at.wrong(f"control digit {name}", "keeps what no case before has given")
    layer = kept.layer if is_coated else None
    if is_coated and layer is None:
        raise at.wrong("control digit M", "keeps a film that no case before has given")
    key = (load, kept.friction, kept.materials, layer, kept.area, kept.gap, turned)
    if key not in kept.setups:
        try:
            kept.setups[key] = _built(at, kept, load, layer, turned=turned)
        except InputError as error:
            raise error.at(f"{at.label}, line {at.line}: case {at.case}, {error.path}") from None
    return kept.setups[key]


def _built(
    at: InpLines, kept: _Kept, load: float, layer: tuple[float, ...] | None, *, turned: bool
) -> ContactSetup:
    friction, materials, area = kept.friction or 0.0, kept.materials or (), kept.area or ()
    nu1, nu2, g1, g2 = materials
    solids = [Solid(shear_modulus=G * MPA, poisson_ratio=nu) for G, nu in ((g1, nu1), (g2, nu2))]
    modulus = 1.0 / sum((1.0 - s.poisson_ratio) / (2.0 * s.shear_modulus) for s in solids)
    kind, mx, my, *rest = area
    ellipse = _ellipse(int(kind), (mx, my, *rest), abs(load), modulus)
    if load < 0.0:  # an approach: of given axes the load goes as it, else as its power 1.5
        one = _ellipse(int(kind), (mx, my, *rest), 1.0, modulus)
        load = (-load * MM / one.approach) ** (1.0 if kind == -3 else 1.5)
        ellipse = _ellipse(int(kind), (mx, my, *rest), load, modulus)
    gg3, thickness, limit, _ = layer or (1.0, 0.0, 0.0, 0.0)
    if layer and (gg3 <= 0.0 or thickness < 0.0):
        raise InputError("film", "must have GG3 > 0 and LAYTHK >= 0", f"{gg3:g}, {thickness:g}")
    strength = limit * MPA if limit > 1e-10 else math.inf
    problem = ContactProblem(
        ellipse=ellipse,
        bodies=(Body(base=solids[0]), Body(base=solids[1])),
        friction=FrictionLaw(coefficient=friction, shear_strength=strength),
        film_compliance=thickness * MM / (gg3 * MPA),
        coupled=(nu1, g1) != (nu2, g2),
    )
    if kind < 0:
        columns, rows = (max(round(n / rest[2]), 4) for n in (mx, my))
        return ContactSetup(problem=problem, columns=columns, rows=rows)
    if len(kept.gap) == 0:
        raise at.wrong("control digit Z", "keeps a gap that no case before has given")
    return ContactSetup(problem=problem, gap=_gap(int(mx), int(my), rest, kept.gap, turned=turned))


def _ellipse(kind: int, area: tuple[float, ...], load: float, modulus: float) -> ContactEllipse:
    """Hertz contact under a load [N]; of a gap on cells only load and modulus count."""
    mx, my, first, second, *more = area
    if kind == -3:
        return ellipse_of_axes(load, first * MM, second * MM, modulus)
    if kind == -1:
        return ellipse_of_curvatures(load, 2.0 * first / MM, 2.0 * second / MM, modulus)
    if kind == -2:
        ratio = curvature_ratio(second) if second <= 1.0 else 1.0 / curvature_ratio(1.0 / second)
        return ellipse_of_curvatures(load, 2.0 * first / MM, 2.0 * first / ratio / MM, modulus)
    return ellipse_of_axes(load, mx * more[0] * MM, my * more[1] * MM, modulus)


def _gap(mx: int, my: int, place: list[float], b: tuple[float, ...], *, turned: bool) -> Gap:
    """Cell means of B1 x^2 + B2 x y + B3 y^2 + B4 x + B5 y + B6 [mm]; `turned`: seen with x reversed."""
    xl, yl, dx, dy = place
    x = np.asarray(xl + dx * (np.arange(mx) + 0.5), dtype=np.float64)
    y = np.asarray(yl + dy * (np.arange(my) + 0.5), dtype=np.float64)[:, None]
    height = b[0] * (x * x + dx * dx / 12.0) + b[1] * x * y + b[2] * (y * y + dy * dy / 12.0)
    height += b[3] * x + b[4] * y + b[5]
    along: Array = -x[::-1] if turned else x
    return Gap(
        along=along * MM,
        across=y[:, 0] * MM,
        row_width=dy * MM,
        column_width=dx * MM,
        height=(height[:, ::-1] if turned else height) * MM,
    )


def _motion(
    at: InpLines,
    setup: ContactSetup,
    digit: Mapping[str, int],
    given: tuple[float, float, float],
    step: float,
    *,
    turned: bool,
) -> ContactCase:
    """The case in our units and signs."""
    along, across, spin = given
    forces = digit["F"]
    wanted = (along if forces else None, across if forces == 2 else None)
    along, across = (0.0 if forces else along), (0.0 if forces == 2 else across)
    continues = digit["P"] == 0 and at.case > 1 and digit["T"] in (1, 2)
    if digit["T"] == 2:
        gap, ellipse = setup.gap, setup.problem.ellipse
        width = (2.0 * ellipse.semi_minor / setup.columns if gap is None else gap.column_width) / MM
        if abs(step / width - max(round(step / width), 1)) > LARGEST_REST:
            rule = f"must be a whole number of columns of {width:.4g} mm"
            raise at.wrong("DQ", rule, f"{step:g}")
    case = ContactCase(number=at.case, setup=setup, motion=Motion.SHIFT)
    if digit["T"] == 0:  # the normal problem alone
        return case
    case = replace(case, continues=continues, wanted=wanted)
    if digit["T"] == 1:
        shifts = along * MM, across * MM
        return replace(case, longitudinal_shift=shifts[0], lateral_shift=shifts[1], turn=0.0 - spin)
    return replace(
        case,
        motion=Motion.ROLLING if digit["T"] == 3 else Motion.TRANSIENT,
        longitudinal_creep=along,
        lateral_creep=across,
        spin=0.0 - spin / MM,
        distance=step * MM if digit["T"] == 2 else 0.0,
        turned=turned,
    )
