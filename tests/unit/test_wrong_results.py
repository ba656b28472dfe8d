"""Files of results that are wrong, or made to do harm: each is refused in one line before it is read."""

import json
from pathlib import Path

import drawn
import h5py
import numpy as np
import pytest
import xarray as xr

from separatrix.cli import main
from separatrix.figures import draw
from separatrix.figures.style import heading, literal_texts
from separatrix.ground.errors import InputError
from separatrix.present import container, load

STUDY = {"cage": {"mass": {"value": 0.025, "unit": "kg"}}}
HEAD = {"verb": "simulate", "title": "A run", "seed": 1, "study": json.dumps(STUDY)}


def refused(capsys, *arguments: str) -> str:
    """Return the line with which a command is refused."""
    assert main(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    return err


@pytest.fixture
def path(tmp_path):
    """File of results that holds a number, an array, texts, and an axis without points."""
    values = {
        "kick": ((), 0.5),
        "time": (("time",), np.linspace(0.0, 1.0, 50)),
        "name": (("material",), np.array(["A", "B"], dtype=object)),
        "pocket": (("pocket",), np.empty(0)),
    }
    xr.Dataset(values, attrs=HEAD).to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    return tmp_path / "run.nc"


def _external(file: h5py.File, folder: Path) -> None:
    (folder / "secret").write_bytes(b"s" * 40)
    file.create_dataset("leak", (40,), "u1", external=[(str(folder / "secret"), 0, 40)])


def _virtual(file: h5py.File, folder: Path) -> None:
    with h5py.File(folder / "other.nc", "w") as other:
        other["x"] = np.arange(10.0)
    layout = h5py.VirtualLayout(shape=(10,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(folder / "other.nc"), "x", shape=(10,))
    file.create_virtual_dataset("leak", layout)


def _compound(file: h5py.File, folder: Path) -> None:
    file.create_dataset("pair", (2,), np.dtype([("a", "f8"), ("b", "i4")]))


def _references(file: h5py.File, folder: Path) -> None:
    file.create_dataset("reference", (2,), h5py.ref_dtype)


def _enormous_attribute(file: h5py.File, folder: Path) -> None:
    file.attrs.create("numbers", np.zeros(7000), shape=(7000,))
    file["kick"].attrs.create("texts", ["a"] * 2000, dtype=h5py.string_dtype())


def _named_type(file: h5py.File, folder: Path) -> None:
    file["kind"] = np.dtype("f8")


def _link(name: str, link: h5py.SoftLink | h5py.ExternalLink) -> object:
    return lambda file, _: file.__setitem__(name, link)


def _bomb(file: h5py.File, folder: Path) -> None:
    file.create_dataset("zeros", (5_000_000,), "f8", compression="gzip", data=np.zeros(5_000_000))


HARM = {
    "external storage": (_external, "has its data in another file"),
    "virtual": (_virtual, "has its data in another file"),
    "compound": (_compound, "must hold numbers or text"),
    "references": (_references, "must hold numbers or text"),
    "lists of lists": (
        lambda f, _: f.create_dataset("lists", (2,), h5py.vlen_dtype("f8")),
        "must hold numbers or text",
    ),
    "an enumeration": (
        lambda f, _: f.create_dataset("choice", (2,), h5py.enum_dtype({"A": 1})),
        "must hold numbers or text",
    ),
    "a loop": (_link("loop", h5py.SoftLink("/loop")), "is a link"),
    "a soft link": (_link("soft", h5py.SoftLink("/kick")), "is a link"),
    "an external link": (_link("far", h5py.ExternalLink("/etc/passwd", "/x")), "is a link"),
    "a group": (lambda file, _: file.create_group("inside"), "is not an array"),
    "a named type": (_named_type, "is not an array"),
    "a deflate bomb": (_bomb, "is stored in pieces"),
    "huge in pieces": (
        lambda f, _: f.create_dataset("h", (10**6, 10**6), "f8", chunks=(10, 10)),
        "is stored in pieces",
    ),
    "huge": (lambda f, _: f.create_dataset("h", (10**6, 10**6), "f8"), "declares more data than the file"),
    "fixed texts": (lambda f, _: f.create_dataset("t", (10,), "S100000"), "declares more data than the file"),
    "a list of texts as attribute": (_enormous_attribute, "is not a text or numbers"),
    "a reference as attribute": (
        lambda file, _: file.attrs.create("r", file["kick"].ref, dtype=h5py.ref_dtype),
        "is not a text or numbers",
    ),
}


@pytest.mark.parametrize("kind", HARM)
def test_a_file_that_could_do_harm_is_refused_before_it_is_read(path, kind):
    """External storage, links, groups, odd types, and whatever would expand."""
    assert float(load(path)["kick"]) == 0.5
    spoil, message = HARM[kind]
    with h5py.File(path, "a") as file:
        spoil(file, path.parent)
    with pytest.raises(InputError, match=message):
        load(path)


def test_texts_that_share_one_long_text_are_counted_each(path):
    """Small pieces of a file can point to the same long text; an honest file has room for each."""
    with h5py.File(path, "a") as file:
        long = file.create_dataset("long", (400,), h5py.string_dtype())
        long[0], long[1:] = "x" * 20_000, "y" * 8
    raw = bytearray(path.read_bytes())
    with h5py.File(path) as file:
        at, count = file["long"].id.get_offset(), file["long"].size
    for i in range(count):  # length, address and index of a text
        raw[at + 16 * i : at + 16 * (i + 1)] = raw[at : at + 16]
    path.write_bytes(raw)
    with h5py.File(path) as file:
        assert len(file["long"][399]) == 20_000
    with pytest.raises(InputError, match="declares more data than the file has bytes"):
        load(path)


def test_a_heap_of_texts_at_which_the_library_would_not_end_is_refused(path):
    """The free rest of a heap has no length: HDF5 looks for the next piece at the same place for ever."""
    raw = path.read_bytes()
    heap = raw.rindex(b"GCOL\x01\0\0\0")
    size = int.from_bytes(raw[heap + 8 : heap + 16], "little")
    rests = [at for at in range(heap + 16, heap + size, 8) if raw[at : at + 8] == bytes(8)]
    rest = next(at for at in rests if int.from_bytes(raw[at + 8 : at + 16], "little") == heap + size - at)
    path.write_bytes(raw[: rest + 8] + bytes(8) + raw[rest + 16 :])
    with pytest.raises(InputError, match="a heap of texts is not filled by its pieces"):
        load(path)


def test_a_file_that_is_too_large_is_refused(path, monkeypatch):
    """The limit is in the message."""
    monkeypatch.setattr(container, "MOST_BYTES", 1024**2)
    with path.open("ab") as file:
        file.truncate(3 * 1024**2)
    with pytest.raises(InputError, match="is larger than a file of results can be, 1 MB; got 3 MB"):
        load(path)


def test_a_file_that_was_cut_is_refused(path):
    """At whatever byte: a line, not a traceback."""
    whole = path.read_bytes()
    for length in range(0, len(whole), 997):
        path.write_bytes(whole[:length])
        with pytest.raises(InputError, match="is not a readable netCDF"):
            load(path)


SPOILED_HEADS = {
    "seed": (None, "lacks its seed"),
    "study": ("{", "contains a study that separatrix did not write"),
    "title": (None, "lacks its title"),
}


@pytest.mark.parametrize("name", [*SPOILED_HEADS, "a list", "deep", "seed of text"])
def test_a_head_that_is_no_head_is_refused(path, name, capsys):
    """Missing, not JSON, not a table, or nested without end."""
    key, value, message = {
        "a list": ("study", "[]", "contains a study that separatrix did not write"),
        "deep": (
            "study",
            '{"a":' * 3000 + "1" + "}" * 3000,
            "contains a study that separatrix did not write",
        ),
        "seed of text": ("seed", "x", "lacks its seed"),
    }.get(name) or (name, *SPOILED_HEADS[name])
    with h5py.File(path, "a") as file:
        del file.attrs[key]
        if value is not None:
            file.attrs[key] = value
    assert message in refused(capsys, "compare", str(path), str(path), "--json")


def test_no_input_sends_control_characters_to_the_terminal(path, tmp_path, capsys, monkeypatch):
    """In a title of a saved run, in the name of a file, in a message: spelled out."""
    monkeypatch.chdir(tmp_path)
    with h5py.File(path, "a") as file:
        file.attrs["title"] = "\x1b[31mRED\x07\x9b\u202e"
    assert main(["compare", str(path), str(path), "--json"]) in (0, 2)
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
