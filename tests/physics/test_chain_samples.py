"""The chain on samples of its inputs: the chain itself to the last bit, propagation, failures, workers."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest

from separatrix import chain
from separatrix.distribution import Normal, Samples
from separatrix.draws import sample
from separatrix.errors import InputError
from separatrix.orbit import HIGHEST
from separatrix.ranking.friction import conditions_of
from separatrix.study import KinematicModel
from separatrix.study_file import read_study
from separatrix.study_numbers import study_numbers, value_of, with_distributions, with_values
from separatrix.uncertainty import chain_samples as module
from separatrix.uncertainty.chain_samples import CHUNK, INTERRUPTED, chain_samples

BASE = read_study("cryogenic-turbopump")
VARIED = (
    "film.thickness",
    "film.elastic_modulus",
    "film.race_friction",
    "operation.axial_load",
    "operation.inner_speed",
    "bearing.inner_conformity",
    "cage.mass",
)


def uncertain(study, share, keys=VARIED):
    """The study with these numbers normal, `share` of the mean wide; conformities a tenth of that."""
    known = study_numbers(study)
    means = {key: value_of(study, known[key]) for key in keys}
    widths = {key: share * (0.1 if "conformity" in key else 1.0) for key in keys}
    laws = {k: Normal(mean=m, standard_deviation=widths[k] * m) for k, m in means.items()}
    return with_distributions(study, laws)


def same(one, other):
    """Whether two answers are the same in every number."""
    names = [f.name for f in fields(one) if isinstance(getattr(one, f.name), np.ndarray)]
    return all(np.array_equal(getattr(one, n), getattr(other, n), equal_nan=True) for n in names)


def own_pocket(study):
    """The study with a pocket whose stiffness comes from the material of each candidate."""
    return replace(study, cage=replace(study.cage, ball_cage_stiffness=None))


def loaded_sideways(study):
    """The study with a radial load, under which the balls' speeds differ around."""
    return replace(study, operation=replace(study.operation, radial_load=400.0))


@pytest.mark.parametrize("change", [lambda study: study, own_pocket, loaded_sideways])
def test_a_sample_at_the_means_is_the_chain_to_the_last_bit(change):
    """Every number that the samples hold, from the stages as the other verbs call them."""
    study = uncertain(change(BASE), 0.01)
    draws = sample(study, 1)
    middle = draws.with_values(np.array([[one.central for one in draws.inputs]]))
    found = chain_samples(study, middle)
    assert found.solved.tolist() == [True]
    for place, candidate in enumerate(study.ranking.candidates):
        state = chain.cage_state(study, material=candidate.material, friction=0.1)
        impact, cage = state.restitution.restitution, state.cage
        assert found.race_damping[0] == impact.race_damping == cage.race_damping
        assert found.race_damping_free_spin[0] == impact.race_damping_free_spin
        assert (found.inner_damping[0], found.outer_damping[0]) == (
            impact.inner_damping,
            impact.outer_damping,
        )
        assert found.cage_speed[0] == cage.cage_speed
        assert found.ball_cage_stiffness[0, place] == impact.ball_cage_stiffness == cage.ball_cage_stiffness
        assert found.restitution_factor[0, place] == impact.restitution_factor
        assert found.restitution_factor_free_spin[0, place] == impact.restitution_factor_free_spin
        assert found.restitution_factor_hertz[0, place] == impact.restitution_factor_hertz
        pocket = conditions_of(study, state)
        assert (found.slip_speed[0], found.pocket_pressure[0, place]) == (pocket.slip_speed, pocket.pressure)
        waves = len(cage.orbital_cosines)
        assert found.orbital_cosines[0].tolist() == [*cage.orbital_cosines, *[0.0] * (HIGHEST - waves)]
        assert found.orbital_sines[0].tolist() == [*cage.orbital_sines, *[0.0] * (HIGHEST - waves)]


def test_small_widths_propagate_by_the_derivatives():
    """GUM, 5.1.2: the variance is the sum of (derivative times standard deviation) squared.

    Inputs of 0.3 % (a conformity: 0.03 %). The second-order part is of that order of the first, and 256
    balanced points give a standard deviation to about 1 %: 2 % bounds both. The slope's own numerical
    noise, below 1e-4 of it, needs derivatives over steps of one standard deviation.
    """
    study = uncertain(BASE, 0.003)
    draws = sample(study, 256)
    found = chain_samples(study, draws, jobs=2)
    central = np.array([one.central for one in draws.inputs])
    rows = []
    for i, key in enumerate(draws.names):
        if key in VARIED:
            step = np.zeros(central.size)
            step[i] = draws.inputs[i].distribution.standard_deviation
            rows += [central + step, central - step]
    ends = chain_samples(study, draws.with_values(np.array(rows)))
    for name in ("race_damping", "cage_speed"):
        values = getattr(ends, name)
        expected = math.sqrt(np.sum((0.5 * (values[::2] - values[1::2])) ** 2))
        assert np.std(getattr(found, name)) == pytest.approx(expected, rel=0.02), name
    values = ends.restitution_factor[:, 0]
    expected = math.sqrt(np.sum((0.5 * (values[::2] - values[1::2])) ** 2))
    assert np.std(found.restitution_factor[:, 0]) == pytest.approx(expected, rel=0.02)


def test_workers_change_nothing():
    """The same numbers for 1, 2 and 8 threads, over several chunks and samples that share stages."""
    study = with_distributions(
        uncertain(BASE, 0.02, ("film.thickness", "cage.mass")),
        {"operation.axial_load": Samples(values=(2500.0, 3000.0, 3500.0))},
    )
    draws = sample(study, 3 * CHUNK + 5)
    first, second, third = (chain_samples(study, draws, jobs=jobs) for jobs in (1, 2, 8))
    assert first.solved.all()
    assert same(first, second)
    assert same(first, third)


def test_the_order_of_the_samples_changes_nothing():
    """Shared stages are found however the samples lie: a shuffled question has the shuffled answer."""
    study = with_distributions(BASE, {"operation.axial_load": Samples(values=(2500.0, 3000.0))})
    study = with_distributions(study, {"film.thickness": Samples(values=(4e-7, 5e-7, 6e-7))})
    draws = sample(study, 48)
    order = np.random.default_rng(3).permutation(48)
    plain = chain_samples(study, draws)
    shuffled = chain_samples(study, draws.with_values(draws.values[order]))
    assert np.array_equal(plain.restitution_factor[order], shuffled.restitution_factor)
    assert len(np.unique(plain.race_damping)) == 6


@pytest.mark.parametrize(
    ("key", "equilibria", "tractions"),
    [("cage.mass", 1, 1), ("film.thickness", 1, CHUNK), ("operation.axial_load", CHUNK, CHUNK)],
)
def test_a_stage_is_computed_again_only_where_its_inputs_differ(key, equilibria, tractions, monkeypatch):
    """Mass acts on the impact alone, the film on traction and impact, a load on all."""
    calls = {"bearing_state": 0, "traction_slope": 0}

    def counted(name):
        original = getattr(module, name)

        def call(*args, **kwargs):
            calls[name] += 1
            return original(*args, **kwargs)

        monkeypatch.setattr(module, name, call)

    counted("bearing_state")
    counted("traction_slope")
    study = uncertain(BASE, 0.02, (key,))
    found = chain_samples(study, sample(study, CHUNK))
    assert found.solved.all()
    assert calls == {"bearing_state": equilibria, "traction_slope": 2 * tractions}
    assert len(np.unique(found.restitution_factor[:, 0])) == CHUNK


def test_a_number_that_nobody_classified_touches_everything():
    """A new key costs time until somebody says what it touches; it never shares a stage that it changes."""
    for key in ("bearing.new", "operation.new", "lubricant.viscosity"):
        assert module._stage(BASE, key) == module._EQUILIBRIUM


@pytest.mark.parametrize("model", [KinematicModel.FREE, KinematicModel.OUTER_RACE_CONTROL])
def test_stages_that_an_input_is_said_not_to_touch_stay_the_same(model):
    """Every number of the study, changed a little: equilibrium and traction are equal to the last bit."""
    study = replace(BASE, kinematics=model)
    bearing = module._bearing(study)
    traction = module._traction(study, bearing)
    known = study_numbers(study)
    changed = {key: value_of(study, known[key]) for key in known if module._stage(study, key) > 0}
    for key, value in changed.items():
        if not value:
            continue
        other = with_values(study, {key: value + 1 if known[key].is_whole else 1.01 * value})
        again = module._bearing(other)
        assert np.array_equal(again.equilibrium.load_inner, bearing.equilibrium.load_inner), key
        assert np.array_equal(again.equilibrium.orbital_speed, bearing.equilibrium.orbital_speed), key
        if module._stage(study, key) == module._LATER:
            assert module._traction(other, again) == traction, key


def test_the_mass_alone_acts_by_the_printed_formula():
    """A second road: eta = exp(-pi zeta/sqrt(1 - zeta^2)) with zeta^2 in proportion to the mass."""
    study = uncertain(BASE, 0.02, ("cage.mass",))
    draws = sample(study, 16)
    found = chain_samples(study, draws)
    zeta = np.sqrt(found.ball_cage_stiffness[:, 0] * draws.column("cage.mass")) / (2.0 * found.race_damping)
    eta = np.exp(-np.pi * zeta / np.sqrt(1.0 - zeta**2))
    assert found.restitution_factor[:, 0] == pytest.approx(eta, rel=1e-13)  # rounding


def test_a_failed_sample_is_a_row_in_place():
    """What does not fit, and what no bearing can carry, keeps its number and its reason; the others stand."""
    study = uncertain(BASE, 0.01, ("bearing.ball_diameter", "operation.axial_load", "cage.pocket_clearance"))
    draws = sample(study, 5)
    values = draws.values.copy()
    good = chain_samples(study, draws)
    values[1, draws.names.index("bearing.ball_diameter")] = 0.016
    values[2, draws.names.index("cage.pocket_clearance")] = 0.006
    values[3, draws.names.index("operation.axial_load")] = 1e7
    found = chain_samples(study, draws.with_values(values), jobs=2)
    assert found.solved.tolist() == [True, False, False, False, True]
    assert [failure.sample for failure in found.failures] == [1, 2, 3]
    reasons = [failure.reason for failure in found.failures]
    assert "[bearing] ball_count must be at most" in reasons[0]
    assert "pocket_clearance must be smaller than the gap" in reasons[1]
    assert all("\n" not in reason for reason in reasons)
    assert sum(found.failure_counts.values()) == 3
    assert np.isnan(found.restitution_factor[1:4]).all()
    assert np.array_equal(found.restitution_factor[[0, 4]], good.restitution_factor[[0, 4]])
    told = next(iter(found.notes()))
    assert told.startswith("5 samples: 2 solved, 3 not (")
    assert "Sample 1: [bearing] ball_count" in told


def test_an_interrupt_keeps_the_rows_that_are_finished():
    """What was computed is there, what was not says so; nothing is lost or invented."""
    study = uncertain(BASE, 0.02, ("film.thickness", "operation.axial_load"))
    draws = sample(study, 6 * CHUNK)
    whole = chain_samples(study, draws)
    seen = []

    def interrupt(done, total):
        seen.append((done, total))
        if len(seen) == 2:
            raise KeyboardInterrupt

    part = chain_samples(study, draws, progress=interrupt)
    assert seen[0] == (CHUNK, 6 * CHUNK)
    assert not part.complete
    assert whole.complete
    assert 2 * CHUNK <= part.solved.sum() < 6 * CHUNK
    assert {failure.reason for failure in part.failures} == {INTERRUPTED}
    assert np.array_equal(part.restitution_factor[part.solved], whole.restitution_factor[part.solved])


def test_a_thick_film_is_said_once_for_all_samples():
    """The film in series is out of its range in some samples: counted, not warned about one by one."""
    study = with_distributions(BASE, {"film.thickness": Samples(values=(4e-7, 2e-5, 2e-5, 2e-5))})
    found = chain_samples(study, sample(study, 16))
    assert found.solved.all()
    notes = list(found.notes())
    assert len(notes) == 1
    assert notes[0].startswith("In 12 of 16 samples the film is thicker than 0.03")


def test_frictions_of_candidates_do_not_touch_the_chain():
    """A study without distributions draws its frictions only, and every sample has the chain's answer."""
    found = chain_samples(BASE, sample(BASE, 8))
    assert len(np.unique(found.restitution_factor)) == 1
    assert found.restitution_factor[0, 0] == chain.restitution_state(BASE).restitution.restitution_factor


def test_a_study_without_cage_or_rolling_is_refused_before_anything_is_computed():
    """The refusals of the chain itself, not one failure for each sample."""
    study = uncertain(BASE, 0.01, ("film.thickness",))
    draws = sample(study, 4)
    with pytest.raises(InputError, match=r"lacks the section \[cage\]"):
        chain_samples(replace(study, cage=None), draws)
    still = with_values(study, {"operation.inner_speed": 0.0})
    with pytest.raises(InputError, match="must differ from outer_speed"):
        chain_samples(still, draws)
