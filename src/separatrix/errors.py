"""What separatrix raises on purpose, and the one line it says."""

from __future__ import annotations

from collections.abc import Sequence


class SeparatrixError(Exception):
    """Base of every error that separatrix raises on purpose."""


class InputError(SeparatrixError, ValueError):
    """A wrong input: where it stands, the rule, the unit, the value, the cure.

    Parameters
    ----------
    where : str
        The quantity, for instance ``"[bearing] inner_conformity"``.
    rule : str
        What must hold, for instance ``"must lie between 0.5 and 0.6"``.
    unit : str
        Unit of the rule's numbers; empty where there is none, ``"-"`` if dimensionless.
    value : str
        What was given; empty if nothing was.
    cure : str
        A sentence that helps; may be empty.
    """

    def __init__(self, where: str, rule: str, unit: str = "", value: str = "", cure: str = "") -> None:
        super().__init__(where, rule, unit, value, cure)
        self.where, self.rule, self.unit, self.value, self.cure = where, rule, unit, value, cure
        self.problems: tuple[InputError, ...] = ()

    def __str__(self) -> str:
        text = f"{self.where} {self.rule}".rstrip() + (f" [{self.unit}]" if self.unit else "")
        text += f"; got {self.value}." if self.value else "."
        return f"{text} {self.cure}".rstrip()


def together(problems: Sequence[InputError]) -> InputError:
    """One error for everything wrong at once, a line each; its `problems` holds each."""
    single = [one for problem in problems for one in problem.problems or (problem,)]
    if len(single) == 1:
        return single[0]
    error = InputError("\n".join(map(str, single)).removesuffix("."), "")
    error.problems = tuple(single)
    return error


class ConvergenceError(SeparatrixError, RuntimeError):
    """An iteration did not settle; carries how far it came."""

    def __init__(self, message: str, iterations: int = 0, residual: float = 0.0) -> None:
        super().__init__(message, iterations, residual)
        self.message, self.iterations, self.residual = message, iterations, residual

    def __str__(self) -> str:
        return self.message


class DataError(SeparatrixError, LookupError):
    """A table of the library lacks what was asked for."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class ValidityWarning(UserWarning):
    """A model is used outside the range its source gives; the numbers are returned."""
