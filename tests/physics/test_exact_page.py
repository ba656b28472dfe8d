"""The example of docs/theory/exact-contact.md runs and gives the numbers beside it."""

import re
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "exact-contact.md"


def test_the_example_of_the_page():
    """Six numbers, to their digits."""
    text = PAGE.read_text(encoding="utf-8")
    names: dict[str, object] = {}
    exec(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], names)  # noqa: S102
    one, free = names["one"], names["free"]
    first = f"{one.traction_coefficient:.5f}, {one.lateral_force:.2f} N and {one.stick_share:.2f}"
    last = f"{free.slope:.2f}, {free.slope_error:.2f} and {free.free_rolling_offset:.2e}"
    assert f"The first three are {first}; the last three {last}." in text
