"""What the printed ranking says first, how ties and missing measurements look, where the files are."""

from __future__ import annotations

import pytest

from separatrix.report import ranking, report


def row(name: str, rank: int | None, friction: float | None = 0.1, **other: object) -> dict:
    """Return one candidate's row; without a friction nothing else is known of it."""
    known = {
        "restitution_threshold": 0.6,
        "restitution_threshold_low": 0.55,
        "restitution_threshold_high": 0.64,
        "margin": 0.3,
        "probability_stable": 1.0,
        "probability_low": 0.98,
        "probability_high": 1.0,
        "verdict": "STABLE",
        "restitution_factor": 0.3,
        "energy_growth": 1e-5,
        "largest_offset": 5e-4,
        "drift_rate": 0.01,
        "largest_contact_force": 275.0,
        "whirl_frequency": 1445.2,
        "whirl_direction": 1,
        "runs": 64,
    }
    values = known if friction is not None else dict.fromkeys(known)
    return {"name": name, "rank": rank, "friction": friction, "reason": "So it is.", **values, **other}


def document(*rows: dict) -> dict:
    """Return what the evidence is made of: one environment and the same rows overall."""
    return {"environments": [{"name": "air", "materials": rows}], "overall": rows}


def test_tied_ranks_are_marked():
    """Two candidates within the scatter share a rank, and each says so."""
    lines = ranking._table([row("A", 1), row("B", 1), row("C", 3)]).splitlines()[-3:]
    assert [line.split()[0] for line in lines] == ["1=", "1=", "3"]


def test_a_missing_measurement_has_dashes_not_numbers():
    """No friction, threshold, margin or probability, and the words instead of a verdict."""
    line = ranking._table([row("A", None, None)]).splitlines()[-1]
    assert line.split() == ["-", "A", "-", "-", "-", "-", "not", "measured"]


def test_the_evidence_stands_beside_each_candidate():
    """Environments measured, offset in mm, drift, force, whirl with its direction, energy growth, runs."""
    lines = ranking._evidence(document(row("A", 1), row("B", None, None))).splitlines()[-2:]
    assert lines[0].split() == ["A", "1", "of", "1", "0.500", "0.01", "275", "1445", "forward", "1e-05", "64"]
    assert lines[1].split() == ["B", "0", "of", "1", *"------"]


def test_the_bearings_restitution_factor_is_shown_where_candidates_differ_in_it():
    """One column more, as soon as the pockets differ."""
    alike = ranking._evidence(document(row("A", 1), row("B", 2)))
    differ = ranking._evidence(document(row("A", 1), row("B", 2, restitution_factor=0.5)))
    assert "bearing's" not in alike
    assert "bearing's" in differ
    assert "0.50" in differ.splitlines()[-1]


def test_candidates_with_one_reason_share_it():
    """Equal frictions have equal reasons: said once."""
    assert ranking._reasons([row("A", 1), row("B", 1)]) == ["  A, B: So it is."]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([row("A", 1), row("B", 2)], "A is first overall: STABLE, with a margin of +0.30"),
        (
            [row("A", 1), row("B", 1, verdict="UNDECIDED")],
            "A and B are tied first overall: STABLE, UNDECIDED",
        ),
        ([row("A", None, None)], "no candidate was ranked."),
    ],
)
def test_the_answer_in_short(rows, said):
    """Who is first, with the verdict; nobody if nothing was measured."""
    assert ranking._in_short(document(*rows)).startswith(said)


def test_check_does_not_promise_figures():
    """`check --out` writes its text and document only, and says so."""
    parts = ("bearing", "operation", "kinematics", "film", "cage", "stability", "ranking")
    study = {"title": "T", "study": dict.fromkeys(parts), "warnings": []}
    assert report("check", study, where="there").endswith("This text and the document are in there/\n")
