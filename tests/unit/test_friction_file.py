"""Friction files written, read back and refused, and studies that rank by them."""

import json

import pytest
from commands import changed, document, read_friction, refusal, refusal_line, rows_of, written

from separatrix import Operation, read_study, resolved, solve
from separatrix.chain.pocket_friction import PocketConditions, friction_in_pocket
from separatrix.friction.friction_fit import TestedFriction
from separatrix.front import main

GOOD = """\
[[test]]
material = "Armalon"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.08
"""
SMALL = f"""{GOOD}
[[test]]
material = "My compound"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.2
slip_speed = ["1 m/s", "5 m/s"]
temperature = "77 K"
sample = "s1"
"""
POCKET = PocketConditions(
    slip_speed=21.0, slip_speed_low=21.0, slip_speed_high=21.0, impact_force=80.0, pressure=1.5e8,
    max_pressure=2.25e8, contact_radius=4e-4,
)  # fmt: skip
TURNING = Operation(inner_speed=100.0, axial_load=10.0, temperature=77.0, fluid="liquid nitrogen")


def study(folder, text=SMALL, ranking=""):
    """A study beside a friction file."""
    written(folder, text, "friction.toml")
    return written(
        folder, f'extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n{ranking}\n'
    )


def test_a_study_ranks_the_materials_of_a_friction_file(tmp_path):
    """Environments and candidates in their order; a material of the library has its elastic record."""
    asked = read_study(study(tmp_path)).ranking
    assert asked.environments == ("liquid nitrogen, 440C",)
    assert [c.name for c in asked.candidates] == ["Armalon", "My compound"]
    assert asked.candidates[0].material.name == "Armalon"
    assert asked.candidates[1].material is None
    friction = asked.candidates[1].friction["liquid nitrogen, 440C"]
    assert friction.mean == pytest.approx(0.2, rel=1e-12)  # rounding of exp and log
    assert isinstance(friction.law, TestedFriction)
    assert "friction.toml, sha256" in friction.source


def test_a_study_may_rank_some_materials_and_assume_another_scatter(tmp_path):
    """The keys materials and friction_scatter hold for a file as for a table."""
    path = study(tmp_path, ranking='materials = ["My compound"]\nfriction_scatter = 0.2')
    asked = read_study(path)
    seen = solve(asked, asked.ranking.candidates[0]).frictions["liquid nitrogen, 440C"]
    assert seen.standard_error == pytest.approx(0.04, rel=1e-9)
    assert seen.assumed_scatter


def test_a_study_takes_the_tests_at_its_temperature_and_says_how_many_it_leaves_out(tmp_path):
    """A test at 77 K and one at 295 K: mean, count and source are those of the cold one."""
    cold = SMALL.replace("friction = 0.08", 'friction = 0.08\ntemperature = "77 K"')
    warm = SMALL.split("[[test]]")[1].replace("0.08", '0.3\ntemperature = "295 K"')
    (candidate, _) = read_study(study(tmp_path, f"{cold}\n[[test]]{warm}")).ranking.candidates
    friction = candidate.friction["liquid nitrogen, 440C"]
    assert friction.mean == pytest.approx(0.08, rel=1e-12)  # rounding of exp and log
    assert friction.count == 1
    assert "1 of 2 tests, at other temperatures, left out" in friction.source


# Not tested as the pocket rubs.
@pytest.mark.parametrize("verb", [["stability"], ["simulate"], ["rank"], ["sensitivity", "--samples", "64"]])
def test_every_verb_has_the_same_friction_of_the_first_candidate(elsewhere, tmp_path, capsys, verb):
    """Tests at 1 and 5 m/s: that at 5, not their mean, in the cage that stands in its answer."""
    first, second = (f'0.08\nslip_speed = "{v} m/s"' for v in (1, 5))
    one = SMALL.split("[[test]]")[1]
    text = f"[[test]]{one.replace('0.08', first)}" + 2 * f"[[test]]{one.replace('0.08', second)}".replace(
        "0.08", "0.12"
    )
    few = '[stability]\nkicks = ["0.5 m/s"]\nruns = 2\nduration = "10 ms"\nrestitution_factors = [0.5]'
    path = study(tmp_path, text, few)
    answer = document(capsys, verb[0], str(path), *verb[1:], "--jobs", "1")
    cage, notes = answer["cage"], " ".join(answer["warnings"])
    if verb[0] in ("stability", "simulate"):
        assert "0.12 of Armalon in liquid nitrogen, 440C, extrapolated" in notes
    assert cage["ball_cage_friction"] == pytest.approx(0.12, rel=1e-6)  # the two at 5 m/s weigh alike


def test_the_cage_asks_for_what_its_pocket_rubs():
    """A table of 1 to 5 m/s at 77 K, a pocket at 21 m/s in the other medium: the mean stays, words say so."""
    table = read_study("cryogenic-turbopump").ranking.candidates[2]
    seen = friction_in_pocket(table.friction["gaseous nitrogen, 440C"], POCKET, TURNING, 0.09)
    assert (seen.mean, seen.standard_error) == (0.07, pytest.approx(0.0063))
    assert seen.standard_deviation == seen.standard_error  # stated without its tests: no number is added
    assert seen.extrapolation == (
        "slip speed in the pocket 21 m/s, tests cover 1 to 5 m/s: value at 5 m/s used",
        "test pressure unknown (pocket: 150 MPa)",
        "tested in gaseous nitrogen, not in liquid nitrogen",
    )


def test_the_shipped_study_rubs_at_25_metres_a_second():
    """The pocket of the shipped study: regression, 25.1 m/s and 157 MPa in an impact of the middle kick."""
    solution = solve(read_study("cryogenic-turbopump"))
    found = solution.pocket
    # 67.4 N: of half the mass of the ring, which is what an impact feels; the whole mass would press with 84
    # N.
    assert solution.felt_mass == pytest.approx(
        0.5 * solution.inertia.mass, rel=1e-12
    )  # a thin ring; rounding
    # regressions to the digits of the numbers
    assert found.slip_speed == pytest.approx(25.124, rel=1e-4)
    assert found.pressure == pytest.approx(157.289e6, rel=1e-4)
    assert found.impact_force == pytest.approx(67.409, rel=1e-4)
    assert found.max_pressure == pytest.approx(1.5 * found.pressure)


def test_a_result_holds_every_test_behind_a_friction(tmp_path):
    """Whole, in SI, as the file may change; also of materials not ranked, as scatter is pooled over them."""
    found = resolved(read_study(study(tmp_path)))["ranking"]
    (test,) = found["candidates"][1]["friction"]["liquid nitrogen, 440C"]["tests"]
    assert (test["friction"], test["slip_speed"], test["sample"]) == (0.2, [1.0, 5.0], "s1")
    assert found["friction_scatter"]["value"] == 0.09
    assert found["other_tests"] == []
    json.dumps(found, allow_nan=False)
    found = resolved(read_study(study(tmp_path, ranking='materials = ["My compound"]')))["ranking"]
    assert [test["material"] for test in found["other_tests"]] == ["Armalon"]


def test_check_names_tests_that_sensitivity_refuses(tmp_path, capsys):
    """A mean that is known to ten times itself: the same line from both, and nothing of tests that tell."""
    for friction in ("0.001\nstandard_error = 0.5", "0.08"):
        path = study(tmp_path, SMALL.replace("0.08", friction, 1))
        refused = document(capsys, "check", str(path))["refusals"]
        if friction == "0.08":
            assert refused == []
            continue
        assert main(["sensitivity", str(path), "--json", "--samples", "64"]) == 2
        line = capsys.readouterr().err.removeprefix("separatrix: ").rstrip()
        assert line.startswith("Friction from tests of Armalon in liquid nitrogen, 440C must not scatter")
        assert {"verb": "sensitivity", "sentence": line} in refused


WRONG_FILES = r"""
^title = "mine" :: friction.toml lacks: test. Write [[test]]
nitrogen => nitrogen, wet :: line 4: [[test]] medium must not hold a comma; got "liquid nitrogen, wet"
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "a.csv"
    :: line 13: [[test]] checksum is that of test 1 once more. Each log counts once; remove one
+checksum = "a"\nsource = "a.csv"\nGOODchecksum = "a"\nsource = "b.csv"
    :: line 13: [[test]] checksum is that of test 1 once more
+\n[[test]]\nmaterial = "armalon"\ncounterface = "440C"\nmedium = "liquid  nitrogen"\nfriction = 1
    :: line 8: [[test]] material differs from that of test 1 only in capitals or spaces; got "armalon"
    :: line 10: [[test]] medium differs from that of test 1 only in capitals or spaces
"""
"""A change of a good file, one added (+) or the file itself (^); place and rule of each mistake."""


@pytest.mark.parametrize(("change", "lines"), rows_of(WRONG_FILES))
def test_a_wrong_friction_file_is_refused_a_line_a_mistake(tmp_path, change, lines):
    """The line names the file, the rule and the value; a study that names the file passes it on."""
    named = written(tmp_path, 'extends = "cryogenic-turbopump"\n[ranking]\nfriction = "friction.toml"\n')
    text = changed("" if change[0] == "^" else GOOD, change.replace("GOOD", GOOD))
    wrong = written(tmp_path, text, "friction.toml")
    for found in (refusal(wrong, read_friction), refusal(named)):
        found = [line.replace("friction.toml, ", "", 1) for line in found.splitlines()]
        assert [line[: len(one)] for line, one in zip(found, lines, strict=True)] == lines


OF_THE_FILE = 'friction = "friction.toml"\n'
WRONG_STUDIES = {
    'friction = "other.toml"': ("[ranking] friction names no file", "other.toml"),
    'friction = "folder.toml"': ("names no file beside the study",),
    'friction = "pin-on-disk-77"': ("[ranking] friction is not a friction table", "separatrix tribometer"),
    OF_THE_FILE + 'materials = ["Armalom"]': ("that friction.toml lacks", "Did you mean Armalon?"),
    OF_THE_FILE + "friction_scatter = 9": ("must lie between 0.001 and 1", "got 9", "0.09 is 9 %"),
}


@pytest.mark.parametrize("ranking", WRONG_STUDIES)
def test_a_study_that_asks_wrongly_for_friction_is_refused_in_one_line(tmp_path, ranking):
    """The line names the study and its key."""
    (tmp_path / "folder.toml").mkdir()
    written(tmp_path, GOOD, "friction.toml")
    line = refusal_line(written(tmp_path, f'extends = "cryogenic-turbopump"\n[ranking]\n{ranking}\n'))
    assert line.startswith("study.toml")
    assert [word for word in WRONG_STUDIES[ranking] if word not in line] == [], line
