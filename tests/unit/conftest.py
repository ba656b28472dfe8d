"""What tests of several verbs share."""

import pytest


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Stand in an empty folder, to see what is written."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def page(tmp_path):
    """The page of a folder with one study, without its guard."""
    from commands import SMALL, written
    from fastapi.testclient import TestClient

    from separatrix.front.page.server import application

    (tmp_path / "studies").mkdir()
    written(tmp_path / "studies", SMALL, "small.toml")
    with TestClient(application(tmp_path / "studies")) as client:
        yield client


@pytest.fixture
def undrawn(monkeypatch):
    """Leave the pictures of answers out, where a test is about something else."""
    monkeypatch.setattr("separatrix.present.html.write_drawn", lambda *_: None)
