"""The verb `mobility` and its record: what is refused, and what a study without a cage gets."""

import json
from dataclasses import replace

import numpy as np
import pytest

import separatrix
from separatrix.front import api
from separatrix.study.study import Wear, Worn


def test_document_and_table_of_a_wheel():
    """Units and places of the keys; the main table is the push."""
    answer = api.mobility("momentum-wheel")
    document = json.loads(json.dumps(answer.document()))
    assert document["slip_law"] == "elastic creep"
    assert document["rigid"]["slip_law"] == "rigid"
    assert document["traction"]["capacity"] == pytest.approx(document["capacity"], rel=0.15)
    assert sum(document["shares"]) == pytest.approx(1.0, rel=1e-9)
    table = answer.to_dataframe()
    assert {"force_forward", "force_backward", "force_law"} <= set(table)
    assert len(table) == len(document["speed"])


def test_a_worn_film_is_noted():
    """Its friction is not in the slip fields."""
    study = separatrix.read_study("cryogenic-turbopump")
    wear = Wear(width=0.2e-3, friction=0.3, races=Worn.INNER)
    solution = separatrix.solve(replace(study, film=replace(study.film, wear=wear)))
    found = solution.mobility
    assert any(note.startswith("The film is worn: the mobility") for note in solution.notes)
    assert np.isfinite(found.force_law).all()
