"""What separatrix raises on purpose: each error is one line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager


class SeparatrixError(Exception):
    """Base of every error that separatrix raises on purpose."""


class InputError(SeparatrixError, ValueError):
    """A wrong input: its path, the rule, what was given, the cure.

    Parameters
    ----------
    path : str
        The quantity and where it stands, for instance ``"case.toml, line 7: [bearing] inner_conformity"``.
    rule : str
        What must hold, with the unit of its numbers: ``"must lie between 0.5 and 0.6 [-]"``.
    got : str
        The value given; empty if there was none.
    cure : str
        A sentence that helps; may be empty.
    """

    def __init__(self, path: str, rule: str, got: str = "", cure: str = "") -> None:
        super().__init__(path, rule, got, cure)
        self.path, self.rule, self.got, self.cure = path, rule, got, cure
        self.problems: tuple[InputError, ...] = ()

    def __str__(self) -> str:
        if self.problems:
            return "\n".join(map(str, self.problems))
        text = f"{self.path} {self.rule}".rstrip()
        text += f"; got {self.got}." if self.got else "."
        return f"{text} {self.cure}".rstrip()

    def at(self, path: str, *, cure: str | None = None) -> InputError:
        """Return the same fault at another path, with its own cure or this one."""
        return InputError(path, self.rule, self.got, self.cure if cure is None else cure)


def together(problems: Sequence[InputError]) -> InputError:
    """One error for everything wrong at once, a line each; its `problems` holds each."""
    single = [one for problem in problems for one in problem.problems or (problem,)]
    if len(single) == 1:
        return single[0]
    error = InputError("\n".join(map(str, single)), "")
    error.problems = tuple(single)
    return error


@contextmanager
def noted(problems: list[InputError]) -> Iterator[None]:
    """Add a refusal to the list of problems instead of raising it."""
    try:
        yield
    except InputError as error:
        problems.extend(error.problems or (error,))


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
