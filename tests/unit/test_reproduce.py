"""`reproduce`: stored answers are computed again from what they keep; a changed one is found."""

import contextlib
import io
import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from commands import document, refused

import separatrix
from separatrix.front import main
from separatrix.study import sources
from separatrix.study.reading import read_study
from separatrix.study.sources import provenance_of

FEW = "[stability]\nruns = 2\nduration = '5 ms'\nkicks = ['0.5 m/s']\nrestitution_factors = [0.3]\n"
BASE = "extends = 'cryogenic-turbopump'\ntitle = 'Base \u00b5'\n"
FRICTION = """[[test]]
material = "PTFE"
counterface = "440C"
medium = "gas"
friction = 0.12
"""

LIBRARY = """[cage_material."Compound X"]
elastic_modulus = { value = "3 GPa", source = "a sheet", confidence = "maker" }
poisson_ratio = { value = 0.4, source = "a sheet", confidence = "guess" }
"""
CASES = "film.thickness\n1 um\n0.5 um\n"
ASKED = [
    ("check", "ball-218"),
    ("bearing", "ball-218"),
    ("bearing", "lox-turbopump-radial"),
    ("restitution", "sub/variant.toml"),
    ("check", "tested.toml"),
    ("simulate", "sub/variant.toml", "--kick", "0.3 m/s", "--run", "3", "--model", "paper"),
    ("stability", "sub/variant.toml"),
    ("sweep", "sub/variant.toml", "--vary", "film.thickness=0.5..1um:2"),
    ("sweep", "sub/variant.toml", "--cases", "cases.csv"),
    ("rank", "sub/variant.toml"),
    ("map", "sub/variant.toml", "--points", "2", "--runs", "2"),
]


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """Answers by what was asked; their files, above them, elsewhere and of other kinds, are gone."""
    folder = tmp_path_factory.mktemp("made")
    own, far, answers = folder / "own", folder / "far" / "shared", {}
    (own / "sub").mkdir(parents=True)
    far.mkdir(parents=True)
    (far / "mine.toml").write_text(LIBRARY)
    (own / "base.toml").write_bytes((BASE + FEW).replace("\n", "\r\n").encode())
    (own / "sub" / "variant.toml").write_text(f"extends = '../base.toml'\nlibrary = '{far / 'mine.toml'}'\n")
    tested = "extends = 'cryogenic-turbopump'\n[ranking]\nfriction = 'friction.toml'\n"
    (own / "tested.toml").write_text(tested)
    (own / "friction.toml").write_text(FRICTION)
    (own / "cases.csv").write_text(CASES)
    with contextlib.chdir(own):
        for asked in ASKED:
            with contextlib.redirect_stdout(io.StringIO()) as out:
                assert main([*asked, "--json", "--jobs", "2", "--quiet"]) == 0
            answers[asked] = json.loads(out.getvalue())
    shutil.rmtree(folder / "own")
    shutil.rmtree(folder / "far")
    return answers


@pytest.fixture
def put(elsewhere):
    """Return what writes an answer into an empty folder."""

    def write(answer):
        Path("answer.json").write_text(json.dumps(answer), encoding="utf-8")
        return "answer.json"

    return write


def again(capsys, path: str) -> dict:
    """Return the one answer of `reproduce`."""
    (found,) = document(capsys, "reproduce", path, "--quiet", "--jobs", "2")["answers"]
    return found


@pytest.mark.parametrize("asked", ASKED, ids=" ".join)
def test_a_stored_answer_is_the_same(stored, put, capsys, asked):
    """Bit for bit, from nothing but the answer."""
    found = again(capsys, put(stored[asked]))
    assert found["agreement"] == "bit for bit", found
    assert found["versions"] == []


VARIANT = ("restitution", "sub/variant.toml")


def changed(answer: dict, change) -> dict:
    """Return a copy of an answer that was changed."""
    copy = json.loads(json.dumps(answer))
    change(copy)
    return copy


def test_a_changed_number_or_study_is_found(stored, put, capsys):
    """The key, what the answer says, and what is computed; a hair is rounding."""

    def wrong(answer):
        answer["inner"]["load"] *= 1.001

    def hair(answer):
        answer["inner"]["load"] *= 1.0 + 1e-13

    def edit(answer):
        answer["provenance"]["study"]["data"]["operation"]["axial_load"] = "2 kN"

    was = stored[VARIANT]["inner"]["load"]
    found = again(capsys, put(changed(stored[VARIANT], wrong)))
    assert (found["agreement"], found["count"]) == ("different", 1)
    (one,) = found["differences"]
    assert (one["key"], one["stored"], one["computed"]) == ("inner.load", was * 1.001, was)
    assert one["relative"] == pytest.approx(1e-3, rel=1e-2)
    found = again(capsys, put(changed(stored[VARIANT], hair)))
    assert found["agreement"] == "to rounding"
    assert found["differences"][0]["key"] == "inner.load"
    found = again(capsys, put(changed(stored[VARIANT], edit)))
    assert "study.operation.axial_load.value" in {one["key"] for one in found["differences"]}
    assert main(["reproduce", put(changed(stored[VARIANT], wrong)), "--quiet"]) == 0
    assert "restitution variant: different: 1 value differs." in capsys.readouterr().out


def test_another_version_is_named_and_computed_all_the_same(stored, put, capsys):
    """One line has what differs; other words of a warning are no difference."""

    def older(answer):
        answer["warnings"] = ["another"]
        answer["provenance"]["versions"]["numpy"] = "2.0.0"
        answer["separatrix_version"] = "0.0.1"

    assert main(["reproduce", put(changed(stored[VARIANT], older)), "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "the same, bit for bit" in out
    (line,) = [line for line in out.splitlines() if "Other versions" in line]
    assert "(then 2.0.0)" in line
    assert "(then 0.0.1)" in line


def test_an_option_that_is_gone_and_was_not_asked_for_is_left_out(stored, put, capsys):
    """As `animate` in runs of an earlier version; one that was asked for is refused (below)."""

    def older(answer):
        answer["provenance"]["command"]["question"]["animate"] = None

    asked = next(one for one in ASKED if one[0] == "simulate")
    assert again(capsys, put(changed(stored[asked], older)))["agreement"] == "bit for bit"


def _study(section: str, **keys):
    return lambda kept: kept["study"]["data"].setdefault(section, {}).update(keys)


def _ask(**question):
    return lambda kept: kept["command"].update(question=question)


HOSTILE = {
    "friction outside": (_study("ranking", friction="../../f.toml"), "names no file beside the study"),
    "a wrong study": (_study("cage", mass="-1 g"), "[cage] mass must be > 0"),
    "a library": (lambda kept: kept["study"]["files"].update({"library 1: a": "x"}), "not valid"),
    "no study": (lambda kept: kept.update(study=None), "does not keep its study"),
    "no origins": (lambda kept: kept["study"].pop("origins"), "is damaged"),
    "no files": (lambda kept: kept["study"].pop("files"), "is damaged"),
    "option": (_ask(out="x"), "is not an option"),
    "value": (_ask(run="1"), "not one of this option"),
    "range": (_ask(run=-1), "must lie between"),
    "kick": (_ask(kick="9**9**9 m/s"), "--kick"),
    "no provenance of use": (lambda kept: kept.clear(), "has no provenance"),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_answer_is_refused_in_one_line(stored, put, capsys, kind):
    """No file but the answer is read; nothing is written."""
    spoil, said = HOSTILE[kind]
    asked = next(one for one in ASKED if one[0] == "simulate")
    path = put(changed(stored[asked], lambda answer: spoil(answer["provenance"])))
    assert said in refused(capsys, "reproduce", path, "--quiet")


def test_a_kept_study_reaches_no_other_file(stored, put, capsys):
    """What the keys `extends` and `library` of a stranger's answer name is not opened."""

    def reach(answer):
        answer["provenance"]["study"]["data"] |= {"extends": "/etc/passwd", "library": ["../../secret"]}

    assert again(capsys, put(changed(stored[VARIANT], reach)))["agreement"] == "bit for bit"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{", "no valid JSON"),
        ('{"verb": NaN}', "no valid JSON"),
        ("[" * 100_000, "no valid JSON"),
        ("[]", "is not the document"),
        ('{"verb": "rank"}', "is not the document"),
        ('{"verb": "new", "study": {}}', "must be an answer of"),
        ('{"verb": "rank", "study": {}}', "lacks separatrix_version. Compute this answer again"),
    ],
)
def test_what_is_not_an_answer_is_refused(put, capsys, content, said):
    """One line says why."""
    put({})
    Path("answer.json").write_text(content)
    assert said in refused(capsys, "reproduce", "answer.json")


def test_what_holds_no_document_is_refused(put, capsys):
    """Nothing there, a folder without an answer, a page without answers."""
    put({})
    Path("page.html").write_text("<html></html>")
    for path in ("nothing.json", ".", "page.html"):
        assert path in refused(capsys, "reproduce", path)


def test_an_answer_has_the_texts_that_its_study_names(stored):
    """The merged study, and each file by the name that the study has for it; no path of a library."""
    kept = stored[VARIANT]["provenance"]["study"]
    assert kept["name"] == "variant"
    assert kept["data"]["title"] == "Base \u00b5"
    assert kept["data"]["stability"]["runs"] == 2
    assert set(kept["files"]) == {"library 1: mine.toml"}
    assert "/far/" not in json.dumps(kept)


def test_a_study_of_python_says_why_it_keeps_nothing():
    """Also one that was changed after it was read; another model goes into what it keeps."""
    study = read_study("cryogenic-turbopump")
    assert provenance_of(study, "bearing", {})["reason"] is None
    assert provenance_of(read_study("cryogenic-turbopump", "paper"), "rank", {})["reason"] is None
    other = replace(study, film=replace(study.film, race_friction=0.3))
    assert "changed in Python" in provenance_of(other, "bearing", {})["reason"]
    assert provenance_of(other, "bearing", {})["study"] is None
    bare = replace(study, content=None)
    assert "made in Python" in provenance_of(bare, "bearing", {})["reason"]
    assert bare == study


def test_an_answer_of_python_is_reproduced(put, capsys):
    """With the options of the call."""
    path = put({})
    cases = [{"film.thickness": h} for h in (1e-6, 5e-7)]
    answer = separatrix.sweep("cryogenic-turbopump", cases=cases, jobs=1)
    Path(path).write_text(json.dumps(answer.document()))
    assert again(capsys, path)["agreement"] == "bit for bit"


def test_files_too_large_are_not_kept(tmp_path, monkeypatch):
    """The answer says so."""
    (tmp_path / "study.toml").write_text("extends = 'cryogenic-turbopump'\nlibrary = 'mine.toml'\n")
    (tmp_path / "mine.toml").write_text(LIBRARY)
    monkeypatch.setattr(sources, "MOST_KEPT", 10)
    assert "larger than" in provenance_of(read_study(tmp_path / "study.toml"), "bearing", {})["reason"]
