"""One number and one unit, read strictly: pint is the oracle for what each unit means."""

import math
import pickle
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix import InputError, read_study, resolved, shipped_studies
from separatrix.ground.units import UNITS, format_number, format_quantity, parse

PINT_NAMES = {
    "lbf in": "lbf * inch",
    "lbf/in": "lbf / inch",
    "in": "inch",
    "kgf": "kilogram_force",
    "g0": "standard_gravity",
    "t": "metric_ton",
    "rev/s": "revolution/s",
    "rev/min": "revolution/min",
    "°C": "degC",
    "°": "degree",
}
"""Spelling for pint where it is not ours; spaces are products and a final digit is a power elsewhere."""

CYCLES = {"Hz", "kHz"}
"""As a rotational speed these are turns per second; pint makes them radians per second."""

EVERY_UNIT = [(si, unit) for si, known in UNITS.items() for unit in known]


def pint_name(unit: str) -> str:
    """Our spelling as pint wants it: ``kg mm2`` is ``kg * mm**2``."""
    if unit in PINT_NAMES:
        return PINT_NAMES[unit]
    powers = "".join(f"**{c}" if c.isdigit() else c for c in unit)
    return powers.replace(" ", " * ")


@pytest.fixture(scope="module")
def registry():
    """The oracle."""
    import pint

    return pint.UnitRegistry()


@pytest.mark.parametrize(("si", "unit"), [u for u in EVERY_UNIT if u[0] != "rad/s" or u[1] not in CYCLES])
def test_every_unit_means_what_pint_says(si, unit, registry):
    """12.5 of each unit of the table, in SI; both round, so the last bit or two may differ."""
    oracle = registry.Quantity(12.5, pint_name(unit)).to(pint_name(si)).magnitude
    assert parse(f"12.5 {unit}", si) == pytest.approx(oracle, rel=4e-16 * 4)


def test_angle_and_cycles_are_kept_apart():
    """250 Hz of rotation is 500 pi rad/s, to the last bit what 15 000 rpm is, and never 250 rad/s."""
    for text in ("250 Hz", "15000 rpm", "250 rev/s", "0.25 kHz", "90000 deg/s"):
        assert parse(text, "rad/s") == 500 * math.pi
    assert parse("250 rad/s", "rad/s") == 250.0
    assert parse("250 Hz", "Hz") == 250.0


@pytest.mark.parametrize(
    ("value", "si", "texts"),
    [
        (3000.0, "N", "300 daN|300daN| 300 daN |+3e2 daN|3000. N|3.0E+3 N|3 kN|.3e4 N"),
        (0.0111125, "m", "11.1125 mm|0.4375 in|11112.5 um"),  # products of floats would differ in a digit
        (5e-7, "m", "0.5 um|0.5 \u00b5m|0.5 \u03bcm"),  # keyboards, word processors
        # superscripts, a caret, a middle dot or a star, as on data sheets
        (2.64e-5, "kg m2", "26.4 kg mm2|26.4 kg mm^2|26.4 kg mm\u00b2|26.4 kg\u00b7mm\u00b2|26.4 kg*mm2"),
        # apostrophes, as some countries write thousands
        (parse("4e4 rpm", "rad/s"), "rad/s", "40'000 rpm|40\u2019000 rpm|40000 rpm"),
    ],
)
def test_one_quantity_is_one_float_however_it_is_written(value, si, texts):
    """Exact arithmetic, rounded once: a change of units or of spelling changes nothing."""
    for text in texts.split("|"):
        assert parse(text, si) == value, text


WRONG = {
    "bare number": (11.1, "m", 'needs a unit of length; got 11.1. Write "11.1 mm".'),
    "bare number as text": ("11.1", "m", 'needs a unit of length; got "11.1". Write "11.1 mm".'),
    "bool": (True, "m", "needs a unit of length; got true."),
    "empty": ("", "m", "one number and one unit of length"),
    "unit only": ("mm", "m", "one number and one unit of length"),
    "two numbers": ("1 2 mm", "m", "one number and one unit of length"),
    "wrong dimension": ("3 N", "m", 'unit of length (m, cm, mm, um, ...); got "3 N", which is a force.'),
    "rad/s for rpm of frequency": ("3 rad/s", "Hz", "which is a rotational speed"),
    "decimal comma": ("1,5 mm", "m", 'needs a decimal point, not a comma; got "1,5 mm". Write "1.5 mm".'),
    "case": ("3 Mpa", "Pa", 'Did you mean "MPa"?'),
    "nan": ("nan mm", "m", "finite"),
    "infinity": ("Infinity mm", "m", "finite"),
    "expression": ("9**9**9 m", "m", "one number and one unit"),
    "underscore": ("1_000 mm", "m", "one number and one unit"),
    "hexadecimal": ("0x10 mm", "m", "needs a unit of length"),
    "newline": ("1 mm\n", "m", "one number and one unit"),
    "no-break space": ("1\u00a0mm", "m", "one number and one unit"),
    "Arabic digits": ("\u0663 mm", "m", "one number and one unit"),
    "minus sign": ("\u22123 mm", "m", "one number and one unit"),
    "overflow": ("1e999 m", "m", "computer can hold"),
    "overflow by the unit": ("1e308 kN", "N", "computer can hold"),
    "underflow": ("1e-999 m", "m", "computer can hold"),
    "long exponent": ("1e9999999999 m", "m", "needs a unit"),
    "very long": ("1" * 1_000_000, "m", "at most 60 characters"),
    **{
        text: (text, "rad/s", "one number and one unit")  # not groups of three digits
        for text in ("40'00 rpm", "4'0000 rpm", "'400 rpm", "1.5'000 rpm", "40'000'0 rpm")
    },
    "forty or forty thousand": ("40,000 rpm", "rad/s", 'Write "40000 rpm" or "40.000 rpm"'),
    "escape": ("1 m\x1b[31m", "m", "needs a unit of length"),
}


@pytest.mark.parametrize(("text", "si", "words"), WRONG.values(), ids=WRONG.keys())
def test_what_is_not_one_number_and_one_unit_is_refused(text, si, words):
    """One printable line of bounded length that says what is due; it survives a process pool."""
    with pytest.raises(InputError) as caught:
        parse(text, si, "[bearing] bore")
    message = str(caught.value)
    assert message.startswith("[bearing] bore ")
    assert words in message
    assert message.isprintable()
    assert len(message) < 250
    assert str(pickle.loads(pickle.dumps(caught.value))) == message  # noqa: S301 - our own bytes


SHOWN = """
0.0111125 m = 11.11 mm; 1.5 m = 1.5 m; 0.0 m = 0 mm; -5.193e-5 m = -51.93 um; 5e-7 m = 500 nm
1570.7963267948966 rad/s = 15000 rpm; 0.4363323129985824 rad = 25 deg; 3000.0 N = 3000 N; 22250.0 N = 22.25 kN
2e11 Pa = 200 GPa; 1.5224e9 Pa = 1.522 GPa; 0.025 kg = 25 g; 3e6 N/m = 3 MN/m; 3979.4 N s/m = 3979 N s/m
2.64e-5 kg m2 = 26.4 kg mm2; 77.0 K = 77 K; 0.09 - = 0.09; 123456789.0 - = 1.235e+08; 1e-9 - = 1e-09
"""


@pytest.mark.parametrize("row", SHOWN.strip().replace("\n", "; ").split("; "))
def test_values_are_shown_in_the_unit_an_engineer_would_choose(row):
    """Four digits, a handy prefix, no exponent where a plain number is readable, no sign of a zero."""
    quantity, text = row.split(" = ")
    value, unit = quantity.split(" ", 1)
    assert format_quantity(float(value), unit) == text
    assert format_quantity(None, unit) == "none"
    assert format_number(-0.0) == "0"


# Whatever the text, the answer is a finite number or one line of refusal; units change nothing.

EXAMPLE = shipped_studies()["cryogenic-turbopump"].read_text(encoding="utf-8")


def refused_in_one_line(call):
    """Result of a call, or None if it was refused properly."""
    refusal = ""
    try:
        return call()
    except InputError as error:
        refusal = str(error)
    assert all(line.isprintable() for line in refusal.split("\n"))
    assert len(refusal) < 400
    return None


nearly = st.from_regex(r"[-+]?[0-9.,_eE*/ ]{1,12} ?[A-Za-z0-9/* ]{0,6}", fullmatch=True)


@settings(max_examples=120)
@given(st.text(max_size=70) | nearly, st.sampled_from(sorted(UNITS)))
def test_any_text_is_a_finite_number_or_refused(text, si):
    """And text in the neighbourhood of the grammar: no exception but ours, no hang, no NaN."""
    value = refused_in_one_line(lambda: parse(text, si))
    assert value is None or math.isfinite(value)


@given(st.floats(-1e12, 1e12, allow_nan=False), st.sampled_from([*sorted(UNITS), "-"]))
def test_a_shown_value_reads_back_to_its_digits(value, si):
    """format_quantity and parse speak the same units; four digits are kept, powers of ten aside."""
    text = format_quantity(value, si)
    number = float(text) if si == "-" else parse(text, si)
    assert number == pytest.approx(value, rel=6e-4, abs=1e-300)  # half a unit of the fourth digit


@given(st.binary(max_size=400))
def test_any_bytes_are_refused_in_one_line(tmp_path: Path, content: bytes):
    """A file of noise."""
    path = tmp_path / "noise.toml"
    path.write_bytes(content)
    assert refused_in_one_line(lambda: read_study(path)) is None


@given(st.integers(0, len(EXAMPLE) - 1), st.integers(1, 40), st.text(max_size=12))
def test_a_damaged_study_is_read_or_refused_in_one_line(tmp_path: Path, start: int, length: int, insert: str):
    """Some characters cut out of the example and others put in."""
    path = tmp_path / "damaged.toml"
    path.write_text(EXAMPLE[:start] + insert + EXAMPLE[start + length :], encoding="utf-8", errors="replace")
    study = refused_in_one_line(lambda: read_study(path))
    assert study is None or resolved(study)["bearing"]["ball_count"]["value"] >= 3
