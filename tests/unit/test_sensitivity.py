"""Next test, inverse questions, fitted restitution factor, and their sentences."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from asked import LINEAR_KNOWN, answer, inputs, linear, question
from scipy.special import ndtr, ndtri

from separatrix.chain import restitution_state
from separatrix.distribution import LogNormal, Normal, Samples, Uniform
from separatrix.draws import UncertainInput
from separatrix.restitution import damping_ratio_for, restitution_factor
from separatrix.sensitivity import (
    Case,
    Estimate,
    FilmAxis,
    Measurement,
    Question,
    RestitutionGrid,
    allowed_friction,
    allowed_sentence,
    default_measurements,
    fitted_question,
    friction_grid,
    indices_of,
    input_words,
    next_test,
    next_test_sentences,
    question_of,
    reducible_shares,
    region_sentences,
    sampled_design,
    sampled_values,
    sobol_sentence,
    stable_regions,
    with_fit_error,
)
from separatrix.sensitivity.design import central_values, evaluated
from separatrix.sensitivity.likelihood import likelihood
from separatrix.sensitivity.region import damping_ratios, restitution_factors
from separatrix.sensitivity.spans import spans_above
from separatrix.study import Friction
from separatrix.study_file import read_study

# Two candidates; the film's number x0 enters both, each has a friction. Means are far above the scatter, so
# that an error given as a share of the value is nearly one of a fixed size.
FILM = Normal(mean=30.0, standard_deviation=0.3)
OWN = Normal(mean=10.0, standard_deviation=0.2)
SLOPES = ((1.0, 1.0, -40.05), (1.0, -0.6, -23.8))
CASES = (
    Case(candidate="A", environment="gas", inputs=(0, 1), friction=1),
    Case(candidate="B", environment="gas", inputs=(0, 2), friction=2),
)


ORDERS = (("x1", "x2"), ("x2", "x1"))


def two_candidates():
    """Margins a x0 + b f + c."""
    margins = [
        lambda x, k=k, a=a, b=b, c=c: a * x[:, 0] + b * x[:, 1 + k] + c for k, (a, b, c) in enumerate(SLOPES)
    ]
    return question([FILM, OWN, OWN], *margins, cases=CASES)


def in_closed_form(case, place, deviation, reducible=1.0):
    """P(settled as stable) and P(settled as not) after measuring one input of a normal sum."""
    a, b, c = SLOPES[case]
    mean = a * FILM.mean + b * OWN.mean + c
    measured, other = (a * 0.3, b * 0.2) if place == 0 else (b * 0.2, a * 0.3)
    known = reducible * measured**2  # what a perfect test would take away
    slope = abs(b if place else a)
    taken = known**2 / (known + (slope * deviation) ** 2)  # variance of the posterior mean
    left = np.sqrt(measured**2 + other**2 - taken)
    z = ndtri(0.95)
    return ndtr((mean - z * left) / np.sqrt(taken)), ndtr((-mean - z * left) / np.sqrt(taken))


@pytest.mark.parametrize(
    ("place", "error", "repeats", "reducible"),
    [(0, 0.005, 1, 1.0), (0, 0.01, 4, 1.0), (1, 0.002, 1, 1.0), (0, 0.004, 1, 0.7), (2, 0.004, 3, 0.5)],
)
def test_what_a_test_settles_is_that_of_normal_sums(place, error, repeats, reducible):
    """The closed form; 0.015 is what n = 4096 leaves of P(STABLE) near its limits, with a step of 1/128."""
    asked = two_candidates()
    test = Measurement(input=place, error=error, repeats=repeats, reducible=reducible)
    (found,) = next_test(asked, sampled_design(asked, 4096), [test]).tests
    mean = FILM.mean if place == 0 else OWN.mean
    for one in found.cases:
        case = "AB".index(one.candidate)
        stable, unstable = in_closed_form(case, place, error * mean / repeats**0.5, reducible)
        assert one.settles_stable == pytest.approx(stable, abs=0.015)
        assert one.settles_unstable == pytest.approx(unstable, abs=0.015)
    assert found.settled.value == pytest.approx(sum(one.settles for one in found.cases), abs=1e-12)


def test_the_interval_of_a_test_holds_the_closed_form():
    """Over 20 seeds at n = 1024 at least 15 hold it, give or take a step: 95 % less four standard errors."""
    asked, error = two_candidates(), 0.005
    exact = sum(sum(in_closed_form(case, 0, error * FILM.mean)) for case in (0, 1))
    held = 0
    for seed in range(20):
        design = sampled_design(asked, 1024, seed=seed)
        settled = next_test(asked, design, [Measurement(input=0, error=error)]).tests[0].settled
        held += settled.low - 1 / 128 <= exact <= settled.high + 1 / 128
    assert held >= 15


def test_choosing_the_best_is_worth_what_two_normals_say():
    """Knowing f of A exactly against a certain B: E max(m, 0) - max(E m, 0) = s phi(0) for a mean of 0.

    2 % is what splines and n = 4096 leave.
    """
    cases = (
        Case(candidate="A", environment="gas", inputs=(0,)),
        Case(candidate="B", environment="gas", inputs=(1,)),
    )
    asked = question(
        [Normal(mean=5.0, standard_deviation=0.3), Normal(mean=0.0, standard_deviation=0.1)],
        lambda x: x[:, 0] - 5.0,
        lambda x: 0.0 * x[:, 1],
        cases=cases,
    )
    (found,) = next_test(asked, sampled_design(asked, 4096), [Measurement(input=0, error=0.03)]).tests
    exact = 0.3 / np.sqrt(2.0 * np.pi)
    assert found.choice_perfect.value == pytest.approx(exact, rel=0.02)
    # measured to 3 % of 5, the posterior mean scatters by 0.3^2 / sqrt(0.3^2 + 0.15^2)
    assert found.choice.value == pytest.approx(exact * 0.3 / np.hypot(0.3, 0.15), rel=0.03)


def test_a_choice_that_never_changes_is_worth_nothing():
    """A better than B whatever is measured."""
    asked = question([OWN, OWN], lambda x: x[:, 0], lambda x: x[:, 1] - 5.0)
    for one in next_test(asked, sampled_design(asked, 256)).tests:
        assert one.choice.value == one.choice_perfect.value == 0.0


def test_tests_are_ranked_by_what_they_settle():
    """Falling expected numbers, and words that say the same of the first."""
    asked = two_candidates()
    answered = next_test(asked, sampled_design(asked, 1024))
    settled = [one.settled.value for one in answered.tests]
    assert settled == sorted(settled, reverse=True)
    assert set(answered.undecided) == {("A", "gas"), ("B", "gas")}


def test_a_test_that_tells_nothing_settles_nothing():
    """A thousand per cent of error, or no reducible part, leaves every probability where it is."""
    asked = two_candidates()
    tests = [Measurement(input=0, error=10.0), Measurement(input=0, error=0.001, reducible=0.0)]
    for one in next_test(asked, sampled_design(asked, 256), tests).tests:
        assert one.settled.value == 0.0
        assert one.avoided.value == pytest.approx(0.0, abs=1e-3)  # weights differ in the last digits only


def test_a_case_on_the_border_is_neither_settled_nor_undecided():
    """P(STABLE) = 5 % exactly: no test counts it, and a sentence says so."""
    asked = question([Normal(mean=-ndtri(0.95), standard_deviation=1.0)], lambda x: x[:, 0])
    answered = next_test(asked, sampled_design(asked, 256))
    assert (answered.undecided, answered.borderline) == ((), (("c0", "gas"),))
    assert answered.tests[0].settled.value == 0.0
    assert any("so near 5 or 95 %" in line for line in next_test_sentences(answered))


def test_samples_and_a_mean_of_zero_can_be_measured():
    """An input of a few values and one about 0: every number finite."""
    known = [Samples(values=(1.0, 2.0, 3.0)), Normal(mean=0.0, standard_deviation=1.0)]
    asked = question(known, lambda x: x[:, 0] - 2.0 + x[:, 1])
    for one in next_test(asked, sampled_design(asked, 256)).tests:
        assert np.isfinite(
            [one.settled.value, one.choice.high, one.choice_perfect.high, one.avoided.high]
        ).all()


def test_a_result_that_no_sample_explains_leaves_all_as_it_was():
    """A hundred deviations from every sample: weights alike, and above 0."""
    told = likelihood(OWN, Measurement(input=0, error=0.001), samples=4096, fewest=100)
    (weights,) = told.weights(np.array([9.9, 10.0, 10.2]), np.array([30.0]))
    assert weights[0] == weights[1] == weights[2] > 0.0


def test_three_more_tests_of_a_friction_are_the_default():
    """Single tests scatter as the irreducible part does."""
    _, first, second = default_measurements(two_candidates(), reducible={1: 0.5})
    assert (first.repeats, first.reducible) == (3, 0.5)
    assert first.error == pytest.approx(0.02 * np.sqrt(0.5))  # rounding
    assert second.error == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("known", "error"),
    [
        (Normal(mean=30.0, standard_deviation=6.0), 0.05),  # +- 40 %: measured to 10 %
        (Normal(mean=30.0, standard_deviation=0.3), 0.005),  # +- 2 %: to 1 %, for 10 % would tell nothing
        (Normal(mean=0.0, standard_deviation=1.0), 0.05),
    ],
)
def test_what_is_known_better_than_10_percent_is_measured_twice_as_well(known, error):
    """A test that tells less than what is known is no test."""
    asked = question([known], lambda x: x[:, 0])
    (found,) = default_measurements(asked)
    assert (found.error, found.repeats, found.reducible) == (pytest.approx(error), 1, 1.0)


def test_what_is_counted_or_set_is_not_measured():
    """Numbers of balls, the length of a run, and the boundary that runs tell are no tests."""
    known = [OWN, Samples(values=(11, 12, 13)), OWN, Samples(values=(0, 1))]
    asked = question(known, lambda x: x[:, 0])
    named = inputs(*known, names=["film.thickness", "bearing.ball_count", "stability.duration", "boundary"])
    found = default_measurements(replace(asked, inputs=named, boundary=3))
    assert [one.input for one in found] == [0]


def many_candidates(count):
    """As many undecided candidates, each of its own friction."""
    cases = [Case(candidate=f"c{k}", environment="gas", inputs=(k,), friction=k) for k in range(count)]
    margins = [lambda x, k=k: x[:, k] - 10.0 - 0.02 * k for k in range(count)]
    return question([OWN] * count, *margins, cases=cases)


def test_words_of_many_tests_are_few_and_keep_the_border():
    """Six tests by name, the number of the others and what they would settle at most."""
    asked = many_candidates(9)
    lines = next_test_sentences(next_test(asked, sampled_design(asked, 256)))
    assert sum(line.startswith(("3 more tests of the x", "No single")) for line in lines) == 6
    assert lines[6].startswith("Each of 3 more tests would settle less: 0.")


def test_words_of_the_next_test():
    """The purpose's own sentence, with its interval; what helps little stands together at the end."""
    asked = two_candidates()
    tests = [
        Measurement(input=0, error=0.001),
        Measurement(input=1, error=5.0),
        Measurement(input=2, error=5.0),
    ]
    lines = next_test_sentences(next_test(asked, sampled_design(asked, 1024), tests))
    assert lines[0].startswith(
        "Measuring the x0 to 0.2 % would settle 0.8 of 2 undecided materials (95 % interval "
    )
    assert lines[1] in {f"Measuring the {a} or the {b} would decide almost nothing." for a, b in ORDERS}


def test_words_of_more_tests_of_a_friction():
    """Their number and the material; in brackets how likely each case is settled."""
    asked = many_candidates(2)
    tests = [Measurement(input=0, error=0.005, repeats=3)]
    line = next_test_sentences(next_test(asked, sampled_design(asked, 256), tests))[0]
    assert line.startswith("3 more tests of the x0 would settle ")
    assert ": c0 in gas (" in line


def test_words_where_no_single_test_helps():
    """Said as it is."""
    asked = two_candidates()
    lines = next_test_sentences(
        next_test(asked, sampled_design(asked, 256), [Measurement(input=0, error=5.0)])
    )
    assert lines[0] == "No single measurement settles any of 2 undecided materials."


def test_words_where_nothing_is_undecided():
    """No test is recommended then."""
    asked = question([OWN], lambda x: x[:, 0])
    lines = next_test_sentences(next_test(asked, sampled_design(asked, 256)))
    assert len(lines) == 1
    assert lines[0].startswith("Nothing is undecided")


def test_words_for_the_only_undecided_one():
    """A probability instead of a share of one."""
    asked = question([FILM, OWN], lambda x: x[:, 0] + 0.3 * x[:, 1] - 33.05)
    lines = next_test_sentences(
        next_test(asked, sampled_design(asked, 1024), [Measurement(input=0, error=0.001)])
    )
    assert lines[0].startswith(
        "Measuring the x0 to 0.2 % would settle the one undecided material, c0 in gas, with"
    )


def test_words_of_the_drivers():
    """The largest share first; a verdict that never changes has its reason."""
    asked = question(LINEAR_KNOWN, linear)
    case = indices_of(asked, sampled_design(asked, 1024)).cases[0]
    text = sobol_sentence(case)
    assert text.startswith("The margin of c0 in gas is driven by the x0 (4")
    assert text.endswith("The verdict of c0 in gas has no doubt to share out: every sample is stable.")


def test_a_rare_verdict_is_not_shared_out():
    """Fewer than 30 samples of the rarer verdict: their number instead of indices."""
    asked = question([Normal(mean=3.0, standard_deviation=1.0)], lambda x: x[:, 0])
    case = indices_of(asked, sampled_design(asked, 1024)).cases[0]
    assert case.verdict == ()
    assert case.verdict_reason.endswith("samples are not stable")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("film.thickness", "the film's thickness"),
        ("film.race_friction", "the friction between ball and race"),
        ("operation.axial_load", "the axial load"),
        ("bearing.inner_conformity", "the bearing's inner conformity"),
        ("film.poisson_ratio", "the film's Poisson's ratio"),
        ("bearing.ball_material.elastic_modulus", "the elastic modulus of the ball material"),
        ("ranking.PEEK 1.5.material.elastic_modulus", "the elastic modulus of PEEK 1.5"),
        ("stability.duration", "the length of a run"),
    ],
)
def test_names_of_a_study_read_as_words(name, words):
    """As they stand in a sentence."""
    assert input_words(name) == words


def test_every_stretch_above_a_level_is_found():
    """Two humps; straight lines between the points; an end of the search is marked."""
    x = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    first, second = spans_above(x, np.array([0.0, 1.0, 0.0, 0.0, 1.0, 1.0]), 0.5)
    assert (first.low, first.high, first.from_edge, first.to_edge) == (
        0.5,
        pytest.approx(2.0**0.5),
        False,
        False,
    )
    assert (second.high, second.from_edge, second.to_edge) == (5.0, False, True)
    assert spans_above(x, np.zeros(6), 0.5) == ()
    (whole,) = spans_above(x, np.ones(6), 0.5)
    assert whole.from_edge
    assert whole.to_edge


FACTOR = Normal(mean=0.5, standard_deviation=0.05)


def friction_limit(threshold, factor=FACTOR):
    """A single candidate with a friction; margin = threshold(f) - eta."""
    known = [factor, Normal(mean=0.1, standard_deviation=0.01)]

    def judge(values, eta):
        limit = threshold(values[:, 1])[:, None]
        return answer(limit - eta, limit)

    return Question(
        inputs=inputs(*known, names=["eta", "ranking.A.gas"]),
        cases=(Case(candidate="A", environment="gas", friction=1),),
        evaluate=lambda values: judge(values, values[:, :1]),
        judge=judge,
    )


def test_the_largest_friction_is_where_the_probability_falls_below_95_percent():
    """A threshold of 1 - f, a normal eta: f = 0.5 - 1.645 * 0.05; 2e-3 is the scatter of n."""
    asked = friction_limit(lambda f: 1.0 - f)
    (found,) = allowed_friction(asked, sampled_values(asked, 4096))
    exact = 0.5 - ndtri(0.95) * 0.05
    assert found.most.value == pytest.approx(exact, abs=2e-3)
    assert found.most.low <= exact <= found.most.high
    assert found.most_nominal == pytest.approx(0.5, rel=4e-3)  # a step of the fine grid
    assert allowed_sentence(found).startswith("A new material may have a pocket friction of at most 0.41")


def test_scatter_of_the_new_friction_costs_some_of_it():
    """Log-normal, as the friction of any next cage.

    With a certain eta of 0.5 it is f exp(1.645 d) = 0.5 exp(d^2 / 2), 2 % less than with a normal scatter;
    2e-3 is a step between the frictions that are judged.
    """
    asked = friction_limit(lambda f: 1.0 - f, Normal(mean=0.5, standard_deviation=1e-6))
    (found,) = allowed_friction(asked, sampled_values(asked, 4096), scatter=0.2)
    d = np.sqrt(np.log1p(0.2**2))
    assert found.most.value == pytest.approx(0.5 * np.exp(d**2 / 2.0 - ndtri(0.95) * d), rel=2e-3)
    assert " if it scatters by 20 % of itself, to be stable" in allowed_sentence(found)


def test_a_limit_that_comes_back_is_told_whole():
    """Stable below 0.1 and again from 0.3 to 0.4: both stretches, and the sentence says so."""
    asked = friction_limit(
        lambda f: np.where((f < 0.1) | ((f > 0.3) & (f < 0.4)), 0.9, 0.1),
        Normal(mean=0.5, standard_deviation=0.01),
    )
    (found,) = allowed_friction(asked, sampled_values(asked, 128))
    assert len(found.spans) == len(found.spans_nominal) == 2
    assert found.most.value == pytest.approx(0.4, rel=0.08)  # a step of the grid
    assert "Not every friction below is" in allowed_sentence(found)


def test_where_no_friction_is_uncertain_none_is_varied():
    """No answer, and no error after all the work: a pocket without friction, say."""
    asked = question([OWN], lambda x: x[:, 0])
    assert allowed_friction(asked, sampled_values(asked, 128)) == ()


def test_no_friction_at_all_has_its_reason():
    """A film that returns too much."""
    asked = friction_limit(lambda f: 0.4 - 0.0 * f)
    (found,) = allowed_friction(asked, sampled_values(asked, 128))
    assert found.most is None
    assert found.most_nominal is None
    assert "No pocket friction is stable with a probability of 95 %" in allowed_sentence(found)


def test_a_friction_without_end_is_not_given_one():
    """Stable at every friction searched."""
    asked = friction_limit(lambda f: 0.9 + 0.0 * f)
    (found,) = allowed_friction(asked, sampled_values(asked, 128))
    assert found.spans[0].to_edge
    assert "No end of it was found up to a friction of 1." in allowed_sentence(found)


STUDY = read_study("cryogenic-turbopump")
THICKNESSES = (0.0, 1e-8, 1e-7, 5e-7, 1e-6, 5e-6, 1e-5)


@pytest.fixture(scope="module")
def state():
    """The chain of the study."""
    return restitution_state(STUDY)


def test_damping_ratios_are_those_of_the_chain():
    """Arrays give what the chain's own functions give, to rounding, and back."""
    eta = np.array([0.0, 1e-6, 0.1, 0.5, 0.9, 0.999])
    np.testing.assert_allclose(damping_ratios(eta), [damping_ratio_for(one) for one in eta], rtol=1e-12)
    zeta = np.array([1e-6, 0.1, 0.7, 0.99, 1.0, 3.0])
    np.testing.assert_allclose(
        restitution_factors(zeta), [restitution_factor(one) for one in zeta], rtol=1e-12
    )


def test_the_grid_holds_the_chain_at_the_study_itself(state):
    """At the study's film and race friction it is the chain's restitution factor; 1e-6 is the slope's own."""
    grid = friction_grid(STUDY, state, thicknesses=(1e-7, 5e-7), frictions=(0.05, 0.1))
    assert (STUDY.film.thickness, STUDY.film.race_friction) == (5e-7, 0.1)
    assert grid.restitution_factor[1, 1] == pytest.approx(state.restitution.restitution_factor, rel=1e-6)


MASS = 1.2


def of_film():
    """One candidate of friction 0.15 or so whose threshold is 1 - 4 f, with an uncertain cage mass."""
    known = [
        LogNormal(mean=5e-7, standard_deviation=1e-7),
        Normal(mean=0.1, standard_deviation=0.005),
        Normal(mean=MASS, standard_deviation=0.1),
        Normal(mean=0.15, standard_deviation=0.01),
    ]
    names = ["film.thickness", "film.race_friction", "cage.mass", "ranking.A.gas"]

    def judge(values, eta):
        limit = 1.0 - 4.0 * values[:, 3:4]
        return answer(limit - eta, limit)

    def evaluate(values):
        return judge(values, factor_of(values[:, 0], values[:, 1], values[:, 2])[:, None])

    return Question(
        inputs=inputs(*known, names=names),
        cases=(Case(candidate="A", environment="gas", friction=3),),
        evaluate=evaluate,
        judge=judge,
    )


def factor_of(thickness, friction, mass):
    """Falls with thickness, rises with race friction; the damping ratio goes as the root of the mass."""
    zeta = 0.02 / friction * (1.0 + thickness / 1e-6)
    return restitution_factors(np.minimum(zeta * np.sqrt(np.maximum(mass, 0.0)), 1.0))


def film_grid():
    """The same without the mass."""
    x = np.concatenate(([0.0], np.geomspace(1e-8, 1e-5, 61)))
    y = np.array([0.05, 0.1, 0.2])
    return RestitutionGrid(
        x=FilmAxis(name="film.thickness", words="film thickness", unit="m", values=x, own=5e-7),
        y=FilmAxis(name="film.race_friction", words="race friction", unit="-", values=y, own=0.1),
        restitution_factor=factor_of(x[None, :], y[:, None], 1.0),
    )


def test_the_film_region_is_that_of_the_model_asked_again():
    """Second road: every node by the model with its film put in, all else as sampled.

    The probability may differ by a sample in a hundred: what is straight between nodes of the grid.
    """
    asked, grid = of_film(), film_grid()
    values = sampled_values(asked, 512)
    (found,) = stable_regions(asked, values, grid)
    for k, y in enumerate(grid.y.values):
        for i, x in list(enumerate(grid.x.values))[::10]:
            again = values.copy()
            again[:, :2] = x, y
            share = np.mean(evaluated(asked, again).margin >= 0.0)
            assert found.probability_stable[k, i] == pytest.approx(share, abs=0.01)


def test_the_film_region_has_its_stretches_and_words():
    """With more race friction a thicker film is needed; the end of the search is said as such."""
    asked = of_film()
    (region,) = stable_regions(asked, sampled_values(asked, 512), film_grid())
    ends = [row.probable[0].low for row in region.rows]
    assert ends == sorted(ends)
    assert ends[-1] > 1e-6
    lines = region_sentences(region)
    assert lines[2].startswith(
        "A in gas: with a race friction of 0.2 stable at a film thickness of at least "
    )


def test_bare_races_have_no_film_to_choose(state):
    """Said so, in one line."""
    bare = replace(STUDY, film=replace(STUDY.film, material=None, thickness=None))
    with pytest.raises(ValueError, match="has bare races"):
        friction_grid(bare, state)


def test_a_fitted_restitution_factor_tells_its_error():
    """The error in samples left out is that of fresh samples: within a factor of two over six seeds.

    A single seed may miss by four: a few samples in the tails make most of it.
    """
    asked, told, found = of_film(), 0.0, 0.0
    for seed in range(6):
        values, fresh = (sampled_values(asked, 1024, seed=s) for s in (seed, 100 + seed))
        fitted, error = fitted_question(asked, values, evaluated(asked, values))
        told += error.restitution_factor**2
        found += np.mean((evaluated(fitted, fresh).margin - evaluated(asked, fresh).margin) ** 2)
    assert 0.25 < told / found < 4.0


def test_indices_of_a_fit_hold_those_of_the_model():
    """The model's own indices lie in the intervals, widened by the error of the fit."""
    asked = of_film()
    values = sampled_values(asked, 512)
    fitted, error = fitted_question(asked, values, evaluated(asked, values))
    assert error.missed < 1e-4  # a smooth function of three inputs
    true, told = (indices_of(one, sampled_design(one, 1024)) for one in (asked, fitted))
    widened = with_fit_error(told, error)
    assert widened.fit_error == error.missed
    for one, other in zip(true.cases[0].margin, widened.cases[0].margin, strict=True):
        assert other.total.low <= one.total.value <= other.total.high


def test_the_bound_of_a_fit_holds_for_the_worst_error():
    """Error along the factor itself moves S by no more than the bound."""
    from separatrix.sensitivity.fit import _bound

    one = Estimate(value=0.5, low=0.5, high=0.5)
    wide = _bound(one, 0.1)
    # f = (1 + 0.1 sqrt 2) x + y, where g = x + y: the error has a tenth of g's deviation
    worse = (1.0 + 0.1 * 2.0**0.5) ** 2 / ((1.0 + 0.1 * 2.0**0.5) ** 2 + 1.0)
    assert wide.low <= 1.0 - worse <= worse <= wide.high


def test_fewer_samples_than_terms_fit_nothing():
    """A refusal, not a fit that knows every sample by heart."""
    asked = of_film()
    values = sampled_values(asked, 128)[:10]
    with pytest.raises(ValueError, match="straight line"):
        fitted_question(asked, values, evaluated(asked, values))


def test_a_uniform_input_is_told_by_its_quantiles():
    """Values of shape (sample, input) fill the unit interval evenly in every block of the design."""
    asked = question([Uniform(low=0.0, high=1.0)], lambda x: x[:, 0])
    values = sampled_values(asked, 128).reshape(16, 8)
    counts = np.sort(np.floor(values * 8), axis=1)
    assert (counts == np.arange(8)).all()


def test_the_nominal_stretch_is_the_verdicts_not_the_margins():
    """A judge that asks for a margin of 0.1 and a friction within 0.002: its stretch begins later.

    Of the samples not half are ever stable then, so it is not their median either.
    """
    asked = of_film()

    def strict(values, eta):
        limit = 1.0 - 4.0 * values[:, 3:4]
        found = answer(limit - eta, limit)
        near = np.abs(values[:, 3:4] - 0.15) < 0.002
        return replace(found, verdict=np.where(near & (limit - eta >= 0.1), 1, 0))

    values = sampled_values(asked, 128)
    (lenient,) = stable_regions(asked, values, film_grid())
    (severe,) = stable_regions(replace(asked, judge=strict), values, film_grid())
    low, high = (one.rows[2].nominal[0].low for one in (lenient, severe))
    exact = [1e-6 * (damping_ratio_for(0.4 - more) / (0.1 * MASS**0.5) - 1.0) for more in (0.0, 0.1)]
    assert (low, high) == pytest.approx(exact, rel=0.02)  # an eighth of the grid's step of 12 %


def cases_in(*environments):
    """One undecided case in each environment, all of one film and each of its own friction."""
    known = [FILM, *[OWN for _ in environments]]
    cases = [
        Case(candidate="A", environment=name, inputs=(0, 1 + k), friction=1 + k)
        for k, name in enumerate(environments)
    ]
    margins = [lambda x, k=k: x[:, 0] + 0.1 * x[:, 1 + k] - 31.05 for k in range(len(environments))]
    return question(known, *margins, cases=cases)


def test_words_count_cases_where_there_are_several_environments():
    """A material may be undecided in one and settled in another."""
    asked = cases_in("gas", "liquid")
    lines = next_test_sentences(
        next_test(asked, sampled_design(asked, 1024), [Measurement(input=0, error=0.0005)])
    )
    assert " of 2 undecided cases" in lines[0]
    assert "A in gas" in lines[0]


def test_words_name_the_best_test_even_where_it_settles_too_little():
    """An expected number below one half of a case."""
    asked = two_candidates()
    lines = next_test_sentences(
        next_test(asked, sampled_design(asked, 1024), [Measurement(input=0, error=0.007)])
    )
    assert lines[0].startswith(
        "No single measurement settles any of 2 undecided materials; the best, measuring the"
    )
    assert "would settle 0.4 of 2 undecided materials" in lines[0]


def test_frictions_of_one_pocket_have_one_answer():
    """Two environments differ in the test, not in the pocket: one answer, for the candidate."""
    known = [FACTOR, *[Normal(mean=0.1, standard_deviation=0.01)] * 2]
    asked = question(
        known,
        lambda x: 1.0 - x[:, 1] - x[:, 0],
        lambda x: 1.0 - x[:, 2] - x[:, 0],
        cases=[
            Case(candidate="A", environment=name, friction=1 + k) for k, name in enumerate(("gas", "liquid"))
        ],
    )
    (found,) = allowed_friction(asked, sampled_values(asked, 128))
    assert (found.like, found.all_alike) == (("A",), True)


def test_different_pockets_have_their_own_answers():
    """Each names the candidates whose pockets it holds for."""
    known = [FACTOR, *[Normal(mean=0.1, standard_deviation=0.01)] * 2]
    asked = question(
        known,
        lambda x: 1.0 - x[:, 1] - x[:, 0],
        lambda x: 0.9 - x[:, 2] - x[:, 0],
        cases=[Case(candidate=name, environment="gas", friction=1 + k) for k, name in enumerate("AB")],
    )
    found = allowed_friction(asked, sampled_values(asked, 128))
    assert [one.like for one in found] == [("A",), ("B",)]
    assert allowed_sentence(found[1]).startswith("A new material with the pockets of B may have")


def test_samples_that_do_not_share_out_evenly_are_all_counted():
    """A sample that failed may be missing: 4095 give nearly the same friction as 4096."""
    asked = friction_limit(lambda f: 1.0 - f)
    values = sampled_values(asked, 4096)
    (whole,), (less,) = (allowed_friction(asked, one) for one in (values, values[1:]))
    assert less.most.value == pytest.approx(whole.most.value, abs=1e-3)  # one sample of the 5 %


def as_drawn(values):
    """Frictions that do not move."""
    return values


def of_the_chain(in_pockets=as_drawn):
    """Stands for the chain's model: two candidates, one of them in two environments, and a film."""
    measured, unrepeated = STUDY.ranking.candidates[:2]
    known = [
        UncertainInput(key=key, unit=unit, distribution=one, central=one.mean, source=source)
        for key, unit, one, source in (
            ("film.thickness", "m", LogNormal(mean=5e-7, standard_deviation=1e-7), "study"),
            ("ranking.Mat. A.gas", "-", Normal(mean=0.1, standard_deviation=0.009), "assumed"),
            ("ranking.Mat. A.liquid", "-", Normal(mean=0.2, standard_deviation=0.01), "measured"),
            ("ranking.B.gas", "-", Normal(mean=0.1, standard_deviation=0.01), "measured"),
        )
    ]
    cases = [
        SimpleNamespace(candidate=name, environment=place, place=k, columns=columns, count=len(columns))
        for name, place, k, columns in (
            ("Mat. A", "gas", 0, (1,)),
            ("Mat. A", "liquid", 0, (2,)),
            ("B", "gas", 1, (3,)),
            ("Mat. A", "", 0, (1, 2)),
            ("B", "", 1, (3,)),
        )
    ]

    def judge(values, eta, draws=None):
        frictions = np.column_stack([values[:, list(case.columns)].mean(axis=1) for case in cases])
        limit = 1.0 - frictions - (0.0 if draws is None else 1e-3 * draws[:, None])
        return answer(limit - eta, limit)

    candidates = (
        replace(
            measured,
            name="Mat. A",
            friction={
                "gas": Friction(mean=0.1),
                "liquid": Friction(mean=0.2, standard_deviation=0.01, count=4),
                "air": None,
            },
        ),
        replace(unrepeated, name="B", friction={"gas": Friction(mean=0.1, standard_deviation=0.01)}),
    )
    chain = np.array([1.0, 1.1])
    return SimpleNamespace(
        inputs=known,
        cases=cases,
        judge=judge,
        factors=lambda values: SimpleNamespace(restitution_factor=1e6 * values[:, :1] * chain),
        in_pockets=in_pockets,
        kinds=[SimpleNamespace(runs=1000), SimpleNamespace(runs=234)],
        study=SimpleNamespace(ranking=SimpleNamespace(candidates=candidates, friction_scatter=0.09)),
    )


def test_the_chains_model_is_asked_of_each_environment():
    """Its cases but those over all environments; the shared inputs enter all, a friction its own."""
    asked = question_of(of_the_chain())
    assert [(case.candidate, case.environment) for case in asked.cases] == [
        ("Mat. A", "gas"),
        ("Mat. A", "liquid"),
        ("B", "gas"),
    ]
    assert [case.inputs for case in asked.cases] == [(0, 4, 1), (0, 4, 2), (0, 4, 3)]
    values = sampled_values(asked, 128)
    found = evaluated(asked, values)
    again = asked.judge(values, found.threshold - found.margin)
    np.testing.assert_allclose(again.margin, found.margin, atol=1e-12)  # rounding


def test_frictions_move_with_the_inputs_where_they_are_drawn_and_not_where_they_are_given():
    """The pocket's friction of Mat. A in gas goes with the film: `evaluate` knows it, `judge` is told."""

    def in_pockets(values):
        moved = values.copy()
        moved[:, 1] *= 1.0 + 1e5 * values[:, 0]
        return moved

    asked = question_of(of_the_chain(in_pockets))
    plain = question_of(of_the_chain())
    values = sampled_values(asked, 1024)
    moved, still = asked.evaluate(values), plain.evaluate(values)
    rise = 1e5 * values[:, 0] * values[:, 1]
    np.testing.assert_allclose(still.threshold[:, 0] - moved.threshold[:, 0], rise, atol=1e-12)  # rounding
    np.testing.assert_array_equal(still.threshold[:, 1:], moved.threshold[:, 1:])
    factor = still.threshold - still.margin
    np.testing.assert_array_equal(
        asked.judge(values, factor).threshold, plain.judge(values, factor).threshold
    )
    fitted, _ = fitted_question(asked, values, moved)
    np.testing.assert_allclose(fitted.evaluate(values).threshold, moved.threshold, atol=1e-12)  # rounding


def test_candidates_whose_names_hold_dots_keep_them():
    """The friction of "Mat. A" is not that of "Mat" in " A.gas"."""
    words = [one.words for one in question_of(of_the_chain()).inputs]
    assert words[1] == "the pocket friction of Mat. A in gas"


def test_what_the_runs_leave_open_is_an_input():
    """Each sample has a boundary of its own; with every input at its centre it is the one that they say."""
    asked = question_of(of_the_chain())
    assert (asked.boundary, asked.inputs[4].words) == (4, "the boundary itself, known from 1234 runs")
    values = sampled_values(asked, 1024)
    assert set(values[:, 4]) == set(range(64))
    centre = central_values(asked)
    assert asked.evaluate(centre).threshold[0, 0] == pytest.approx(0.9, abs=1e-12)  # rounding
    first, last = (np.append(centre[0, :4], draw)[None] for draw in (0.0, 63.0))
    zero = np.zeros((1, 3))
    fall = asked.judge(first, zero).threshold - asked.judge(last, zero).threshold
    np.testing.assert_allclose(fall, 0.063, atol=1e-12)  # rounding


def test_more_tests_take_away_what_is_not_from_cage_to_cage():
    """Of s^2 (1 + 1/n) the part 1/(n + 1): a half for one test, a fifth for four, none without a count."""
    assert reducible_shares(of_the_chain()) == {1: 0.5, 2: 0.2, 3: 0.0}


def stated(deviation, source, **known):
    """Share of one friction's variance that tests could take away."""
    model = of_the_chain()
    one = replace(model.inputs[3], distribution=Normal(mean=0.1, standard_deviation=deviation), source=source)
    friction = Friction(mean=0.1, **known)
    other = replace(model.study.ranking.candidates[1], friction={"gas": friction})
    ranking = SimpleNamespace(candidates=(other,), friction_scatter=0.09)
    changed = SimpleNamespace(inputs=[*model.inputs[:3], one], study=SimpleNamespace(ranking=ranking))
    return reducible_shares(changed)[3]


def test_a_friction_that_is_stated_as_plus_minus_can_be_learned():
    """What lies beyond the default scatter of 9 %: of 15 % the share 1 - (9/15)^2; a half at least."""
    assert stated(0.015, "study", standard_deviation=0.015) == pytest.approx(0.64)  # rounding
    assert stated(0.005, "study", standard_deviation=0.005) == 0.5


def test_a_fitted_friction_can_be_learned_by_its_standard_error():
    """e^2 / (s^2 + e^2), whatever the number of tests behind the fit."""
    known = {"standard_deviation": 0.008, "standard_error": 0.006, "count": 9}
    assert stated(0.01, "measured", **known) == pytest.approx(0.36)  # rounding


def test_conditions_that_were_not_tested_can_be_learned():
    """(e^2 + w^2) / (s^2 + e^2): what s was widened by is no scatter from cage to cage."""
    known = {"standard_deviation": 0.008, "standard_error": 0.006, "widening": 0.0064}
    assert stated(0.01, "measured", **known) == pytest.approx(0.36 + 0.4096)  # rounding
