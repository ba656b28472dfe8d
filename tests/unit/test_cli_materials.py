"""`separatrix materials` as a user calls it, and results that outlive a change of the library."""

import json

import pytest

import separatrix
from separatrix.front import main
from separatrix.ground.errors import InputError

OURS = """\
title = "Our lab"
[film."Our film"]
remark = "Batch 7."
elastic_modulus = [
  { value = "2 GPa", temperature = "77 K", source = "fitted to test 12", confidence = "measured" },
  { value = "0.4 GPa", temperature = "295 K", source = "as PTFE", confidence = "guess" },
]
poisson_ratio = { value = 0.4, source = "usual", confidence = "guess" }
"""
STUDY = 'title = "Ours"\nextends = "cryogenic-turbopump"\n[film]\nmaterial = "Our film"\n'
DATUM = {"value", "unit", "range", "temperature", "pressure", "medium", "form", "source", "confidence"}
RECORD = {"kind", "name", "remark", "composition", "aliases", "library", "data"}
FLUID = RECORD | {"substance", "phase", "coolprop"}
TABLE = (RECORD - {"composition", "aliases", "data"}) | {"title", "source", "confidence", "friction"}
TABLE |= {"conditions", "environments"}


@pytest.fixture
def folder(elsewhere, tmp_path):
    """A folder with a library and a study that names a record of it."""
    (tmp_path / "materials.toml").write_text(OURS)
    (tmp_path / "case.toml").write_text(STUDY)
    return tmp_path


@pytest.fixture
def ask(capsys):
    """Run a verb of `materials`; what it says on standard output."""

    def run(*arguments):
        assert main(["materials", *arguments]) == 0
        out, err = capsys.readouterr()
        assert err == ""
        return out

    return run


def test_the_list_has_every_record_with_the_documented_keys(folder, ask):
    """Shipped ones and those of the current folder; numbers in SI; no record lacks a source."""
    document = json.loads(ask("list", "--json"))
    assert set(document) == {"separatrix_version", "verb", "libraries", "materials"}
    assert document["verb"] == "materials list"
    assert [library["file"] for library in document["libraries"]] == ["materials.toml"]
    keys = {"fluid": FLUID, "friction table": TABLE}
    for record in document["materials"]:
        assert set(record) == keys.get(record["kind"], RECORD)
        assert set(record["library"]) == {"file", "sha256", "shipped"}
        for data in record.get("data", {}).values():
            assert all(set(datum) == DATUM and datum["source"] for datum in data)
    kinds = {record["name"]: record["kind"] for record in document["materials"]}
    some = {"Our film": "film", "liquid nitrogen": "fluid", "pin-on-disk-77K": "friction table"}
    assert some.items() <= kinds.items()


def test_a_record_is_shown_whole(folder, ask):
    """Every number with range, condition, confidence and source; the checksum of the library."""
    text = " ".join(ask("show", "Our film").split())
    assert "elastic modulus 2 GPa, 77 K; measured: fitted to test 12" in text
    assert "elastic modulus 400 MPa, 295 K; guess: as PTFE" in text
    assert "Poisson's ratio 0.4, at no stated temperature; guess: usual" in text
    assert "materials.toml, of the user, sha256" in text
    assert set(json.loads(ask("show", "Our film", "--json"))["records"][0]) == RECORD
    fluid = json.loads(ask("show", "LN2", "--json"))["records"][0]  # by another name of it
    assert (set(fluid), fluid["name"]) == (FLUID, "liquid nitrogen")


def test_python_has_the_same_library(folder, ask):
    """`materials()` says what the command prints; its table has a row for each number."""
    films = separatrix.materials("film")
    text = ask("list", "--kind", "film")
    assert films.summary() == text
    assert "440C" not in text
    assert max(map(len, text.splitlines())) <= 110  # of a terminal: names and files stand in full
    assert films.document()["materials"] == json.loads(ask("list", "--kind", "film", "--json"))["materials"]
    assert "Our film" in [*films.to_dataframe()["name"]]
    assert separatrix.material("Our film").summary() == ask("show", "Our film")
    with pytest.raises(InputError, match="is not a film of the library"):
        separatrix.material("Our cage", kind="film")
