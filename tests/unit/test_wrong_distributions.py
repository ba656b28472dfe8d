"""Distributions that a study file may not have: one line each, with place, rule, value and cure."""

import pytest
from commands import refusal, table

from separatrix.study.reading import read_study

HEAD = 'title = "Wrong"\nextends = "cryogenic-turbopump"\n'
CANDIDATE = '[[ranking.candidates]]\nname = "{}"\nfriction = {{ "air" = {} }}\n'
FORMS = {"film": "[film]\nthickness = {}\n", "friction": CANDIDATE.replace('"{}"', '"One"')}
FORMS["ball"] = (
    "[bearing]\nball_material = {{ elastic_modulus = '2e5 MPa', poisson_ratio = {}, density = '8 g/cm3' }}\n"
)
FORMS["second"] = f"""{CANDIDATE.format("One", 0.1).replace("{", "{{").replace("}", "}}")}\
[[ranking.candidates]]
name = "One.air"
friction = {{{{ "lox" = 0.1 }}}}
material = {{{{ elastic_modulus = "5 GPa", poisson_ratio = {{}} }}}}
"""
WRONG = r"""
film: "0.5 um +- 0 %" :: line 4: [film] thickness ; width > 0 ; is certain
film: "0.5 um +- -20 %" :: a width > 0 ; "-20 %" ; no sign
film: "0.5 um +- 0 um" :: a width > 0 ; "0 um"
film: "0.5 um +- -0.1 um" :: a width > 0 ; "-0.1 um" ; no sign
film: "0.5 um +- 20" :: after +-, needs a unit, or % ; "20 %", or the width
film: "0.5 um +- 0.1 N" :: after +- ; which is a force
film: "0.5 +- 20 %" :: needs a unit before +- too ; "0.5 um +- 20 %"
film: "0.5 +- 0.1 um" :: needs a unit before +- too ; on either side
film: "(0.5 +- 0.1)" :: one number and one unit of length
film: "(0.5 +- 20 %) um" :: after +- ; "20 % um"
film: "0.5 um +- 20 % +- 3 %" :: one value, +- and one expanded uncertainty
film: "0,5 um +- 20 %" :: decimal point, not a comma
film: { between = [0.2, 1] } :: between, item 1, needs a unit of length
[film]\nrace_friction = "0.1 mm +- 10 %" :: must be a plain number
[film]\nrace_friction = "0,1 +- 10 %" :: a decimal point
[film]\nmaterial = { elastic_modulus = "2 GPa +- 0 %", poisson_ratio = 0.4 }
    :: [film] material.elastic_modulus ; a width > 0
friction: "0.1 +- 0 %" :: friction.air ; a width > 0
[kinematics]\nmodel = ["free", "inner race control"] :: [kinematics] model must be
[bearing]\nball_count = [12, 12.5] :: item 2, must be a whole number
[stability]\nruns = [32, 64] :: [stability] runs must be a whole number
film: "0.5 um +-" :: one value, +- and one ; like "0.5 um +- 20 %"
film: "+- 20 %" :: one value, +- and one
film: { between = ["1 um", "0.2 um"] } :: between must rise; got "1 um" and "0.2 um" ; lower one first
film: { between = ["1 um", "1000 nm"] } :: must rise ; if it is certain
film: { between = ["1 um", "2 um", "3 um"] } :: a list of two bounds
film: { between = ["0 um", "1 um"] }
    :: leaves the range that the study takes at the lower end ; [film] thickness must be > 0
film: { between = ["1 um", "1 m"] } :: must be <= 10 mm ; { between = ["1 um", "1 m"] }, whose mean is 500
film: { between = ["0 um", "1 um"], log = true } :: must be > 0 with log = true
film: { between = ["1 um", "2 um"], log = 1 } :: log must be true or false
film: { samples = ["1 um", "2 um"], log = true } :: only with between
film: { mean = "1 um" } :: lacks: standard_deviation
film: { standard_deviation = "1 um" } :: lacks: mean
film: { mean = "1 um", standard_deviation = "0 um" } :: a width > 0
film: { mean = "1 um", standard_deviation = "-1 nm" } :: a width > 0
film: { mean = "1 um", standard_deviation = 0.1 } :: standard_deviation needs a unit of length
film: { mean = "1 um", standard_deviation = "1 nm", between = ["1 um", "2 um"] }
    :: must have only one of between
film: {} :: must have between, or mean with standard_deviation, or samples
film: { betwen = ["1 um", "2 um"] } :: betwen is not a key ; Did you mean between?
film: [] :: must have 2 to 10000 samples; got 0
film: ["1 um"] :: must have 2 to 10000 samples ; without brackets
film: ["1 um", "1000 nm"] :: must differ: there is no spread
film: ["1 um", "thin"] :: item 2, must be one number and one unit
film: ["1 um", 2] :: item 2, needs a unit of length
film: ["3 um", "-1 um"] :: at the lower end, -1 um
film: { samples = 3 } :: must be a list in [brackets]
film: [["1 um", "2 um"], "3 um"] :: item 1, needs a unit
film: { mean = "1 um", standard_deviation = "40 um" }
    :: leaves the range that the study takes ; write { between
[operation]\nradial_load = "0 N +- 10 %" :: is a share of 0
[operation]\nradial_load = "0 N +- 10 N" :: at the lower end, -25 N ; radial_load must be >= 0
[operation]\ntemperature = "-196 degC +- 2 %" :: whose zero is arbitrary ; in kelvin
[bearing]\ninner_conformity = "0.505 +- 0.01" :: at the lower end, 0.48 ; must be > 0.5 and <= 0.6
[bearing]\nball_count = { between = [12, 13] } :: a list of whole numbers
[bearing]\nball_count = "13 +- 1" :: "13 +- 1". Write it like [12, 13].
[bearing]\nball_count = [13, 30] :: at the upper end, 30 ; must be at most
[stability]\nkicks = ["1 m/s +- 10 %"] :: kicks[1] takes no distribution
[stability]\nkicks = { between = ["1 m/s", "2 m/s"] } :: kicks must be a list
[stability]\nseed = "1 +- 1" :: seed takes no distribution
[cage]\npocket_clearance = { between = ["0.1 mm", "6 mm"] }
    :: at the upper end, 6 mm ; smaller than the gap between balls
ball: "0.45 +- 0.1"
    :: [bearing] ball_material.poisson_ratio leaves ; must be >= 0 and < 0.5
friction: { between = [-0.1, 0.1] } :: line 5: [ranking] candidates[1].friction.air leaves ; -0.1
second: { between = [0.2, 0.7] }
    :: line 9: [ranking] candidates[2].material.poisson_ratio leaves ; at the upper end, 0.7
friction: "0 +- 0.1" :: friction.air.mean must be >= 1e-05 where there is a standard deviation [-]; got 0.
friction: { mean = 0, standard_deviation = 0.1 }
    :: friction.air.mean must be >= 1e-05 where there is a standard deviation [-]; got 0.
friction: { mean = 0.1, standard_deviation = "-9 %" } :: a width > 0
film: "0.5 um +- 1e160 m" :: must be
friction: { between = [1e-160, 1], log = true } :: must be
friction: [1e200, 1e-3] :: must be
film: ["1e308 m", "1.1e308 m"] :: must be
[bearing]\nball_count = [12, 1e300] :: must be
film: { between = ["1 um", "1e299 m"] } :: must be
film: { mean = "1 um", standard_deviation = "1e-200 m" } :: must be
"""
"""Text of a study that extends the shipped one, or a thickness of its film or a friction in air."""


@pytest.mark.parametrize(("text", "words"), table(WRONG))
def test_a_wrong_distribution_is_refused_in_one_line(text, words, tmp_path):
    """Where it stands, what must hold and what was given, and nothing but `InputError`."""
    form, _, value = text.partition(": ")
    text = FORMS[form].format(value) if form in FORMS else f"{text}\n"
    (tmp_path / "wrong.toml").write_text(HEAD + text, encoding="utf-8")
    assert refusal(words, read_study, tmp_path / "wrong.toml").startswith("wrong.toml")


def test_more_than_fifty_uncertain_numbers_are_refused(tmp_path):
    """Their samples would say little of each."""
    text = "".join(CANDIDATE.format(i, '"0.1 +- 10 %"') for i in range(51))
    (tmp_path / "wrong.toml").write_text(HEAD + text)
    refusal(["has more than 50 uncertain numbers; got 51"], read_study, tmp_path / "wrong.toml")
