"""Distributions that a study file may not have: one line each, with place, rule, value and cure."""

import pytest

from separatrix.ground.errors import InputError
from separatrix.study.reading import read_study

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


WRONG = {
    "zero percent": (
        film('"0.5 um +- 0 %"'),
        ("line 4: [film] thickness", "width > 0", "is certain"),
    ),
    "negative percent": (film('"0.5 um +- -20 %"'), ("a width > 0", '"-20 %"', "no sign")),
    "zero width": (film('"0.5 um +- 0 um"'), ("a width > 0", '"0 um"')),
    "negative width": (film('"0.5 um +- -0.1 um"'), ("a width > 0", '"-0.1 um"', "no sign")),
    "width without unit": (film('"0.5 um +- 20"'), ("after +-, needs a unit, or %", '"20 %", or the width')),
    "width in another unit": (film('"0.5 um +- 0.1 N"'), ("after +-", "which is a force")),
    "mean without unit": (film('"0.5 +- 20 %"'), ("needs a unit before +- too", '"0.5 um +- 20 %"')),
    "one unit for both": (film('"0.5 +- 0.1 um"'), ("needs a unit before +- too", "on either side")),
    "brackets without unit": (film('"(0.5 +- 0.1)"'), ("one number and one unit of length",)),
    "a percentage in brackets": (film('"(0.5 +- 20 %) um"'), ("after +-", '"20 % um"')),
    "two signs": (film('"0.5 um +- 20 % +- 3 %"'), ("one value, +- and one expanded uncertainty",)),
    "nothing behind the sign": (film('"0.5 um +-"'), ("one value, +- and one", 'like "0.5 um +- 20 %"')),
    "nothing before the sign": (film('"+- 20 %"'), ("one value, +- and one",)),
    "a decimal comma": (film('"0,5 um +- 20 %"'), ("decimal point, not a comma",)),
    "words": (film('"about 0.5 um +- some"'), ("must be one number and one unit of length",)),
    "nan": (film('"nan um +- 20 %"'), ("must be a finite number",)),
    "too long": (film('"0.5 um +- ' + "1" * 200 + '%"'), ("one value, +- and one",)),
    "reversed bounds": (
        film('{ between = ["1 um", "0.2 um"] }'),
        ('between must rise; got "1 um" and "0.2 um"', "lower one first"),
    ),
    "equal bounds": (film('{ between = ["1 um", "1000 nm"] }'), ("must rise", "if it is certain")),
    "one bound": (film('{ between = ["1 um"] }'), ("a list of two bounds; got a list of 1",)),
    "three bounds": (film('{ between = ["1 um", "2 um", "3 um"] }'), ("a list of two bounds",)),
    "a bound that is no list": (film('{ between = "1 um" }'), ("a list of two bounds",)),
    "bounds without units": (film("{ between = [0.2, 1] }"), ("between, item 1, needs a unit of length",)),
    "a bound that is not allowed": (
        film('{ between = ["0 um", "1 um"] }'),
        ("leaves the range that the study takes at the lower end", "[film] thickness must be > 0"),
    ),
    "a bound beyond all film": (
        film('{ between = ["1 um", "1 m"] }'),
        ("must be <= 10 mm", '{ between = ["1 um", "1 m"] }, whose mean is 500'),
    ),
    "log of zero": (film('{ between = ["0 um", "1 um"], log = true }'), ("must be > 0 with log = true",)),
    "log that is no truth": (film('{ between = ["1 um", "2 um"], log = 1 }'), ("log must be true or false",)),
    "log without bounds": (film('{ samples = ["1 um", "2 um"], log = true }'), ("only with between",)),
    "a mean alone": (film('{ mean = "1 um" }'), ("lacks: standard_deviation",)),
    "a deviation alone": (film('{ standard_deviation = "1 um" }'), ("lacks: mean",)),
    "a zero deviation": (film('{ mean = "1 um", standard_deviation = "0 um" }'), ("a width > 0",)),
    "a negative deviation": (film('{ mean = "1 um", standard_deviation = "-1 nm" }'), ("a width > 0",)),
    "a deviation without unit": (
        film('{ mean = "1 um", standard_deviation = 0.1 }'),
        ("standard_deviation needs a unit of length",),
    ),
    "two forms at once": (
        film('{ mean = "1 um", standard_deviation = "1 nm", between = ["1 um", "2 um"] }'),
        ("must have only one of between",),
    ),
    "an empty table": (film("{}"), ("must have between, or mean with standard_deviation, or samples",)),
    "an unknown key": (
        film('{ betwen = ["1 um", "2 um"] }'),
        ("betwen is not a key", "Did you mean between?"),
    ),
    "no samples": (film("[]"), ("must have 2 to 10000 samples; got 0",)),
    "one sample": (film('["1 um"]'), ("must have 2 to 10000 samples", "without brackets")),
    "equal samples": (film('["1 um", "1000 nm"]'), ("must differ: there is no spread",)),
    "samples with text": (film('["1 um", "thin"]'), ("item 2, must be one number and one unit",)),
    "samples without unit": (film('["1 um", 2]'), ("item 2, needs a unit of length",)),
    "a sample that is not allowed": (film('["3 um", "-1 um"]'), ("at the lower end, -1 um",)),
    "samples that are no list": (film("{ samples = 3 }"), ("must be a list in [brackets]",)),
    "samples in samples": (film('[["1 um", "2 um"], "3 um"]'), ("item 1, needs a unit",)),
    "too wide to be log-normal": (
        film('{ mean = "1 um", standard_deviation = "40 um" }'),
        ("leaves the range that the study takes", "write { between"),
    ),
    "no share of zero": ('[operation]\nradial_load = "0 N +- 10 %"\n', ("is a share of 0",)),
    "a load around zero": (
        '[operation]\nradial_load = "0 N +- 10 N"\n',
        ("at the lower end, -25 N", "radial_load must be >= 0"),
    ),
    "percent of degrees": (
        '[operation]\ntemperature = "-196 degC +- 2 %"\n',
        ("whose zero is arbitrary", "in kelvin"),
    ),
    "a share of a fluid": ('[operation]\nfluid = { between = ["a", "b"] }\n', ("fluid",)),
    "kinematics": ('[kinematics]\nmodel = ["free", "inner race control"]\n', ("[kinematics] model must be",)),
    "a ratio with a unit": ('[film]\nrace_friction = "0.1 mm +- 10 %"\n', ("must be a plain number",)),
    "a ratio with a comma": ('[film]\nrace_friction = "0,1 +- 10 %"\n', ("a decimal point",)),
    "a ratio too wide": (
        '[bearing]\ninner_conformity = "0.505 +- 0.01"\n',
        ("at the lower end, 0.48", "must be > 0.5 and <= 0.6"),
    ),
    "a count with bounds": ("[bearing]\nball_count = { between = [12, 13] }\n", ("a list of whole numbers",)),
    "a count with a width": ('[bearing]\nball_count = "13 +- 1"\n', ('"13 +- 1". Write it like [12, 13].',)),
    "half a ball": ("[bearing]\nball_count = [12, 12.5]\n", ("item 2, must be a whole number",)),
    "too many balls": ("[bearing]\nball_count = [13, 30]\n", ("at the upper end, 30", "must be at most")),
    "uncertain kicks": ('[stability]\nkicks = ["1 m/s +- 10 %"]\n', ("kicks[1] takes no distribution",)),
    "kicks between": ('[stability]\nkicks = { between = ["1 m/s", "2 m/s"] }\n', ("kicks must be a list",)),
    "uncertain runs": ("[stability]\nruns = [32, 64]\n", ("[stability] runs must be a whole number",)),
    "an uncertain seed": ('[stability]\nseed = "1 +- 1"\n', ("seed takes no distribution",)),
    "a pocket wider than its gap": (
        '[cage]\npocket_clearance = { between = ["0.1 mm", "6 mm"] }\n',
        ("at the upper end, 6 mm", "smaller than the gap between balls"),
    ),
    "a modulus in place": (
        '[film]\nmaterial = { elastic_modulus = "2 GPa +- 0 %", poisson_ratio = 0.4 }\n',
        ("[film] material.elastic_modulus", "a width > 0"),
    ),
    "a Poisson's ratio in place": (
        '[bearing]\nball_material = { elastic_modulus = "2e5 MPa", poisson_ratio = "0.45 +- 0.1", density = '
        '"7800 kg/m3" }\n',
        ("[bearing] ball_material.poisson_ratio leaves", "must be >= 0 and < 0.5"),
    ),
    "a friction below zero": (
        friction("{ between = [-0.1, 0.1] }"),
        ("line 5: [ranking] candidates[1].friction.air leaves", "-0.1"),
    ),
    "a property of the second candidate": (
        friction("0.1")
        + '[[ranking.candidates]]\nname = "One.air"\nfriction = { "lox" = 0.1 }\n'
        + 'material = { elastic_modulus = "5 GPa", poisson_ratio = { between = [0.2, 0.7] } }\n',
        ("line 9: [ranking] candidates[2].material.poisson_ratio leaves", "at the upper end, 0.7"),
    ),
    "a friction around zero": (
        friction('"0 +- 0.1"'),
        ("friction.air.mean must be >= 1e-05 where there is a standard deviation [-]; got 0.",),
    ),
    "a friction of zero that scatters": (
        friction("{ mean = 0, standard_deviation = 0.1 }"),
        ("friction.air.mean must be >= 1e-05 where there is a standard deviation [-]; got 0.",),
    ),
    "a friction of zero width": (friction('"0.1 +- 0 %"'), ("friction.air", "a width > 0")),
    "a friction of text": (friction('["low", "high"]'), ("friction.air, item 1, must be a plain number",)),
    "a friction's deviation": (friction('{ mean = 0.1, standard_deviation = "-9 %" }'), ("a width > 0",)),
    "more than fifty": (MANY, ("has more than 50 uncertain numbers; got 51",)),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_distribution_is_refused_in_one_line(name, tmp_path):
    """Where it stands, what must hold and what was given, and nothing but `InputError`."""
    text, words = WRONG[name]
    path = tmp_path / "wrong.toml"
    path.write_text(HEAD + text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_study(path)
    message = str(error.value)
    assert "\n" not in message
    assert message.startswith("wrong.toml")
    for word in words:
        assert word in message, message


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
    path = tmp_path / "case.toml"
    path.write_text(HEAD + TOO_FAR[kind])
    with pytest.raises(InputError, match=r"case.toml, line \d+: .* must be") as error:
        read_study(str(path))
    assert "\n" not in str(error.value)
