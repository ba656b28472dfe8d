"""`reproduce`: stored answers are computed again from what they keep; a changed one is found."""

import base64
import contextlib
import hashlib
import io
import json
import os
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from commands import document, refused

import separatrix
from separatrix.cli import main
from separatrix.ground import input_files
from separatrix.study.reading import provenance, provenance_of, read_study
from separatrix.study.reading.templates import template_workbook
from separatrix.study.study import with_models

FEW = "[stability]\nruns = 2\nduration = '5 ms'\nkicks = ['0.5 m/s']\nrestitution_factors = [0.3]\n"
BASE = "extends = 'cryogenic-turbopump'\ntitle = 'Base \u00b5'\n"
FRICTION = """[[test]]
material = "PTFE"
counterface = "440C"
medium = "gas"
friction = 0.12
"""

CASES = "film.thickness\n1 um\n0.5 um\n"
STUDIES = (
    "ball-218",
    "cryogenic-turbopump",
    "le7",
    "lox-turbopump-radial",
    "lox-turbopump",
    "momentum-wheel",
)
ASKED = [
    *(("check", name) for name in STUDIES),
    *(("bearing", name) for name in STUDIES),
    ("restitution", "cryogenic-turbopump"),
    ("restitution", "sub/variant.toml"),
    ("check", "sub/variant.toml"),
    ("check", "book.xlsx"),
    ("bearing", "worn.toml"),
    ("check", "tested.toml"),
    ("simulate", "sub/variant.toml", "--kick", "0.3 m/s", "--run", "3", "--ball", "traction"),
    ("stability", "sub/variant.toml"),
    ("sweep", "sub/variant.toml", "--vary", "film.thickness=0.5..1um:2"),
    ("sweep", "sub/variant.toml", "--cases", "cases.csv"),
    ("rank", "sub/variant.toml"),
    ("map", "sub/variant.toml", "--points", "2", "--runs", "2"),
]


def home(folder: Path) -> Path:
    """Write studies that take what they need from other files, above them, elsewhere, and of other kinds."""
    own, far = folder / "own", folder / "far" / "shared"
    (own / "sub").mkdir(parents=True)
    far.mkdir(parents=True)
    library = Path(separatrix.__file__).parent / "study/library/data/cage_materials.toml"
    text = library.read_text(encoding="utf-8").replace("Armalon", "Compound X")
    rest = text.partition('[cage_material."Compound X"]')[2]
    (far / "mine.toml").write_text(f'[cage_material."Compound X"]{rest.partition("[cage_material.")[0]}')
    (own / "base.toml").write_bytes((BASE + FEW).replace("\n", "\r\n").encode())
    (own / "sub" / "variant.toml").write_text(f"extends = '../base.toml'\nlibrary = '{far / 'mine.toml'}'\n")
    (own / "worn.toml").write_text(
        "extends = 'cryogenic-turbopump'\n[film]\nwear = { friction = 0.4, profile = 'worn.csv' }\n"
    )
    (own / "worn.csv").write_text("y [mm],thickness [um]\n-0.5,1\n0,0.2\n0.5,1\n")
    (own / "book.xlsx").write_bytes(template_workbook())
    (own / "tested.toml").write_text(
        "extends = 'cryogenic-turbopump'\n[ranking]\nfriction = 'friction.toml'\n"
    )
    (own / "friction.toml").write_text(FRICTION)
    (own / "cases.csv").write_text(CASES)
    return own


def told(*arguments: str) -> str:
    """Return what a command prints."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        assert main([*arguments, "--quiet"]) == 0
    return out.getvalue()


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """Answers by what was asked; the files that they were made from are gone."""
    folder = tmp_path_factory.mktemp("made")
    before = Path.cwd()
    os.chdir(home(folder))
    try:
        answers = {asked: json.loads(told(*asked, "--json", "--jobs", "2")) for asked in ASKED}
    finally:
        os.chdir(before)
    shutil.rmtree(folder / "own")
    shutil.rmtree(folder / "far")
    return answers


@pytest.fixture
def put(tmp_path, monkeypatch):
    """Return what writes an answer into an empty folder."""
    monkeypatch.chdir(tmp_path)

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
    assert (found["same"], found["result"]["agreement"]) == (True, "bit for bit"), found
    assert (found["versions"], found["changed_files"]) == ([], [])


VARIANT = ("restitution", "sub/variant.toml")


def changed(answer: dict, change) -> dict:
    """Return a copy of an answer that was changed."""
    copy = json.loads(json.dumps(answer))
    change(copy)
    return copy


def test_a_changed_number_is_found(stored, put, capsys):
    """The key, what the answer says, and what is computed; a hair is rounding."""

    def wrong(answer):
        answer["inner"]["load"] *= 1.001

    def hair(answer):
        answer["inner"]["load"] *= 1.0 + 1e-13

    was = stored[VARIANT]["inner"]["load"]
    found = again(capsys, put(changed(stored[VARIANT], wrong)))
    assert (found["same"], found["result"]["count"]) == (False, 1)
    (one,) = found["result"]["differences"]
    assert (one["key"], one["stored"], one["computed"]) == ("inner.load", was * 1.001, was)
    assert one["relative"] == pytest.approx(1e-3, rel=1e-2)
    found = again(capsys, put(changed(stored[VARIANT], hair)))
    assert (found["same"], found["result"]["agreement"]) == (True, "to rounding")
    assert found["result"]["largest_at"] == "inner.load"
    assert main(["reproduce", put(changed(stored[VARIANT], wrong)), "--quiet"]) == 0
    assert "restitution variant: different: 1 value differs." in capsys.readouterr().out


def test_a_changed_study_is_found(stored, put, capsys):
    """By its checksum; with a checksum that fits, by what it is computed to."""

    def edit(answer, *, hide):
        file = answer["provenance"]["files"]["base.toml"]
        file["text"] = file["text"].replace("5 ms", "6 ms") + "\r\n[operation]\r\naxial_load = '2 kN'\r\n"
        if hide:
            file["sha256"] = hashlib.sha256(file["text"].encode()).hexdigest()

    found = again(capsys, put(changed(stored[VARIANT], lambda one: edit(one, hide=False))))
    assert (found["same"], found["changed_files"]) == (False, ["base.toml"])
    found = again(capsys, put(changed(stored[VARIANT], lambda one: edit(one, hide=True))))
    assert (found["same"], found["changed_files"]) == (False, [])
    assert found["result"]["differences"][0]["key"].startswith("study.")


def test_another_version_is_named_and_computed_all_the_same(stored, put, capsys):
    """One line has what differs."""

    def older(answer):
        answer["provenance"]["versions"]["numpy"] = "2.0.0"
        answer["separatrix_version"] = "0.0.1"

    assert main(["reproduce", put(changed(stored[VARIANT], older)), "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "the same, bit for bit" in out
    (line,) = [line for line in out.splitlines() if "Other versions" in line]
    assert "(then 2.0.0)" in line
    assert "(then 0.0.1)" in line


def test_a_report_has_its_answers_in_it(stored, put, capsys):
    """Each of them is computed again."""
    answers = {asked[0]: stored[asked] for asked in (ASKED[0], ASKED[6])}
    text = json.dumps(answers).replace("</", r"<\/")
    page = f'<html><script type="application/json" id="separatrix-answers">{text}</script></html>'
    put({})
    Path("report.html").write_text(page, encoding="utf-8")
    found = document(capsys, "reproduce", "report.html", "--quiet")
    assert (found["same"], [one["verb"] for one in found["answers"]]) == (True, ["check", "bearing"])


def _file(name: str, text: str = "x"):
    content = {"text": text, "sha256": hashlib.sha256(text.encode()).hexdigest()}
    return lambda kept: kept["files"].__setitem__(name, content)


def _entry(text: str):
    return _file("sub/variant.toml", text)


def _link(kept):
    kept["links"] = dict.fromkeys(kept["links"], "../../elsewhere")


def _bomb(kept):
    kept["files"]["big"] = {"base64": base64.b64encode(bytes(2000)).decode(), "sha256": "0"}


HOSTILE = {
    "climbs": (_file("../outside.toml"), "must be a relative name"),
    "climbs inside": (_file("a/../../outside.toml"), "must be a relative name"),
    "absolute": (_file("/outside.toml"), "must be a relative name"),
    "drive": (_file("C:/outside.toml"), "must be a relative name"),
    "backslash": (_file("..\\outside.toml"), "must be a relative name"),
    "newline": (_file("a\nb"), "must be a relative name"),
    "file in a file": (_file("base.toml/x"), "cannot be restored"),
    "no content": (lambda kept: kept["files"].__setitem__("a", {"sha256": "0"}), "without content"),
    "large": (_bomb, "must be at most"),
    "base outside": (_entry("extends = '../../../secret.toml'"), "does not keep"),
    "absolute base": (_entry("extends = '/etc/passwd'"), "does not keep"),
    "library outside": (_entry("extends = '../base.toml'\nlibrary = '../../secret'"), "does not keep"),
    "friction outside": (
        _entry("extends = '../base.toml'\n[ranking]\nfriction = '../../f.toml'"),
        "not keep",
    ),
    "profile outside": (
        _entry("extends = '../base.toml'\n[film]\nwear = { friction = 0.4, profile = '/etc/passwd' }"),
        "does not keep",
    ),
    "link": (_link, "must be a relative name"),
    "entry": (lambda kept: kept.update(entry="../x.toml"), "does not keep its study"),
    "shipped": (lambda kept: kept.update(entry="shipped:../x.toml"), "does not ship"),
    "another verb": (lambda kept: kept["command"].update(verb="rank"), "another verb"),
    "option": (lambda kept: kept["command"].update(question={"out": "x"}), "is not an option"),
    "value": (lambda kept: kept["command"].update(question={"run": "1"}), "not one of this option"),
    "range": (lambda kept: kept["command"].update(question={"run": -1}), "must lie between"),
    "kick": (lambda kept: kept["command"].update(question={"kick": "9**9**9 m/s"}), "--kick"),
    "models": (lambda kept: kept["command"].update(models={"motion": "hover"}), "--motion"),
    "no provenance of use": (lambda kept: kept.clear(), "does not keep the files"),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_answer_is_refused_in_one_line(stored, put, capsys, kind, monkeypatch):
    """Nothing is read or written outside a temporary folder."""
    monkeypatch.setattr(input_files, "MOST_BYTES", 100_000 if kind != "large" else 2000)
    spoil, said = HOSTILE[kind]
    asked = next(one for one in ASKED if one[0] == "simulate")
    path = put(changed(stored[asked], lambda answer: spoil(answer["provenance"])))
    assert said in refused(capsys, "reproduce", path, "--quiet")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{", "no valid JSON"),
        ('{"verb": NaN}', "no valid JSON"),
        ("[" * 100_000, "no valid JSON"),
        ("[]", "is not the document"),
        ('{"verb": "rank"}', "is not the document"),
        ('{"verb": "new", "study": {}}', "must be an answer of"),
        ('{"verb": "rank", "study": {}}', "has no provenance"),
        ('{"verb": "rank", "study": {}, "provenance": {"entry": "a"}}', "lacks command"),
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


def test_no_absolute_path_is_in_the_names(stored):
    """Files above the study and elsewhere have relative names; what they say is theirs, byte for byte."""
    kept = stored[VARIANT]["provenance"]
    own = {name: one for name, one in kept["files"].items() if "text" in one}
    assert set(own) == {"sub/variant.toml", "base.toml", "elsewhere-1/mine.toml"}
    assert (kept["entry"], *kept["links"].values()) == ("sub/variant.toml", "elsewhere-1/mine.toml")
    assert own["base.toml"]["text"] == (BASE + FEW).replace("\n", "\r\n")
    for one in own.values():
        del one["text"]
    assert "/far/" not in json.dumps(kept)


def test_a_study_of_python_says_why_it_keeps_nothing(tmp_path):
    """Also one that was changed after it was read; models are an option, not a change."""
    study = read_study("cryogenic-turbopump")
    assert provenance_of(study, "bearing")["reason"] is None
    in_space = with_models(study, {"ball": "traction"})
    assert provenance_of(in_space, "rank")["command"]["models"] == {"ball": "traction"}
    assert provenance_of(in_space, "rank")["reason"] is None
    other = replace(study, film=replace(study.film, race_friction=0.3))
    assert "changed in Python" in provenance_of(other, "bearing")["reason"]
    assert provenance_of(other, "bearing")["files"] == {}
    bare = replace(study, records={})
    assert "made in Python" in provenance_of(bare, "bearing")["reason"]
    assert bare == study


def test_an_answer_of_python_is_reproduced(put, capsys):
    """With the options of the call; the arrays have the same provenance."""
    path = put({})
    answer = separatrix.sweep(
        "cryogenic-turbopump", cases=[{"film.thickness": 1e-6}, {"film.thickness": 5e-7}], jobs=1
    )
    Path(path).write_text(json.dumps(answer.document()))
    assert again(capsys, path)["same"] is True
    kept = json.loads(answer.to_xarray().attrs["provenance"])
    assert kept == answer.document()["provenance"]


def test_files_too_large_or_too_far_apart_are_not_kept(tmp_path, monkeypatch):
    """The answer says so."""
    (tmp_path / "study.toml").write_text(BASE)
    monkeypatch.setattr(provenance, "MOST_BYTES", 10)
    assert "larger than" in provenance_of(read_study(tmp_path / "study.toml"), "bearing")["reason"]
    monkeypatch.undo()
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    (tmp_path / "link").symlink_to(folder)
    (tmp_path / "a" / "base.toml").write_text(BASE)
    (tmp_path / "study.toml").write_text("extends = 'link/../base.toml'\n")
    assert "no folder in common" in provenance_of(read_study(tmp_path / "study.toml"), "bearing")["reason"]
