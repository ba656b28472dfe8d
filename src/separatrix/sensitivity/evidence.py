"""What single runs show where every input is at its central value: the evidence beside a verdict."""

from __future__ import annotations

from dataclasses import replace
from threading import Event

from separatrix.cage import Judgement, judge
from separatrix.stability.pool import Progress, work_through
from separatrix.stability.whole import whole_ensemble
from separatrix.uncertainty.model import Model
from separatrix.uncertainty.training import changed_cage
from separatrix.units import Ratio

Evidence = dict[tuple[str, str], Judgement]
"""By environment, "" for all of them together, and candidate."""


def evidence_of(model: Model, *, jobs: int = 1, progress: Progress | None = None) -> Evidence:
    """Verdict and evidence of every case with its inputs at their centres, by the ensemble of `rank`.

    Raises
    ------
    KeyboardInterrupt
        Interrupted.
    """
    stop, settings = Event(), model.study.stability
    frictions = model.frictions(model.central_values)[0]
    cages = [changed_cage(model.study, place).cage for place in range(model.central.size)]
    keys = [
        (cages[case.place].ball_cage_stiffness, float(friction))
        for case, friction in zip(model.cases, frictions, strict=True)
    ]
    places = {key: case.place for key, case in zip(keys, model.cases, strict=True)}

    def judged(key: tuple[float, Ratio]) -> Judgement:
        cage = replace(cages[places[key]], ball_cage_friction=key[1])
        return judge(cage, whole_ensemble(cage, settings, stop))

    asked = sorted(places)
    found = work_through(judged, asked, jobs=jobs, progress=progress, stop=stop)
    known = {key: one for key, one in zip(asked, found, strict=True) if one is not None}
    if len(known) < len(asked):
        raise KeyboardInterrupt
    return {
        (case.environment, case.candidate): known[key] for key, case in zip(keys, model.cases, strict=True)
    }
