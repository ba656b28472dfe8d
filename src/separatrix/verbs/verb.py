"""What every verb and tool is: options, what it computes, its page; one frozen record, read by every door."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

if TYPE_CHECKING:
    from collections.abc import Iterator

    from separatrix.ground.plain_data import Part
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study


class Option(NamedTuple):
    """What a door shows of an option: its line of help, and what stands for its value.

    `is_argument` says that it has a place on the command line instead of a name; one without a default must
    be there. `flag` is its name there if that is not the name of its field. A whole number with a `most`
    lies between 1 and that.
    """

    help: str
    metavar: str = ""
    is_argument: bool = False
    flag: str = ""
    most: int = 0


KICK = 'Initial disturbance, for instance "0.5 m/s" [default: the reference of the study].'
Kick = Annotated[str | float | None, Option(KICK, "SPEED")]
Samples = Annotated[int, Option("Bearings drawn, a power of two.", "N")]
"""Options of several verbs."""

Shown = dict[str, tuple[Any, Option, Any]]
"""Type, `Option` and default of each option, by name; `dataclasses.MISSING` of one without a default."""


def shown_options(options: type) -> Shown:
    """Return what a door shows of each field of a class of options."""
    hints = get_type_hints(options, include_extras=True)
    found = {}
    for field in fields(options):
        hint = hints[field.name]
        note = next(one for one in hint.__metadata__ if isinstance(one, Option))
        found[field.name] = hint.__origin__, note, field.default
    return found


def kind_of(hint: Any) -> str:
    """Return what an option of a type takes: a flag, number, file or text, or several, as in `texts`."""
    kinds = {get_origin(hint) or hint, *get_args(hint)}
    known = {bool: "flag", int: "number", Path: "file"}
    one = next((kind for type_, kind in known.items() if type_ in kinds), "text")
    return f"{one}s" if tuple in kinds else one


@dataclass(frozen=True, slots=True, kw_only=True)
class NoOptions:
    """Of a verb that takes none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A question without a study of its own: to logs, to the library, to saved answers.

    `options` is the class of its options: each field has an `Option` beside its type. `compute` takes the
    options and, where it `takes_time`, the number of threads and what hears of its progress; it returns
    its document, and `page` makes the page of that. `rows` is the key of its main list, `folder` the usual
    place of its files, empty for one that writes none; one that `writes_data` writes more than its document
    and its text. `help` is its line of help if that is not in `TOOLS`. One with `pictures` writes these
    alone, into the folder that this returns for its options. `ended` is what an interrupt leaves undone.
    """

    name: str
    compute: Callable[..., Any]
    page: Callable[[Part], Page]
    options: type = NoOptions
    epilog: str | None = None
    takes_time: bool = False
    help: str = ""
    rows: str = ""
    folder: str = ""
    writes_data: bool = True
    pictures: Callable[[Any], Path | None] | None = None
    ended: str = "no answer was given."


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb(Tool):
    """A question to a study.

    `compute` takes the study, the options and, of a verb that keeps runs, a `Runner`, and returns its record;
    `page` makes the page of its document. `needs` are sections of a study that may be left out but not here.
    `keeps_runs` is for an answer whose finished runs are kept in its folder, and that may be made on a
    cluster. `moves_a_cage` is for one whose model may be chosen. `links` are functions of `cage_of_study`
    that refuse what the verb would refuse.
    """

    needs: tuple[str, ...] = ()
    moves_a_cage: bool = False
    keeps_runs: bool = False
    links: tuple[str, ...] = ()

    def refusals(self, study: Study) -> Iterator[str]:
        """Yield, in a second, what the verb would refuse of a study, a sentence each."""
        if self.links:
            from separatrix.verbs.parts import cage_of_study

            yield from cage_of_study.refused(study, *(getattr(cage_of_study, one) for one in self.links))
