"""Every value of a library, a friction file and a study wrong in nine ways: decided as by the readers before.

The decisions are in reader_mutants.json: the lines that are refused, or "read"; and each rule that refuses
one, with its bounds, units, words and cure, by the key. The decisions of the hand-written
readers were the same, but that a wrong row of a friction table had the line of its header, and that a study
lost the line of `title`, a fault beside a refused one, and the lines of a wrong distribution's neighbours.
Written anew, after a look at each difference, by `python tests/unit/test_reader_mutants.py`.
"""

import json
import re
import tempfile
from pathlib import Path

import pytest
from commands import read_friction
from rich_studies import SPACE

from separatrix import InputError, read_study
from separatrix.study.library import read_library

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
    "study": SPACE,
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


def changed_at(text, pair, change):
    """The text with one of its pairs of key and value changed in one of the ways."""
    key, value, changed = pair[1], pair[3], CHANGES[change]
    wrong = f'{key[:-2]}q"' if key[0] == '"' else f"{key[:-1]}q"
    if isinstance(changed, tuple):
        new = f"{key} = {re.sub(*changed, value)}"
    else:
        new = changed.format(key=key, value=value, wrong=wrong)
    return text[: pair.start()] + (new + (pair[4] or "") if new else "") + text[pair.end() :]


def decisions(dialect, folder, rules):
    """Refused lines of every mutant, in the order of the values, by the change; the rules by their keys."""
    text, path = FILES[dialect], folder / f"{dialect}.toml"
    for change in CHANGES:
        found = []
        for pair in PAIR.finditer(text):
            path.write_text(changed_at(text, pair, change))
            try:
                READERS[dialect](path)
                found.append("read")
            except InputError as error:
                found.append(" ".join(sorted(set(re.findall(r"toml, line (\d+)", str(error))), key=int)))
                for one in error.problems or (error,):
                    if not one.rule.startswith(("is not a valid key", "is not valid TOML")):
                        rules.setdefault(re.sub(r"^.*?(, line \d+: |$)", "", one.path), set()).add(
                            f"{one.rule}. {one.cure}"
                        )
        yield change, found


def decided(dialect, folder):
    """All that is frozen of a dialect, as JSON has it."""
    rules = {}
    lines = dict(decisions(dialect, folder, rules))
    return lines | {f"rules of {key}": sorted(said) for key, said in sorted(rules.items())}


@pytest.mark.parametrize("dialect", FILES)
def test_mutants_are_decided_as_before(dialect, tmp_path):
    """Which are read, and the lines and rules of those that are not."""
    assert decided(dialect, tmp_path) == json.loads(FROZEN.read_text(encoding="utf-8"))[dialect]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        rows = {dialect: decided(dialect, Path(made)) for dialect in FILES}
    one = {
        d: ",\n".join(f"{json.dumps(c)}: {json.dumps(f)}" for c, f in of.items()) for d, of in rows.items()
    }
    FROZEN.write_text(
        "{" + ",\n".join(f'"{d}": {{\n{lines}}}' for d, lines in one.items()) + "}\n", encoding="utf-8"
    )
