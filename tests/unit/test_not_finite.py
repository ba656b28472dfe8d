"""Evidence that overflows gives no verdict, but a reason."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

from separatrix.cage import CageMotion, Judgement, Verdict
from separatrix.draws import Case
from separatrix.ranking import NotFinished
from separatrix.ranking.lowest import MeanFriction
from separatrix.ranking.rank import _row


def judgement(**changes) -> Judgement:
    """Evidence that is 0 but for what the row reads otherwise, without the checks of a real one."""
    one = object.__new__(Judgement)
    values = {f.name: 0.0 for f in fields(Judgement)}
    values |= {"verdict": Verdict.STABLE, "cage_motion": next(iter(CageMotion)), "reason": "So it is."}
    for name, value in (values | {"pocket_impact_shares": (0.0,) * 3} | changes).items():
        object.__setattr__(one, name, value)
    return one


def row(one: Judgement):
    """The row of a candidate with this evidence, before its threshold is known."""
    eta = SimpleNamespace(restitution_factor=0.3)
    question = SimpleNamespace(stiffness={"A": 1e6}, cages={1e6: SimpleNamespace(restitution=eta)})
    found = SimpleNamespace(judgements={(1e6, 0.1): one}, points={})
    return _row(question, found, Case("A", "air"), MeanFriction(0.1, 0.01), None)


@pytest.mark.parametrize("bad", [np.inf, np.nan])
def test_a_row_whose_evidence_is_not_finite_has_a_reason_and_no_verdict(bad):
    """Every number of it is absent, so that the answer can be written."""
    found = row(judgement(largest_contact_force=float(bad)))
    assert isinstance(found, NotFinished)
    assert found.judgement is None
    assert found.reason == (
        f"no verdict: largest contact force is {float(bad)}. The inputs are far from those of a bearing"
    )
