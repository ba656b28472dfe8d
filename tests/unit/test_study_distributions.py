"""Uncertain numbers of a study: how a file writes them, what the study holds, what is refused."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from commands import refusal_line, rows_of, written
from scipy import stats
from scipy.stats import lognorm

from separatrix import InputError, read_study, resolved
from separatrix.study.keys import study_numbers, value_of, with_values
from separatrix.study.uncertain import CUT, log_normal, log_uniform, normal, samples, uniform
from separatrix.verdict.draws import sample, uncertain_inputs
from separatrix.verdict.ranking_records import measured

HEAD = 'title = "Uncertain"\nextends = "cryogenic-turbopump"\n'


@pytest.fixture
def study_of(tmp_path):
    """Study of a text that stands over the shipped one."""
    return lambda text: read_study(written(tmp_path, HEAD + text, "case.toml"))


FORMS = {
    '"0.5 um +- 20 %"': normal(mean=5e-7, standard_deviation=5e-8),
    '"0.5 um +- 0.1 um"': normal(mean=5e-7, standard_deviation=5e-8),
    '"(0.5 +- 0.1) um"': normal(mean=5e-7, standard_deviation=5e-8),
    '"0.5um+-100nm"': normal(mean=5e-7, standard_deviation=5e-8),
    '"0.5 um ± 20 %"': normal(mean=5e-7, standard_deviation=5e-8),
    '"0.5 um +/- 20%"': normal(mean=5e-7, standard_deviation=5e-8),
    '"0.5 um +- 80 %"': log_normal(mean=5e-7, standard_deviation=2e-7),
    '{ between = ["0.2 um", "1 um"] }': uniform(low=2e-7, high=1e-6),
    '{ between = ["0.2 um", "1 um"], log = true }': log_uniform(low=2e-7, high=1e-6),
    '{ mean = "0.5 um", standard_deviation = "50 nm" }': normal(mean=5e-7, standard_deviation=5e-8),
    '["0.2 um", "0.4 um", "0.6 um"]': samples(values=(2e-7, 4e-7, 6e-7)),
}


@pytest.mark.parametrize("text", FORMS)
def test_every_form_is_read(text, study_of):
    """The kind and its numbers, to rounding of the unit; and the text as it stands in the file."""
    study = study_of(f"[film]\nthickness = {text}\n")
    found, wanted = study.distributions["film.thickness"], FORMS[text]
    # What follows the sign is two standard deviations, as on a certificate (GUM, 7.2.4).
    assert found.kind == wanted.kind
    moments = wanted.mean, wanted.standard_deviation
    assert (found.mean, found.standard_deviation) == pytest.approx(moments, rel=1e-14)  # rounding of the unit
    assert found.text == text
    assert study.film.thickness == found.mean


def test_the_page_on_uncertain_inputs_is_right(study_of):
    """The study on the page is read, and so is every form of its table."""
    page = (Path(__file__).parents[2] / "docs" / "reference" / "distributions.md").read_text(encoding="utf-8")
    page = page.partition("## How to write them")[2].partition("\n## ")[0]
    assert len(study_of(page.partition("```toml\n")[2].partition("```")[0]).distributions) == 6
    forms = re.findall(r"^\| `([^`]+)` \|", page, re.MULTILINE)
    assert len(forms) == 7
    for form in forms:
        assert "film.thickness" in study_of(f"[film]\nthickness = {form}\n").distributions, form


def test_a_width_in_another_unit_or_of_a_temperature_is_a_difference(study_of):
    """20 degC +- 2 degC is 2 K wide, not 275 K; degrees Fahrenheit are smaller."""
    for text, mean, deviation in (
        ("20 degC +- 2 degC", 293.15, 1.0),
        ("77 K +- 2 degC", 77.0, 1.0),
        ("77 K +- 1.8 degF", 77.0, 0.5),
        ("(20 ± 2) degC", 293.15, 1.0),
        ("77 K +- 2 %", 77.0, 0.77),
    ):
        film = '[film]\nelastic_modulus = "2 GPa"\npoisson_ratio = 0.4\n'  # good at any temperature
        study = study_of(f'[operation]\nfluid = "air"\ntemperature = "{text}"\n{film}')
        law = study.distributions["operation.temperature"]
        assert (law.mean, law.standard_deviation) == pytest.approx((mean, deviation), rel=1e-12)


def test_ratios_and_materials_in_place_are_uncertain_alike(study_of):
    """Every number of a study: without unit, of a film, of a ring's material, of a candidate."""
    study = study_of("""
[bearing]
outer_conformity = "0.52 +- 1 %"
ring_material = { elastic_modulus = "205 GPa +- 2 %", poisson_ratio = 0.285, density = "7650 kg/m3" }
[film]
race_friction = { mean = 0.1, standard_deviation = 0.01 }
material = { elastic_modulus = { between = ["1 GPa", "5 GPa"] }, poisson_ratio = 0.4 }
[cage]
mass = ["26 g", "24 g", "25 g"]
[[ranking.candidates]]
name = "Mine"
friction = { "air" = "0.1 +- 20 %", "water" = { mean = 0.1, standard_deviation = "9 %" }, "oil" = 0.05 }
material = { elastic_modulus = "5 GPa +- 30 %", poisson_ratio = [0.3, 0.4] }
""")
    assert {*study.distributions} == {
        *("bearing.outer_conformity", "bearing.ring_material.elastic_modulus"),
        *("film.race_friction", "film.elastic_modulus", "cage.mass", "ranking.Mine.air"),
        *("ranking.Mine.material.elastic_modulus", "ranking.Mine.material.poisson_ratio"),
    }
    known = study_numbers(study)
    for key, law in study.distributions.items():
        assert value_of(study, known[key]) == pytest.approx(law.mean, rel=1e-15), key
    friction = study.ranking.candidates[0].friction
    assert friction["air"].standard_deviation == pytest.approx(0.01)
    assert friction["water"].standard_deviation == pytest.approx(0.009)
    assert measured(friction["water"]).error == pytest.approx(0.009)


def test_an_uncertain_clearance_moves_the_angle(study_of):
    """The study holds an angle; its clearance is the uncertain number."""
    base = read_study("cryogenic-turbopump")
    clearance = base.bearing.free_clearance
    text = f'[bearing]\nradial_clearance = "{clearance * 1e6:.6f} um +- 5 %"\n'
    study = study_of(text)
    assert "radial_clearance" in resolved(study)["bearing"]["contact_angle"]["origin"]
    assert study.bearing.free_angle == pytest.approx(base.bearing.free_angle, rel=1e-6)
    wider = with_values(study, {"bearing.radial_clearance": 1.05 * clearance})
    assert math.cos(base.bearing.free_angle) - math.cos(wider.bearing.free_angle) == pytest.approx(
        0.05 * (1.0 - math.cos(base.bearing.free_angle)), rel=1e-4
    )


def test_a_clearance_that_was_given_stays_where_the_ball_varies(study_of):
    """The angle follows from clearance and diameter, if the clearance is what the file says."""
    given = study_of('[bearing]\nradial_clearance = "83 um"\nball_diameter = "11.1125 mm +- 0.1 %"\n')
    larger = with_values(given, {"bearing.ball_diameter": 11.12e-3})
    assert larger.bearing.free_clearance == pytest.approx(83e-6, rel=1e-12)
    by_angle = with_values(read_study("cryogenic-turbopump"), {"bearing.ball_diameter": 11.12e-3})
    assert by_angle.bearing.free_angle == read_study("cryogenic-turbopump").bearing.free_angle


def test_values_are_set_together_and_become_certain(study_of):
    """Two numbers that fit each other only together; those that are set have no distribution any more."""
    study = study_of(
        '[bearing]\nball_diameter = "11.1125 mm +- 0.1 %"\n[cage]\npocket_clearance = "0.6 mm +- 10 %"\n'
    )
    big = with_values(study, {"bearing.ball_diameter": 0.10, "bearing.pitch_diameter": 0.60})
    assert big.bearing.pitch_diameter == 0.60
    assert list(big.distributions) == ["cage.pocket_clearance"]
    with pytest.raises(InputError, match=r"\[bearing\] ball_count must be at most"):
        with_values(study, {"bearing.ball_diameter": 0.016})


def test_resolved_inputs_tell_origin_and_distribution(study_of):
    """In the part where the number stands, and in one list of all; the whole is JSON without NaN."""
    study = study_of(
        '[film]\nthickness = "0.5 um +- 20 %"\nmaterial = { elastic_modulus = ["2 GPa", "3 GPa"], '
        "poisson_ratio = 0.4 }\n"
    )
    parts = resolved(study)
    entry = parts["film"]["thickness"]
    assert entry["value"] == 5e-7
    assert entry["origin"] == 'case.toml, line 4: "0.5 um +- 20 %"'
    assert entry["distribution"]["kind"] == "normal"
    assert parts["film"]["material"]["elastic_modulus"]["distribution"]["kind"] == "samples"
    names = {one["name"] for one in parts["uncertain_inputs"]}
    assert names == {"film.thickness", "film.elastic_modulus"}
    json.dumps(parts["uncertain_inputs"], allow_nan=False)


@pytest.mark.parametrize("text", ['"0.5 +- 180 %"', "{ mean = 0.5, standard_deviation = 0.45 }"])
def test_a_friction_that_scatters_widely_is_read_and_drawn(study_of, text):
    """What is read is drawn, and the tail of its scatter counts as 2, the largest that a study takes."""
    study = study_of(f'[[ranking.candidates]]\nname = "One"\nfriction = {{ "air" = {text} }}\n')
    (one,) = uncertain_inputs(study)
    assert (one.distribution.mean, one.distribution.standard_deviation) == (0.5, 0.45)
    assert one.distribution.kind == "log-normal"
    assert one.distribution.high > 10.0
    shape = math.sqrt(math.log1p(0.9**2))
    above = lognorm.sf(2.0, shape, scale=0.5 * math.exp(-0.5 * shape**2))
    # the cut at 5 standard deviations takes 3e-7, and the points leave one part in 4096
    values = sample(study, 4096).values
    assert values.max() == 2.0
    assert (values == 2.0).mean() == pytest.approx(above, abs=1 / 4096)


def test_two_frictions_of_one_name_cannot_be_uncertain(study_of):
    """A candidate "A.B" in "C" and one "A" in "B.C" would be one name: refused."""
    with pytest.raises(InputError, match="or is ambiguous"):
        study_of("""
[[ranking.candidates]]
name = "A.B"
friction = { "C" = "0.1 +- 20 %" }
[[ranking.candidates]]
name = "A"
friction = { "B.C" = 0.1 }
""")


def film(text: str) -> str:
    """Return a film of this thickness."""
    return f"[film]\nthickness = {text}\n"


def friction(text: str) -> str:
    """Return a candidate of this friction in air."""
    return f'[[ranking.candidates]]\nname = "One"\nfriction = {{ "air" = {text} }}\n'


MANY = "".join(friction('"0.1 +- 10 %"').replace("One", str(i)) for i in range(51))
SECOND = """\
[[ranking.candidates]]
name = "One.air"
friction = { "lox" = 0.1 }
material = { elastic_modulus = "5 GPa", poisson_ratio = { between = [0.2, 0.7] } }
"""

WRONG = r"""
film "0.5 um +- 0 %" :: line 4: [film] thickness ; width > 0 ; is certain
film "0.5 um +- -0.1 um" :: a width > 0 ; "-0.1 um" ; no sign
film "0.5 um +- 20" :: after +-, needs a unit, or % ; "20 %", or the width
film "0.5 +- 20 %" :: needs a unit before +- too ; "0.5 um +- 20 %"
film "(0.5 +- 0.1)" :: one number and one unit of length
film "(0.5 +- 20 %) um" :: after +- ; "20 % um"
film "0.5 um +- 20 % +- 3 %" :: one value, +- and one expanded uncertainty
film "0.5 um +-" :: one value, +- and one ; like "0.5 um +- 20 %"
film "0,5 um +- 20 %" :: decimal point, not a comma
film "0.5 um +- 0.1 N" :: after +-, needs a unit of length
film { between = ["1 um", "0.2 um"] } :: between must rise; got "1 um" and "0.2 um" ; lower one first
film { between = ["1 um"] } :: a list of two bounds; got a list of 1
film { between = [0.2, 1] } :: between, item 1, needs a unit of length
film { between = ["0 um", "1 um"] }
    :: leaves the range that the study takes at the lower end ; [film] thickness must be > 0
film { between = ["1 um", "1 m"] } :: must be <= 10 mm ; { between = ["1 um", "1 m"] }, whose mean is 500
film { between = ["0 um", "1 um"], log = true } :: must be > 0 with log = true
film { between = ["1 um", "2 um"], log = 1 } :: log must be true or false
film { mean = "1 um", standard_deviation = "1 nm", log = true } :: only with between
film { mean = "1 um" } :: lacks: standard_deviation
film { mean = "1 um", standard_deviation = "1 nm", between = ["1 um", "2 um"] }
    :: must have only one of between
film {} :: must have between, or mean with standard_deviation
film { betwen = ["1 um", "2 um"] } :: betwen is not a key ; Did you mean between?
film [] :: must have 2 to 10000 samples; got 0
film ["1 um"] :: must have 2 to 10000 samples ; without brackets
film ["1 um", "1000 nm"] :: must differ: there is no spread
film ["1 um", 2] :: item 2, needs a unit of length
film ["3 um", "-1 um"] :: at the lower end, -1 um
film [["1 um", "2 um"], "3 um"] :: item 1, needs a unit
film { mean = "1 um", standard_deviation = "40 um" }
    :: leaves the range that the study takes ; write { between
[operation]\nradial_load = "0 N +- 10 %" :: is a share of 0
[operation]\nradial_load = "0 N +- 10 N" :: at the lower end, -25 N ; radial_load must be >= 0
[operation]\ntemperature = "-196 degC +- 2 %" :: whose zero is arbitrary ; in kelvin
[operation]\naxial_load = "300 daN +- many" :: [operation] axial_load, after +-, must be one number
[operation]\nfluid = { between = ["a", "b"] } :: fluid
[film]\nrace_friction = "0.1 mm +- 10 %" :: must be a plain number
[bearing]\ninner_conformity = "0.505 +- 0.01" :: at the lower end, 0.48 ; must be > 0.5 and <= 0.6
[bearing]\nball_count = "13 +- 1" :: ball_count takes no distribution; got "13 +- 1".
[stability]\nkicks = ["1 m/s +- 10 %"] :: kicks[1] takes no distribution
[cage]\npocket_clearance = { between = ["0.1 mm", "6 mm"] }
    :: at the upper end, 6 mm ; smaller than the gap between balls
[film]\nmaterial = { elastic_modulus = "2 GPa +- 0 %", poisson_ratio = 0.4 }
    :: [film] material.elastic_modulus ; a width > 0
[bearing]\nball_material = { density = "8 g/cm3", elastic_modulus = "2e5 MPa", poisson_ratio = "0.45 +- 0.1" }
    :: [bearing] ball_material.poisson_ratio leaves ; must be >= 0 and < 0.5
friction { between = [-0.1, 0.1] } :: line 5: [ranking] candidates[1].friction.air leaves ; -0.1
SECOND :: line 9: [ranking] candidates[2].material.poisson_ratio leaves ; at the upper end, 0.7
friction "0 +- 0.1" :: friction.air.mean must be >= 1e-05 where there is a standard deviation [-]; got 0.
friction ["low", "high"] :: friction.air, item 1, must be a plain number
MANY :: has more than 50 uncertain numbers; got 51
"""
"""A distribution, and words of its refusal."""


@pytest.mark.parametrize(("text", "words"), rows_of(WRONG))
def test_a_wrong_distribution_is_refused_in_one_line(text, words, tmp_path):
    """Where it stands, what must hold and what was given, and nothing but `InputError`."""
    kind, _, value = text.partition(" ")
    known = {"film": film, "friction": friction, "MANY": lambda _: MANY}
    known["SECOND"] = lambda _: friction("0.1") + SECOND
    whole = known[kind](value) if kind in known else text + "\n"
    message = refusal_line(written(tmp_path, HEAD + whole, "wrong.toml"))
    assert message.startswith("wrong.toml")
    assert [word for word in words[0].split(" ; ") if word not in message] == [], message


TOO_FAR = {
    "a log-normal width": film('"0.5 um +- 1e160 m"'),
    "a log-uniform bound": friction("{ between = [1e-160, 1], log = true }"),
    "samples of a friction": friction("[1e200, 1e-3]"),
    "samples of a length": film('["1e308 m", "1.1e308 m"]'),
    "a uniform bound": film('{ between = ["1 um", "1e299 m"] }'),
    "a standard deviation": film('{ mean = "1 um", standard_deviation = "1e-200 m" }'),
}


@pytest.mark.parametrize("kind", TOO_FAR)
def test_numbers_that_overflow_are_refused_in_one_line(kind, tmp_path):
    """Where the mean, the deviation or the quantiles would leave what a computer can hold."""
    line = refusal_line(written(tmp_path, HEAD + TOO_FAR[kind]))
    assert re.match(r"study.toml, line \d+: .* must be", line)


# Distributions of one number: moments and quantiles by a second road, refusals, words.

POINTS = (np.arange(2**16) + 0.5) / 2**16
"""Midpoints: the mean of a function of them is its integral, to 1e-9 for what is smooth inside."""

LAW = normal(mean=0.5, standard_deviation=0.05)
LOG_SIGMA = math.sqrt(math.log1p(0.4**2))
CASES = {
    "normal": (LAW, stats.truncnorm(-CUT, CUT, loc=0.5, scale=0.05)),
    "uniform": (uniform(low=2.0, high=5.0), stats.uniform(2.0, 3.0)),
    "log-uniform": (log_uniform(low=0.2, high=5.0), stats.loguniform(0.2, 5.0)),
    "log-normal": (
        log_normal(mean=2.0, standard_deviation=0.8),
        stats.lognorm(LOG_SIGMA, scale=2.0 * math.exp(-0.5 * LOG_SIGMA**2)),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_quantiles_and_moments_are_those_of_scipy_and_of_their_integrals(name):
    """To rounding; the log-normal of scipy has no end, which moves 2.9e-7 of probability."""
    ours, theirs = CASES[name]
    u = np.linspace(0.01, 0.99, 99)
    # The cut at 5 standard deviations takes 8e-6 of a normal one's and 3e-5 of this log-normal one's. The
    # outermost points that a sampling can give stay between the stated ends.
    assert ours.quantile(u) == pytest.approx(theirs.ppf(u), rel=1e-5 if name == "log-normal" else 1e-12)
    assert float(np.mean(ours.quantile(POINTS))) == pytest.approx(ours.mean, rel=1e-5)
    assert ours.mean == pytest.approx(theirs.mean(), rel=1e-12)
    assert float(np.std(ours.quantile(POINTS))) == pytest.approx(ours.standard_deviation, rel=1e-4)
    assert ours.standard_deviation == pytest.approx(theirs.std(), rel=1e-4)
    ends = ours.quantile(np.array([2.0**-31, 1.0 - 2.0**-31]))
    assert ours.low <= ends[0] < ends[1] <= ours.high


@pytest.mark.parametrize("ratio", [1.0001, 1.05, math.exp(0.0999), math.exp(0.1001), 30.0])
def test_the_width_of_a_log_uniform_distribution_is_exact_on_both_sides_of_its_series(ratio):
    """Gauss points integrate the variance about the mean without cancellation; to rounding they agree."""
    law = log_uniform(low=1.0, high=ratio)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    values = ratio ** (0.5 + 0.5 * nodes)
    variance = 0.5 * float(weights @ (values - law.mean) ** 2)
    assert law.standard_deviation == pytest.approx(math.sqrt(variance), rel=1e-10)


def test_samples_are_drawn_with_equal_weights_in_rising_order():
    """Each of n values takes one n-th of the probability; moments are those of the list."""
    law = samples(values=(0.3, 0.1, 0.2, 0.2))
    drawn = law.quantile(np.array([0.0, 0.24, 0.26, 0.74, 0.76, 1.0]))
    assert drawn.tolist() == [0.1, 0.1, 0.2, 0.2, 0.3, 0.3]
    assert law.mean == pytest.approx(np.mean([0.1, 0.2, 0.2, 0.3]), rel=1e-15)
    assert law.standard_deviation == pytest.approx(np.std([0.1, 0.2, 0.2, 0.3]), rel=1e-14)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: normal(mean=1.0, standard_deviation=0.0), "standard_deviation must be > 0; got 0.0."),
        (lambda: normal(mean=math.nan, standard_deviation=1.0), "mean must be a finite number"),
        (lambda: log_normal(mean=0.0, standard_deviation=1.0), "mean must be > 0"),
        (lambda: uniform(low=2.0, high=1.0), "high must be > 2; got 1.0."),
        (lambda: uniform(low=-math.inf, high=1.0), "low must be a finite number"),
        (lambda: log_uniform(low=0.0, high=1.0), "low must be > 0"),
        (lambda: samples(values=(1.0,)), "values must have 2 to 10000 samples; got 1."),
        (lambda: samples(values=(1.0, math.inf)), "values must be a finite number"),
        (lambda: samples(values=(2.0, 2.0)), "values must differ"),
    ],
)
def test_a_record_refuses_what_is_no_distribution(make, words):
    """A distribution of Python is checked as that of a file."""
    with pytest.raises(InputError, match="must") as error:
        make()
    assert words in str(error.value)
