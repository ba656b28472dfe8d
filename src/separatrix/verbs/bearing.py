"""`bearing`: ball equilibrium and the contacts of the most loaded ball."""

from __future__ import annotations

from dataclasses import replace

from separatrix.chain.contacts import BearingState
from separatrix.chain.solution import solve
from separatrix.study.study import Study


def compute(study: Study) -> BearingState:
    """Ball equilibrium and the contacts of the most loaded ball."""
    solution = solve(study)
    found, clearances = solution.bearing, solution.clearances
    return replace(found, clearances=clearances, notes=solution.notes)
