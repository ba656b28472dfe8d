"""Inputs that hypothesis makes are the same each time, and no clock decides: a loaded machine is slow."""

import os

from hypothesis import HealthCheck, settings

NO_MATTER = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
settings.register_profile(
    "ours", derandomize=True, deadline=None, max_examples=60, suppress_health_check=NO_MATTER
)
settings.load_profile("ours")

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as of the command: numpy is not imported yet
