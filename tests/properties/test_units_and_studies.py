"""Whatever the text, the answer is a finite number or one line of refusal; units change nothing."""

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.ground.errors import InputError
from separatrix.ground.units import UNITS, format_quantity, parse
from separatrix.study.reading import read_study
from separatrix.study.sources import resolved
from separatrix.study.study import shipped_studies

units = st.sampled_from([(si, unit) for si, known in UNITS.items() for unit in known])
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


@given(units, st.floats(-1e9, 1e9, allow_nan=False))
def test_a_number_with_a_unit_is_read_back(unit, number):
    """Scaling by the unit and back returns the number, to rounding; temperatures are shifted too."""
    si, name = unit
    if abs(number) < 1e-9:
        number = 0.0
    value = parse(f"{number!r} {name}", si)
    zero, one = parse(f"0 {name}", si), parse(f"1 {name}", si)
    near = {"rel": 1e-12, "abs": 1e-12 * abs(zero)}  # cancellation of shifts
    assert value == pytest.approx(zero + number * (one - zero), **near)


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


OTHER_UNITS = {
    '"11.1125 mm"': '"0.4375 in"',
    '"65 mm"': '"6.5 cm"',
    '"50 mm"': '"50000 um"',
    '"15000 rpm"': '"250 Hz"',
    '"300 daN"': '"3 kN"',
    '"0.5 um"': '"500 nm"',
    '"25 g"': '"0.025 kg"',
    '"3e6 N/m"': '"3 kN/mm"',
    '"0.6 mm"': '"600 µm"',
    '"1 mm"': '"1e-3 m"',
    '"77 K"': '"77000e-3 K"',
    '"25 deg"': '"1500 arcmin"',
}


def test_a_change_of_units_changes_nothing_to_the_last_bit(tmp_path):
    """The shipped example, every quantity in another unit, is the same study."""
    text = EXAMPLE
    for old, new in OTHER_UNITS.items():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "cryogenic-turbopump.toml"
    path.write_text(text, encoding="utf-8")
    assert read_study(path) == read_study("cryogenic-turbopump")
