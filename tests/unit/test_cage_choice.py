"""One cage and one environment for every verb: what a study names, and what it must say."""

from dataclasses import replace

import pytest

from separatrix.chain.solution import solve
from separatrix.ground.errors import InputError
from separatrix.study.candidates import other_than_candidates, require_friction, required_environment
from separatrix.study.reading import read_study

OTHERS = """extends = "cryogenic-turbopump"
[cage]
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
    path = tmp_path / "case.toml"
    path.write_text(OTHERS.format(cage=cage, fluid=fluid, ranking=ranking))
    return read_study(path)


def extended(tmp_path, text):
    """The shipped study with some lines changed."""
    path = tmp_path / "case.toml"
    path.write_text('extends = "cryogenic-turbopump"\n' + text)
    return read_study(path)


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


LOX = '[operation]\nfluid = "LOX"\n'


def test_an_environment_that_nothing_matches_must_be_said(tmp_path):
    """Liquid oxygen is not liquid nitrogen; the refusal lists what there is, and a given one serves."""
    study = extended(tmp_path, LOX + '[cage]\nmaterial = "Armalon"\n')
    with pytest.raises(InputError, match=r'environment is missing.*or "liquid nitrogen, 440C"'):
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
    with pytest.raises(InputError, match=r'"Vespel SP 211" is not a candidate.*My compound, Other'):
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
