"""The library: exact names, the paper's table, and a source and a confidence for every datum."""

import tomllib
from importlib.resources import files

import pytest

from separatrix import library
from separatrix.errors import DataError

CONFIDENCES = {"handbook", "literature", "guess"}
DATA = files("separatrix.library") / "data"

PAPER_TABLE_3 = """
Meldin HTC 100 | - | - | .22 | .32
Meldin 7211 | .10 | .13 | .18 | .20
Armalon | .09 | .07 | .05 | .08
PEEK WG 101 | .10 | .17 | .15 | .14
PEEK 450 GL 30 | .29 | .16 | .39 | .27
PEEK 450 CA 30 | .11 | .17 | .12 | .13
Vespel SP 211 | .12 | .13 | .14 | .11
"""


@pytest.mark.parametrize("kind", library.FILES)
def test_every_datum_has_a_source_and_a_confidence(kind):
    """And a guess is marked as one, with its reason."""
    records = tomllib.loads((DATA / library.FILES[kind]).read_text(encoding="utf-8"))
    assert records
    for name, record in records.items():
        assert record["remark"].strip(), name
        assert {"elastic_modulus", "poisson_ratio"} <= set(record)
        for key in set(record) - {"remark"}:
            assert set(record[key]) == {"value", "confidence", "source"}, (name, key)
            assert record[key]["confidence"] in CONFIDENCES, (name, key)
            assert len(record[key]["source"]) >= 6, (name, key)


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind in library.FILES for name in library.names(kind)]
)
def test_every_material_can_be_built(kind, name):
    """Values in SI, source and confidence as text."""
    material = library.material(kind, name)
    assert 1e8 < material.elastic_modulus < 4e11
    assert "modulus: " in material.confidence
    assert "modulus: " in material.source
    assert material.source.isprintable()


def test_the_friction_table_is_the_paper_s():
    """Table 3, every number; a cross is absent, never 0."""
    table = library.friction_table("pin-on-disk-77K")
    rows = [line.split(" | ") for line in PAPER_TABLE_3.strip().splitlines()]
    assert list(table.friction) == [row[0] for row in rows]
    for name, *values in rows:
        for environment, value in zip(table.environments, values, strict=True):
            friction = table.friction[name][environment]
            assert (friction is None) == (value == "-")
            assert friction is None or friction.mean == float(value)


def test_the_seven_materials_of_the_paper_have_elastic_records():
    """Whoever ranks them without a pocket stiffness needs a modulus."""
    table = library.friction_table("pin-on-disk-77K")
    assert set(table.friction) == set(library.names("cage material"))
    assert all(table.candidate(name).material is not None for name in table.friction)


def test_the_file_of_the_table_says_who_typed_it_and_what_is_missing():
    """Its header is part of the datum."""
    text = (DATA / "pin-on-disk-77K.toml").read_text(encoding="utf-8")
    for words in ("table 3", "Typed in", "absent", "1 to 5 m/s", "1 to 14 daN", "table 2", "lost"):
        assert words in text


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: library.bearing_material("440 C"), "440C, 52100, Si3N4"),
        (lambda: library.film_material("oil"), "PTFE transfer film"),
        (lambda: library.cage_material("brass"), "Armalon"),
        (lambda: library.friction_table("none"), "pin-on-disk-77K"),
        (lambda: library.friction_table("pin-on-disk-77K").candidate("brass"), "Vespel SP 211"),
    ],
)
def test_an_unknown_name_is_answered_with_the_known_ones(ask, words):
    """Names are exact: no record is substituted for another."""
    with pytest.raises(DataError, match=words):
        ask()
