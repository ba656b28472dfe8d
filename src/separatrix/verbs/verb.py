"""What every verb is: its options, what it computes, its page; one frozen record, read by every door."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, NamedTuple, get_type_hints

if TYPE_CHECKING:
    from collections.abc import Iterator

    from separatrix.ground.document import Part
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study


class Option(NamedTuple):
    """What a door shows of an option: its line of help, and what stands for its value."""

    help: str
    metavar: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoOptions:
    """Of a verb that takes none."""


def no_refusals(study: Study) -> Iterator[str]:  # noqa: ARG001
    """Yield nothing: what a verb needs stands in `needs`."""
    return iter(())


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question to a study.

    `options` is the class of its options: each field has an `Option` beside its type. `compute` takes the
    study, the options and, of a verb that keeps runs, a `Runner`, and returns its record; `page` makes the
    page of its document. `needs` are sections of a study that may be left out but not here. `keeps_runs` is
    for an answer whose finished runs are kept in its folder, and that may be made on a cluster.
    `moves_a_cage` is for one whose models of motion and ball may be chosen. `refusals` yields, in a second,
    what the verb would refuse of a study or take long for, a sentence each.
    """

    name: str
    help: str
    compute: Callable[..., Any]
    page: Callable[[Part], Page]
    options: type = NoOptions
    needs: tuple[str, ...] = ()
    epilog: str | None = None
    moves_a_cage: bool = False
    has_full: bool = False
    writes_data: bool = True
    keeps_runs: bool = False
    refusals: Callable[[Study], Iterator[str]] = no_refusals

    def shown_options(self) -> Mapping[str, tuple[Any, Option, Any]]:
        """Type, help and default of each option, by name."""
        hints = get_type_hints(self.options, include_extras=True)
        found = {}
        for field in fields(self.options):
            hint = hints[field.name]
            note = next(one for one in hint.__metadata__ if isinstance(one, Option))
            found[field.name] = hint.__origin__, note, field.default
        return found
