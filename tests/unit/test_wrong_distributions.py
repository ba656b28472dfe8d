"""Distributions that a study file may not have: one line each, with place, rule, value and cure."""

import re

import pytest
from commands import refusal_line, refused, rows_of, written

HEAD = 'title = "Wrong"\nextends = "cryogenic-turbopump"\n'
MANY = "\n".join(
    f'[[ranking.candidates]]\nname = "{i}"\nfriction = {{ "air" = "0.1 +- 10 %" }}' for i in range(51)
)


def film(text: str) -> str:
    """Return a film of this thickness."""
    return f"[film]\nthickness = {text}\n"


def friction(text: str) -> str:
    """Return a candidate of this friction in air."""
    return f'[[ranking.candidates]]\nname = "One"\nfriction = {{ "air" = {text} }}\n'


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
film { samples = ["1 um", "2 um"], log = true } :: only with between
film { mean = "1 um" } :: lacks: standard_deviation
film { mean = "1 um", standard_deviation = "1 nm", between = ["1 um", "2 um"] }
    :: must have only one of between
film {} :: must have between, or mean with standard_deviation, or samples
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
[bearing]\nball_count = { between = [12, 13] } :: a list of whole numbers
[bearing]\nball_count = "13 +- 1" :: "13 +- 1". Write it like [12, 13].
[bearing]\nball_count = [12, 12.5] :: item 2, must be a whole number
[bearing]\nball_count = [13, 30] :: at the upper end, 30 ; must be at most
[stability]\nkicks = ["1 m/s +- 10 %"] :: kicks[1] takes no distribution
[stability]\nseed = "1 +- 1" :: seed takes no distribution
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
    "samples of a count": f"[bearing]\nball_count = [12, 1{'0' * 300}]\n",
    "a uniform bound": film('{ between = ["1 um", "1e299 m"] }'),
    "a standard deviation": film('{ mean = "1 um", standard_deviation = "1e-200 m" }'),
}


@pytest.mark.parametrize("kind", TOO_FAR)
def test_numbers_that_overflow_are_refused_in_one_line(kind, tmp_path):
    """Where the mean, the deviation or the quantiles would leave what a computer can hold."""
    line = refusal_line(written(tmp_path, HEAD + TOO_FAR[kind]))
    assert re.match(r"study.toml, line \d+: .* must be", line)


@pytest.mark.parametrize(
    ("samples", "words"),
    [
        *((text, "must be a power of two from 64") for text in ("0", "-64", "32")),
        *(("1000", "Try 1024."), ("131072", "to 65536"), ("9" * 30, "to 65536")),
    ],
)
def test_a_wrong_number_of_bearings_is_refused(samples, words, capsys):
    """Of the verb that draws them."""
    assert words in refused(capsys, "sensitivity", "cryogenic-turbopump", "--samples", samples)


@pytest.mark.parametrize("section", ["cage", "ranking"])
def test_sensitivity_needs_a_cage_and_candidates(section, tmp_path, monkeypatch, capsys):
    """They are what the question is about."""
    monkeypatch.chdir(tmp_path)
    sections = {
        "cage": '[cage]\nmass = "9 g"\nball_cage_stiffness = "3e6 N/m"\npocket_clearance = "0.2 mm"\n',
        "ranking": '[ranking]\nfriction = "pin-on-disk-77K"\n',
    }
    del sections[section]
    written(tmp_path, 'extends = "le7"\n' + "".join(sections.values()))
    assert f"[{section}] is missing" in refused(capsys, "sensitivity", "study.toml")
