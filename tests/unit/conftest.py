"""What tests of several verbs share."""

import pytest


@pytest.fixture
def undrawn(monkeypatch):
    """Leave the pictures of answers out, where a test is about something else."""
    monkeypatch.setattr("separatrix.verbs.answer_files._draw", lambda *_: None)
