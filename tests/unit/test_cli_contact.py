"""The verb `contact` as a user runs it: files, answers, refusals; and the same from Python."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from commands import document, refused
from contact_inputs import CATTANEO, MATERIALS, case, end, fastsim, from_cattaneo_to_carter

import separatrix
from separatrix.cli import main
from separatrix.contact_file import solving
from separatrix.errors import ConvergenceError, InputError
from separatrix.figures import draw
from separatrix.present import load

VALID = """
title = "Ball in a groove"
[contact]
load = "300 N"
semi_axis_rolling = "0.15 mm"
semi_axis_lateral = "0.45 mm"
[body_1]
material = "440C"
[body_2]
elastic_modulus = "200 GPa"
poisson_ratio = 0.285
[[body_2.layers]]
thickness = "0.5 um"
shear_modulus = "3 GPa"
poisson_ratio = 0.38
[friction]
coefficient = 0.1
[motion]
longitudinal = [-0.001, 0, 0.001]
spin = "0.5 rad/m"
[grid]
columns = 12
rows = 16
[pressure]
own = false
"""


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Each test in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def write(*changes, name="ball.toml"):
    """Write the valid file with changes of its text, each of which must be there."""
    text = VALID
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    Path(name).write_text(text)
    return name


KEYS = [
    "case",
    "contact",
    "motion",
    "longitudinal_creep",
    "lateral_creep",
    "spin",
    "curvature",
    "longitudinal_shift",
    "lateral_shift",
    "turn",
    "distance",
    "load",
    "force",
    "lateral_force",
    "spin_moment",
    "stick_share",
    "dissipation",
    "max_pressure",
    "film_strain",
    "force_share",
    "lateral_force_share",
    "stick_cells",
    "slip_cells",
    "iterations",
    "residual",
    "reason",
]


def test_the_document_has_the_keys_that_scripts_rely_on(capsys):
    """One document in SI units, a row for each case; no file."""
    found = document(capsys, "contact", write())
    assert list(found) == [
        *("separatrix_version", "verb", "name", "title", "contacts", "slope", "cases", "warnings"),
    ]
    assert [list(row) for row in found["cases"]] == [KEYS] * 3
    assert (found["name"], found["title"]) == ("ball", "Ball in a groove")
    (setup,) = found["contacts"]
    assert setup["ellipse"]["semi_major"] == 0.45e-3
    assert setup["bodies"][1]["layers"][0]["solid"]["shear_modulus"] == 3e9
    first, middle, last = found["cases"]
    assert (first["spin"], first["longitudinal_creep"], first["reason"]) == (0.5, -0.001, None)
    assert first["force"] == pytest.approx(-last["force"], rel=1e-4)  # odd in the creep, to the solver's 1e-5
    assert first["force"] > 0.0 > last["force"]
    assert abs(middle["force"]) < 1e-4 * first["force"]
    assert middle["lateral_force"] > 0.0  # phi = -s < 0
    assert list(Path().iterdir()) == [Path("ball.toml")]


def test_text_files_and_figures(capsys):
    """A table with units and signs; a folder named after the file; the dataset draws the figures."""
    assert main(["contact", write()]) == 0
    out = capsys.readouterr().out
    for words in ("creep x", "1/mm", "N mm", "positive body 1 is the", "Figures and data are in ball/"):
        assert words in out
    names = {path.name for path in Path("ball").iterdir()}
    pictures = {f"contact-{kind}-case-{n}" for kind in ("tractions", "slip") for n in (1, 2, 3)} | {
        "contact-forces"
    }
    assert names == {
        *("contact.json", "contact.txt", "contact.nc"),
        *(f"{picture}.{kind}" for picture in pictures for kind in ("png", "svg")),
    }
    data = load("ball/contact.nc")
    assert data["traction"].dims == ("case", "direction", "row", "column")
    assert (data["along"].attrs["units"], data["traction"].attrs["units"]) == ("m", "Pa")
    assert {name for name, _ in draw("contact", data)} == pictures
    assert json.loads(Path("ball/contact.json").read_text())["cases"][0]["case"] == 1


def test_the_file_of_the_docs_is_valid():
    """What a reader copies from the how-to page is solved."""
    page = Path(__file__).parents[2] / "docs" / "how-to" / "contact.md"
    text = page.read_text(encoding="utf-8").partition("```toml\n")[2].partition("```")[0]
    Path("copied.toml").write_text(text)
    with pytest.warns(separatrix.ValidityWarning, match="compressed"):
        found = separatrix.solve_contact("copied.toml")
    assert [one.reason for one in found.cases] == [""] * 7


def test_help(capsys):
    """The options and the two kinds of file."""
    assert main(["contact", "--help"]) == 0
    out = capsys.readouterr().out
    for words in ("FILE", ".inp", "--json", "--out", "--quiet"):
        assert words in out


WRONG = {  # what changes in the file, what the line says
    "unknown key": (
        "columns =",
        "colums =",
        "line 22: [grid] colums is not a valid key of [grid]. Did you mean",
    ),
    "unknown section": ("[grid]", "[gird]", "[gird] is not a section of a contact file. Did you mean grid?"),
    "no load": ('load = "300 N"\n', "", "line 3: [contact] lacks: load."),
    "bare load": ('"300 N"', "300", 'line 4: [contact] load needs a unit of force; got 300. Write "300 N".'),
    "load of another kind": ('"300 N"', '"300 mm"', "[contact] load needs a unit of force"),
    "no force": ('"300 N"', '"0 N"', 'load must be above 0 and at most 1e+12 [N]; got "0 N".'),
    "nan": ('"300 N"', '"nan N"', "[contact] load must be a finite number with a unit"),
    "inf creep": (
        "[-0.001, 0, ",
        "[inf, 0, ",
        "[motion] longitudinal, item 1, must be a finite number; got inf.",
    ),
    "huge creep": ("[-0.001, 0, 0.001]", "1e9", "must lie from -1000 to 1000 [-]; got 1000000000.0."),
    "negative thickness": ('"0.5 um"', '"-0.5 um"', "[body_2] layers[1].thickness must be above 0"),
    "incompressible film": (
        "= 0.38",
        "= 0.495",
        "layers[1].poisson_ratio must lie from 0 to 0.49 [-]; got 0.495.",
    ),
    "two moduli": (
        '"3 GPa"',
        '"3 GPa"\nelastic_modulus = "8 GPa"',
        "layers[1] needs material, or poisson_ratio",
    ),
    "crushed film": ('"3 GPa"', '"0.1 GPa"', "[contact] load compresses a layer by more than itself; got "),
    "axis and radius": (
        "semi_axis_lateral",
        "radius_lateral",
        "[contact] needs semi_axis_rolling and semi_axis",
    ),
    "unknown material": ('"440C"', '"440D"', "440C"),
    "spin without its unit": (
        '"0.5 rad/m"',
        "0.5",
        "[motion] spin must be a number in 1/mm; got 0.5.",
    ),
    "huge spin": (
        '"0.5 rad/m"',
        '"1e9 rad/m"',
        "[motion] spin must make a creep of at most 1000 at the edge",
    ),
    "lists": ('"0.5 rad/m"', '["0.5 rad/m", "1 rad/m"]', "must have as many values in each list; got 2, 3."),
    "kind": (
        "[motion]",
        '[motion]\nkind = "slide"',
        '[motion] kind must be "rolling", "shift" or "transient"',
    ),
    "no distance": ("[motion]", '[motion]\nkind = "transient"', "[motion] lacks: distance."),
    "slope": (
        '"0.5 rad/m"',
        '["0 1/m", "1 1/m", "2 1/m"]\nslope = true',
        "slope needs one spin and one curvature",
    ),
    "coarse": ("columns = 12", "columns = 2", "[grid] columns must lie from 4 to 256 [-]; got 2."),
    "profile without values": (
        "coefficient = 0.1",
        'across = ["0 mm"]',
        "needs either coefficient, or across and",
    ),
    "friction": (
        "coefficient = 0.1",
        "coefficient = -0.1",
        "coefficient must lie from 0 to 100 [-]; got -0.1.",
    ),
    "pressure": ('"0.15 mm"', '"0.15 um"', "[contact] needs a pressure below the modulus of the pair"),
    "not TOML": ("[grid]", "[grid", "is not valid TOML"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_file_is_refused_in_a_line(name, capsys):
    """Place, rule, value and cure; exit status 2; nothing written."""
    old, new, said = WRONG[name]
    line = refused(capsys, "contact", write((old, new)))
    assert said in line
    assert line.startswith("separatrix: ball.toml")


def test_too_many_cells_are_refused_before_the_work(capsys):
    """500 cases of 256 x 256 cells would fill the memory."""
    creeps = f"longitudinal = {[0] * 500}"
    fine = ("columns = 12\nrows = 16", "columns = 256\nrows = 256")
    Path("ball.toml").write_text(VALID.replace(*fine).replace("longitudinal = [-0.001, 0, 0.001]", creeps))
    said = refused(capsys, "contact", "ball.toml")
    assert "ball: its 500 cases must have at most 5000000 cells together; got 32768000." in said


def test_rough_surfaces_and_the_pressure_under_tractions(capsys):
    """Roughness softens the contact; two ways move its pressure; each as from Python."""
    creep = ("longitudinal = [-0.001, 0, 0.001]", "longitudinal = 0.0002")
    layer = '[[body_2.layers]]\nthickness = "0.5 um"\nshear_modulus = "3 GPa"\npoisson_ratio = 0.38\n'
    plain = document(capsys, "contact", write(creep, (layer, "")))["cases"][0]
    rough = write(creep, (layer, ""), ("[grid]", '[film]\nroughness = "1 um"\n[grid]'))
    assert abs(document(capsys, "contact", rough)["cases"][0]["force"]) < 0.9 * abs(plain["force"])
    ways = [
        document(capsys, "contact", write(creep, ("own = false", f"own = true\ncoupled = true\n{more}")))
        for more in ("", "two_way = true")
    ]
    pressures = [one["cases"][0]["max_pressure"] for one in ways]
    assert pressures[0] != pressures[1]
    assert pressures[1] == pytest.approx(pressures[0], rel=0.02)  # of the order of beta mu
    one_way = write(("own = false", "own = true\ntwo_way = true"))
    said = refused(capsys, "contact", one_way)
    assert "two_way needs own = true, coupled = true and steady rolling" in said


def test_the_text_says_what_bounds_the_tractions(capsys):
    """Cohesion, strength and roughness beside the coefficient."""
    more = 'coefficient = 0.1\ncohesion = "5 MPa"\nshear_strength = "80 MPa"\n[film]\nroughness = "1 um"'
    assert main(["contact", write(("coefficient = 0.1", more)), "--out", "out"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Friction coefficient 0.1, and 5 MPa of cohesion, at most 80 MPa" in said
    assert "Rough surfaces compliance 1 um over the pressure" in said


def test_every_mistake_has_its_line(capsys):
    """Three mistakes, three lines."""
    path = write(
        ('"300 N"', "300"), ("columns = 12", "columns = 12.5"), ("coefficient = 0.1", "coefficient = -1")
    )
    assert main(["contact", path]) == 2
    assert capsys.readouterr().err.count("\n") == 3


FASTSIM = fastsim()
WRONG_INPUTS = {  # a file of CONTACT, what the line says
    "module": (" 1 MODULE\n", "line 1: case 1, MODULE must be 3, or 0 at the end; got 1."),
    "no end": (CATTANEO.removesuffix(" 0 MODULE\n"), "case 3, MODULE is missing: the file ends before it."),
    "digit": (
        FASTSIM.replace("203100", "233100"),
        "line 3: case 1, control digit B must be one of 0, 2; got 3.",
    ),
    "approach of a gap": (CATTANEO.replace("201120", "201020"), "N must be 1 with a gap on cells; got 0."),
    "stresses": (FASTSIM.replace("203100", "203101"), "control digit S must be 0; got 1. Stresses inside"),
    "friction law": (FASTSIM.replace("022020", "422020"), "control digit L must be one of 0, 1; got 4."),
    "simplified theory": (FASTSIM.replace("022020", "022320"), "control digit M must be one of 0, 4; got 3."),
    "kinetic friction": (FASTSIM.replace("0.3 0.3", "0.3 0.2"), "FKIN must equal FSTAT, 0.3 [-]; got 0.2."),
    "word": (FASTSIM.replace("82000. 0.", "heavy 0."), 'case 1, FN must be a number; got "heavy".'),
    "lifted": (FASTSIM.replace("82000. 0.", "-1. 0."), "FN must be > 0 [N]; got -1."),
    "direction": (FASTSIM.replace("0. 0.4 3", "90d 0.4 3"), "CHI must be 0 or 180d"),
    "centre of spin": (
        FASTSIM.replace("-0.000625 0.000625", "0 1e-4 2. 3."),
        'SPINXO must be 0 or left out; got "2."',
    ),
    "step": (
        from_cattaneo_to_carter(1).replace("0. 0.25 1000.", "0. 0.35 1000."),
        "DQ must be a whole number",
    ),
    "area": (FASTSIM.replace("\n-3\n", "\n-6\n"), "IPOTCN must be one of -3, -2, -1, 1, 2, 3, 4; got -6."),
    "nothing kept": (
        end(case("203100 102000 0100341", "1 0 0 0", "0 1 1", MATERIALS)),
        "L keeps what no case",
    ),
    "sliding": (CATTANEO.replace("-0.8750", "-1.0"), "case 2, FX must be below the force of sliding"),
    "empty": ("% nothing\n", "case 1, MODULE is missing"),
}


@pytest.mark.parametrize("name", WRONG_INPUTS)
def test_what_is_not_computed_of_contact_is_refused_in_a_line(name, capsys):
    """File, line, case and digit."""
    text, said = WRONG_INPUTS[name]
    Path("example.inp").write_text(text)
    assert said in refused(capsys, "contact", "example.inp")


def test_the_table_of_contacts_users(capsys):
    """Its names, units and counts."""
    Path("cattaneo.inp").write_text(CATTANEO)
    assert main(["contact", "cattaneo.inp", "--out", "out"]) == 0
    out = capsys.readouterr().out
    for words in ("FSTAT", "CKSI", "CETA", "CPHI", "-0.87500", " 45 ", " 132 "):
        assert words in out


def test_a_force_of_zero_between_equal_bodies_needs_no_creep(capsys):
    """Free rolling, also with both forces given; another force has the creep of its sign."""
    changes = ("203100", "203110"), ("82000. 0. -0.000625 0.000625", "82000. 0. 0. 0.")
    text = FASTSIM
    for old, new in changes:
        text = text.replace(old, new)
    both = text.replace("203110", "203120").replace("82000. 0. 0. 0.", "82000. 0.5 -0.5 0.")
    Path("free.inp").write_text(text)
    Path("both.inp").write_text(both)
    (free,) = document(capsys, "contact", "free.inp")["cases"]
    (pulled,) = document(capsys, "contact", "both.inp")["cases"]
    assert (free["longitudinal_creep"], free["reason"]) == (0.0, None)
    shares = [pulled["force_share"], pulled["lateral_force_share"]]
    assert shares == pytest.approx([0.5, -0.5], abs=1e-4)  # how far it is searched
    assert pulled["longitudinal_creep"] < 0.0 < pulled["lateral_creep"]


def test_a_case_that_does_not_converge_is_a_row_with_its_reason(monkeypatch, capsys):
    """No number, but residual and reason; a case that starts from it has none either."""
    usual, calls = solving.solve, []

    def fails_second(*given, **options):
        calls.append(given)
        if len(calls) == 2:
            raise ConvergenceError("Tractions did not settle.", 60, 0.02)
        return usual(*given, **options)

    monkeypatch.setattr(solving, "solve", fails_second)
    assert main(["contact", write()]) == 0
    assert "Case 2 has no solution: Tractions did not settle." in capsys.readouterr().out
    rows = json.loads(Path("ball/contact.json").read_text())["cases"]
    assert (rows[1]["force"], rows[1]["residual"], rows[1]["reason"]) == (
        None,
        0.02,
        "Tractions did not settle.",
    )
    assert [row["force"] is None for row in rows] == [False, True, False]


def test_from_python():
    """A batch without a file: broadcast creeps, arrays, a table, a figure; wrong creeps are refused."""
    steel = separatrix.Body(base=separatrix.solid(200e9, 0.285))
    problem = separatrix.ContactProblem(
        ellipse=separatrix.ellipse_of_axes(300.0, 0.15e-3, 0.45e-3, 200e9 / (1 - 0.285**2) / 2),
        bodies=(steel, steel),
        friction=separatrix.FrictionLaw(coefficient=0.1),
    )
    asked = separatrix.rolling_cases(problem, longitudinal=[1e-4, 2e-4], spin=1.0, columns=10, rows=10)
    found = separatrix.solve_contact(asked)
    data = found.to_xarray()
    area = float((data["along"][1] - data["along"][0]) * (data["across"][1] - data["across"][0]))
    total = data["traction"].sel(direction="along").sum(("row", "column")) * area
    np.testing.assert_allclose(total, data["force"], rtol=1e-12)  # rounding of a sum
    assert list(found.to_dataframe()["longitudinal_creep"]) == [1e-4, 2e-4]
    assert found.plot("contact-tractions-case-2").axes
    assert "force" in found.summary()
    with pytest.raises(InputError, match="broadcast"):
        separatrix.rolling_cases(problem, longitudinal=[1.0, 2.0], lateral=[1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="finite"):
        separatrix.rolling_cases(problem, spin=np.nan)


def test_the_slope_is_that_of_the_curve(capsys):
    """Without spin it is a tangent: of small creeps the chord, to its error and that of 12 columns."""
    path = write(('"0.5 rad/m"', '"0 1/m"\nslope = true'), ("[-0.001, 0, 0.001]", "[-1e-6, 0, 1e-6]"))
    found = document(capsys, "contact", path)
    force = found["cases"][0]["force"] / 300.0
    slope = found["slope"]
    assert slope["slope"] == pytest.approx(force / 1e-6, rel=0.3 / 12 + slope["slope_error"] / slope["slope"])
    assert (slope["free_rolling_offset"], slope["reason"]) == (0.0, None)


@pytest.mark.parametrize("kind", ["shift", "transient"])
def test_shift_and_transient(kind, capsys):
    """A shift in lengths; rolling from a start, each row further on."""
    motion = {
        "shift": 'kind = "shift"\nlongitudinal = ["0.1 um", "0.2 um"]\nspin = "0.1 mrad"',
        "transient": 'kind = "transient"\nlongitudinal = 0.001\ndistance = ["0.05 mm", "0.2 mm"]',
    }[kind]
    path = write((VALID[VALID.index("longitudinal") : VALID.index("[grid]")], f"{motion}\n"))
    first, second = document(capsys, "contact", path)["cases"]
    assert (first["motion"], first["reason"]) == (kind, None)
    assert second["force"] < first["force"] < 0.0
    if kind == "transient":  # in columns of 2 x 0.15 mm/12
        assert [first["distance"], second["distance"]] == pytest.approx([0.05e-3, 0.15e-3])
