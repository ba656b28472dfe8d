"""Answer of `contact` as plain data, as labelled arrays with the fields of every case, and as text."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from separatrix.chain.traction.exact.contact import ContactSolution
from separatrix.chain.traction.profile import Profile
from separatrix.contact_file.question import ContactAnswer, ContactCase, ContactSetup, Motion, SolvedCase
from separatrix.present.nodes import Document, field_units, plain
from separatrix.present.text.tables import (
    ABSENT,
    facts,
    heading,
    paragraph,
    quantity,
    section,
    significant,
    table,
)
from separatrix.units import Array

NUMBERS = (
    *("load", "force", "lateral_force", "spin_moment", "stick_share", "dissipation", "max_pressure"),
    "film_strain",
)
"""Numbers of a solution; the dissipation is power per rolling speed, in a shift an energy."""

CREEPS, SHIFTS = (
    ("longitudinal_creep", "lateral_creep", "spin", "curvature"),
    ("longitudinal_shift", "lateral_shift", "turn"),
)
GIVEN = (*CREEPS, *SHIFTS, "distance")
OF_MOTION = {Motion.ROLLING: CREEPS, Motion.SHIFT: SHIFTS, Motion.TRANSIENT: (*CREEPS, "distance")}
"""What a case is given, or what was found for it, by its motion."""

FIELDS = ("fraction", "pressure", "traction", "slip", "stick")


UNITS = field_units(ContactSolution) | field_units(ContactCase)
WHERE = {"long_name": "1 where the surfaces stick"}


def document(answer: ContactAnswer, notes: Sequence[str]) -> Document:
    """Return the answer as plain data: SI units, None for absent values; the notes are its warnings."""
    from separatrix import __version__

    asked, setups = answer.question, _setups(answer)
    slope: Document | None = None
    if asked.slope:
        of, names = answer.slope, ("slope", "slope_error", "free_rolling_offset")
        slope = {name: None if of is None else float(getattr(of, name)) for name in names}
        slope |= {"reason": answer.slope_reason or None}
    contacts = [
        plain(one.problem, "contacts", left_out=[])
        | {"columns": one.columns, "rows": one.rows, "on_gap": bool(one.gap)}
        for one in setups
    ]
    return {
        "separatrix_version": __version__,
        "verb": "contact",
        "name": asked.name,
        "title": asked.title,
        "contacts": contacts,
        "slope": slope,
        "cases": [_case(one, setups.index(one.case.setup)) for one in answer.cases],
        "warnings": list(notes),
    }


def _setups(answer: ContactAnswer) -> list[ContactSetup]:
    """Return the contacts of the cases, each once."""
    return list({id(one.case.setup): one.case.setup for one in answer.cases}.values())


def _case(one: SolvedCase, number: int) -> Document:
    case, found = one.case, one.solution
    own = OF_MOTION[case.motion]
    share, cells = one.sliding_share or (None, None), one.cells or (None, None)
    return {
        "case": case.number,
        "contact": number,
        "motion": case.motion.value,
        **{name: float(getattr(case, name)) if name in own else None for name in GIVEN},
        **{name: None if found is None else float(getattr(found, name)) for name in NUMBERS},
        "force_share": share[0],
        "lateral_force_share": share[1],
        "stick_cells": cells[0],
        "slip_cells": cells[1],
        "iterations": None if found is None else found.iterations,
        "residual": one.residual,
        "reason": one.reason or None,
    }


def contact_dataset(answer: ContactAnswer, notes: Sequence[str] = ()) -> xr.Dataset:
    """Return numbers and fields of the cases; absent ones are NaN, their reason is in the variable `reason`.

    Dimensions are case, direction (along, across), row and column. Cases on one grid share the coordinates
    `along` and `across` [m]; where grids differ these depend on the case, too, and smaller grids end in NaN.
    """
    found = document(answer, notes)
    rows, slope = found["cases"], found["slope"] or {}
    data: dict[str, object] = {
        key: ((), np.nan if slope[key] is None else slope[key], {"units": "-"})
        for key in ("slope", "slope_error", "free_rolling_offset")
        if key in slope
    }
    names = ("force_share", "lateral_force_share", "stick_cells", "slip_cells", "residual")
    for name in (*NUMBERS, *GIVEN, *names):
        values = np.array([row[name] for row in rows], dtype=float)
        data[name] = ("case", values, {"units": UNITS.get(name, "-")})
    data["contact"] = ("case", np.array([row["contact"] for row in rows]))
    data["turned"] = ("case", np.array([one.case.turned for one in answer.cases]))
    for name in ("motion", "reason"):
        data[name] = ("case", np.array([row[name] or "" for row in rows], dtype=object))
    data |= _fields([one.solution for one in answer.cases])
    numbers = np.array([row["case"] for row in rows])
    coordinates = {"case": ("case", numbers), "direction": ("direction", ["along", "across"])}
    places = {name: data.pop(name) for name in ("along", "across") if name in data}
    attributes = {"verb": "contact", "title": answer.question.title, "name": answer.question.name}
    return xr.Dataset(data, coords=coordinates | places, attrs=attributes)


def _fields(solutions: Sequence[ContactSolution | None]) -> dict[str, object]:
    known = [one for one in solutions if one is not None]
    if not known:
        return {}
    size = {"row": max(x.across.size for x in known), "column": max(x.along.size for x in known)}
    is_one = all(
        np.array_equal(one.along, known[0].along) and np.array_equal(one.across, known[0].across)
        for one in known
    )
    found: dict[str, object] = {}
    for name, dim in (("along", "column"), ("across", "row")):
        values = np.stack([padded(None if x is None else getattr(x, name), (size[dim],)) for x in solutions])
        long = {"units": "m", "long_name": f"{'x' if name == 'along' else 'y'}, {name}"}
        found[name] = (dim, getattr(known[0], name), long) if is_one else (("case", dim), values, long)
    for name in FIELDS:
        vector = name in ("traction", "slip")
        shape = (2,) * vector + (size["row"], size["column"])
        values = np.stack([padded(None if x is None else getattr(x, name), shape) for x in solutions])
        dims = ("case", *(("direction",) if vector else ()), "row", "column")
        found[name] = (dims, values, {"units": UNITS[name]} if name in UNITS else WHERE)
    return found


def padded(values: Array | NDArray[np.bool_] | None, shape: tuple[int, ...]) -> Array:
    """Return values in the first places of an array of this shape, NaN in the others."""
    full = np.full(shape, np.nan)
    if values is not None:
        full[tuple(slice(n) for n in values.shape)] = values
    return full


SIGNS = (
    "Forces and moment act on body 1. Where the longitudinal creep is positive body 1 is the faster, and its "
    "force is negative. Spin s adds s y to the longitudinal creep; Kalker's spin is phi = -s."
)
SIGNS_OF_SHIFT = (
    "Forces and moment act on body 1, against its shift. Each shift begins without tractions. A turn t adds "
    "t y to the shift along x and -t x to that along y."
)
OF_CONTACT = (
    "Units and signs are CONTACT's: N, mm, rad; forces act on body 1. H elements stick, S slip; those that "
    "the outline cuts are counted. In a shift (T = 1) CKSI and CETA are distances [mm] and CPHI is an angle."
)
ZERO = 1e-6  # of the load: the solver's tolerance
DIGIT_T = {Motion.SHIFT: "1", Motion.TRANSIENT: "2", Motion.ROLLING: "3"}


def in_words(answer: ContactAnswer, notes: Sequence[str]) -> str:
    """Return the answer as text."""
    asked, setups = answer.question, _setups(answer)
    blocks = [heading(asked.title)]
    if setups and not asked.of_contact:
        blocks.append(section("Contact", facts(_contact(setups[0], answer))))
    cases = _contact_table(answer) if asked.of_contact else _table(answer)
    failed = [one for one in answer.cases if one.solution is None]
    lines = [paragraph(f"Case {one.case.number} has no solution: {one.reason}", first="  ") for one in failed]
    signs = SIGNS_OF_SHIFT if asked.cases[0].motion is Motion.SHIFT else SIGNS
    lines += [paragraph(OF_CONTACT if asked.of_contact else signs)]
    blocks.append(section("Cases", cases, "", *lines))
    if notes:
        blocks.append("\n".join(paragraph(note, first="Note: ", indent="      ") for note in notes))
    return "\n\n".join(blocks) + "\n"


def _contact(setup: ContactSetup, answer: ContactAnswer) -> list[tuple[str, str]]:
    problem, ellipse = setup.problem, setup.problem.ellipse
    solved = next((one.solution for one in answer.cases if one.solution is not None), None)
    b, a = (f"{1e3 * axis:.4g} mm" for axis in (ellipse.semi_minor, ellipse.semi_major))
    largest = solved and solved.max_pressure
    found = [
        ("Load", quantity(ellipse.load, "N")),
        ("Hertz ellipse", f"{b} along rolling, {a} across (half axes)"),
        ("Maximum pressure", quantity(largest or ellipse.max_pressure, "Pa", 4)),
    ]
    for number, body in enumerate(problem.bodies, 1):
        layers = [
            f"{quantity(x.thickness, 'm', 3)} with G {quantity(x.solid.shear_modulus, 'Pa', 3)}"
            for x in body.layers
        ]
        base = f"G {quantity(body.base.shear_modulus, 'Pa', 4)}, nu {body.base.poisson_ratio:g}"
        found.append((f"Body {number}", "; ".join([base, *(f"layer of {one}" for one in layers)])))
    mu = problem.friction.coefficient
    values = f"{min(mu.values):g} to {max(mu.values):g} across" if isinstance(mu, Profile) else f"{mu:g}"
    law = problem.friction
    if law.cohesion > 0.0:
        values += f", and {quantity(law.cohesion, 'Pa', 3)} of cohesion"
    if math.isfinite(law.shear_strength):
        values += f", at most {quantity(law.shear_strength, 'Pa', 3)}"
    found.append(("Friction coefficient", values))
    L = problem.film_compliance
    if isinstance(L, Profile) or L > 0.0:
        compliance = f"up to {max(L.values):.3g}" if isinstance(L, Profile) else f"{L:.3g}"
        found.append(("Film in series h/G", f"{compliance} m/Pa"))
    if problem.roughness > 0.0:
        compliance = f"compliance {quantity(problem.roughness, 'm', 3)} over the pressure"
        found.append(("Rough surfaces", compliance))
    if solved and solved.film_strain:
        found.append(("Strain of the softest layer", significant(solved.film_strain, 2)))
    if answer.slope is not None:
        one = answer.slope
        value = f"{significant(one.slope)} +- {significant(one.slope_error, 2)}"
        value += f", at a creep of {significant(one.free_rolling_offset)}"
        found.append(("Slope at free rolling", value))
    elif answer.slope_reason:
        found.append(("Slope at free rolling", f"none: {answer.slope_reason}"))
    return found


def _table(answer: ContactAnswer) -> str:
    heads = {
        Motion.ROLLING: ("creep x\n%", "creep y\n%", "spin\n1/mm"),
        Motion.TRANSIENT: ("creep x\n%", "creep y\n%", "spin\n1/mm", "rolled\nmm"),
        Motion.SHIFT: ("shift x\num", "shift y\num", "turn\nmrad"),
    }[answer.cases[0].case.motion]
    results = ("force\nN", "lateral\nN", "moment\nN mm", "force x\nover load", "stick\n%")
    is_shift = answer.cases[0].case.motion is Motion.SHIFT
    headers = ("case", *heads, *results, "work\nuJ" if is_shift else "power over\nspeed, N")
    rolled, rows = 0.0, []
    for one in answer.cases:
        case = one.case
        rolled += case.distance
        moves = [1e2 * case.longitudinal_creep, 1e2 * case.lateral_creep, 1e-3 * case.spin]
        if case.motion is Motion.SHIFT:
            moves = [1e6 * case.longitudinal_shift, 1e6 * case.lateral_shift, 1e3 * case.turn]
        moves += [1e3 * rolled] if case.motion is Motion.TRANSIENT else []
        rows.append([str(case.number), *(significant(move + 0.0) for move in moves), *_results(one)])
    return table(headers, rows)


def _results(one: SolvedCase) -> list[str]:
    found = one.solution
    if found is None:
        return [ABSENT] * 6
    zero = ZERO * found.load
    forces = [value if abs(value) > zero else 0.0 for value in (found.force, found.lateral_force)]
    moment = 1e3 * found.spin_moment if abs(found.spin_moment) > zero * found.across.max() else 0.0
    work = found.dissipation * (1e6 if one.case.motion is Motion.SHIFT else 1.0)
    numbers = [*forces, moment, forces[0] / found.load]
    return [*map(significant, numbers), f"{100.0 * found.stick_share:.1f}", significant(work)]


def _contact_table(answer: ContactAnswer) -> str:
    forces = ("FN\nN", "FX\n/FSTAT/FN", "FY\n/FSTAT/FN", "MZ\nN mm")
    headers = ("case", "T", *forces, "CKSI", "CETA", "CPHI", "H", "S", "residual")
    rows = []
    for one in answer.cases:
        case, found = one.case, one.solution
        ours = case.longitudinal_creep, case.lateral_creep, -1e-3 * case.spin
        if case.motion is Motion.SHIFT:
            ours = 1e3 * case.longitudinal_shift, 1e3 * case.lateral_shift, -case.turn
        largest = max(map(abs, ours))
        given = [significant(value if abs(value) > 1e-6 * largest else 0.0) for value in ours]
        cells, share = one.cells or (None, None), one.sliding_share or (None, None)
        shares = [ABSENT if x is None else f"{round(x, 5) + 0.0:.5f}" for x in share]
        moment = ABSENT
        if found is not None:
            zero = ZERO * found.load * float(found.across.max())
            moment = significant(1e3 * found.spin_moment if abs(found.spin_moment) > zero else 0.0)
        rows.append(
            [
                *(str(case.number), DIGIT_T[case.motion] if largest or case.wanted[0] else "0"),
                significant(case.setup.problem.ellipse.load),
                *shares,
                moment,
                *given,
                *(ABSENT if x is None else str(x) for x in cells),
                ABSENT if one.residual is None else f"{one.residual:.0e}",
            ]
        )
    return table(headers, rows)
