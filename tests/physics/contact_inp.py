"""Input files of CONTACT (E. Vollebregt), module 3, as far as contact_inputs.py writes them.

Control digits are those of its user guide. Its units are N, mm and rad; forces act on body 1, and a positive
creep has a negative force, as here; its spin is Kalker's, with the opposite sign to ours. Bodies that roll
towards -x (CHI = 180 degrees) are solved as their mirror image.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from separatrix import (
    Body,
    ContactCase,
    ContactMotion,
    ContactProblem,
    ContactQuestion,
    ContactSetup,
    FrictionLaw,
    Gap,
    Solid,
    ellipse_of_axes,
    ellipse_of_curvatures,
    exact_contact,
)
from separatrix.chain.hertz import curvature_ratio

MM, MPA = 1e-3, 1e6
SOLVER = {0: 5, 1: 0}
"""Numbers on the solver's line by digit G; they are not used."""


@dataclass
class Lines:
    """Numbers of a file in their order; comments begin with %, and words end a line of numbers."""

    lines: list[str]

    def numbers(self, count):
        """As many numbers, on as many lines as they take."""
        found = []
        while len(found) < count:
            words = self.lines.pop(0).split()
            found += [
                math.radians(float(word[:-1])) if word.endswith("d") else float(word)
                for word in words[: count - len(found)]
            ]
        return found

    def digits(self, names):
        """Digits of a control word by their letters; those in front that are left out are 0."""
        return dict(zip(names, map(int, self.lines.pop(0).split()[0].zfill(len(names))), strict=True))


@dataclass
class Kept:
    """Data of the case before, for a case whose digits do not state them anew."""

    mirrored: bool
    setups: dict = field(default_factory=dict)
    friction: float = 0.0
    step: float = 0.0
    materials: tuple = ()
    film: tuple = ()
    area: tuple = ()
    gap: tuple = ()


def solved_inp(text):
    """Rows of the cases of a file, numbers by their names in CONTACT's frame and our units."""
    lines = [line for line in (one.partition("%")[0] for one in text.split("\n")) if line.strip()]
    mirrored = any("180" in word and word.endswith("d") for line in lines for word in line.split()[:1])
    at, kept, cases = Lines(lines), Kept(mirrored), []
    while at.numbers(1) == [3]:
        cases.append(_case(at, kept, first=not cases))
    answer = exact_contact(ContactQuestion(cases=tuple(cases)))
    return [_row(one, -1.0 if mirrored else 1.0) for one in answer.cases]


def _row(one, x):
    case, found = one.case, one.solution
    stick = int(found.stick.sum())
    return {
        "load": found.load,
        "force": x * found.force,
        "lateral_force": found.lateral_force,
        "spin_moment": x * found.spin_moment,
        "force_share": x * one.sliding_share[0],
        "lateral_force_share": one.sliding_share[1],
        "longitudinal_creep": x * case.longitudinal_creep,
        "lateral_creep": case.lateral_creep,
        "longitudinal_shift": x * case.longitudinal_shift,
        "stick_share": found.stick_share,
        "max_pressure": found.max_pressure,
        "stick_cells": stick,  # those that the outline cuts count as whole
        "slip_cells": int((found.pressure > 0.0).sum()) - stick,
    }


def _case(at, kept, *, first):
    digit = at.digits("CPBTNFS")
    starts, rolls = digit["P"] == 0 and not first, digit["T"] >= 2
    digit |= at.digits("VLDCMZE")
    digit |= at.digits("XHGIAOWR")
    at.numbers(SOLVER[digit["G"]])
    load, along, across, spin = at.numbers(4)
    if digit["L"] == 0:
        kept.friction = at.numbers(2)[0]
    if digit["C"] == 2:
        if rolls:
            kept.step = at.numbers(3)[1]
        kept.materials = tuple(at.numbers(4))
        if digit["M"] == 4:
            kept.film = tuple(at.numbers(4))
    if digit["D"] == 2:
        kept.area = _area(at)
    if digit["Z"] == 2 and kept.area[0] > 0:
        at.numbers(2)
        kept.gap = tuple(at.numbers(6))
    setup = _setup(kept, load if digit["N"] else -load, is_coated=digit["M"] == 4)
    if digit["T"] == 0:  # the normal problem alone
        return ContactCase(setup=setup, motion=ContactMotion.SHIFT)
    x = -1.0 if kept.mirrored else 1.0
    wanted = (x * along if digit["F"] else None, across if digit["F"] == 2 else None)
    along, across = (0.0 if digit["F"] else x * along), (0.0 if digit["F"] == 2 else across)
    continues = starts and digit["T"] in (1, 2)
    if digit["T"] == 1:
        shifts = {"longitudinal_shift": along * MM, "lateral_shift": across * MM, "turn": -x * spin}
        return ContactCase(
            setup=setup, motion=ContactMotion.SHIFT, continues=continues, wanted=wanted, **shifts
        )
    return ContactCase(
        setup=setup,
        motion=ContactMotion.ROLLING if digit["T"] == 3 else ContactMotion.TRANSIENT,
        longitudinal_creep=along,
        lateral_creep=across,
        spin=-x * spin / MM,
        distance=kept.step * MM if digit["T"] == 2 else 0.0,
        continues=continues,
        wanted=wanted,
    )


def _area(at):
    """IPOTCN, elements along and across, and its numbers: of cells XL, YL, DX, DY."""
    kind = int(at.numbers(1)[0])
    mx, my, *rest = at.numbers(5 if kind < 0 else 6)
    if kind == 3:
        rest[:2] = [rest[0] - 0.5 * rest[2], rest[1] - 0.5 * rest[3]]
    return kind, int(mx), int(my), *rest


def _setup(kept, load, *, is_coated):
    """The contact of a case, under a load [N], or an approach [mm] with a minus sign.

    The contact of an earlier case is the same object, so that cases start each other.
    """
    film = kept.film if is_coated else None
    key = (load, kept.friction, kept.materials, film, kept.area, kept.gap)
    if key not in kept.setups:
        kept.setups[key] = _built(kept, load, film)
    return kept.setups[key]


def _built(kept, load, film):
    nu1, nu2, g1, g2 = kept.materials
    solids = [Solid(shear_modulus=G * MPA, poisson_ratio=nu) for G, nu in ((g1, nu1), (g2, nu2))]
    modulus = 1.0 / sum((1.0 - s.poisson_ratio) / (2.0 * s.shear_modulus) for s in solids)
    kind, mx, my, *rest = kept.area
    if load < 0.0:  # an approach: of given axes the load goes as it, else as its power 1.5
        one = _ellipse(kept.area, 1.0, modulus)
        load = (-load * MM / one.approach) ** (1.0 if kind == -3 else 1.5)
    gg3, thickness = film[:2] if film else (1.0, 0.0)
    problem = ContactProblem(
        ellipse=_ellipse(kept.area, load, modulus),
        bodies=(Body(base=solids[0]), Body(base=solids[1])),
        friction=FrictionLaw(coefficient=kept.friction),
        film_compliance=thickness * MM / (gg3 * MPA),
        coupled=(nu1, g1) != (nu2, g2),
    )
    if kind < 0:
        columns, rows = (max(round(n / rest[2]), 4) for n in (mx, my))
        return ContactSetup(problem=problem, columns=columns, rows=rows)
    return ContactSetup(problem=problem, gap=_gap(mx, my, rest, kept.gap, mirrored=kept.mirrored))


def _ellipse(area, load, modulus):
    """Hertz contact under a load [N]; of a gap on cells only load and modulus count."""
    kind, mx, my, first, second, *more = area
    if kind == -3:
        return ellipse_of_axes(load, first * MM, second * MM, modulus)
    if kind == -1:
        return ellipse_of_curvatures(load, 2.0 * first / MM, 2.0 * second / MM, modulus)
    if kind == -2:
        return ellipse_of_curvatures(
            load, 2.0 * first / MM, 2.0 * first / curvature_ratio(second) / MM, modulus
        )
    return ellipse_of_axes(load, mx * more[0] * MM, my * more[1] * MM, modulus)


def _gap(mx, my, place, b, *, mirrored):
    """Cell means of B1 x^2 + B2 x y + B3 y^2 + B4 x + B5 y + B6 [mm]; `mirrored`: with x reversed."""
    xl, yl, dx, dy = place
    x = xl + dx * (np.arange(mx) + 0.5)
    y = yl + dy * (np.arange(my) + 0.5)[:, None]
    height = b[0] * (x * x + dx * dx / 12.0) + b[1] * x * y + b[2] * (y * y + dy * dy / 12.0)
    height += b[3] * x + b[4] * y + b[5]
    along = -x[::-1] if mirrored else x
    return Gap(
        along=along * MM,
        across=y[:, 0] * MM,
        row_width=dy * MM,
        column_width=dx * MM,
        height=(height[:, ::-1] if mirrored else height) * MM,
    )
