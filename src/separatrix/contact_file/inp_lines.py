"""Numbers of an input file of CONTACT in their order, each refused in its line and case."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from separatrix.errors import InputError
from separatrix.units import NUMBER, shown


@dataclass(slots=True)
class InpLines:
    """Numbers of the file in order; comments begin with %."""

    label: str
    lines: Iterator[tuple[int, list[str]]]
    line: int = 0
    case: int = 1
    rest: list[str] = field(default_factory=list)
    """Words of the line after those that were read."""

    def wrong(self, what: str, rule: str, got: str = "", cure: str = "") -> InputError:
        """Refusal of a number on this line."""
        return InputError(f"{self.label}, line {self.line}: case {self.case}, {what}", rule, got, cure)

    def words(self, what: str) -> list[str]:
        """Words of the next line that has some."""
        found = next(self.lines, None)
        if found is not None:
            self.line, words = found
            return words
        raise InputError(f"{self.label}: case {self.case}, {what}", "is missing: the file ends before it")

    def numbers(self, *names: str) -> list[float]:
        """A number for each name, on as many lines as they take."""
        found: list[float] = []
        while len(found) < len(names):
            words, missing = self.words(names[len(found)]), len(names) - len(found)
            for word in words[:missing]:
                found.append(self._number(word, names[len(found)]))
            self.rest = words[missing:]
        return found

    def _number(self, word: str, name: str) -> float:
        angle = math.pi / 180.0 if name == "CHI" and word[-1:] in "dD" else 1.0
        plain = word.rstrip("dDrR") if name == "CHI" else word
        try:
            value = float(re.sub("[dD]", "e", plain)) * angle
        except ValueError:
            raise self.wrong(name, "must be a number", shown(word)) from None
        if not math.isfinite(value):
            raise self.wrong(name, "must be finite", shown(word))
        return value

    def refuse_more(self, what: str) -> None:
        """Refuse a number other than 0 that follows, which CONTACT reads if it is there."""
        more = self.rest[0] if self.rest else ""
        if re.fullmatch(NUMBER, more) and float(more) != 0.0:
            raise self.wrong(what, "must be 0 or left out", shown(more))

    def whole(self, value: float, name: str) -> int:
        """The number as an integer."""
        if value != int(value):
            raise self.wrong(name, "must be a whole number", f"{value:g}")
        return int(value)

    def digits(self, names: str) -> dict[str, int]:
        """Digits of a control word by their letters; those in front that are left out are 0."""
        word, *self.rest = self.words(f"control digits {names}")
        if not word.isdecimal() or len(word) > len(names):
            raise self.wrong(f"control digits {names}", "must be one number of these digits", shown(word))
        return dict(zip(names, map(int, word.zfill(len(names))), strict=True))
