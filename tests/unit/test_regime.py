"""Where the boundary may bend: the land's play against that of the pockets, over the range of a study."""

from __future__ import annotations

import numpy as np
import pytest

from separatrix.distribution import Normal, Samples, Uniform
from separatrix.draws import uncertain_inputs
from separatrix.study_file import read_study
from separatrix.study_numbers import with_distributions
from separatrix.uncertainty.regime import BENDS, play_of
from separatrix.uncertainty.training import changed_cage, drawn, moving_inputs

BASE = read_study("cryogenic-turbopump")
"""Land 1 mm, pockets 0.6 mm."""

MASS = {"cage.mass": Normal(mean=0.025, standard_deviation=0.001)}
CROSSING = {"cage.land_clearance": Uniform(low=0.4e-3, high=1e-3)}


def found(laws, study=BASE):
    """Study, inputs, names of those that move the cage, and where its boundary bends."""
    uncertain = with_distributions(study, laws)
    inputs = uncertain_inputs(uncertain)
    names = moving_inputs(uncertain, inputs, 0)
    cage = changed_cage(uncertain, 0).cage
    return cage, inputs, names, play_of(cage, names, {one.key: one.distribution for one in inputs})


@pytest.mark.parametrize(
    ("laws", "bends"),
    [
        (MASS, 0),
        ({"cage.land_clearance": Uniform(low=0.8e-3, high=1e-3)}, 0),
        ({"cage.land_clearance": Uniform(low=0.62e-3, high=1e-3)}, 2),
        (CROSSING, 4),
        (CROSSING | {"cage.pocket_clearance": Uniform(low=0.4e-3, high=0.8e-3)}, 5),
        ({"cage.pocket_clearance": Samples(values=(0.0, 0.6e-3))}, 0),
    ],
)
def test_the_boundary_bends_only_where_the_clearances_reach(laws, bends):
    """Bends lie at ratios of 1.16, 1.08, 1, 0.82 and 0.6: each counts if samples lie on both sides of it."""
    play = found(laws)[3]
    assert (0 if play is None else play.bends.size) == bends


def test_a_cage_without_a_land_has_no_bend(tmp_path):
    """Whatever its pockets are."""
    path = tmp_path / "case.toml"
    path.write_text(
        'extends = "cryogenic-turbopump"\n[cage]\nguidance = "ball"\n'
        'pocket_clearance = { between = ["0.4 mm", "2 mm"] }\n',
        encoding="utf-8",
    )
    study = read_study(path)
    assert found(dict(study.distributions), study)[3] is None


def test_hinges_begin_at_their_bends():
    """Nothing on a wide land; below a bend as far as the logarithm of the ratio lies below it."""
    _, _, names, play = found(MASS | CROSSING)
    ratios = np.array([1.5, 1.16, 0.9, 0.7])
    parameters = np.stack([np.full(4, 0.025), ratios * 0.6e-3], axis=1)
    assert names == ("cage.mass", "cage.land_clearance")
    assert play.ratio(parameters) == pytest.approx(np.log(ratios), abs=1e-15)
    bends = np.array([1.16, 1.08, 1.0, 0.82])
    expected = np.log(np.maximum(bends / ratios[:, None], 1.0))
    assert play.hinges(parameters) == pytest.approx(expected, abs=1e-15)


def test_the_curve_of_a_tight_land_is_traced_where_the_land_is_hardly_felt():
    """At the first bend; a wide land stays as it is."""
    cage, _, _, play = found({"cage.land_clearance": Uniform(low=0.3e-3, high=0.8e-3)})
    assert cage.land_clearance == pytest.approx(0.55e-3)
    assert play.opened(cage).land_clearance == pytest.approx(np.exp(BENDS[0]) * 0.6e-3)
    wide, _, _, play = found({"cage.land_clearance": Uniform(low=0.6e-3, high=1.4e-3)})
    assert play.opened(wide) is wide


@pytest.mark.parametrize("low", [0.3e-3, 0.66e-3])
def test_both_sides_of_the_first_bend_have_their_cages(low):
    """At least half as many as were asked for, and those that were asked for come first."""
    _, inputs, names, play = found({"cage.land_clearance": Uniform(low=low, high=1e-3)})
    plain = drawn(inputs, names, 64, None, 5)
    values = drawn(inputs, names, 64, play, 5)
    assert (values[:64] == plain).all()
    bent = play.hinges(values[:, [0]])[:, 0] > 0.0
    assert np.count_nonzero(bent) >= 32
    assert np.count_nonzero(~bent) >= 32
    assert len(values) <= 96
