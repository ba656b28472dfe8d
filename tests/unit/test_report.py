"""What the printed ranking says first, how ties and missing measurements look, where the files are."""

from __future__ import annotations

from dataclasses import fields, replace
from types import SimpleNamespace

import pytest

from separatrix.chain.pocket_friction import PocketConditions
from separatrix.study.reading import read_study
from separatrix.study.study import BallModel, MotionModel
from separatrix.told import ranking
from separatrix.told.answer import in_words, whereabouts
from separatrix.told.cage import judgement_facts
from separatrix.told.sensitivity import marks
from separatrix.told.sentences import verdict_sentences
from separatrix.verdict.judgement import Judgement, KickCount, Verdict
from separatrix.verdict.ranking_records import NotFinished, NotMeasured, Ranked, RankedEnvironment, Ranking
from separatrix.verdict.reasons import CageMotion

STUDY = read_study("cryogenic-turbopump")


def kick(speed: float, settles: int) -> KickCount:
    """Return 64 runs from a kick."""
    given = dict.fromkeys(("rolls", "whirls", "drifts", "unresolved", "kept_by_land"), 0)
    shares = {f"probability_{name}": 0.9 for name in ("stable", "low", "high")}
    return KickCount(kick=speed, settles=settles, **given, **shares)


JUDGEMENT = Judgement(
    verdict=Verdict.STABLE,
    probability_stable=0.95,
    probability_low=0.9,
    probability_high=0.98,
    worst_kick=0.1,
    by_kick=(kick(0.1, 64), kick(2.0, 61)),
    reason="So it is.",
    ball="damper",
    cage_motion=CageMotion.ON_THE_LAND,
    growth_rate=-16.04,
    growth_rate_low=-17.0,
    growth_rate_high=-15.1,
    largest_offset=4e-3,
    mean_offset=2e-4,
    orbit_evenness=0.02,
    drift_rate=1.97,
    drift_rate_law=0.0,
    largest_contact_force=80.0,
    largest_land_force=5.0,
    force_limit=90.0,
    force_exceeds_races=False,
    left_pocket=0,
    pocket_impact_shares=(0.1, 0.7, 0.1, 0.1),
    land_impact_share=0.4,
    whirl_frequency=1445.0,
    whirl_direction=-1,
    whirl_ratio=-3.0,
    drive_energy=1.4e-3,
    end_energy=2e-5,
    pocket_power=3e-3,
    land_power=-0.03,
    rubbing_force=5.2,
    rubbing_speed=6.0,
    rubbing_power=0.0312,
    impact_rate=1200.0,
    energy_imbalance=0.0,
    duration=0.3,
    longest_run=0.6,
    runs=64,
)


def row(name: str, rank: int, verdict: Verdict = Verdict.STABLE, **changes: object) -> Ranked:
    """Return one candidate's row."""
    one = Ranked(
        name=name,
        friction=0.1,
        friction_error=0.01,
        friction_deviation=None,
        probability_lowest_friction=0.5,
        friction_scatter_assumed=False,
        extrapolation=(),
        cage_mass=0.025,
        ball_cage_stiffness=3e6,
        pocket_clearance=6e-4,
        land_clearance=1e-3,
        restitution_factor=0.3,
        restitution_threshold=0.6,
        restitution_threshold_low=0.55,
        restitution_threshold_high=0.64,
        margin=0.3,
        rank=rank,
        within_reach=True,
        judgement=replace(JUDGEMENT, verdict=verdict),
        reason="So it is.",
    )
    return replace(one, **changes)


def unfinished(name: str, judgement: Judgement | None = None) -> NotFinished:
    """Return a row that an interrupt left without a rank."""
    names = {f.name for f in fields(NotFinished)} - {"judgement", "reason"}
    known = {key: getattr(row(name, 1), key) for key in names}
    return NotFinished(**known, judgement=judgement, reason="interrupted")


MISSING = NotMeasured(name="D", reason="not measured in air")


def found(*rows, names=("air",)) -> Ranking:
    """Return a ranking with the same rows in each environment and overall."""
    pocket = PocketConditions(**{f.name: 1.0 for f in fields(PocketConditions)})
    return Ranking(
        environment="air",
        candidate="A",
        restitution_factor=0.3,
        restitution_factor_free_spin=0.3,
        ball_cage_stiffness=3e6,
        pocket=pocket,
        friction_scatter=0.09,
        solid_lubrication_limit=0.6,
        paper_statement="It is written.",
        environments=tuple(RankedEnvironment(name=name, materials=rows) for name in names),
        overall=rows,
        stability=None,
        own_eta=None,
        own_curves=None,
        kicks=(0.1, 2.0),
        runs=64,
        duration=0.3,
        ball_model=BallModel.DAMPER,
        motion_model=MotionModel.PLANE,
        capacity=100.0,
        complete=True,
    )


def text(*rows, names=("air",), **options) -> str:
    """Return the printed ranking."""
    answer = SimpleNamespace(ranking=found(*rows, names=names))
    return in_words("rank", answer, STUDY, ["A note."], **options)


def test_tied_ranks_are_marked():
    """Two candidates within the scatter share a rank, and each shows it."""
    lines = ranking.verdicts([row("A", 1), row("B", 1), row("C", 3)]).splitlines()[-3:]
    assert [line.split()[0] for line in lines] == ["1=", "1=", "3"]


@pytest.mark.parametrize(
    ("one", "cells"),
    [
        (MISSING, "- D - - - - not measured"),
        (unfinished("A"), "- A 0.100 - - - not finished"),
        (unfinished("A", JUDGEMENT), "- A 0.100 - - 0.95 (0.90 to 0.98) STABLE"),
    ],
)
def test_what_is_missing_has_dashes_not_numbers(one, cells):
    """Not measured, interrupted before the verdict, or before the threshold."""
    assert ranking.verdicts([one]).splitlines()[-1].split() == cells.split()
    assert one.name in text(one)


def test_extrapolated_frictions_are_marked_and_explained_once():
    """A mark in the row; below, each sentence once, with names where it does not hold for all."""
    rows = [row("A", 1, extrapolation=("too fast", "too hot")), row("B", 2, extrapolation=("too fast",))]
    lines = ranking.verdicts([*rows, row("C", 3)]).splitlines()[-3:]
    assert [line.split()[2][-1] for line in lines] == ["*", "*", "0"]
    assert ranking.footnotes(rows) == ["  * extrapolated beyond the tests: too fast. too hot (A)."]
    assert ranking.footnotes([row("C", 3)]) == []


def test_a_friction_alone_has_no_probability_of_being_the_lowest():
    """The line gives the reason; with another it has the numbers; without any measurement there is none."""
    start = "  Probability of the lowest mean friction:"
    alone = [row("A", 1, probability_lowest_friction=None), MISSING]
    assert ranking.lowest(alone) == [f"{start} none, for only A was measured here."]
    assert ranking.lowest([row("A", 1), row("C", 1)]) == [f"{start} C 0.50, A 0.50."]
    assert ranking.lowest([MISSING]) == []


def test_the_mark_of_an_assumed_scatter_explains_the_cell():
    """The guess is of the scatter between samples; the per cent in the cell is of more than that."""
    known = SimpleNamespace(friction_scatter_assumed=True, extrapolation=())
    (note,) = marks(SimpleNamespace(environments=[SimpleNamespace(materials=[known])], default_scatter=0.09))
    assert "? its scatter from sample to sample was not measured: 9 % of the mean" in " ".join(note.split())
    assert "The per cent beside a friction is the whole scatter" in " ".join(note.split())


def test_the_evidence_is_beside_each_candidate():
    """Motion, growth rate with its interval, offset in mm, drift, both forces, whirl, whirl ratio."""
    one_run = row("B", 2, judgement=replace(JUDGEMENT, growth_rate_low=None))
    lines = ranking.evidence([row("A", 1), one_run, MISSING]).splitlines()[-3:]
    assert " ".join(lines[0].split()) == "A ON THE LAND -16 (-17 to -15.1) 4.000 2 80 5 1445 backward -3.00"
    assert lines[1].split()[4:6] == ["-16", "4.000"]
    assert lines[2].split() == ["D", *"--------"]


def test_the_bearings_restitution_factor_is_shown_where_candidates_differ_in_it():
    """One column more, as soon as the pockets differ."""
    alike = ranking.evidence([row("A", 1), row("B", 2)])
    differ = ranking.evidence([row("A", 1), row("B", 2, restitution_factor=0.5)])
    assert "bearing's" not in alike
    assert "bearing's" in differ
    assert "0.50" in differ.splitlines()[-1]


def test_no_verdict_is_shown_without_its_evidence():
    """In each environment: a table of verdicts, then runs, their length, kicks, and the evidence."""
    asked = found(row("A", 1))
    there = ranking.environment(asked, asked.environments[0])
    assert "  Evidence: 64 runs of 300 ms from each kick, 0.1, 2 m/s" in there
    assert there.index("verdict") < there.index("Evidence") < there.index("ON THE LAND")


def test_gaps_in_the_measurements_are_listed():
    """Who was measured in fewer than all environments; nothing where all were in all."""
    assert ranking.gaps(found(row("A", 1), MISSING))[1].endswith("1 environments: D in 0.")
    assert ranking.gaps(found(row("A", 1))) == []


def test_candidates_with_one_reason_share_it():
    """Equal frictions have equal reasons: printed once."""
    assert ranking.reasons([row("A", 1), row("B", 1)]) == ["  A, B: So it is."]


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (
            [row("A", 1), row("B", 2), row("C", 3, Verdict.UNSTABLE), MISSING],
            "A ranks first in air: STABLE. The cage remains stable up to a restitution factor of 0.60 (0.55 "
            "to 0.64); this bearing and film have 0.30, a margin of +0.30. The others: STABLE B; UNSTABLE C; "
            "not measured D.",
        ),
        (
            [row("A", 1), row("B", 1, Verdict.UNDECIDED, margin=0.2, restitution_factor=0.4)],
            "2 materials tie for first in air: STABLE A; UNDECIDED B. From the reference kick the "
            "largest stable restitution factor is 0.60; this bearing and film have 0.30 to 0.40, a margin of "
            "+0.20 to +0.30. There is no other candidate.",
        ),
        (
            [row("A", 1, Verdict.UNDECIDED), row("B", 2)],
            "A ranks first in air: UNDECIDED. From the reference kick the largest stable restitution "
            "factor is 0.60 (0.55 to 0.64); this bearing and film have 0.30, a margin of +0.30. A: So it is. "
            "The others: STABLE B.",
        ),
        ([MISSING], "No candidate was ranked in air."),
    ],
)
def test_the_answer_in_short(rows, words):
    """Who is first, with verdict and margin, why if undecided, and others; nobody if none was measured."""
    assert " ".join(text(*rows).split("\n\n")[1].split()) == words


def test_the_report_says_why_the_first_is_undecided():
    """With all of its reason, in the sentence of its margin."""
    numbers = {"restitution_threshold": 0.6, "restitution_factor": 0.3, "margin": 0.3, "rank": 1, "name": "A"}
    numbers |= {"restitution_threshold_low": 0.5, "restitution_threshold_high": 0.7, "reason": "So it is."}
    for verdict, ends in (("UNDECIDED", "+0.30. A: So it is."), ("STABLE", "a margin of +0.30.")):
        rows = [numbers | {"verdict": verdict}]
        assert verdict_sentences(rows, "air")[1].endswith(ends)


def test_a_ranking_fits_a_screen():
    """Seven materials in four environments: 60 lines at most, the own environment alone, a reason once."""
    given = {"extrapolation": ("too fast",), "reason": "No clear answer " * 12}
    rows = [row(f"Material {i}", i + 1, Verdict.UNDECIDED, **given) for i in range(7)]
    printed = text(*rows, names=("liquid nitrogen", "air", "vacuum", "helium"))
    assert len(printed.splitlines()) <= 60
    assert max(map(len, printed.splitlines())) <= 96
    assert printed.index("Material 0 ranks first in air") < printed.index("Air\n---")
    assert "Liquid nitrogen\n---" not in printed
    assert " ".join(printed.split()).count("No clear answer " * 12) == 1
    for words in ("64 runs of 300 ms from each kick", "largest", "drift", "pocket", "land", "Note: A note."):
        assert words in printed


def test_quiet_leaves_the_table():
    """The bearing's own environment and nothing else: no notes, no evidence."""
    printed = text(row("A", 1), quiet=True)
    assert printed.startswith("Air\n---")
    assert len(printed.splitlines()) == 6
    assert "A note" not in printed


def test_where_the_files_are():
    """`check --out` writes its text and document only; of a ranking one picture is the first to open."""
    assert whereabouts("check", "there") == "This text and the document are in there/\n"
    assert whereabouts("map", "there") == "Figures and data are in there/\n"
    assert whereabouts("rank", "there", overview=True).endswith("(begin with rank-overview.png)\n")


def lines(**changes: object) -> dict[str, str]:
    """Return the lines on this judgement, by label."""
    return dict(judgement_facts(replace(JUDGEMENT, **changes), "So it is."))


@pytest.mark.parametrize(
    ("label", "words", "changes"),
    [
        ("Verdict", "STABLE. So it is.", {}),
        ("P(stable)", "0.95 (95 %: 0.90 to 0.98)", {}),
        ("Growth rate", "-16 1/s (95 %: -17 to -15.1), from 0.1 m/s, the worst kick", {}),
        (
            "Growth rate",
            "-16 1/s (one run: no interval), from 0.1 m/s, the worst kick",
            {"growth_rate_low": None},
        ),
        ("Offset", "4 mm at most; 200 um at the end, relative spread 0.02", {}),
        ("Drift rate", "1.97 1/s", {}),
        ("Drift rate", "1.97 1/s; by the linear law 2.04 1/s", {"drift_rate_law": 2.04}),
        ("Largest forces", "80 N, at a pocket; 5 N at the land", {}),
        (
            "Largest forces",
            "above what the races hold, 60 N, at a pocket; 5 N at the land",
            {"force_limit": 60.0, "force_exceeds_races": True},
        ),
        ("Ball", "damper. The study asks for it.", {}),
        (
            "Left its pocket",
            "in 3 of 128 runs a ball reached the edge of its pocket's wall",
            {"left_pocket": 3},
        ),
        (
            "Impacts",
            "pocket 2 takes 70 % of the impacts at pockets (even share 25 %); "
            "40 % of all impacts are at the land",
            {},
        ),
        ("Impacts", "none at a pocket, all at the land", {"pocket_impact_shares": (0.0,) * 4}),
        (
            "Impacts",
            "none at a pocket, none at the land",
            {"pocket_impact_shares": (0.0,) * 4, "land_impact_share": 0.0},
        ),
        (
            "Whirl",
            "1.445 kHz backward, seen from the balls; the centre orbits at -3.00 of the ball set's speed",
            {},
        ),
        ("Whirl", "1.445 kHz backward; the ball set is at rest", {"whirl_ratio": None}),
        ("Energy at the end", "20 uJ; frame and loads alone can supply 1.4 mJ", {}),
        ("Friction power", "pocket feeds 3 mW, land takes 30 mW", {}),
        ("Rubbing on the land", "5.2 N at 6 m/s, 31.2 mW of heat", {}),
        ("Runs", "64 from each kick, of up to 600 ms", {}),
        ("Motion", "unresolved in most runs", {"cage_motion": None}),
    ],
)
def test_a_verdict_comes_with_its_evidence(label, words, changes):
    """Largest offset, drift, forces, growth with its interval, whirl, impacts, length and number of runs."""
    assert lines(**changes)[label] == words


def test_a_cage_that_does_not_rub_has_no_line_for_it():
    """Nothing instead of zeros."""
    assert "Rubbing on the land" not in lines(rubbing_force=0.0)
