"""Answer of `contact` as plain data, and as labelled arrays with the fields of every case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from separatrix.chain.traction.exact.contact import ContactSolution
from separatrix.contact_file.question import ContactAnswer, ContactCase, Motion, SolvedCase
from separatrix.present.json import null_if_not_finite, plain

NUMBERS = {
    "load": "N",
    "force": "N",
    "lateral_force": "N",
    "spin_moment": "N m",
    "stick_share": "-",
    "dissipation": "N",
    "max_pressure": "Pa",
    "film_strain": "-",
}
"""Numbers of a solution and their units; the dissipation is power per rolling speed, in a shift an energy."""

GIVEN = {
    "longitudinal_creep": "-",
    "lateral_creep": "-",
    "spin": "1/m",
    "curvature": "1/m2",
    "longitudinal_shift": "m",
    "lateral_shift": "m",
    "turn": "rad",
    "distance": "m",
}
OF_MOTION = {
    Motion.ROLLING: tuple(GIVEN)[:4],
    Motion.SHIFT: tuple(GIVEN)[4:7],
    Motion.TRANSIENT: (*tuple(GIVEN)[:4], "distance"),
}
"""What a case is given, or what was found for it, by its motion."""

FIELDS = {"fraction": "-", "pressure": "Pa", "traction": "Pa", "slip": "-", "stick": ""}


def contact(answer: ContactAnswer, notes: Sequence[str]) -> dict[str, Any]:
    """Return the answer as plain data: SI units, None where something is absent.

    Parameters
    ----------
    answer : ContactAnswer
        From `separatrix.contact_file.solving.solve_cases`.
    notes : sequence of str
        Warnings on the way.
    """
    from separatrix import __version__

    asked = answer.question
    setups = list({id(one.case.setup): one.case.setup for one in answer.cases}.values())
    with null_if_not_finite():
        contacts = [
            plain(one.problem, "contacts")
            | {"columns": one.columns, "rows": one.rows, "on_gap": bool(one.gap)}
            for one in setups
        ]
    return {
        "separatrix_version": __version__,
        "verb": "contact",
        "name": asked.name,
        "title": asked.title,
        "contacts": contacts,
        "slope": _slope(answer),
        "cases": [_case(one, setups.index(one.case.setup)) for one in answer.cases],
        "warnings": list(notes),
    }


def _slope(answer: ContactAnswer) -> dict[str, Any] | None:
    if not answer.question.slope:
        return None
    found = answer.slope
    names = ("slope", "slope_error", "free_rolling_offset")
    node: dict[str, Any] = {name: None if found is None else float(getattr(found, name)) for name in names}
    return node | {"reason": answer.slope_reason or None}


def _case(one: SolvedCase, number: int) -> dict[str, Any]:
    case, found = one.case, one.solution
    node: dict[str, Any] = {"case": case.number, "contact": number, "motion": case.motion.value}
    node |= _given(case)
    node |= {name: None if found is None else float(getattr(found, name)) for name in NUMBERS}
    share, cells = one.sliding_share or (None, None), one.cells or (None, None)
    node |= {"force_share": share[0], "lateral_force_share": share[1]}
    node |= {"stick_cells": cells[0], "slip_cells": cells[1]}
    node |= {"iterations": None if found is None else found.iterations, "residual": one.residual}
    return node | {"reason": one.reason or None}


def _given(case: ContactCase) -> dict[str, float | None]:
    own = OF_MOTION[case.motion]
    return {name: float(getattr(case, name)) if name in own else None for name in GIVEN}


def contact_dataset(answer: ContactAnswer, notes: Sequence[str] = ()) -> xr.Dataset:
    """Return numbers and fields of the cases; absent ones are NaN, their reason is in the variable `reason`.

    Dimensions are case, direction (along, across), row and column. Cases on one grid share the coordinates
    `along` and `across` [m]; where grids differ these depend on the case, too, and smaller grids end in NaN.
    """
    found = contact(answer, notes)
    rows, slope = found["cases"], found["slope"] or {}
    data: dict[str, Any] = {
        key: ((), np.nan if slope[key] is None else slope[key], {"units": "-"})
        for key in ("slope", "slope_error", "free_rolling_offset")
        if key in slope
    }
    for name, unit in (NUMBERS | GIVEN | {"force_share": "-", "lateral_force_share": "-"}).items():
        data[name] = ("case", np.array([row[name] for row in rows], dtype=float), {"units": unit})
    for name in ("stick_cells", "slip_cells", "residual"):
        data[name] = ("case", np.array([row[name] for row in rows], dtype=float), {"units": "-"})
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


def _fields(solutions: Sequence[ContactSolution | None]) -> dict[str, Any]:
    known = [one for one in solutions if one is not None]
    if not known:
        return {}
    size = {"row": max(x.across.size for x in known), "column": max(x.along.size for x in known)}
    is_one = all(
        np.array_equal(one.along, known[0].along) and np.array_equal(one.across, known[0].across)
        for one in known
    )
    found: dict[str, Any] = {}
    for name, dim in (("along", "column"), ("across", "row")):
        values = np.stack([padded(None if x is None else getattr(x, name), (size[dim],)) for x in solutions])
        long = {"units": "m", "long_name": f"{'x' if name == 'along' else 'y'}, {name}"}
        found[name] = (dim, getattr(known[0], name), long) if is_one else (("case", dim), values, long)
    for name, unit in FIELDS.items():
        vector = name in ("traction", "slip")
        shape = (2,) * vector + (size["row"], size["column"])
        values = np.stack([padded(None if x is None else getattr(x, name), shape) for x in solutions])
        dims = ("case", *(("direction",) if vector else ()), "row", "column")
        found[name] = (dims, values, {"units": unit} if unit else {"long_name": "1 where the surfaces stick"})
    return found


def padded(values: Any, shape: tuple[int, ...]) -> Any:
    """Values in the first places of an array of this shape, NaN in the others."""
    full = np.full(shape, np.nan)
    if values is not None:
        full[tuple(slice(n) for n in values.shape)] = values
    return full
