"""Records as plain data, as labelled arrays, and as tables."""

import json
from dataclasses import dataclass, fields, replace
from enum import Enum, IntEnum
from typing import Annotated

import numpy as np
import pytest
from cages import TURNING

from separatrix import Guidance, document, read_study, solve
from separatrix.ground.plain_data import Group, NotFiniteError, field_units, node_of, plain, shape, units_of
from separatrix.ground.units import Newton, Ratio, Rows
from separatrix.present.dataset import arrays_of, dataset, main_table
from separatrix.verbs import Computed, cage_answers, chain_answers, verb_named
from separatrix.verbs.verb import NoOptions
from separatrix.verdict import swept_cases as sweep
from separatrix.verdict.ranking_records import NotMeasured, Ranked

STUDY = read_study("cryogenic-turbopump")


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
    """A record of everything that answers have."""

    inner: Inner
    values: Annotated[np.ndarray, "Pa", ("strip", "node")]
    colour: Colour = Colour.RED
    step: Step = Step.FIRST
    guidance: Guidance = Guidance.BALL
    parts: Annotated[tuple[Inner, ...], Rows("part", "part_", label="load")] = ()
    by_name: dict | None = None


@dataclass(frozen=True, slots=True)
class Row:
    """A record with a name."""

    name: str
    friction: Ratio | None
    extrapolation: tuple[str, ...] = ()
    shares: Annotated[tuple[Ratio, ...] | None, ("ball",)] = None


@dataclass(frozen=True, slots=True)
class Place:
    """Records in a record of a list."""

    name: str
    materials: Annotated[tuple[Row, ...], Rows("material", "material_", label="name")]


@dataclass(frozen=True, slots=True)
class Places:
    """An answer in two environments."""

    restitution_factor: Ratio
    environments: Annotated[tuple[Place, ...], Rows("environment", label="name")]


def to_xarray(record):
    """Return the arrays of a record, by way of its plain data."""
    node = Group(shape(record))
    return arrays_of(node_of(plain(node, left_out=[]), units_of(node)))


def test_a_record_becomes_what_json_can_hold():
    """Nested records, arrays, enumerations, tuples and mappings; study enumerations keep their spelling."""
    record = Outer(Inner(2.0), np.array([[1.0, 2.0]]), parts=(Inner(1.0, 0.5),), by_name={"a": np.int64(3)})
    assert json.loads(json.dumps(plain(record), allow_nan=False)) == {
        "inner": {"load": 2.0, "ratio": None},
        "values": [[1.0, 2.0]],
        "colour": "RED",
        "step": "FIRST",
        "guidance": "ball",
        "parts": [{"load": 1.0, "ratio": 0.5}],
        "by_name": {"a": 3},
    }
    assert plain({Guidance.INNER: 1}) == {"inner": 1}


def test_units_and_dimensions_come_from_the_annotations():
    """Of arrays, of records in a list along their dimension, and of single records behind their prefix."""
    assert field_units(Outer) == {"values": "Pa"}
    assert field_units(Inner) == {"load": "N", "ratio": "-"}
    data = to_xarray(Outer(Inner(2.0), np.array([[1.0, 2.0]]), parts=(Inner(1.0, 0.5), Inner(3.0))))
    assert (data["values"].dims, data["values"].attrs["units"]) == (("strip", "node"), "Pa")
    assert (data["part"].values.tolist(), data["part"].attrs["units"]) == ([1.0, 3.0], "N")
    np.testing.assert_array_equal(data["part_ratio"], [0.5, np.nan])
    assert (float(data["inner_load"]), data["inner_load"].attrs["units"]) == (2.0, "N")


@pytest.mark.parametrize(
    "bad", [float("nan"), float("inf"), np.array([0.0, np.nan])], ids=["nan", "inf", "array"]
)
def test_a_number_that_is_not_finite_is_a_fault_with_its_place(bad):
    """NaN and infinity never reach a document; the message names the field."""
    with pytest.raises(NotFiniteError, match=r"result\.inner\.load"):
        plain(Outer(Inner(bad), np.zeros(1)))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_document_leaves_out_a_number_that_is_not_finite_with_a_warning(bad):
    """Null and a reason, not a traceback after a long computation; missing in the dataset, too."""
    record = Outer(Inner(bad), np.array([[bad, 1.0]]))
    study = replace(STUDY, notes=("A note.",))
    found = document(verb_named("bearing"), made(record, study))
    assert (found["inner"]["load"], found["values"]) == (None, [[None, 1.0]])
    note, reason = found["warnings"]
    assert note == "A note."
    words = f"A number is not finite and is left out: bearing.inner.load is {bad} and 1 more."
    assert reason.startswith(words)
    json.dumps(found, allow_nan=False)
    np.testing.assert_array_equal(to_xarray(record)["values"], [[np.nan, 1.0]])


def test_a_row_that_was_not_measured_has_all_keys():
    """Null but for its name, the reason and the empty list; none of the ranked one's is missing."""
    found = plain(NotMeasured(name="A", reason="not measured"))
    assert {f.name for f in fields(Ranked)} - {"judgement", "over_inputs"} <= set(found)
    given = {key: value for key, value in found.items() if value is not None}
    assert given == {"name": "A", "reason": "not measured", "extrapolation": []}


def made(record, study):
    """Return a record as a verb computes it."""
    return Computed(record=record, study=study, options=NoOptions(), is_complete=True)


ROWS = (Row("A", 0.1, ("too fast", "too hot"), (0.25, 0.75)), Row("B", None))


@pytest.mark.parametrize("rows", [ROWS, ROWS[::-1]])
def test_materials_are_aligned_by_name(rows):
    """In a dataset a material has one place whatever its rank; what a row lacks is missing, texts are one."""
    answer = Places(0.3, (Place("x", rows), Place("y", rows[::-1])))
    found = document(verb_named("rank"), made(answer, replace(STUDY, notes=("one",))))
    data = dataset(found)
    assert data["material"].values.tolist() == ["A", "B"]
    np.testing.assert_array_equal(data["material_friction"], [[0.1, np.nan]] * 2)
    assert data["material_extrapolation"].values.tolist() == [["too fast; too hot", ""]] * 2
    assert data["material_shares"].dims == ("environment", "material", "ball")
    np.testing.assert_array_equal(data["material_shares"][0], [[0.25, 0.75], [np.nan] * 2])
    assert float(data["chain_restitution_factor"]) == 0.3
    assert json.loads(data.attrs["warnings"]) == ["one"]
    assert json.loads(data.attrs["study"])["bearing"]["ball_count"]["value"] == 13


def test_a_dataset_has_balls_that_are_held_by_unlike_numbers_of_waves():
    """Capacity and slope around a loaded bearing fall off at different rates: each has its own dimension."""
    cage = replace(TURNING, capacity_waves=(0.6, 0.3, 0.0), slope_waves=(0.7, 0.2, 0.0, 0.1, 0.0))
    data = dataset({"cage": plain(cage), "units": {"cage": units_of(Group(shape(cage)))}})
    assert [data[f"cage_{name}"].shape for name in ("capacity_waves", "slope_waves")] == [(3,), (5,)]


def test_an_answer_is_a_table():
    """A row a ball, a case, or a candidate in an environment; columns are the arrays along them."""
    state = solve(STUDY).bearing
    balls = main_table(to_xarray(state))
    assert (balls.index.name, len(balls)) == ("ball", 13)
    assert balls["load_inner"].to_numpy() == pytest.approx(state.equilibrium.load_inner, rel=0)
    assert "ball_spin_2" in balls
    cases = sweep.sweep(STUDY, [{"film.thickness": h} for h in (2e-7, 5e-7)])
    cases = main_table(to_xarray(cases))
    assert cases["film.thickness"].tolist() == [2e-7, 5e-7]
    rows = main_table(to_xarray(Places(0.3, (Place("x", ROWS), Place("y", ROWS)))))
    assert rows.loc["x", "A"]["friction"] == 0.1


def test_every_answer_of_a_verb_is_arranged():
    """Each record of `answers` is a shape of its own: none is shown field by field by accident."""
    known = {**vars(chain_answers), **vars(cage_answers)}.values()
    records = {one for one in known if getattr(one, "__name__", "").endswith("Answer")}
    assert len(records) == 10
    assert all(shape.dispatch(one) is not shape.dispatch(object) for one in records)
