"""The verb `sweep` and its function: cases, tables, refusals, threads, and what it must agree with."""

from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest
from commands import document, refused

from separatrix import InputError, Runner, moving_cage, read_study, solve
from separatrix.front import main
from separatrix.study.study import CageModel
from separatrix.verdict.judgement import judge, transmitted_force
from separatrix.verdict.swept_cases import MOST_CASES, sweep, worst_case

STUDY = read_study("momentum-wheel")
QUICK = replace(STUDY, stability=replace(STUDY.stability, runs=4, duration=0.01))
CASES = [
    {"bearing.contact_angle": angle, "cage.mass": mass} for angle in (0.25, 0.3) for mass in (0.003, 0.004)
]

pytestmark = pytest.mark.usefixtures("elsewhere")


def test_a_case_is_the_study_with_those_values():
    """The chain of each case to the last bit, in the order of the cases, for any number of threads."""
    found = sweep(STUDY, CASES)
    for case, one in zip(CASES, found.cases, strict=True):
        study = replace(
            STUDY,
            bearing=replace(STUDY.bearing, contact_angle=case["bearing.contact_angle"]),
            cage=replace(STUDY.cage, mass=case["cage.mass"]),
        )
        state = solve(study)
        assert one.restitution_factor == state.restitution.restitution_factor
        assert one.max_pressure_outer == state.bearing.outer.ellipse.max_pressure
        assert one.slope_inner == state.traction.inner.slope
        assert (one.verdict, one.reason) == (None, "")
    assert found == sweep(STUDY, CASES, runner=Runner(jobs=3))


def test_a_verdict_is_that_of_the_whole_ensemble():
    """With its evidence, as `judge` gives it."""
    study = replace(QUICK, cage=replace(QUICK.cage, model=CageModel.PAPER))
    (one,) = sweep(study, [{"ball_cage_friction": 0.3}], verdicts=True).cases
    found = solve(study)
    cage = moving_cage(found, 0.3)
    judged = judge(cage, Runner().whole_ensemble(cage, QUICK.stability), capacity=transmitted_force(found))
    assert (one.verdict, one.reason) == (judged.verdict.name, judged.reason)
    for name in ("probability_stable", "largest_offset", "drift_rate", "largest_contact_force", "runs"):
        assert getattr(one, name) == getattr(judged, name)


@pytest.mark.parametrize("model", list(CageModel))
def test_a_margin_is_a_safety_factor_in_the_full_model(model):
    """Critical friction over friction; in the paper's model the threshold less eta. Never both."""
    study = replace(QUICK, cage=replace(QUICK.cage, model=model))
    (one,) = sweep(study, [{"ball_cage_friction": 0.3}], margins=True).cases
    if model is CageModel.PAPER:
        assert one.margin == one.restitution_threshold - one.restitution_factor
        assert (one.safety_factor_low, one.is_below_margin) == (None, one.margin < 0.0)
        return
    assert one.margin is None
    assert one.safety_factor_low <= one.own_critical_friction / 0.3 == one.safety_factor
    assert one.is_below_margin is (one.own_critical_friction < 0.3)
    none = dict.fromkeys(("safety_factor", "safety_factor_low", "safety_factor_high"))
    land = replace(one, case=7, verdict="UNSTABLE", driven_by_land=True, **none)
    assert (land.is_below_margin, worst_case([one, land]).value) == (True, 0.0)


def test_a_refused_case_is_a_row_with_its_reason():
    """The others are answered; what was known before the refusal stays."""
    found = sweep(STUDY, [{"cage.mass": 0.0035, "bearing.ball_diameter": d} for d in (0.007144, 0.5)])
    assert found.cases[0].reason == ""
    assert found.cases[1].restitution_factor is None
    assert "ball_diameter" in found.cases[1].reason
    assert found.cases[1].values == (0.0035, 0.5)


def test_a_bearing_without_a_cage_can_be_swept():
    """Down to its traction."""
    bare = replace(STUDY, cage=None, ranking=None)
    (one,) = sweep(bare, [{"operation.axial_load": 50.0}]).cases
    assert one.slope_outer > 0.0
    assert (one.restitution_factor, one.reason) == (None, "")


@pytest.mark.parametrize(
    ("cases", "rule"),
    [
        ([], "must have between 1 and"),
        ([{"cage.mass": 0.01}] * (MOST_CASES + 1), "must have between 1 and"),
        ([{"kick": 0.5}], "kick is not a numeric input that a sweep can vary"),
        ([{"cage.colour": 0.5}], "cage.colour is not a numeric input"),
        ([{"cage.mass": 0.01}, {"cage.pocket_clearance": 0.01}], "Case 1 must give cage.mass"),
    ],
)
def test_what_is_no_list_of_cases_is_refused(cases, rule):
    """In the words of the mistake."""
    with pytest.raises(InputError, match=rule):
        sweep(STUDY, cases)


def test_every_value_goes_with_every_other(capsys):
    """Two axes of 2 and 3 values: six cases, the last axis first to change; the same in the workbook."""
    axes = ["--vary", "cage.mass=3..4g:2", "--vary", "film.thickness=0.5..1um:3"]
    found = document(capsys, "sweep", "momentum-wheel", *axes, "--out", "s")
    assert [case["cage.mass"] for case in found["cases"]] == [0.003] * 3 + [0.004] * 3
    assert [case["film.thickness"] for case in found["cases"]] == [5e-7, 7.5e-7, 1e-6] * 2
    assert found["parameters"][0] == {"name": "cage.mass", "unit": "kg"}
    sheet = openpyxl.load_workbook("s/sweep.xlsx")["cases"]
    factor = [cell.value for cell in sheet[1]].index("restitution factor") + 1
    assert sheet.cell(2, factor).value == found["cases"][0]["restitution_factor"]


def test_cases_of_a_table_have_their_units(capsys):
    """Text with a unit a cell; a byte order mark and blank lines are no matter."""
    Path("c.csv").write_text("\ufeffcage.mass,ball_cage_friction\n3 g,0.1\n\n0.004 kg,0.2\n")
    found = document(capsys, "sweep", "momentum-wheel", "--cases", "c.csv")["cases"]
    assert [(case["cage.mass"], case["ball_cage_friction"]) for case in found] == [(0.003, 0.1), (0.004, 0.2)]


WRONG = {
    "no unit": ("cage.mass\n10\n", "row 2, cage.mass needs a unit of mass"),
    "another unit": ("cage.mass\n10 mm\n", "row 2, cage.mass needs a unit of mass"),
    "not whole": ("cage.land_count\n1.5\n", "row 2, cage.land_count takes whole numbers"),
    "a cell too few": ("cage.mass,cage.land_count\n1 g\n", "row 2 must have 2 cells; got 1"),
    "no case": ("cage.mass\n", "needs a row of parameters and below it a row for each case"),
    "a name": ("cage.mas\n1 g\n", "row 1 names no parameter of a study"),
    "twice": ("cage.mass,cage.mass\n1 g,2 g\n", "row 1 must name each parameter once; got cage.mass"),
    "twice, short": ("cage.ball_cage_friction,ball_cage_friction\n.1,.2\n", "row 1 must name each"),
    "time twice": ("cage.mass,time_share,time_share\n1 g,1,2\n", "must name each parameter once"),
}


@pytest.mark.parametrize(("text", "said"), WRONG.values(), ids=WRONG)
def test_a_wrong_table_is_refused_with_its_row(text, said, capsys):
    """Status 2, one line with the place, nothing written."""
    Path("c.csv").write_text(text)
    assert said in refused(capsys, "sweep", "momentum-wheel", "--cases", "c.csv")


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("cage.mass,cage.land_count\n1,1.5\n", ["row 2", "row 2"]),
        ("cage.mas,cage.land_coun\n1 g,1\n", ["row 1 names", "row 1 names"]),
        ("cage.mass\n10\n3 g\n3 m\n", ["row 2", "row 4"]),
    ],
)
def test_every_mistake_of_a_table_has_its_line(text, places, capsys):
    """Cells of a row, names of the first, rows."""
    Path("c.csv").write_text(text)
    assert main(["sweep", "momentum-wheel", "--cases", "c.csv"]) == 2
    lines = capsys.readouterr().err.splitlines()
    starts = [f"separatrix: c.csv {place}" for place in places]
    assert all(line.startswith(start) for line, start in zip(lines, starts, strict=True))
