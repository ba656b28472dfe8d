"""What the chain takes from a study, and what it refuses."""

from dataclasses import replace

import pytest
from commands import extended

from separatrix import InputError, read_study, solve
from separatrix.cage import MovingCage, moving_cage, settings_for
from separatrix.chain.impact_restitution import ball_pocket_stiffness, hertz_coefficient
from separatrix.study.candidates import other_than_candidates, require_friction, required_environment
from separatrix.study.study import (
    Candidate,
    Film,
    Friction,
    Guidance,
    KinematicModel,
    Kinematics,
    Material,
    MotionModel,
    PocketContact,
    PocketShape,
    StabilitySettings,
)

STUDY = read_study("cryogenic-turbopump")
POLYMER = Material(name="polymer", elastic_modulus=5e9, poisson_ratio=0.4)


def study(**changes):
    """The shipped study with one part changed."""
    return replace(STUDY, **changes)


def cage(**changes):
    """Its cage with one field changed."""
    return study(cage=replace(STUDY.cage, **changes))


def moving(asked) -> MovingCage:
    """The moving cage of a study, without friction."""
    return moving_cage(solve(asked), 0.0)


CONTROLLED = Kinematics(model=KinematicModel.OUTER_RACE_CONTROL)
BARE = study(film=Film(race_friction=0.0), kinematics=CONTROLLED)
STILL = study(operation=replace(STUDY.operation, inner_speed=0.0))
NAMELESS = cage(ball_cage_stiffness=None, material=None, material_name=None)
REFUSED = [
    (STILL, "traction", "inner_speed must differ from outer_speed"),
    (STILL, "restitution", "inner_speed must differ from outer_speed"),
    (STILL, "mobility", "inner_speed must differ from outer_speed"),
    (BARE, "traction", "race_friction must be > 0"),
    (BARE, "mobility", "race_friction must be > 0"),
    (study(cage=None), "restitution", r"lacks the section \[cage\]"),
    (NAMELESS, "ball_cage_stiffness", r"ball_cage_stiffness is missing.*elastic_modulus"),
]


@pytest.mark.parametrize(("asked", "link", "rule"), REFUSED)
def test_a_link_of_the_chain_that_cannot_be_is_refused(asked, link, rule):
    """Where it is asked for: the equilibrium is there."""
    with pytest.raises(InputError, match=rule):
        getattr(solve(asked), link)
    assert solve(asked).bearing.inner.load > 0.0


def test_pocket_stiffness_is_the_given_one_or_hertz_at_the_impact_speed():
    """A given stiffness wins; else the candidate's material, else the cage's."""
    polymer = Candidate(name="polymer", material=POLYMER, friction={"vacuum, 440C": Friction(mean=0.1)})
    given = solve(STUDY, polymer)
    assert (given.ball_cage_stiffness, given.stiffness_source) == (3e6, "given in the study")
    ball = STUDY.bearing.ball_diameter, STUDY.bearing.ball_material
    expected = ball_pocket_stiffness(*ball, POLYMER, cage_mass=STUDY.cage.mass, impact_speed=0.5)
    other = replace(POLYMER, name="other", elastic_modulus=9e9)
    own = cage(ball_cage_stiffness=None, impact_speed=0.5, material=POLYMER)
    assert solve(own).ball_cage_stiffness == expected
    asked = solve(replace(own, cage=replace(own.cage, material=other)), polymer)
    assert asked.ball_cage_stiffness == expected
    assert asked.stiffness_source == "Hertz, ball on a flat wall of polymer at 0.5 m/s"


def test_default_kicks_scale_with_the_bearing():
    """0.5, 2.5 and 10 times cage speed times half the pocket clearance, to three digits."""
    found = moving(STUDY)
    speed, settings = found.cage_speed * STUDY.cage.pocket_clearance / 2, settings_for(STUDY.stability, found)
    assert settings.kicks == pytest.approx([0.5 * speed, 2.5 * speed, 10 * speed], rel=5e-3)
    assert settings.reference_kick == settings.kicks[1] == float(f"{2.5 * speed:.3g}")
    assert settings_for(settings, found) == settings


@pytest.mark.parametrize(
    ("given", "kicks", "reference"),
    [
        ({"kicks": (0.1, 0.5, 2.0)}, (0.1, 0.5, 2.0), None),
        ({"kicks": (2.0, 4.0)}, (2.0, 4.0), None),
        ({"kicks": (0.1, 2.0), "reference_kick": 0.7}, (0.1, 2.0), 0.7),
        ({"reference_kick": 1.0}, (0.2, 1.0, 4.0), 1.0),
    ],
)
def test_given_kicks_stay(given, kicks, reference):
    """The reference is the given one, or the bearing's own; pocket speeds count as 0.02 m/s or more."""
    reference = reference or settings_for(STUDY.stability, moving(STUDY)).reference_kick
    found = settings_for(StabilitySettings(**given), moving(STUDY))
    assert (found.kicks, found.reference_kick) == (kicks, reference)
    slow = settings_for(StabilitySettings(), replace(moving(STUDY), cage_speed=0.0))
    assert (slow.kicks, slow.reference_kick) == ((0.01, 0.05, 0.2), 0.05)


def test_eta_does_not_move_with_the_list_of_kicks():
    """Phenolic's eta fell from 0.42 to 0.28 with kicks of 2 and 3 m/s: a property of the bearing must not."""
    soft = cage(ball_cage_stiffness=None, material=POLYMER)
    hard = replace(soft, stability=StabilitySettings(kicks=(2.0, 3.0)))
    assert solve(hard).restitution == solve(soft).restitution


def test_the_chain_of_a_study_is_solved_once():
    """What does not depend on the cage is the same object for every cage, and for another study like it."""
    known = solve(STUDY).traction
    heavier = replace(STUDY, cage=replace(STUDY.cage, mass=0.03))
    assert solve(heavier).traction is known
    thicker = replace(STUDY, film=replace(STUDY.film, thickness=2.0 * STUDY.film.thickness))
    assert solve(thicker).traction is not known
    assert solve(thicker).bearing is solve(STUDY).bearing
    with pytest.raises(ValueError, match="read-only"):  # or the next caller would get what was written
        solve(STUDY).bearing.equilibrium.load_inner[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        known.inner.traction_coefficient[0] = 0.0
    bare = study(film=Film(race_friction=0.1))
    assert solve(bare).lubrication is None  # which film it would be is not known


def test_the_cage_in_the_plane_takes_the_design_as_it_is():
    """Pockets, scatter, land and start-up arrive unchanged."""
    pocket = {"pocket_axial_clearance": 4e-4, "pocket_axial_offset": 5e-5}
    scatter = {"pocket_spacing_scatter": 0.05, "pocket_position_scatter": 1e-5, "ball_diameter_scatter": 1e-6}
    land = {"guidance": Guidance.INNER, "land_clearance": 8e-4, "land_friction": 0.15, "land_count": 2}
    land |= {"land_out_of_round": 2e-5, "land_lobes": 3, "unbalance": 1e-6, "gravity": 9.81}
    flat = {"pocket_shape": PocketShape.ELONGATED, "motion": MotionModel.PLANE}
    changes = {**flat, **pocket, **scatter, **land}
    started = replace(STUDY.operation, ramp_time=0.05, ramp_start=0.2)
    found = moving(replace(cage(**changes), operation=started))
    assert {name: getattr(found, name) for name in changes} == changes
    assert (found.ramp_time, found.ramp_start, found.hertz_coefficient) == (0.05, 0.2, None)
    angles = tuple(0.1 + 0.483 * j for j in range(13))
    assert moving(cage(pocket_angles=angles)).pocket_angles == angles


def test_hertz_contact_has_the_coefficient_of_the_material_or_stores_the_impact_of_a_stiffness():
    """Given k = 0.8 K sqrt(depth), where 0.4 K depth^2.5 is the energy at the impact speed; rounding."""
    soft = cage(ball_cage_stiffness=None, material=POLYMER, pocket_contact=PocketContact.HERTZ)
    expected = hertz_coefficient(STUDY.bearing.ball_diameter, STUDY.bearing.ball_material, POLYMER)
    assert moving(soft).hertz_coefficient == pytest.approx(expected, rel=1e-12)
    found = moving(cage(impact_speed=0.5, pocket_contact=PocketContact.HERTZ))
    K, energy = found.hertz_coefficient, 0.5 * found.mass * 0.5**2
    depth = (2.5 * energy / K) ** 0.4
    assert 0.8 * K * depth**0.5 == pytest.approx(3e6, rel=1e-12)  # rounding
    assert 0.5 * 3e6 * depth**2 == pytest.approx(energy, rel=1e-12)  # rounding


def test_a_stiffness_by_hertz_in_a_bore_says_that_it_is_of_a_flat_wall():
    """0.6 mm on 11.1 mm is 2.1 times as stiff; flat walls and a stated stiffness have no note."""
    bore = {"pocket_shape": PocketShape.CYLINDRICAL, "motion": MotionModel.SPACE}
    by_hertz = {"ball_cage_stiffness": None, "material": POLYMER}
    for changes, count in ((bore | by_hertz, 1), (bore, 0), (by_hertz, 0)):
        found = solve(cage(**changes))
        assert found.ball_cage_stiffness > 0.0
        notes = [note for note in found.notes if "flat wall" in note]
        assert len(notes) == count
    found = solve(cage(**bore | by_hertz))
    assert not found.notes  # before the stiffness is computed
    assert found.ball_cage_stiffness > 0.0
    assert "A bore with a clearance of 600 um is 2.1 times as stiff" in found.notes[-1]


# One cage and one environment for every verb: what a study names, and what it must say.

OTHERS = """[cage]
{cage}
[operation]
fluid = "{fluid}"
[ranking]
{ranking}
[[ranking.candidates]]
name = "My compound"
friction = {{ "LN2, AISI 440C" = 0.3, "air, 440c" = 0.2 }}
material = {{ elastic_modulus = "3 GPa", poisson_ratio = 0.4 }}
[[ranking.candidates]]
name = "Other"
friction = {{ "LN2, AISI 440C" = 0.1, "air, 440c" = 0.4 }}
"""


def case(tmp_path, cage='material = "My compound"', fluid="liquid nitrogen", ranking=""):
    """A study with two candidates of its own."""
    return extended(tmp_path, OTHERS.format(cage=cage, fluid=fluid, ranking=ranking))


def test_a_cage_of_another_material_says_whose_curve_is_shown(tmp_path):
    """The first candidate's; nothing is said where the cage is one of them."""
    other = "material = { elastic_modulus = '9 GPa', poisson_ratio = 0.3, name = 'Bronze' }"
    for cage, said in ((other, "[cage] material Bronze is none of the candidates: the curve"), (None, "")):
        study = case(tmp_path, **({} if cage is None else {"cage": cage}))
        words = other_than_candidates(study, study.ranking)
        assert words.startswith(said)
        assert bool(words) is bool(said)
        assert not words or words.endswith("are those of My compound.")


@pytest.mark.parametrize("name", ["Armalon", "armalon", "Meldin HTC 100", "meldin htc-100"])
def test_the_cage_material_names_the_candidate(tmp_path, name):
    """Its friction in the environment of the bearing, not that of the first candidate on another steel."""
    study = extended(tmp_path, f'[cage]\nmaterial = "{name}"\n')
    assert study.ranking.environment == "liquid nitrogen, 440C"
    assert solve(study).friction.mean == (0.32 if name[0] in "Mm" else 0.08)


def test_the_cage_may_be_a_candidate_that_no_library_has(tmp_path):
    """With the candidate's own modulus for the pocket's stiffness."""
    study = case(tmp_path)
    assert solve(study).friction.mean == 0.3
    assert study.cage.material == study.ranking.candidates[0].material
    soft = replace(study, cage=replace(study.cage, ball_cage_stiffness=None))
    assert solve(soft).stiffness_source.startswith("Hertz")


@pytest.mark.parametrize(
    ("fluid", "environment"),
    [("LN2", "LN2, AISI 440C"), ("liquid nitrogen", "LN2, AISI 440C"), ("Air", "air, 440c")],
)
def test_the_environment_is_found_by_identity(tmp_path, fluid, environment):
    """Fluid and steel by any of their names."""
    study = case(tmp_path, fluid=fluid)
    assert required_environment(study, study.ranking) == environment


def test_the_only_environment_is_that_of_the_study(tmp_path):
    """Without fluid and steel to match; its origin no longer reads that none fits the bearing."""
    lines = '[ranking]\n[[ranking.candidates]]\nname = "A"\nfriction = { "vacuum, 440C" = 0.1 }\n'
    study = extended(tmp_path, lines)
    assert study.ranking.environment == "vacuum, 440C"
    assert study.origins["ranking.environment"].startswith("the only one")


LOX = '[operation]\nfluid = "LOX"\n'


def test_an_environment_that_nothing_matches_must_be_said(tmp_path):
    """Liquid oxygen is not liquid nitrogen; the refusal lists what there is, and a given one serves."""
    study = extended(tmp_path, LOX + '[cage]\nmaterial = "Armalon"\n')
    where = r"^cryogenic-turbopump\.toml, line \d+: \[ranking\] environment is missing"
    with pytest.raises(InputError, match=where + r'.*or "liquid nitrogen, 440C"'):
        required_environment(study, study.ranking)
    with pytest.raises(InputError, match="environment is missing"):
        require_friction(study)
    given = LOX + '[ranking]\nenvironment = "Liquid Nitrogen, 440c"\n'
    assert extended(tmp_path, given).ranking.environment == "liquid nitrogen, 440C"
    with pytest.raises(InputError, match=r"\[ranking\] environment must be one .*liquid nitrogen, 440C"):
        extended(tmp_path, '[ranking]\nenvironment = "vacuum"\n')


def test_a_cage_that_is_no_candidate_must_have_its_friction_said(tmp_path):
    """The refusal lists the candidates, and for a name that nobody has the library; one candidate serves."""
    study = case(tmp_path, 'material = "Vespel SP 211"')
    with pytest.raises(InputError, match=r'toml, line \d+: .* "Vespel SP 211" is not .*My compound, Other'):
        require_friction(study)
    given = case(tmp_path, 'material = "Armalon"\nball_cage_friction = 0.2')
    assert solve(given).friction.mean == 0.2
    nameless = replace(study, cage=replace(study.cage, material=None, material_name=None))
    with pytest.raises(InputError, match=r"does not name a candidate.*My compound, Other"):
        require_friction(nameless)
    alone = replace(nameless, ranking=replace(study.ranking, candidates=study.ranking.candidates[1:]))
    require_friction(alone)
    assert solve(alone).friction.mean == 0.1
    unknown = r"is not a cage material of the library.*Candidates are My compound"
    with pytest.raises(InputError, match=unknown):
        case(tmp_path, 'material = "Unobtainium"')


@pytest.mark.parametrize(
    "text",
    [
        '[bearing]\nball_material = "silicon nitride"\nring_material = "440c"\n',
        '[operation]\nfluid = "LO2"\n[ranking]\nenvironment = "liquid nitrogen, 440C"\n',
        '[cage]\nguidance = "Inner ring"\nmaterial = "armalon"\n',
        '[kinematics]\nmodel = "Outer-race control"\n',
        '[film]\nmaterial = "ptfe transfer film"\n',
        '[ranking]\nfriction = "Pin-on-disk 77K"\nmaterials = ["vespel SP211"]\n',
    ],
)
def test_common_spellings_are_taken(tmp_path, text):
    """Case of letters, hyphens, spaces and the usual other names do not stop a user."""
    extended(tmp_path, text)
