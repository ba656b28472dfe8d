"""What the printed ranking says first, how ties and missing measurements look, where the files are."""

from __future__ import annotations

import pytest
from separatrix.report import ranking, ranking_full, report, whereabouts
from separatrix.report.sensitivity import _marks


def row(name: str, rank: int | None, friction: float | None = 0.1, **other: object) -> dict:
    """Return one candidate's row; without a friction nothing else is known of it."""
    known = {
        "restitution_threshold": 0.6,
        "restitution_threshold_low": 0.55,
        "restitution_threshold_high": 0.64,
        "margin": 0.3,
        "probability_lowest_friction": 0.5,
        "probability_stable": 1.0,
        "probability_low": 0.98,
        "probability_high": 1.0,
        "verdict": "STABLE",
        "uncertain_verdict": None,
        "restitution_factor": 0.3,
        "cage_motion": "ON THE LAND",
        "growth_rate": -20.41,
        "growth_rate_low": -21.0,
        "growth_rate_high": -19.96,
        "worst_kick": 0.5,
        "by_kick": [{"kick": 0.1, "settles": 64}, {"kick": 2.0, "settles": 61}],
        "end_energy": 2e-5,
        "pocket_power": 3e-3,
        "land_power": -0.03,
        "rubbing_force": 5.2,
        "rubbing_speed": 6.0,
        "rubbing_power": 0.0312,
        "longest_run": 0.6,
        "largest_offset": 5e-4,
        "mean_offset": 4.9e-4,
        "orbit_evenness": 0.02,
        "drift_rate": 0.01,
        "drift_rate_law": 0.0,
        "largest_contact_force": 275.0,
        "largest_land_force": 31.0,
        "pocket_impact_shares": [0.5, 0.5],
        "land_impact_share": 0.1,
        "whirl_frequency": 1445.2,
        "whirl_direction": 1,
        "whirl_ratio": 12.99,
        "drive_energy": 1e-3,
        "duration": 0.3,
        "runs": 64,
    }
    values = known if friction is not None else dict.fromkeys(known)
    always = {"name": name, "rank": rank, "friction": friction, "reason": "So it is.", "extrapolation": []}
    return {**always, **values, **other}


def document(*rows: dict) -> dict:
    """Return what the verdicts are made of: one environment and the same rows overall."""
    asked = {"runs": 64, "duration": 0.3, "kicks": [0.1, 2.0], "environment": "air"}
    return {"environments": [{"name": "air", "materials": rows}], "overall": rows, **asked}


def test_tied_ranks_are_marked():
    """Two candidates within the scatter share a rank, and each says so."""
    lines = ranking.verdicts([row("A", 1), row("B", 1), row("C", 3)]).splitlines()[-3:]
    assert [line.split()[0] for line in lines] == ["1=", "1=", "3"]


def test_a_missing_measurement_has_dashes_not_numbers():
    """No friction, threshold, margin or probability, and the words instead of a verdict."""
    line = ranking.verdicts([row("A", None, None)]).splitlines()[-1]
    assert line.split() == ["-", "A", "-", "-", "-", "-", "not", "measured"]


def test_frictions_that_were_not_tested_are_marked_and_explained_once():
    """A mark in the row; below, each sentence once, with names where it is not said of all."""
    rows = [row("A", 1, extrapolation=["too fast", "too hot"]), row("B", 2, extrapolation=["too fast"])]
    text = ranking.verdicts([*rows, row("C", 3)])
    assert [line.split()[2][-1] for line in text.splitlines()[-3:]] == ["*", "*", "0"]
    (note,) = ranking.footnotes(rows)
    assert note == "  * extrapolated beyond the tests: too fast. too hot (A)."
    assert ranking.footnotes([row("C", 3)]) == []


def test_a_friction_alone_has_no_probability_of_being_the_lowest():
    """The line says why; with another it has the numbers, and without any measurement there is none."""
    alone = [row("A", 1, probability_lowest_friction=None), row("B", None, None)]
    told = "  Probability of the lowest mean friction:"
    assert ranking.lowest(alone) == [f"{told} none, for only A was measured here."]
    assert ranking.lowest([row("A", 1), row("C", 1)]) == [f"{told} C 0.50, A 0.50."]
    assert ranking.lowest([row("B", None, None)]) == []


def test_the_mark_of_an_assumed_scatter_says_what_the_cell_shows():
    """The guess is of the scatter between samples; the per cent in the cell is of more than that."""
    known = {"friction_scatter_assumed": True, "extrapolation": []}
    document = {"environments": [{"materials": [known]}], "default_scatter": 0.09}
    (note,) = _marks(document)
    assert "? its scatter from sample to sample was not measured: 9 % of the mean" in " ".join(note.split())
    assert "The per cent beside a friction is the whole scatter" in " ".join(note.split())


def test_the_evidence_stands_beside_each_candidate():
    """Motion, growth rate with its interval, offset in mm, drift, both forces, whirl, whirl ratio."""
    lines = ranking_full._evidence([row("A", 1), row("B", None, None)]).splitlines()[-2:]
    assert (
        " ".join(lines[0].split()) == "A ON THE LAND -20.4 (-21 to -20) 0.500 0.01 275 31 1445 forward 12.99"
    )
    assert lines[1].split() == ["B", *"--------"]


def test_one_run_has_a_growth_rate_without_an_interval():
    """No interval, no brackets."""
    one = row("A", 1, growth_rate_low=None, growth_rate_high=None)
    assert ranking_full._evidence([one]).splitlines()[-1].split()[4:6] == ["-20.4", "0.500"]


def test_no_verdict_is_shown_without_its_evidence():
    """In each environment: a table of verdicts, then runs, their length, kicks, and the evidence."""
    asked = document(row("A", 1))
    there = ranking_full._environment(asked, asked["environments"][0])
    assert "  Evidence: 64 runs of 300 ms from each kick, 0.1, 2 m/s" in there
    assert there.index("verdict") < there.index("Evidence") < there.index("ON THE LAND")


def test_the_first_is_shown_in_detail_if_it_has_a_verdict():
    """All the facts of the one at the top; none of one that was not measured."""
    (text,) = ranking_full._first([row("A", 1), row("B", 2)])
    assert text.startswith("A in detail")
    assert "64 from each kick, of up to 600 ms" in text
    assert ranking_full._first([row("A", None, None)]) == []


def test_gaps_in_the_measurements_are_said():
    """Who was measured in fewer than all environments; nothing where all were in all."""
    assert ranking_full._gaps(document(row("A", 1), row("B", None, None)))[1].endswith(
        "1 environments: B in 0."
    )
    assert ranking_full._gaps(document(row("A", 1))) == []


def test_the_bearings_restitution_factor_is_shown_where_candidates_differ_in_it():
    """One column more, as soon as the pockets differ."""
    alike = ranking_full._evidence([row("A", 1), row("B", 2)])
    differ = ranking_full._evidence([row("A", 1), row("B", 2, restitution_factor=0.5)])
    assert "bearing's" not in alike
    assert "bearing's" in differ
    assert "0.50" in differ.splitlines()[-1]


def test_candidates_with_one_reason_share_it():
    """Equal frictions have equal reasons: said once."""
    assert ranking.reasons([row("A", 1), row("B", 1)]) == ["  A, B: So it is."]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (
            [row("A", 1), row("B", 2), row("C", 3, verdict="UNSTABLE"), row("D", None, None)],
            "A ranks first in air: STABLE. It tolerates a restitution factor up to 0.60; this bearing with "
            "its pocket has 0.30 (margin +0.30). The others: STABLE B; UNSTABLE C; not measured D.",
        ),
        (
            [row("A", 1), row("B", 1, verdict="UNDECIDED", margin=0.2, restitution_factor=0.4)],
            "2 materials tie for first in air (A, B): STABLE, UNDECIDED. They tolerate a restitution factor "
            "up to 0.60; this bearing and their pockets have 0.30 to 0.40 (margin +0.20 to +0.30).",
        ),
        ([row("A", None, None)], "No candidate was ranked in air."),
    ],
)
def test_the_answer_in_short(rows, said):
    """Who is first, with the verdict and the margin, and what the others are; nobody if none was measured."""
    assert ranking.in_short(document(*rows)) == said


def test_a_ranking_fits_a_screen():
    """Seven materials in four environments: 60 lines at most, the own environment alone, a reason once."""
    rows = [
        row(
            f"Material {i}",
            i + 1,
            extrapolation=["too fast"],
            verdict="UNDECIDED",
            reason="No clear answer " * 12,
        )
        for i in range(7)
    ]
    names = ("liquid nitrogen", "air", "vacuum", "helium")
    asked = document(*rows) | {
        "environments": [{"name": name, "materials": rows} for name in names],
        "title": "A bearing",
        "warnings": ["A note."],
    }
    text = report("rank", asked)
    assert len(text.splitlines()) <= 60
    assert max(map(len, text.splitlines())) <= 96
    assert text.index("Material 0 ranks first in air") < text.index("Air\n---")
    assert "Liquid nitrogen\n---" not in text
    assert " ".join(text.split()).count("No clear answer " * 12) == 1
    for words in ("64 runs of 300 ms from each kick", "largest", "drift", "pocket", "land", "Note: A note."):
        assert words in text


def test_quiet_leaves_the_table():
    """The bearing's own environment and nothing else: no notes, no evidence."""
    asked = document(row("A", 1)) | {"title": "A bearing", "warnings": ["A note."]}
    text = report("rank", asked, quiet=True)
    assert text.startswith("Air\n---")
    assert len(text.splitlines()) == 6
    assert "A note" not in text


def test_a_verdict_without_a_threshold_is_shown():
    """An interrupt before the curve was traced: verdict and evidence stand, rank and margin are dashes."""
    lacks = ("restitution_threshold", "restitution_threshold_low", "restitution_threshold_high", "margin")
    cut = row("A", None, **dict.fromkeys(lacks))
    line = ranking.verdicts([cut]).splitlines()[-1].split()
    assert line[:5] == ["-", "A", "0.100", "-", "-"]
    assert line[-1] == "STABLE"
    assert "ON THE LAND" in report("rank", document(cut) | {"title": "A bearing", "warnings": []})


def test_a_candidate_that_was_not_finished_is_a_row():
    """After an interrupt: the word in place of a verdict, no evidence, no failure."""
    left = dict.fromkeys(set(row("A", 1)) - {"name", "friction", "extrapolation"})
    cut = [{**left, "name": "A", "friction": 0.1, "extrapolation": [], "reason": "interrupted"}]
    text = report("rank", document(*cut) | {"title": "A bearing", "warnings": []})
    assert "not finished" in text
    assert "none: no verdict was finished" in text


def test_check_does_not_promise_figures():
    """`check --out` writes its text and document only, and says so."""
    assert whereabouts("check", {}, "there") == "This text and the document are in there/\n"
