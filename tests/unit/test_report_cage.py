"""What the text of a simulation and of a verdict says."""

from separatrix.report.cage import judgement_facts, orbit_facts, room_fact

JUDGEMENT = {
    "verdict": "UNDECIDED",
    "reason": "So it is.",
    "cage_motion": "ON THE LAND",
    "probability_stable": 0.95,
    "probability_low": 0.9,
    "probability_high": 0.98,
    "growth_rate": -16.04,
    "growth_rate_low": -17.0,
    "growth_rate_high": -15.1,
    "worst_kick": 0.1,
    "largest_offset": 4e-3,
    "mean_offset": 2e-4,
    "orbit_evenness": 0.02,
    "drift_rate": 1.97,
    "drift_rate_law": 0.0,
    "largest_contact_force": 80.0,
    "largest_land_force": 5.0,
    "pocket_impact_shares": [0.1, 0.7, 0.1, 0.1],
    "land_impact_share": 0.4,
    "whirl_frequency": 1445.0,
    "whirl_direction": -1,
    "whirl_ratio": -3.0,
    "drive_energy": 1.4e-3,
    "end_energy": 2e-5,
    "pocket_power": 3e-3,
    "land_power": -0.03,
    "rubbing_force": 5.2,
    "rubbing_speed": 6.0,
    "rubbing_power": 0.0312,
    "duration": 0.3,
    "longest_run": 0.6,
    "runs": 64,
}


def said(**change: object) -> dict[str, str]:
    """Return the lines on this judgement, by label."""
    return dict(judgement_facts(JUDGEMENT | change))


def test_a_verdict_comes_with_its_evidence():
    """Largest offset, drift, forces, growth with its interval, whirl, impacts, length and number of runs."""
    lines = said()
    assert lines["Verdict"] == "UNDECIDED. So it is."
    assert lines["Motion"].endswith(
        "rests on its land, or moves on it as loads and the land's friction make it"
    )
    assert lines["P(stable)"] == "0.95 (95 %: 0.90 to 0.98)"
    assert lines["Growth rate"] == "-16 1/s (95 %: -17 to -15.1), from 0.1 m/s, the worst kick"
    assert lines["Offset"] == "4 mm at most; 200 um at the end, relative spread 0.02"
    assert lines["Largest forces"] == "80 N at a pocket, 5 N at the land"
    assert lines["Impacts"] == (
        "pocket 2 takes 70 % of the impacts at pockets (even share 25 %); 40 % of all impacts are at the land"
    )
    assert lines["Whirl"] == (
        "1.445 kHz backward, seen from the balls; the centre orbits at -3.00 of the ball set's speed"
    )
    assert lines["Energy at the end"] == "0.02 mJ; frame and loads alone can give 1.4 mJ"
    assert lines["Friction power"] == "pocket feeds 3 mW, land takes 30 mW"
    assert lines["Rubbing on the land"] == "5.2 N at 6 m/s, 31.2 mW of heat"
    assert lines["Runs"] == "64 from each kick, of up to 600 ms"


def test_the_drift_of_a_cage_without_a_land_stands_beside_the_law():
    """Measured alone with a land, both without."""
    assert said()["Drift rate"] == "1.97 1/s"
    assert said(drift_rate_law=2.04)["Drift rate"] == "1.97 1/s; by the linear law 2.04 1/s"


def test_what_is_absent_is_said_in_words():
    """One run has no interval, a ball set at rest no whirl ratio, a cage that meets nothing no impacts."""
    lines = said(
        growth_rate_low=None, whirl_ratio=None, pocket_impact_shares=[0.0] * 4, land_impact_share=0.0
    )
    assert "(one run: no interval)" in lines["Growth rate"]
    assert lines["Whirl"].endswith("the ball set is at rest")
    assert lines["Impacts"] == "none at a pocket, none at the land"
    assert said(pocket_impact_shares=[0.0] * 4, land_impact_share=1.0)["Impacts"].endswith("all at the land")


def test_the_orbit_of_a_run_is_read_from_the_part_by_which_it_is_judged():
    """Mean and spread of 3 and 5 mm, not of the 1 m before."""
    run = {
        "time": [0.0, 0.5, 0.79, 0.8, 1.0],
        "position": [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [3e-3, 0.0], [0.0, -5e-3]],
        "largest_offset": 1.0,
        "drift_rate": 1.97,
        "drift_rate_law": 2.04,
        "judged_from": 0.8,
        "judged_until": 1.0,
    }
    lines = dict(orbit_facts(run))
    assert lines["Mean offset at the end"] == "4 mm, since 800 ms"
    assert lines["Relative spread"] == "0.25 (0: a circle about the axis)"
    assert lines["Drift rate"] == "1.97 1/s; by the linear law 2.04 1/s"


def test_the_offset_is_compared_with_land_and_pockets():
    """Both clearances as radii; or that of the pockets alone."""
    run = {"cage": {"guidance": "outer", "land_clearance": 1e-3}, "chain": {"half_play": 3e-4}}
    assert room_fact(run) == ("Clearance", "outer land 500 um radial, pockets 300 um each way")
    run["cage"]["guidance"] = "ball"
    assert room_fact(run)[1] == "pockets 300 um each way; no land"
