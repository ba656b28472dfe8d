"""`sweep`: chain and, if asked, verdict of many cases of a study."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from separatrix.chain.solution import solve
from separatrix.ground.errors import SeparatrixError
from separatrix.study.study import Study
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.parameter_axes import (
    Case,
    asked_cases,
)
from separatrix.verdict.swept_cases import Sweep
from separatrix.verdict.swept_cases import sweep as run_cases


def compute(
    study: Study,
    runner: Runner,
    *,
    vary: Sequence[str] = (),
    cases: Path | Sequence[Case] | None = None,
    verdicts: bool = False,
    margins: bool = False,
) -> Sweep:
    """Chain and, if asked, verdict of many cases of a study.

    Parameters
    ----------
    vary : sequence of str
        Ranges, each ``PARAM=LOW..HIGH[unit][:N][:log]``; every value of one with every value of the others.
    cases : Path, or sequence of mapping, optional
        In their place a CSV file, or values by the names of a study file in SI units; with `time_share`
        they are a duty cycle.
    verdicts, margins : bool
        Whether to run the whole ensemble of each case, and to compute its threshold and margin, too.
    """
    asked = asked_cases(vary, cases)
    solution = solve(study)
    with contextlib.suppress(SeparatrixError):
        _ = solution.clearances  # for their notes
    return made_into(
        lambda found: replace(found, notes=solution.notes),
        lambda: run_cases(study, asked, verdicts=verdicts, margins=margins, runner=runner),
    )
