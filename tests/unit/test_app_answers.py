"""What the page runs and shows: jobs with progress, answers as pages of blocks, points of a map, logs."""

import importlib.util
import json
import os
import re
import signal
import sys
import time
import zipfile
from io import BytesIO

import pytest
from commands import SMALL, work_undrawn
from fastapi.testclient import TestClient

from separatrix.front.console import is_importing
from separatrix.front.page import editing
from separatrix.front.page.server import application
from separatrix.front.page.worker import Jobs
from separatrix.ground.errors import InputError

LONG = SMALL.replace('duration = "4 ms"', 'duration = "400 ms"').replace("runs = 4", "runs = 64")
PATIENCE = 1200.0
"""Time for a job, kernels compiled first [s]."""

AXES = {"x": "restitution_factor=0.3..0.9:2", "y": "film.thickness=0.4..0.8um:2", "runs": "1"}
LOG = "time [s],friction\n" + "".join(f"{i / 10},{0.2 + 0.01 * (i % 7)}\n" for i in range(400))


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """A folder with a short study and a long one."""
    place = tmp_path_factory.mktemp("studies")
    (place / "small.toml").write_text(SMALL)
    (place / "long.toml").write_text(LONG)
    return place


@pytest.fixture(scope="module")
def page(root):
    """The page of that folder, with its answers to `bearing`, `rank` and a small `map`, undrawn."""
    with pytest.MonkeyPatch.context() as patch, TestClient(application(root)) as client:
        patch.setattr("separatrix.front.page.worker.work", work_undrawn)
        for verb in ("bearing", "rank", "map"):
            asked = AXES if verb == "map" else {}
            client.post("/run/small.toml", data={"verb": verb, **asked})
        until(client, lambda jobs: all(job.startswith("finished") for job in jobs))
        yield client


def jobs(page):
    """Return the jobs, the newest first, each as the state and text that is shown."""
    return page.get("/jobs").text.split('<article class="job ')[1:]


def until(page, holds, but=("refused", "failed")):
    """Wait until something holds for the jobs; the newest must not end as in `but`."""
    end = time.monotonic() + PATIENCE
    while not holds(found := jobs(page)):
        assert time.monotonic() < end, found
        assert not (but and found and found[0].startswith(but)), found
        time.sleep(0.1)
    return found


def test_an_answer_is_the_page_of_its_document(page, root):
    """The verdicts of the files that the command line writes; its figures and its zip file are fetched."""
    found = json.loads((root / "small" / "rank.json").read_text())
    text = page.get("/answer/rank/small.toml").text
    for row in found["overall"]:
        assert row["name"] in text
        assert row["verdict"] in text
    places = re.findall('hx-get="(/figure/[^"]+)"', text)
    assert places
    for place in places:
        assert 'data-ways="[[' in page.get(place).text
    with zipfile.ZipFile(BytesIO(page.get("/zip/small.toml").content)) as files:
        assert {"small.toml", "small/rank.json", "small/bearing.txt"} <= {*files.namelist()}


@pytest.mark.parametrize("damage", ["{", "[]", '{"verb": "bearing"}', "interrupted"])
def test_a_damaged_or_interrupted_answer_is_a_page_or_a_line_with_its_file(page, root, damage):
    """And no fault of the server."""
    path = root / "small" / "bearing.json"
    kept = path.read_text()
    path.write_text(json.dumps(json.loads(kept) | {"complete": False}) if damage == "interrupted" else damage)
    found = page.get("/answer/bearing/small.toml")
    path.write_text(kept)
    assert found.status_code == 200
    words = "Interrupted: only what was finished" if damage == "interrupted" else "small/bearing.json"
    assert words in found.text


def test_an_answer_says_that_its_study_has_changed(page, root):
    """One line names the inputs; lines that moved in the file are no change."""
    path = root / "small.toml"
    path.write_text(f"# moved\n\n{SMALL}")
    assert "Changed after" not in page.get("/answer/rank/small.toml").text
    path.write_text(SMALL.replace("runs = 4", "runs = 5"))
    assert "Changed after this answer: stability.runs." in page.get("/answer/rank/small.toml").text
    path.write_text(SMALL)


def test_a_chosen_model_is_no_change_of_the_study(page):
    """The answer was asked with it, beside the study."""
    page.post("/run/small.toml", data={"verb": "simulate", "model": "paper"})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    text = page.get("/answer/simulate/small.toml").text
    assert "--model paper" in text
    assert "Changed after" not in text


def test_a_point_of_a_map_is_a_study_of_its_own(page, root):
    """It extends the first, with the value of the map that is next to the click."""
    page.post("/point/small.toml", data={"x": "0.41", "y": "5e-7"})
    until(page, lambda jobs: jobs[0].startswith("finished"))
    (path,) = root.glob("small *.toml")
    text = path.read_text()
    assert 'extends = "small.toml"' in text
    assert 'thickness = "4e-07 m"' in text
    found = json.loads((root / path.stem / "simulate.json").read_text())
    assert found["provenance"]["command"]["question"]["restitution_factor"] == "0.3"


def test_options_are_fields_of_their_types(page, root):
    """A number in digits, a line each, a file beside the study, a flag; empty ones are left out."""
    own, table = page.app.state.page, root / "duty.csv"
    table.write_text("film.thickness\n1 um\n")
    sent = {"vary": "a=1\n b=2 \n", "cases": "duty.csv", "margins": "on", "verdicts": "", "model": "paper"}
    expected = {"vary": ("a=1", "b=2"), "cases": table, "margins": True, "model": "paper"}
    assert editing.asked(own, "small.toml", "sweep", sent) == expected
    assert editing.asked(own, "small.toml", "map", {"runs": "4"}) == {"runs": 4}
    with pytest.raises(InputError, match="--runs must be a whole number"):
        editing.asked(own, "small.toml", "map", {"runs": "4.5"})


def test_a_log_is_dropped_corrected_and_cut(page, root):
    """An open question is answered in the draft of its map; the end of running-in is moved."""
    assert page.put("/logs/a.csv", content=LOG.replace("friction", "b", 1)).status_code == 200
    page.post("/reduce/a.csv")
    until(page, lambda jobs: jobs[0].startswith("refused"), but=())
    draft = (root / "logs" / "a.csv.map.toml").read_text()
    assert "data-line=" in page.get("/log/a.csv").text
    mended = re.sub("(?m)^friction = .*", 'friction = { name = "b", unit = "-" }', draft)
    assert "data-line=" not in page.post("/map/a.csv", data={"text": mended}).text
    page.post("/reduce/a.csv", data={"run_in": "12 s"})
    until(page, lambda jobs: jobs[0].startswith("finished"), but=())
    test = json.loads((root / "logs" / "a.csv.answer" / "tribometer.json").read_text())["tests"][0]
    assert test["run_in_end"] == pytest.approx(12.0)
    text = page.get("/log/a.csv").text
    assert 'data-cut="s"' in text
    assert 'data-ways="[[' in page.get(re.search('hx-get="(/figure/[^"]+)"', text)[1]).text


def test_a_killed_computing_process_loses_only_the_job_in_hand(page):
    """The page says so, resumes it, and computes the next question in a new process."""
    queue = page.app.state.page.jobs
    page.post("/run/long.toml", data={"verb": "rank"})
    until(page, lambda jobs: jobs[0].startswith("running"))
    os.kill(queue._process.pid, signal.SIGKILL)
    until(page, lambda jobs: jobs[0].startswith("failed"), but=())
    assert "resume to go on" in jobs(page)[0]
    number = int(jobs(page)[0].partition("/jobs/")[2].partition("/")[0])
    page.post(f"/jobs/{number}/resume")
    assert jobs(page)[0].startswith(("running", "waiting"))
    page.post(f"/jobs/{number + 1}/cancel")
    until(page, lambda jobs: jobs[0].startswith("cancelled"))
    page.post("/run/small.toml", data={"verb": "bearing"})
    until(page, lambda jobs: jobs[0].startswith("finished"), but=())


def ended(queue, number):
    """Wait for the end of a job; return it."""
    until = time.monotonic() + PATIENCE
    while (job := next(one for one in queue.all() if one.number == number)).is_active:
        assert time.monotonic() < until, job
        time.sleep(0.02)
    return job


def test_a_cancel_at_once_ends_its_job_and_no_other(tmp_path):
    """Before the process has begun, in its first imports, or as the job ends: the next one finishes."""
    queue = Jobs(tmp_path)
    try:
        for wait in (0.0, 0.4, 1.2):
            name = f"after-{wait}.toml"
            (tmp_path / name).write_text(SMALL)
            first = queue.ask("bearing", name)
            time.sleep(wait)
            queue.cancel(first.number)
            state = ended(queue, first.number).state
            assert state == "cancelled" or (wait > 0.0 and state == "finished")
            second = queue.ask("bearing", name)
            found = ended(queue, second.number)
            assert found.state == "finished", found
    finally:
        queue.close()


def test_an_import_is_seen_from_within(tmp_path):
    """An interrupt would leave a module half made."""
    path = tmp_path / "slow_module.py"
    path.write_text("import sys\nframe = sys._getframe()\n")
    made = importlib.util.spec_from_file_location("slow_module", path)
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    assert is_importing(module.frame)
    assert not is_importing(sys._getframe())
