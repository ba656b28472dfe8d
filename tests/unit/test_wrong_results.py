"""Saved answers that are wrong, or made to do harm: each is refused in one line, and draws as it is."""

import json

import drawn
import numpy as np
import pytest

import separatrix
from separatrix.comparing.saved import MOST_BYTES
from separatrix.figures import draw
from separatrix.figures.style import heading, literal_texts
from separatrix.front import main
from separatrix.ground.errors import InputError

ANSWER = separatrix.bearing("cryogenic-turbopump").document()


def saved(folder, **changes):
    """Write the answer of a bearing, changed, and return its path."""
    path = folder / "bearing.json"
    path.write_text(json.dumps(ANSWER | changes))
    return path


def test_a_saved_answer_is_read_as_arrays(tmp_path):
    """With units and places on the axes, as the answer in Python has them."""
    data = separatrix.load(saved(tmp_path))
    assert (data["load_inner"].dims, data["load_inner"].attrs) == (("ball",), {"units": "N"})
    np.testing.assert_array_equal(data["load_inner"], [row["load_inner"] for row in ANSWER["balls"]])


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"units": {"balls": {"ball_spin": ["rad/s", "direction", "race"]}}}, "is damaged"),
        ({"units": {"balls": {"": [1, 2, 3, 4]}}}, "is damaged"),
        ({"balls": [{"ball": 0}, 1]}, "is damaged"),
        ({"contacts": {"inner": {"slip": [[1.0], 2.0]}}, "units": {"contacts": "N"}}, "is damaged"),
        ({"study": []}, "is not the document of an answer"),
        ({"verb": "none"}, "must be an answer of rank, sensitivity"),
        ({"complete": False}, "is not a complete answer of this version"),
    ],
    ids=str,
)
def test_an_answer_that_was_changed_is_refused(tmp_path, changes, rule):
    """Units that do not fit, rows that are not rows, another study: one line, not a traceback."""
    with pytest.raises(InputError, match=rule):
        separatrix.load(saved(tmp_path, **changes))


def test_a_file_that_was_cut_or_is_too_large_is_refused(tmp_path):
    """At whatever byte: a line, not a traceback; and before it is read."""
    path = saved(tmp_path)
    whole = path.read_bytes()
    for length in range(0, len(whole), 997):
        path.write_bytes(whole[:length])
        with pytest.raises(InputError, match="is not the document of an answer: no valid JSON"):
            separatrix.load(path)
    with path.open("ab") as file:
        file.truncate(MOST_BYTES + 1)
    with pytest.raises(InputError, match="is larger than an answer can be, 256 MB"):
        separatrix.load(path)


def test_a_study_nested_without_end_is_refused(tmp_path, capsys):
    """One line."""
    path, deep = saved(tmp_path), '{"a":' * 3000 + "1" + "}" * 3000
    path.write_text(path.read_text().replace('"study": {', f'"study": {{"a": {deep},', 1))
    assert main(["compare", str(path), str(path), "--json"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)


def test_no_input_sends_control_characters_to_the_terminal(tmp_path, capsys, monkeypatch):
    """In a title of a saved answer, in the name of a file, in a message: spelled out."""
    monkeypatch.chdir(tmp_path)
    path = str(saved(tmp_path, title="\x1b[31mRED\x07\x9b\u202e"))
    assert main(["compare", path, path]) == 0
    told = capsys.readouterr()
    odd = tmp_path / "\x1b]0;title\x07.toml"
    odd.write_text('extends = "cryogenic-turbopump"\n')
    assert main(["check", str(odd)]) == 0
    told_of_name = capsys.readouterr()
    for text in (*told, *told_of_name):
        assert all(c == "\n" or c.isprintable() for c in text)


def test_a_dollar_in_a_name_is_written_as_it_is_in_every_figure():
    """Names, title and study; matplotlib would take what is between two for a formula, and fail."""
    data = drawn.curve(**drawn.candidates([[0.1, 0.2]]) | {"material": ["$^$", "B"]})
    film = {"material": {"name": "$_$"}, "thickness": {"value": 5e-7}}
    data.attrs = {"title": "$^$", "study": json.dumps({"film": film})}
    assert heading(literal_texts(data)) == [r"\$^\$", r"\$_\$, 500 nm"]
    for _, figure in draw("stability", data):
        figure.canvas.draw()
