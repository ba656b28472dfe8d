"""What the page runs and shows: jobs with progress, answers, figures."""

import itertools
import json
import os
import signal
import time
from threading import Event, Thread

import numpy as np
import pytest
from commands import work_undrawn
from fastapi.testclient import TestClient
from test_cli_answers import SMALL

from separatrix.comparing.saved import load
from separatrix.front.page.folder import TEMPLATES, Folder, Page
from separatrix.front.page.jobs import Job, Jobs
from separatrix.front.page.server import application
from separatrix.front.page.worker import Task

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
        patch.setattr("separatrix.front.page.jobs.work", work_undrawn)
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


def test_a_duty_cycle_is_run_from_a_table_beside_the_study(page, root):
    """A table of the pick-list, with margins: shares of the time, and the envelope to point at."""
    rows = ("operation.inner_speed,time_share", "9000 rpm,1 h", "15000 rpm,3 h")
    (root / "duty.csv").write_text("\n".join(rows))
    assert '<option value="duty.csv">' in page.get("/study/small.toml").text
    page.post("/run/small.toml", data={"verb": "sweep", "cases": "duty.csv", "margins": "on"})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    data = load(root / "small" / "sweep.json")
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


def refuse(path):
    """Stand for a reader that must not be asked."""
    raise AssertionError(path)


def test_reading_one_file_delays_no_other(root):
    """An answer that takes a second to read leaves titles and tables to other requests."""
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


@pytest.mark.parametrize(("seconds", "is_told"), [(5.0, False), (20.0, True)])
def test_who_waits_for_a_report_is_told_why(seconds, is_told, tmp_path):
    """A new installation compiles for minutes, while the job says what it is at and no point is done."""
    task = Task(number=1, verb="report", study=tmp_path / "a.toml", folder=tmp_path, root=tmp_path)
    job = Job(
        task=task,
        study="a.toml",
        state="running",
        message="Computing bearing for the report.",
        started=time.monotonic() - seconds,
    )
    text = TEMPLATES.get_template("jobs.html").render(jobs=[job])
    assert ("compiles the solver" in text) == is_told
