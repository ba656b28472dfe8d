"""The verb `tribometer` as a function of Python."""

import json

import numpy as np
import pytest
from commands import column_map

import separatrix
from separatrix.front import main
from separatrix.ground.errors import InputError

MAP = {"test": {"material": "Armalon", "counterface": "440C", "medium": "air"}}


@pytest.fixture
def folder(tmp_path):
    """A folder with two logs and a note."""
    for name, friction in (("a2.csv", 0.1), ("a10.csv", 0.12)):
        noise = np.random.default_rng(len(name)).normal(friction, 0.004, 400)
        rows = (f"{0.5 * i},{value:.5f}" for i, value in enumerate(noise))
        (tmp_path / name).write_text("\n".join(["time [s],COF", *rows]))
    (tmp_path / "notes.md").write_text("none")
    return tmp_path


def test_it_returns_what_the_command_prints(folder, capsys):
    """The same numbers, tests in the order of the numbers in their names, progress up to its total."""
    steps = []
    found = separatrix.tribometer(folder, progress=lambda done, total: steps.append((done, total)))
    assert main(["tribometer", str(folder)]) == 0
    assert capsys.readouterr().out == found.summary()
    assert main(["tribometer", str(folder), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == found.document()
    printed = document["tests"]
    assert [test.source for test in found.tests] == ["a2.csv", "a10.csv"]
    assert [test.friction for test in found.tests] == [test["friction"] for test in printed]
    assert [log.rows for log in found.logs] == [400, 400]
    assert steps[-1] == (1000, 1000)
    assert found.friction_tests is None
    assert found.fit is None


def test_with_a_column_map_it_fits_and_takes_the_end_of_running_in(folder):
    """One path or several; a map as an object; the tests as a friction file keeps them."""
    found = separatrix.tribometer([folder / "a2.csv"], column_map=column_map(MAP), run_in="60 s")
    (test,) = found.friction_tests
    assert (test.material, test.environment, test.run_in_end.value) == ("Armalon", "air, 440C", 60.0)
    assert found.fit.of("Armalon", "air, 440C").at().mean == pytest.approx(test.friction)


def test_logs_of_one_name_in_two_folders_are_two_tests_each_with_its_own_conditions(folder):
    """The end of running-in that the map states for one of them is not that of the other."""
    for place, name in (("one", "a2.csv"), ("two", "a10.csv")):
        (folder / place).mkdir()
        (folder / name).rename(folder / place / "a.csv")
    stated = column_map({"files": {"one/*.csv": {"run_in_end": "60 s"}}})
    first, second = separatrix.tribometer([folder / "one", folder / "two"], column_map=stated).tests
    assert (first.run_in_method, second.run_in_method == "given") == ("given", False)


def test_the_speed_of_a_turning_disk_is_that_of_the_steady_part(tmp_path):
    """60 rpm, then 120 rpm behind the end of running-in, on a radius of the map: 0.251 m/s."""
    rows = "".join(f"{i},{0.1 + 0.001 * (i % 3)},{60 if i < 150 else 120}\n" for i in range(300))
    (tmp_path / "a.csv").write_text(f"time [s],COF,Speed [rpm]\n{rows}")
    radius = column_map({"test": {"track_radius": "20 mm"}})
    (test,) = separatrix.tribometer(tmp_path / "a.csv", run_in="150 s", column_map=radius).tests
    assert test.conditions.slip_speed == pytest.approx(4 * np.pi * 0.02, rel=1e-12)  # rounding


def test_its_tables_and_pages_are_those_of_a_test(folder):
    """One row for each test; the series and the page of a test by its source; another source is refused."""
    found = separatrix.tribometer(folder)
    table = found.to_dataframe()
    assert [*table["source"]] == ["a2.csv", "a10.csv"]
    assert [*table["friction"]] == [test.friction for test in found.tests]
    assert "a10.csv" in found.plot("a10.csv").get_suptitle()
    with pytest.raises(InputError, match=r"no picture a3\.csv"):
        found.plot("a3.csv")


@pytest.mark.parametrize(
    ("friction", "medium", "words"),
    [
        (0.0, "air", "friction must be > 0; got 0. Its friction is zero in every row used: check"),
        (3.0, "air", "friction must be <= 2; got 3. If a force was read as friction, map it as tangential"),
        (0.1, "air, dry", 'medium must not hold a comma; got "air, dry". An environment is named'),
    ],
)
def test_a_test_that_a_friction_file_cannot_keep_is_refused_by_its_log(tmp_path, friction, medium, words):
    """One line with the log's name, the rule, the value and the cure; no name of a class."""
    rows = "".join(f"{i},{friction}\n" for i in range(100))
    (tmp_path / "a.csv").write_text(f"time [s],COF\n{rows}")
    stated = column_map({"test": MAP["test"] | {"medium": medium}})
    with pytest.raises(InputError) as caught:
        separatrix.tribometer(tmp_path / "a.csv", column_map=stated, complete=True)
    line = str(caught.value)
    assert line.startswith(f"a.csv: {words}")
    assert "\n" not in line
