"""The example of docs/theory/exact-contact.md runs and gives the numbers beside it."""

import re
import runpy
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "exact-contact.md"


def test_the_example_of_the_page(tmp_path):
    """Six numbers, to their digits."""
    text, script = PAGE.read_text(encoding="utf-8"), tmp_path / "example.py"
    script.write_text(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1])
    names = runpy.run_path(str(script))
    one, free = names["one"], names["free"]
    first = f"{one.traction_coefficient:.5f}, {one.lateral_force:.2f} N and {one.stick_share:.2f}"
    last = f"{free.slope:.2f}, {free.slope_error:.2f} and {free.free_rolling_offset:.2e}"
    assert f"The first three are {first}; the last three {last}." in text
