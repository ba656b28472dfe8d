"""Every value of a library, a friction file and a study wrong in nine ways: decided as by the readers before.

The decisions are in reader_mutants.json: the lines that are refused, or "read". Those of the hand-written
readers were the same, but that a wrong row of a friction table had the line of its header, and that a study
lost the line of `title`, a fault beside a refused one, and the lines of a wrong distribution's neighbours.
Written anew, after a look at each difference, by `python tests/unit/test_reader_mutants.py`.
"""

import json
import re
import tempfile
from pathlib import Path

import pytest

from separatrix.friction.file import read_friction
from separatrix.ground.errors import InputError
from separatrix.study.library.reading import read_library
from separatrix.study.reading import read_study

pytestmark = pytest.mark.filterwarnings("ignore::separatrix.ground.errors.ValidityWarning")
FROZEN = Path(__file__).with_name("reader_mutants.json")
READERS = {"library": read_library, "friction": read_friction, "study": read_study}
FILES = {
    "library": """\
title = "Ours"
[cage_material."Ours"]
elastic_modulus = { value = "9 GPa", range = ["8 GPa", "9.5 GPa"], source = "test 12", confidence = "guess" }
poisson_ratio = { value = 0.38, temperature = ["4 K", "400 K"], source = "as PEEK", confidence = "guess" }
density = { value = "1400 kg/m3", pressure = "1 bar", form = "ring", source = "sheet", confidence = "maker" }
aliases = ["Our compound", "C7"]
replaces = false
[fluid."slush"]
substance = "nitrogen"
phase = "liquid"
coolprop = "Nitrogen"
boiling_temperature = { value = "77.4 K", medium = "none", source = "table", confidence = "handbook; old" }
[friction_table."rig"]
title = "Our rig"
source = "Report 5"
confidence = "measured; three tests each"
environments = ["air, 440C", "LN2, 440C"]
slip_speed = ["1 m/s", "4 m/s"]
normal_force = "10 N"
[friction_table."rig".friction."Ours"]
"LN2, 440C" = { mean = 0.12, standard_deviation = 0.01, count = 3 }
"air, 440C" = 0.2
""",
    "friction": """\
title = "Ours"
[[test]]
material = "Armalon"
counterface = "440C"
medium = "liquid nitrogen"
friction = 0.08
standard_error = 0.01
standard_deviation = 0.02
effective_count = 30.5
temperature = "77 K"
slip_speed = ["1 m/s", "5 m/s"]
pressure = ["1 MPa", "2 MPa"]
sample = "s1"
test = "t1"
run_in_end = "200 m"
flags = ["drift", "too short"]
source = "a.csv"
checksum = "ab"
reduced_by = "separatrix"
""",
    "study": """\
[bearing]
ball_diameter = "7.144 mm"
pitch_diameter = "36 mm"
ball_count = 12
radial_clearance = "12 um +- 10 %"
inner_conformity = 0.53
outer_conformity = 0.54
ball_material = { elastic_modulus = "205 GPa", poisson_ratio = 0.285, density = "7650 kg/m3", name = "ours" }
ring_material = "440C"

[operation]
inner_speed = "6000 rpm"
axial_load = "40 N"
radial_load = "5 N"
moment = "0 N m"
temperature = "20 degC"
fluid = "vacuum"
ramp_time = "50 ms"
ramp_start = 0.2

[film]
race_friction = { between = [0.05, 0.1] }
elastic_modulus = "4 GPa"
poisson_ratio = 0.38
thickness = ["0.4 um", "0.5 um", "0.7 um"]
wear = { width = "0.05 mm", friction = 0.3, thickness = "0.1 um", races = "inner" }

[traction]
model = "exact"
pressure_slip = "included"

[cage]
mass = "3.5 g"
motion = "space"
ball = "traction"
inner_diameter = "33 mm"
outer_diameter = "39 mm"
width = "10 mm"
material = "Vespel SP-3"
pocket_clearance = "0.3 mm"
pocket_shape = "elongated"
pocket_axial_clearance = "0.2 mm"
pocket_axial_offset = "0.02 mm"
guidance = "outer"
land_clearance = "0.3 mm"
land_friction = 0.15
land_count = 2
land_spacing = "8 mm"
land_width = "1 mm"
transverse_inertia = "0.6 kg mm2"
dynamic_unbalance = "0.1 mrad"
gravity = "1 g0"
added_mass = "0.1 g"

[stability]
kicks = ["2 m/s", "0.1 m/s"]
reference_kick = "0.5 m/s"
runs = 32
axial_kick = 0.1
restitution_factors = [0.1, 0.5, 0.9]

[[ranking.candidates]]
name = "Vespel SP-3"
friction = { "vacuum" = { mean = 0.08, standard_deviation = "20 %", count = 4 }, "air, 440C" = "0.2 +- 30 %" }
material = { elastic_modulus = "3.3 GPa", poisson_ratio = 0.4, density = "1.4 g/cm3" }

[[ranking.candidates]]
name = "Phenolic, dry"
friction = { "vacuum" = 0.30 }
material = { elastic_modulus = "7 GPa", poisson_ratio = 0.35 }
""",
}
PAIR = re.compile(r'("[^"\n]*"|[a-z_]+)( = )("[^"\n]*"|\[[^]\n{}]*\]|[0-9.]+|false)(, )?')
CHANGES = {
    "dropped": "",
    "misspelt": "{wrong} = {value}",
    "another unit": (r'(\d) [A-Za-z/0-9]+"', r'\1 mm"'),
    "bare": (r'"([0-9.]+) [^"]*"', r"\1"),
    "negative": (r"(?<![\w.])(\d)", r"-\1"),
    "huge": (r"(?<![\w.])(\d)", r"999999999999\1"),
    "text": '{key} = "x"',
    "nan": "{key} = nan",
    "list": "{key} = []",
}


def decisions(dialect, folder):
    """Refused lines of every mutant, in the order of the values, by the change."""
    text, path = FILES[dialect], folder / f"{dialect}.toml"
    for change, changed in CHANGES.items():
        found = []
        for pair in PAIR.finditer(text):
            key, value = pair[1], pair[3]
            wrong = f'{key[:-2]}q"' if key[0] == '"' else f"{key[:-1]}q"
            if isinstance(changed, tuple):
                new = f"{key} = {re.sub(*changed, value)}"
            else:
                new = changed.format(key=key, value=value, wrong=wrong)
            path.write_text(
                text[: pair.start()] + (new + (pair[4] or "") if new else "") + text[pair.end() :]
            )
            try:
                READERS[dialect](path)
                found.append("read")
            except InputError as error:
                found.append(" ".join(sorted(set(re.findall(r"toml, line (\d+)", str(error))), key=int)))
        yield change, found


@pytest.mark.parametrize("dialect", FILES)
def test_mutants_are_decided_as_before(dialect, tmp_path):
    """Which are read, and the lines of those that are not."""
    assert dict(decisions(dialect, tmp_path)) == json.loads(FROZEN.read_text(encoding="utf-8"))[dialect]


def test_the_files_that_are_changed_are_right(tmp_path):
    """So that each refusal is for its change alone."""
    for dialect, text in FILES.items():
        (tmp_path / "right.toml").write_text(text)
        READERS[dialect](tmp_path / "right.toml")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        rows = {dialect: dict(decisions(dialect, Path(made))) for dialect in FILES}
    one = {
        d: ",\n".join(f"{json.dumps(c)}: {json.dumps(f)}" for c, f in of.items()) for d, of in rows.items()
    }
    FROZEN.write_text(
        "{" + ",\n".join(f'"{d}": {{\n{lines}}}' for d, lines in one.items()) + "}\n", encoding="utf-8"
    )
