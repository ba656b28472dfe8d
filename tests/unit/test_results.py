"""Records as plain data, and plain data as labelled arrays."""

from __future__ import annotations

import json
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Annotated

import numpy as np
import pytest
from separatrix.results.labels import RECORD_CLASSES, unit_of, units
from separatrix.results.plain import NotFiniteError, field_units, plain

from separatrix import results
from separatrix.errors import InputError
from separatrix.results import documents
from separatrix.study import Guidance
from separatrix.study_file import read_study
from separatrix.units import Newton, Ratio


class Colour(Enum):
    """An enumeration of sentences."""

    RED = "It is red."


class Step(IntEnum):
    """An enumeration of numbers."""

    FIRST = 1


@dataclass(frozen=True, slots=True)
class Inner:
    """A record inside a record."""

    load: Newton
    ratio: Ratio | None = None


@dataclass(frozen=True, slots=True)
class Outer:
    """A record of everything that results hold."""

    inner: Inner
    values: Annotated[np.ndarray, "Pa"]
    colour: Colour = Colour.RED
    step: Step = Step.FIRST
    guidance: Guidance = Guidance.BALL
    parts: tuple[Inner, ...] = ()
    by_name: dict | None = None


def test_a_record_becomes_what_json_holds():
    """Nested records, arrays, enumerations, tuples and mappings; study enumerations keep their spelling."""
    record = Outer(
        Inner(2.0), np.array([[1.0, 2.0]]), parts=(Inner(1.0, 0.5),), by_name={Guidance.INNER: np.int64(3)}
    )
    assert json.loads(json.dumps(plain(record), allow_nan=False)) == {
        "inner": {"load": 2.0, "ratio": None},
        "values": [[1.0, 2.0]],
        "colour": "RED",
        "step": "FIRST",
        "guidance": "ball",
        "parts": [{"load": 1.0, "ratio": 0.5}],
        "by_name": {"inner": 3},
    }


@pytest.mark.parametrize(
    "bad", [float("nan"), float("inf"), np.array([0.0, np.nan])], ids=["nan", "inf", "array"]
)
def test_a_number_that_is_none_is_a_fault_that_says_where(bad):
    """NaN and infinity never reach a document; the message names the field."""
    with pytest.raises(NotFiniteError, match=r"result\.inner\.load"):
        plain(Outer(Inner(bad), np.zeros(1)))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_document_leaves_out_a_number_that_is_not_finite_and_says_so(bad, monkeypatch):
    """Null and a reason, not a traceback after a long computation."""
    study = read_study("cryogenic-turbopump")
    monkeypatch.setitem(documents.DOCUMENTS, "check", lambda record: plain(record, "check"))
    found = documents.document("check", {"a": 1.0, "b": [bad, 2.0], "c": bad}, study, ["A note."])
    assert (found["a"], found["b"], found["c"]) == (1.0, [None, 2.0], None)
    note, reason = found["warnings"]
    assert note == "A note."
    assert reason.startswith(f"A number is not finite and is left out: check.b[0] is {bad} and 1 more.")
    json.dumps(found, allow_nan=False)


def test_what_has_no_plain_form_is_refused():
    """A function in a record is a fault of ours, not text."""
    with pytest.raises(TypeError, match="has no plain form"):
        plain({"a": print})


def test_units_come_from_the_annotations():
    """Also in unions, and for arrays; a field without a unit is left out."""
    assert field_units(Outer) == {"values": "Pa"}
    assert field_units(Inner) == {"load": "N", "ratio": "-"}


def test_one_name_has_one_unit():
    """No two records give the same name different units."""
    import importlib

    for module, names in RECORD_CLASSES.items():
        for name in names.split():
            record = getattr(importlib.import_module(f"separatrix.{module}"), name)
            for field, unit in field_units(record).items():
                assert units()[field] == unit, f"{name}.{field}"


def test_units_are_found_behind_prefixes():
    """`chain_`, `contact_`, `cage_` and the like go before a name that has a unit."""
    assert unit_of("chain_race_damping") == "N s/m"
    assert unit_of("contact_max_pressure") == "Pa"
    assert unit_of("cage_pocket_clearance") == "m"
    assert unit_of("work_land_friction") == "J"
    assert unit_of("material_name") is None


def ranking(order: tuple[str, str]) -> dict:
    """Return a small document with two environments and two materials, in either order."""
    friction = {"A": 0.1, "B": None}
    rows = [
        {"name": n, "friction": friction[n], "reason": None if n == "A" else "not measured"} for n in order
    ]
    return {
        "separatrix_version": "0",
        "verb": "rank",
        "warnings": ["one"],
        "restitution_factor": 0.3,
        "environments": [{"name": "x", "materials": rows}, {"name": "y", "materials": rows[::-1]}],
    }


@pytest.mark.parametrize("order", [("A", "B"), ("B", "A")])
def test_materials_are_aligned_by_name(order):
    """Each environment lists its best first; in the dataset a material has one place."""
    data = results.dataset(ranking(order))
    assert data["material"].values.tolist() == ["A", "B"]
    np.testing.assert_array_equal(data["material_friction"], [[0.1, np.nan]] * 2)
    assert data["material_reason"].values.tolist() == [["", "not measured"]] * 2
    assert float(data["chain_restitution_factor"]) == 0.3


def test_a_dataset_survives_its_file(tmp_path):
    """Numbers, missing ones, texts and provenance come back from netCDF."""
    data = results.dataset(ranking(("A", "B")))
    results.save(data, tmp_path / "a.nc")
    back = results.load(tmp_path / "a.nc")
    assert back.identical(data) or back.equals(data)
    assert back.attrs["separatrix_version"] == "0"
    assert json.loads(back.attrs["warnings"]) == ["one"]


def test_what_is_no_result_is_refused(tmp_path):
    """A missing file, and one that is something else."""
    (tmp_path / "b.nc").write_text("no")
    for name, rule in (("a.nc", "cannot be read: no such file"), ("b.nc", "is not a readable netCDF result")):
        with pytest.raises(InputError, match=rule):
            results.load(tmp_path / name)


def test_a_list_that_one_row_lacks_is_a_row_of_missing_values():
    """The dimensions are those of the rows that have it, wherever these stand."""
    rows = [{"name": "A", "pocket_impact_shares": None}, {"name": "B", "pocket_impact_shares": [0.25, 0.75]}]
    data = results.dataset({"verb": "rank", "overall": rows})
    shares = data["overall_pocket_impact_shares"]
    assert shares.dims == ("material", "ball")
    assert np.array_equal(shares.values, [[np.nan, np.nan], [0.25, 0.75]], equal_nan=True)
