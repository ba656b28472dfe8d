"""The notebooks of the documentation run from start to end, and are stored without what they print."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_is_stored_without_outputs(path, monkeypatch):
    """Each ends without an error and shows text and a figure."""
    notebook = nbformat.read(path, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not [cell for cell in cells if cell.outputs or cell.execution_count]
    monkeypatch.delenv("MPLBACKEND", raising=False)  # else the kernel does not show figures
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    shown = [output for cell in cells for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in shown)
    assert any(output.output_type == "stream" and output.name == "stdout" for output in shown)
    assert not [output.text for output in shown if output.output_type == "stream" and output.name == "stderr"]
