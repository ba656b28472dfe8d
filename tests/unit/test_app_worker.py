"""A cancel of the page ends its own job only, at whatever moment it comes."""

import importlib.util
import sys
import time

from commands import SMALL

from separatrix.front.console import is_importing
from separatrix.front.page.worker import Jobs

PATIENCE = 600.0
"""Time for a job on a loaded machine [s]."""


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
