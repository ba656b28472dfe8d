"""What a name of the JSON documents means: from the records, and from the table of quantities."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from dataclasses import fields, is_dataclass
from typing import NamedTuple, get_args, get_type_hints

from separatrix.ground.plain_data import field_axes, field_units
from separatrix.present.quantity_text import QUANTITIES

SECTION = re.compile(
    r"^(?:Attributes|Parameters)\n-+\n(.*?)(?=\n\n\S[^\n]*\n---|\Z)", re.DOTALL | re.MULTILINE
)


class Line(NamedTuple):
    """One name of a table, with the unit, the dimensions and the meaning of its value."""

    name: str
    unit: str = ""
    shape: str = ""
    meaning: str = ""


def lines_of(record: type) -> list[Line]:
    """Return a line for each field of a record."""
    axes, meanings = field_axes(record), meanings_of(record)
    counts = {name: "-" for name, hint in get_type_hints(record).items() if int in (hint, *get_args(hint))}
    units = counts | field_units(record)
    return [
        Line(one.name, units.get(one.name, ""), ", ".join(axes.get(one.name, ())), meanings.get(one.name, ""))
        for one in fields(record)
    ]


def meanings_of(record: type) -> dict[str, str]:
    """Return what is stated of each field of a record.

    The record's own words come before those of the records it extends, and these before the table of
    quantities.
    """
    found = {name: one.meaning or one.label for name, one in QUANTITIES.items()}
    for base in reversed([base for base in record.__mro__ if is_dataclass(base)]):
        found |= _of_docstring(base) | _of_source(base)
    return found


def _of_docstring(record: type) -> dict[str, str]:
    """Entries of the sections Attributes and Parameters."""
    found: dict[str, str] = {}
    for section in SECTION.findall(inspect.cleandoc(record.__doc__ or "")):
        for entry in re.split(r"\n(?=\S)", section):
            head, _, text = entry.partition("\n")
            names = head.partition(" : ")[0].split(", ")
            found |= dict.fromkeys(names, " ".join(text.split()))
    return found


def _of_source(record: type) -> dict[str, str]:
    """Text below a field, or the comment beside it."""
    source = textwrap.dedent(inspect.getsource(record))
    lines, (body,) = source.splitlines(), ast.parse(source).body
    found: dict[str, str] = {}
    last = ""
    for node in body.body if isinstance(body, ast.ClassDef) else ():
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            last, comment = node.target.id, lines[(node.end_lineno or 1) - 1].partition("  # ")[2]
            found |= {last: comment} if comment else {}
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and last:
            found[last] = " ".join(str(node.value.value).split())
    return found
