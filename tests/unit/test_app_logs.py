"""What the page writes of tribometer logs: what they state, and where the user ends running-in."""

import pytest
from fastapi.testclient import TestClient

from separatrix.app.server import application
from separatrix.friction.file import read_friction

HEAD = "Material: PEEK\nCounterface: 440C\nMedium: vacuum\n"
FORM = {"name": "f", "material": "PEEK", "counterface": "440C", "medium": "vacuum"}


@pytest.fixture
def page(tmp_path):
    """The page with a log that states its materials and one that does not."""
    rows = "".join(f"{i},{0.1 + 0.1 * (i < 150) + 0.001 * (i % 3)}\n" for i in range(300))
    with TestClient(application(tmp_path)) as client:
        for name, head in (("a.csv", HEAD), ("b.csv", "")):
            content = f"{head}time [s],COF\n{rows}".encode()
            assert client.put(f"/logs/{name}", content=content).status_code == 200
        yield client


def test_the_form_states_what_is_missing_and_contradicts_no_log(page, tmp_path):
    """A conflict is refused by the name of the log, and nothing is written."""
    refused = page.post("/logs-friction", data=FORM | {"material": "Armalon"})
    assert refused.status_code == 422
    assert "a.csv states another material than the form" in refused.text
    assert not (tmp_path / "f.toml").exists()
    assert page.post("/logs-friction", data=FORM).status_code == 200
    assert [test.material for test in read_friction(tmp_path / "f.toml")] == ["PEEK", "PEEK"]


def test_the_end_of_running_in_that_the_user_moves_is_written(page, tmp_path):
    """It is kept per log until the field is emptied, and the answer names it."""
    assert "running-in ends at 250 s" in page.get("/log/a.csv?run_in=250 s").text
    assert 'value="250 s"' in page.get("/log/a.csv").text  # opened again from the list
    page.get("/log/b.csv?run_in=200 s")
    page.get("/log/b.csv?run_in=")
    written = page.post("/logs-friction", data=FORM)
    assert "as set by hand in a.csv (250 s)." in written.text
    first, second = read_friction(tmp_path / "f.toml")
    assert first.run_in_end == 250.0
    assert second.run_in_end < 200.0


@pytest.mark.parametrize("end", ["never", "1 h"])
def test_a_wrong_end_of_running_in_is_refused_by_the_log(page, end):
    """The line names the log, and no class; what was set before stays."""
    page.get("/log/b.csv?run_in=200 s")
    refused = page.get(f"/log/b.csv?run_in={end}")
    assert refused.status_code == 422
    assert "b.csv: the end of running-in must" in refused.text
    assert "run_in" not in refused.text
    assert 'value="200 s"' in page.get("/log/b.csv").text
