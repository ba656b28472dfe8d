"""What the first page of a report says of drifting cages, mixed ties, small frictions and running parts."""

from dataclasses import replace

import pytest

import separatrix
from separatrix.reporting.first_page import first_page
from separatrix.reporting.record import Facts, Kept, Paragraph, Table
from separatrix.reporting.stages import bearing_and_cage
from separatrix.study.study import ClearanceState
from separatrix.told.sentences import verdict_sentences
from separatrix.verbs import restitution

SHIPPED = separatrix.read_study("cryogenic-turbopump")
HERE = {"restitution_factor": 0.769, "critical_friction": 0.104, "scatter_low": 0.0865, "scatter_high": 0.144}
HERE |= {"critical_friction_low": 0.0628, "critical_friction_high": 0.185}
SMALL = dict.fromkeys(("critical_friction", "critical_friction_low", "critical_friction_high"), 0.00158)
SMALL |= {"restitution_factor": 0.994, "scatter_low": 0.0, "scatter_high": 0.00316}


def leads(friction, here, *, drifts, rate=0.0):
    """Return the sentences on the cage of a study without candidates."""
    study = {"cage": {"ball_cage_friction": {"value": friction}}}
    curve = {"verb": "stability", "study": study, "here": here, "drifts": drifts, "drift_rate_law": rate}
    blocks = first_page({"stability": Kept(curve | {"warnings": []})}, ()).blocks
    return [one.text for one in blocks if isinstance(one, Paragraph) and one.kind == "lead"]


@pytest.mark.parametrize(
    ("rate", "pace"),
    [(0.1064, ", by the linear law at 0.106 1/s (e-fold every 9.4 s)"), (0.0, ""), (None, "")],
)
def test_a_cage_that_drifts_is_not_called_stable(rate, pace):
    """Below the band its disturbances decay; with a land it is stable there."""
    adrift = leads(0.01, HERE, drifts=True, rate=rate)
    assert any(
        one.startswith(f"The cage has no land and drifts at any friction{pace}. Below") for one in adrift
    )
    assert not any("the cage is stable" in one for one in adrift)
    assert adrift[1].endswith("(0.063 to 0.18): disturbances decay, but the cage drifts and is not stable.")
    held = leads(0.01, HERE, drifts=False)
    assert held[1].endswith("the cage is stable.")
    assert not any("drifts" in one for one in held)


def test_a_cage_that_drifts_without_a_friction_of_its_own_is_said_to_drift():
    """No friction to compare with the band, and none found at all."""
    for here in (HERE, None):
        assert any("drifts at any friction" in one for one in leads(None, here, drifts=True, rate=0.1))


def test_a_small_friction_differs_from_0():
    """Two significant digits of the critical friction, its interval and its band."""
    curve, band, *_ = leads(0.0004, SMALL, drifts=False)
    assert curve.endswith("half of the runs whirl at a pocket friction of 0.0016 (0 to 0.0032).")
    assert band.startswith("The cage's friction of 0.0004 is below")
    assert "(0.0016 to 0.0016)" in band
    assert "of 0.10 (0.086 to 0.14)." in leads(0.1, HERE, drifts=False)[0]


def sentences(*verdicts, limit=0.6):
    """Return the answer of a ranking whose candidates tie for first."""
    row = {"restitution_factor": 0.3, "margin": limit - 0.3, "rank": 1, "reason": "So it is."}
    row |= dict.fromkeys(("restitution_threshold", "restitution_threshold_low"), limit)
    row |= {"restitution_threshold_high": 0.7}
    rows = [row | {"name": name, "verdict": one} for name, one in zip("ABC", verdicts, strict=False)]
    return verdict_sentences(rows, "air")


def test_each_of_a_tie_has_its_own_verdict():
    """Those of one verdict share it; of one that is not STABLE nothing remains stable."""
    lead, limit, _ = sentences("STABLE", "UNSTABLE", "STABLE")
    assert lead == "3 materials tie for first in air: STABLE A, C; UNSTABLE B."
    assert limit == (
        "From the reference kick the largest stable restitution factor is 0.60; this bearing and film "
        "have 0.30, a margin of +0.30."
    )
    lead, limit, _ = sentences("STABLE", "STABLE")
    assert lead == "2 materials tie for first in air (A, B): STABLE."
    assert limit.startswith("Their cages remain stable up to a restitution factor of 0.60;")


@pytest.mark.parametrize("verdict", ["UNSTABLE", "UNDECIDED"])
def test_a_first_that_is_not_stable_does_not_remain_so(verdict):
    """Alone at the top; with no threshold above 0 there is nothing to be stable up to."""
    assert "remain" not in sentences(verdict)[1]
    assert sentences("STABLE")[1].startswith("The cage remains stable up to")
    assert sentences(verdict, limit=0.0)[1].startswith("The cage is stable at no restitution factor above 0;")


def test_the_note_on_overdamped_impacts_holds_for_cages_of_one_stiffness_only():
    """Candidates of another stiffness have another eta: the full threshold is not every material's margin."""
    slippery = replace(SHIPPED, film=replace(SHIPPED.film, race_friction=0.02))
    (note,) = restitution.compute(slippery).notes
    assert "whose cage has this k_BC and M_C has its full threshold" in note


def bearing_of(study):
    """Return the blocks on bearing and cage from the answer of `bearing`."""
    return bearing_and_cage({"bearing": Kept(separatrix.bearing(study).document())}).blocks


def test_running_clearances_are_in_the_report():
    """Those of docs/theory/clearances.md, with strains; none where the study states the running ones."""
    cage = replace(SHIPPED.cage, clearances=ClearanceState.AT_REST)
    blocks = bearing_of(replace(SHIPPED, cage=cage))
    (table,) = (one for one in blocks if isinstance(one, Table))
    assert [(row[0], row[1]) for row in table.rows] == [
        ("pocket", "600 \N{MICRO SIGN}m"),
        ("land", "1 mm"),
    ]
    assert [row[2][:5] for row in table.rows] == ["545.5", "1.295"]
    parts = dict(pair for one in blocks if isinstance(one, Facts) for pair in one.pairs)
    assert parts["Thermal strain"].startswith("cage -")
    assert parts["Growth by rotation"].startswith("cage +")
    assert not any(isinstance(one, Table) for one in bearing_of(SHIPPED))
