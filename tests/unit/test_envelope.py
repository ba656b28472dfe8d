"""The operating envelope of a sweep: duty cycles, orders, the worst case and its picture."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from cages import threshold_points
from commands import document, refused

import separatrix
from separatrix import present
from separatrix.cage import moving_cage
from separatrix.chain.solution import solve
from separatrix.figures import draw
from separatrix.figures.envelope import envelope_plots, has_envelope, sweep_plots
from separatrix.front import main
from separatrix.ground.errors import InputError
from separatrix.reporting.pictures import picture
from separatrix.reporting.record import Kept
from separatrix.study.reading import read_study
from separatrix.study.study import ClearanceState
from separatrix.verbs.shapes import to_xarray
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.stability_curve import COARSE, own_threshold, restitution_threshold
from separatrix.verdict.swept_cases import duty, orders, sweep, time_shares, worst_case

STUDY = read_study("momentum-wheel")
QUICK = replace(STUDY, stability=replace(STUDY.stability, runs=4, duration=0.004))
SPEED, FRICTION = "operation.inner_speed", "ball_cage_friction"
SMALL = 'extends = "momentum-wheel"\n[stability]\nkicks = ["0.4 m/s"]\nruns = 4\nduration = "4 ms"\n'
ROWS = "0 rpm,0.1,1 h\n3000 rpm,0.1,2 h\n6000 rpm,1.5,30 min\n9000 rpm,0.1,30 min\n"
DUTY = f"{SPEED},{FRICTION},time_share\n{ROWS}"


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """An empty folder."""
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(SMALL)
    Path("duty.csv").write_text(DUTY)


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    """Folder and text of a duty cycle from the command line, with margins and verdicts."""
    folder = tmp_path_factory.mktemp("duty")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        Path("small.toml").write_text(SMALL)
        Path("duty.csv").write_text(DUTY)
        asked = ["--cases", "duty.csv", "--margins", "--verdicts", "--out", "o"]
        assert main(["sweep", "small.toml", *asked, "--quiet"]) == 0
    return folder / "o"


def case(**known):
    """A swept case with some of its numbers."""
    none = dict.fromkeys(("time_share", "restitution_factor", "margin", "probability_stable", "verdict"))
    return SimpleNamespace(**none | known)


def test_a_duty_cycle_names_its_worst_case_and_its_time(answered):
    """By the lowest margin; text and dataset say the same, and the picture is drawn."""
    data, text = separatrix.load(answered / "sweep.json"), (answered / "sweep.txt").read_text()
    margin = data["margin"].values
    assert int(data["worst_case"]) == 2
    assert float(data["worst_value"]) == margin[2] == min(margin[1:])
    assert data["time_share"].values == pytest.approx([0.25, 0.5, 0.125, 0.125], rel=1e-12)
    assert float(data["duty_below_margin"]) == pytest.approx(0.125, rel=1e-12)
    assert float(data["duty_refused"]) == pytest.approx(0.25, rel=1e-12)
    below = data["restitution_threshold"].values - data["restitution_factor"].values
    assert margin == pytest.approx(below, nan_ok=True)
    assert "2: operation.inner_speed 6000 rpm, ball_cage_friction 1.5" in text
    assert "12.5 % with a margin below 0" in text
    assert {"envelope.png", "envelope.svg", "sweep.png"} <= {path.name for path in answered.iterdir()}
    figure = dict(draw("sweep", data))["envelope"]
    assert "case 2: lowest margin" in figure.axes[0].get_title(loc="left")
    assert [axes.get_ylabel() for axes in figure.axes][1:] == ["P(stable) [-]", "frequency [Hz]", "time [%]"]


def test_every_panel_of_the_envelope_has_its_points_to_point_at(answered):
    """Panels, axes and values are those of the figure; a case has its number, its values and its margin."""
    data = separatrix.load(answered / "sweep.json")
    plots, figure = envelope_plots(data), dict(draw("sweep", data))["envelope"]
    assert [one.y_label for one in plots] == [axes.get_ylabel() for axes in figure.axes]
    threshold = next(one for one in plots[0].series if one.name.startswith("threshold"))
    assert threshold.y == pytest.approx(data["restitution_threshold"].values[1:])
    assert threshold.text[1].startswith("case 2, inner speed 6000 rpm, ball cage friction 1.5: threshold")
    assert threshold.text[1].endswith(f"margin {float(data['margin'][2]):+.3f}")
    assert plots[0].title.startswith("Worst case (dashed line): case 2: lowest margin")
    assert [one.x for one in plots[0].series if one.kind == "upright"] == [(2.0,)]
    assert plots[3].series[0].y == pytest.approx([25.0, 50.0, 12.5, 12.5])


def test_the_report_marks_the_cases_in_its_picture(answered):
    """A mark lies where the picture has its point: higher values higher, and all inside."""
    (found,) = picture(Kept(json.loads((answered / "sweep.json").read_text())), "envelope", "", "")
    marks = [one for one in found.hover if "% of the time" in one.text]
    assert [one.text.partition(",")[0] for one in marks] == [f"case {number}" for number in range(4)]
    assert marks[1].y < marks[0].y < marks[2].y == marks[3].y
    assert all(0 < one.x < found.width and 0 < one.y < found.height for one in found.hover)
    assert len({one.text for one in found.hover}) > 15


def test_start_up_from_zero_is_a_row_with_its_reason(answered):
    """At rest nothing rolls; the cases after it are answered."""
    reason = separatrix.load(answered / "sweep.json")["reason"].values.astype(str)
    assert "must differ from outer_speed" in reason[0]
    assert not any("refused" in one for one in reason[1:])


def test_shares_are_any_unit_and_sum_to_one():
    """Hours, seconds or shares."""
    assert time_shares([{"time_share": 3.0}, {"time_share": 1.0}]) == [0.75, 0.25]
    assert time_shares([{"cage.mass": 3.0}]) == []
    found = sweep(STUDY, [{SPEED: 300.0, "time_share": 2.0}, {SPEED: 400.0, "time_share": 6.0}])
    assert [one.time_share for one in found.cases] == [0.25, 0.75]
    assert found.parameters[0].name == SPEED
    assert len(found.parameters) == 1
    assert (found.duty.below_margin, found.duty.stable, found.duty.refused) == (None, None, 0.0)
    for wrong in (-1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="Case 1, time_share must be a finite share or time >= 0"):
            time_shares([{"time_share": 3.0}, {"time_share": wrong}])


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ((f"{SPEED},time_share", "100 rpm,-1", "200 rpm,2"), "row 2, time_share must be >= 0"),
        ((f"{SPEED},time_share", "100 rpm,-1 h", "200 rpm,2 h"), "row 2, time_share must be >= 0"),
        ((f"{SPEED},time_share", "100 rpm,0", "200 rpm,0"), "time_share must be above 0 in some case"),
        ((f"{SPEED},time_share", "100 rpm,1", "200 rpm,2 h"), "must be shares, or times with their unit"),
        ((f"{SPEED},time_share", "100 rpm,1 kg", "200 rpm,2 h"), "row 2, time_share needs a unit of time"),
        (("time_share", "1", "2"), "needs a parameter beside time_share"),
    ],
)
@pytest.mark.usefixtures("elsewhere")
def test_wrong_shares_are_refused_in_one_line(rows, said, capsys):
    """Status 2, nothing written."""
    Path("c.csv").write_text("\n".join(rows))
    assert said in refused(capsys, "sweep", "momentum-wheel", "--cases", "c.csv")


def test_what_decides_the_worst_case():
    """Margin before P(stable) before the restitution factor; those that are alike are counted."""
    assert worst_case([case(case=0)]) is None
    plain = [case(case=i, restitution_factor=eta) for i, eta in enumerate((0.2, 0.8, 0.8, None))]
    found = worst_case(plain)
    assert (found.case, found.quantity, found.value, found.compared, found.alike) == (
        *(1, "restitution_factor", 0.8),
        *(3, 2),
    )
    run = [case(case=i, restitution_factor=0.5, probability_stable=p) for i, p in enumerate((0.9, 0.1))]
    assert (worst_case(run).case, worst_case(run).quantity) == (1, "probability_stable")
    margins = [case(case=i, probability_stable=0.5, margin=m) for i, m in enumerate((-0.1, 0.1))]
    assert (worst_case(margins).case, worst_case(margins).value) == (0, -0.1)


def test_time_in_each_verdict():
    """Shares of the cases with it; what was refused is in none."""
    cases = [
        case(case=i, time_share=0.25, verdict=word)
        for i, word in enumerate(("STABLE", "UNSTABLE", None, "STABLE"))
    ]
    found = duty(cases)
    assert (found.stable, found.unstable, found.undecided, found.refused) == (0.5, 0.25, 0.0, 0.25)
    assert duty([case(case=0)]) is None


def test_orders_of_a_bearing():
    """Balls past both rings are Z times the shaft together; rings and cage that turn alike pass nothing."""
    at = replace(STUDY.operation, inner_speed=2.0 * pi * 100.0, outer_speed=0.0)
    found = orders(at, 12, 2.0 * pi * 40.0)
    assert found["shaft_frequency"] == pytest.approx(100.0)
    assert found["cage_frequency"] == pytest.approx(40.0)
    assert found["outer_pass_frequency"] == pytest.approx(12 * 40.0)
    assert found["outer_pass_frequency"] + found["inner_pass_frequency"] == pytest.approx(12 * 100.0)
    assert orders(replace(at, outer_speed=at.inner_speed), 12, at.inner_speed)["inner_pass_frequency"] == 0.0


def test_a_threshold_of_one_friction_is_that_of_the_curve():
    """Followed where it bends beside this friction, as the whole curve is."""
    cage = moving_cage(solve(QUICK), 0.0)
    own = own_threshold(cage, QUICK.stability, 0.2, Runner())
    points = threshold_points(cage, QUICK.stability)
    coarse = [one for one in points if one.restitution_factor in COARSE]
    assert own.value == restitution_threshold(points, 0.2).value
    assert len(points) > len(coarse)
    (one,) = sweep(QUICK, [{FRICTION: 0.2}], margins=True).cases
    assert (one.restitution_threshold, one.margin) == (own.value, own.value - one.restitution_factor)


def test_running_clearances_of_each_case():
    """From those at 293 K; a pocket that closes is a row."""
    plastic = replace(STUDY.cage.material, thermal_expansion=50e-6)
    study = replace(
        STUDY, cage=replace(STUDY.cage, clearances=ClearanceState.AT_REST, material=plastic), ranking=None
    )
    warm, cold, closed = sweep(
        study,
        [
            {"operation.temperature": t, "cage.pocket_clearance": c}
            for t, c in ((293.0, 3e-4), (80.0, 3e-4), (80.0, 1e-5))
        ],
    ).cases
    assert (warm.pocket_clearance > 3e-4, cold.pocket_clearance < 3e-4) == (True, True)
    assert warm.pocket_clearance == pytest.approx(3e-4, rel=1e-2)
    assert "pocket_clearance closes to" in closed.reason


@pytest.mark.usefixtures("elsewhere")
def test_the_worst_case_is_in_the_document(capsys):
    """Without margins and verdicts the highest restitution factor decides; no duty is null."""
    found = document(capsys, "sweep", "momentum-wheel", "--vary", f"{SPEED}=3000..9000rpm:3")
    etas = [one["restitution_factor"] for one in found["cases"]]
    expected = {"case": 0, "quantity": "restitution_factor", "value": max(etas), "compared": 3, "alike": 1}
    assert (found["worst"], found["duty"], found["margins"]) == (expected, None, False)


def test_alike_and_refused_cases_have_their_pictures():
    """No worst case where all are alike; no envelope where no case has an answer."""

    def pictures(cases):
        return dict(draw("sweep", to_xarray(sweep(STUDY, cases))))

    alike = pictures([{"operation.temperature": t} for t in (280.0, 290.0, 300.0)])["envelope"]
    assert alike.axes[0].get_title(loc="left").startswith("No worst case: all 3 have the highest")
    assert "envelope" not in pictures([{"bearing.ball_diameter": d} for d in (0.5, 0.6)])


def test_a_refused_case_is_a_gap_in_every_line():
    """In the picture and under the pointer: nothing is known between its neighbours."""
    data = to_xarray(sweep(STUDY, [{SPEED: n} for n in (-300.0, 0.0, 300.0)]))
    lines = [one for plot in envelope_plots(data) for one in plot.series if one.kind == "line"]
    assert len(lines) > 4
    assert all([value is None for value in one.y] == [False, True, False] for one in lines)
    drawn = dict(draw("sweep", data))["envelope"].axes[0].lines[0].get_ydata()
    assert np.isnan(drawn).tolist() == [False, True, False]
