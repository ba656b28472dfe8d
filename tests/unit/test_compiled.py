"""Compiled kernels and their cache."""

from separatrix import compiled
from separatrix.cage.run import run_chunk
from separatrix.compiled import source_stamp


def test_a_change_in_any_file_with_kernels_is_seen(tmp_path):
    """Another source, another stamp; files without kernels do not count."""
    kernels, other = tmp_path / "deep" / "a.py", tmp_path / "b.py"
    kernels.parent.mkdir()
    kernels.write_text("from separatrix.compiled import kernel\n")
    other.write_text("pass\n")
    stamp = source_stamp(tmp_path)
    other.write_text("pass  # changed\n")
    assert source_stamp(tmp_path) == stamp
    kernels.write_text("from separatrix.compiled import kernel  # changed\n")
    assert source_stamp(tmp_path) != stamp


def test_the_stamp_is_part_of_the_key_of_cached_code():
    """Code that was compiled from other sources is not found."""
    assert run_chunk._cache._index_key((), run_chunk.targetctx.codegen())[-1] == compiled._STAMP
