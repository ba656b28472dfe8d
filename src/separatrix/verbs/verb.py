"""What every verb and tool is: options, what it computes, its page; one frozen record, read by every door."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields
from typing import TYPE_CHECKING, Any, NamedTuple, get_type_hints

if TYPE_CHECKING:
    from collections.abc import Iterable

    from separatrix.ground.document import Document, Part
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study


class Option(NamedTuple):
    """What a door shows of an option: its line of help, and what stands for its value.

    `is_argument` says that it has a place on the command line instead of a name; one without a default must
    be there. `flag` is its name there if that is not the name of its field.
    """

    help: str
    metavar: str = ""
    is_argument: bool = False
    flag: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoOptions:
    """Of a verb that takes none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question to a study.

    `options` is the class of its options: each field has an `Option` beside its type. `compute` takes the
    study, the options and, of a verb that keeps runs, a `Runner`, and returns its record; `page` makes the
    page of its document. `needs` are sections of a study that may be left out but not here. `keeps_runs` is
    for an answer whose finished runs are kept in its folder, and that may be made on a cluster.
    `files` yields name and content of what it writes besides, of its answer, options and who is told of
    progress. `moves_a_cage` is for one whose model may be chosen. `refusals` yields, in a
    second, what the verb would refuse of a study or take long for, a sentence each.
    """

    name: str
    compute: Callable[..., Any]
    page: Callable[[Part], Page]
    options: type = NoOptions
    needs: tuple[str, ...] = ()
    epilog: str | None = None
    moves_a_cage: bool = False
    has_full: bool = False
    writes_data: bool = True
    keeps_runs: bool = False
    files: Callable[..., Iterable[tuple[str, bytes]]] | None = None
    refusals: Callable[[Study], Iterable[str]] = lambda study: ()  # noqa: ARG005

    @property
    def help(self) -> str:
        """Its line of help, which stands in the registry."""
        from separatrix.verbs import VERBS

        return VERBS[self.name]

    def shown_options(self) -> Mapping[str, tuple[Any, Option, Any]]:
        """Type, help and default of each option, by name."""
        return options_of(self.options)


def options_of(kind: type) -> Mapping[str, tuple[Any, Option, Any]]:
    """Type, help and default of each option of a class, by name; `REQUIRED` of one without a default."""
    hints = get_type_hints(kind, include_extras=True)
    found = {}
    for field in fields(kind):
        hint = hints[field.name]
        note = next(one for one in hint.__metadata__ if isinstance(one, Option))
        found[field.name] = hint.__origin__, note, field.default
    return found


REQUIRED = MISSING
"""In the place of a default: the option must be given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A question without a study of its own: to logs, to the library, to saved answers.

    `compute` takes the options and, where it `takes_time`, the number of threads and who is told of its
    progress; it returns its document, and `page` makes the page of that. `rows` is the key of its main list.
    """

    name: str
    compute: Callable[..., Document]
    page: Callable[[Part], Page]
    options: type
    rows: str
    help: str = ""
    epilog: str | None = None
    takes_time: bool = False
    has_full: bool = False

    def shown_options(self) -> Mapping[str, tuple[Any, Option, Any]]:
        """Type, help and default of each option, by name."""
        return options_of(self.options)
