"""What the page runs and shows: jobs with progress, answers, figures, points of a map, sliders, logs."""

import itertools
import json
import os
import re
import signal
import time
from threading import Event, Thread

import numpy as np
import pytest
from commands import work_undrawn
from fastapi.testclient import TestClient
from raw_logs import anton_paar
from test_cli_answers import SMALL

from separatrix.app.jobs import Job, Jobs
from separatrix.app.page import TEMPLATES, Folder, Page
from separatrix.app.server import application, made_ready
from separatrix.app.worker import Task
from separatrix.chain.solution import Solution, solve
from separatrix.figures.motion import is_in_space
from separatrix.limits.map_records import varied
from separatrix.present import load
from separatrix.study_file import read_study

LONG = SMALL.replace('duration = "4 ms"', 'duration = "400 ms"').replace("runs = 4", "runs = 64")
PATIENCE = 300.0
"""Time for a job, kernels compiled first [s]."""


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """A folder with a short study and a long one."""
    place = tmp_path_factory.mktemp("studies")
    (place / "small.toml").write_text(SMALL)
    (place / "long.toml").write_text(LONG)
    return place


@pytest.fixture(scope="module")
def page(root):
    """The page of that folder, with its answers to `rank` and to a small `map`; no picture is written."""
    with pytest.MonkeyPatch.context() as patch, TestClient(application(root)) as client:
        patch.setattr("separatrix.app.jobs.work", work_undrawn)
        client.post("/run/small.toml", data={"verb": "rank"})
        axes = {"x": "restitution_factor=0.3..0.9:2", "y": "ball_cage_friction=0.05..0.5:2"}
        client.post("/run/small.toml", data={"verb": "map", "runs": "1", **axes})
        until(client, lambda jobs: all("finished" in job for job in jobs))
        yield client


def jobs(page):
    """Return the jobs, the newest first, each as the state and text that is shown."""
    return page.get("/jobs").text.split('<article class="job ')[1:]


def until(page, holds):
    """Wait until something holds for the jobs."""
    end = time.monotonic() + PATIENCE
    while not holds(found := jobs(page)):
        assert time.monotonic() < end, found
        assert not any(job.startswith(("refused", "failed")) for job in found), found
        time.sleep(0.1)
    return found


def test_an_answer_is_that_of_the_command_line(page, root):
    """The same files in the same folder, and the verdicts of its document in the table."""
    found = json.loads((root / "small" / "rank.json").read_text())
    text = page.get("/answer/rank/small.toml").text
    for row in found["overall"]:
        assert row["name"] in text
        assert row["verdict"] in text
        assert f"{row['margin']:+.2f}" in text
    assert (root / "small" / "rank.xlsx").exists()


@pytest.mark.parametrize(
    ("figure", "names"),
    [
        ("rank/curve", {"linear limit", "half of 4 runs whirl"}),
        ("rank/candidates", {"overall"}),
        ("map/map", {"share of the runs that whirl"}),
    ],
)
def test_a_figure_has_its_series_and_a_text_at_each_point(page, figure, names):
    """What is hovered over is the series that the report has."""
    found = page.get(f"/plot/{figure}/small.toml").json()
    assert names <= {trace.get("name") for trace in found["data"]}
    texts = [len(trace["text"]) == len(trace["x"]) for trace in found["data"] if trace.get("text")]
    assert texts
    assert all(texts)


@pytest.mark.parametrize(("x", "y"), [(0.31, 0.06), (0.88, 0.49)])
def test_a_click_in_a_map_runs_the_point_next_to_it(page, root, x, y):
    """The run has the friction, and the race damping of the restitution factor, of that point."""
    page.post("/point/small.toml", data={"x": x, "y": y})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    eta, friction = round(x, 1), {0.06: 0.05, 0.49: 0.5}[y]
    place = root / "small" / "points" / f"restitution_factor-{eta:g}_ball_cage_friction-{friction:g}"
    data = load(place / "simulate.nc")
    assert float(data["cage_ball_cage_friction"]) == pytest.approx(friction)
    assert float(data["kick"]) == pytest.approx(float(load(root / "small" / "map.nc")["kick"]))
    (run,) = re.findall('id="run">(.*?)</script>', page.get(f"/cage/small.toml?point={place.name}").text)
    seen = json.loads(run)
    assert seen["centre"][-2:] == pytest.approx(
        1e9 * data["position"].values[-1], abs=0.5
    )  # whole nanometres
    assert seen["lean"] is None


def test_the_damping_of_a_point_is_that_of_its_restitution_factor(page, root):
    """Races that give way less return more; both points above are of one cage."""
    places = sorted((root / "small" / "points").iterdir())
    low, high = (float(load(place / "simulate.nc")["cage_race_damping"]) for place in places)
    assert 0.0 < low < high


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"film.thickness": 2e-6},
        {"film.race_friction": 0.2, "cage.ball_cage_friction": 0.2},
        {"cage.mass": 0.05},
    ],
)
def test_sliders_show_what_the_chain_computes(page, root, values):
    """Eta of the changed study; threshold and margin on the finished curve; other cages are to be refined."""
    found = page.get("/explored/small.toml", params=values).json()
    changed = solve(varied(read_study(root / "small.toml"), values))
    eta = changed.restitution.restitution_factor
    assert found["eta"] == f"{eta:.3f}"
    assert float(found["margin"]) == pytest.approx(float(found["threshold"]) - eta, abs=0.01)  # 2 decimals
    assert found["is_refined"] == ("cage.mass" not in values)


def test_a_slider_of_the_cage_refines_its_curve(page):
    """The curve of the changed cage is computed once, and then belongs to the values."""
    page.post("/refine/small.toml?cage.mass=0.05")
    until(page, lambda jobs: jobs[0].startswith("finished"))
    assert page.get("/explored/small.toml?cage.mass=0.05").json()["is_refined"]


def test_a_slider_out_of_range_is_refused_in_words(page):
    """As a study file would be."""
    found = page.get("/explored/small.toml?film.race_friction=7")
    assert (found.status_code, "race_friction" in found.text) == (422, True)


def test_a_point_of_a_map_in_space_is_simulated_and_shown_in_space(page, root):
    """The click takes the motion of the map, not that of the study; the page has the run and its script."""
    axes = {"x": "restitution_factor=0.3..0.9:2", "y": "ball_cage_friction=0.05..0.5:2", "motion": "space"}
    (root / "tilting.toml").write_text(SMALL)
    page.post("/run/tilting.toml", data={"verb": "map", "runs": "1", **axes})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    page.post("/point/tilting.toml", data={"x": 0.3, "y": 0.05})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    (place,) = (root / "tilting" / "points").iterdir()
    assert is_in_space(load(place / "simulate.nc"))
    text = page.get(f"/cage/tilting.toml?point={place.name}").text
    (run,) = re.findall('id="run">(.*?)</script>', text)
    assert len(json.loads(run)["time"]) > 2
    for source in re.findall('(?:src|href)="(/static/cage/[^"]+)"', text):
        assert page.get(source).status_code == 200
    assert not re.search(r"<script(?! type=.application/json)(?![^>]* src=)", text)  # none runs inline


def test_a_duty_cycle_is_run_from_a_table_beside_the_study(page, root):
    """A table of the pick-list, with margins: shares of the time, and the envelope to point at."""
    rows = ("operation.inner_speed,time_share", "9000 rpm,1 h", "15000 rpm,3 h")
    (root / "duty.csv").write_text("\n".join(rows))
    assert '<option value="duty.csv">' in page.get("/study/small.toml").text
    page.post("/run/small.toml", data={"verb": "sweep", "cases": "duty.csv", "margins": "on"})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    path, end = root / "small" / "sweep.nc", time.monotonic() + 20
    while path not in page.app.state.page._read:  # read as the job has ended
        assert time.monotonic() < end
        time.sleep(0.05)
    data = load(path)
    assert data["time_share"].values == pytest.approx([0.25, 0.75])
    assert np.isfinite(data["margin"].values).all()
    assert 'data-source="/plot/sweep/envelope/small.toml"' in page.get("/answer/sweep/small.toml").text
    found = page.get("/plot/sweep/envelope/small.toml").json()
    places = [found["layout"][name]["domain"] for name in ("yaxis", "yaxis2", "yaxis3")]
    assert places[0][1] == 1.0
    assert places[-1][0] == 0.0
    assert all(above[0] > below[1] for above, below in itertools.pairwise(places))
    assert {trace["yaxis"] for trace in found["data"]} == {"y", "y2", "y3"}
    page.post("/run/small.toml", data={"verb": "sweep", "cases": "duty.csv", "vary": "cage.mass=20..30g:2"})
    end = time.monotonic() + PATIENCE
    while not (shown := jobs(page)[0]).startswith("refused"):
        assert time.monotonic() < end
        time.sleep(0.1)
    assert "exclude each other" in shown
    page.post("/jobs/forget")


def test_the_newest_answers_are_read_before_they_are_looked_at(page, monkeypatch):
    """At the start of the server, and at the end of a job; what sliders need is computed then, too."""
    again = Page(folder=page.app.state.page.folder, jobs=page.app.state.page.jobs)
    solved = []
    monkeypatch.setattr(Solution, "friction", property(lambda _: solved.append(True)))
    made_ready(again)
    assert solved == [True]
    monkeypatch.setattr("separatrix.present.load", refuse)
    for verb in ("rank", "map", "sweep"):
        assert again.dataset(again.folder.answers("small.toml") / f"{verb}.nc") is not None
        assert page.app.state.page.dataset(again.folder.answers("small.toml") / f"{verb}.nc") is not None


def refuse(path):
    """Stand for a reader that must not be asked."""
    raise AssertionError(path)


def test_reading_one_file_delays_no_other(root):
    """A dataset that takes a second to read leaves titles and tables to other requests."""
    page, begun, may_end = Page(folder=Folder(root=root), jobs=Jobs(root)), Event(), Event()

    def slowly():
        begun.set()
        assert may_end.wait(20)
        return "read"

    slow = Thread(target=page._known, args=(root / "long.toml", slowly))
    slow.start()
    assert begun.wait(20)
    other = Thread(target=page.title, args=("small.toml",))
    other.start()
    other.join(5)
    assert not other.is_alive()
    may_end.set()
    slow.join(20)
    assert page._known(root / "long.toml", refuse) == "read"


def test_a_job_is_cancelled_and_resumed(page, root):
    """What was finished is in the answer and in the ledger; the second call takes it from there."""
    page.post("/run/long.toml", data={"verb": "rank"})
    until(page, lambda jobs: "<progress max" in jobs[0])
    number = jobs(page)[0].partition("/jobs/")[2].partition("/")[0]
    page.post(f"/jobs/{number}/cancel")
    end = time.monotonic() + PATIENCE
    while jobs(page)[0].startswith("running"):
        assert time.monotonic() < end
        time.sleep(0.1)
    assert jobs(page)[0].startswith("cancelled")
    assert (root / "long" / "finished-runs.sqlite").exists()
    assert "Resume" in jobs(page)[0]
    page.post(f"/jobs/{number}/resume")
    assert jobs(page)[0].startswith(("running", "waiting"))
    page.post(f"/jobs/{int(number) + 1}/cancel")
    until(page, lambda jobs: jobs[0].startswith("cancelled"))


def test_a_killed_computing_process_loses_only_the_job_in_hand(page):
    """The page says so, and computes the next question in a new process."""
    queue = page.app.state.page.jobs
    page.post("/run/long.toml", data={"verb": "rank"})
    until(page, lambda jobs: jobs[0].startswith("running"))
    os.kill(queue._process.pid, signal.SIGKILL)
    end = time.monotonic() + 20
    while not jobs(page)[0].startswith("failed"):
        assert time.monotonic() < end
        time.sleep(0.05)
    assert "resume to go on" in jobs(page)[0]
    page.post("/run/small.toml", data={"verb": "bearing"})
    end = time.monotonic() + PATIENCE
    while not jobs(page)[0].startswith("finished"):
        assert time.monotonic() < end
        time.sleep(0.1)


def test_a_dropped_log_is_read_and_its_cut_is_moved(page, root):
    """Friction of the steady part, found and then cut by hand."""
    time_ = np.arange(0.0, 600.0, 0.5)
    log = anton_paar(0.2 + 0.3 * np.exp(-time_ / 40.0), time_)
    assert page.put("/logs/test.txt", content=log).status_code == 200
    found = page.get("/log/test.txt").text
    assert "What was read" in found
    moved = page.get("/log/test.txt?run_in=300 s").text
    assert "running-in ends at 300 s" in moved
    figure = page.get("/log-figure/test.txt/0?run_in=300 s").json()
    assert figure["layout"]["shapes"][0]["x0"] == pytest.approx(300.0, abs=1.0)  # the next row
    assert page.put("/logs/test.txt", content=log).status_code == 200  # the same again
    assert page.put("/logs/test.txt", content=log + b" ").status_code == 422
    assert page.get("/log/test.txt?run_in=never").status_code == 422


@pytest.mark.parametrize(("seconds", "is_told"), [(5.0, False), (20.0, True)])
def test_who_waits_for_a_report_is_told_why(seconds, is_told, tmp_path):
    """A new installation compiles for minutes, while the job says what it is at and no point is done."""
    task = Task(number=1, verb="report", study=tmp_path / "a.toml", folder=tmp_path, root=tmp_path)
    job = Job(
        task=task,
        study="a.toml",
        title="report",
        state="running",
        message="Computing bearing for the report.",
        started=time.monotonic() - seconds,
    )
    text = TEMPLATES.get_template("jobs.html").render(jobs=[job])
    assert ("compiles the solver" in text) == is_told
