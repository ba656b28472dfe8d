"""The verbs without a bearing as Python functions: logs of tribometers, and the library of materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.friction.log_series import ReducedLogs
from separatrix.friction.log_series import tribometer as reduced
from separatrix.ground.errors import InputError
from separatrix.ground.toml import nearest
from separatrix.ground.units import Kelvin, shown
from separatrix.study.library import Library, beside, library_files, with_files
from separatrix.study.library.records import KINDS, UNITS, AnyRecord, contradictions

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from separatrix.friction.logs.column_map import ColumnMap
    from separatrix.friction.reduction import Reduction
    from separatrix.ground.plain_data import Document
    from separatrix.told.materials import Shown
    from separatrix.verdict.long_jobs import Progress

# Path of a library file or of a folder of them.
Libraries = Sequence[str | Path]


@dataclass(frozen=True, kw_only=True, eq=False)
class TribometerAnswer(ReducedLogs):
    """What logs of tribometers show, from `tribometer`."""

    def document(self) -> Document:
        """Plain data, as ``--json`` prints it: SI units, None where something is absent."""
        from separatrix.present.tribometer import document

        return document(self, written=None)

    def summary(self) -> str:
        """Text, as the command line prints it."""
        from separatrix.present.tribometer import in_words

        return in_words(self, written=None, plots=None)

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each test, in SI units."""
        import pandas as pd

        return pd.json_normalize(self.document()["tests"])

    def to_xarray(self, source: str | None = None) -> xr.Dataset:
        """Friction over the test, its distribution, correlation and spectrum: of the first or named test."""
        from separatrix.present.tribometer import page_data

        return page_data(self._reduction(source))

    def plot(self, source: str | None = None) -> Figure:
        """Return the page of plots of the first test, or of the one with this source."""
        from separatrix.figures.tribometer import page

        return page(self.to_xarray(source))

    def _reduction(self, source: str | None) -> Reduction:
        for one in self.reductions:
            if source in (None, one.log.source):
                return one
        sources = ", ".join(one.log.source for one in self.reductions)
        raise InputError("source", "is not a test of these logs", shown(source), f"There is {sources}.")


def tribometer(
    paths: str | Path | Sequence[str | Path],
    *,
    column_map: ColumnMap | str | Path | None = None,
    run_in: str | None = None,
    join: bool = False,
    complete: bool = False,
    jobs: int = 1,
    progress: Progress | None = None,
) -> TribometerAnswer:
    """Read logs of tribometers and reduce each test to its steady friction.

    Parameters
    ----------
    paths : path or sequence of paths
        Logs, each of one or several tests, or folders of them.
    column_map : ColumnMap or path, optional
        What the files do not state themselves.
    run_in : str, optional
        Where running-in ends in all of them, such as ``"10 min"``; else as in the map, else as detected.
    join : bool
        Whether all logs of a folder are parts of one test.
    complete : bool
        Whether a test that a friction file cannot keep is refused.
    jobs : int
        Threads. The answer does not depend on it.
    progress : callable, optional
        Called with the number of steps done and their total.

    Raises
    ------
    InputError
        A file is wrong: the first one, and how many others are.
    """
    found = reduced(
        paths,
        column_map=column_map,
        run_in=run_in,
        join=join,
        complete=complete,
        jobs=jobs,
        progress=progress,
    )
    return TribometerAnswer(
        reductions=found.reductions, friction_tests=found.friction_tests, fit=found.fit, notes=found.notes
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Materials:
    """Records of the library, from `materials`."""

    library: Library
    records: tuple[AnyRecord, ...]

    def document(self) -> Document:
        """Plain data, as ``materials list --json`` prints it, without the version."""
        return {
            "libraries": [file.plain() for file in self.library.files],
            "materials": [record.plain() for record in self.records],
        }

    def summary(self) -> str:
        """Text, as ``materials list`` prints it."""
        from separatrix.told.materials import listed

        return listed(self.records)

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each number of a material, film or fluid, with unit, conditions, source, confidence."""
        import pandas as pd

        rows = [
            {"kind": record.kind, "name": record.name, "property": key, **datum.plain(UNITS[key])}
            for record in self.records
            for key, data in record.data.items()
            for datum in data
        ]
        return pd.DataFrame(rows)

    def find(self, name: str) -> tuple[AnyRecord, ...]:
        """Return the records of a name; a fluid also by another name of it.

        Raises
        ------
        InputError
            There is none.
        """
        found = tuple(record for record in self.records if record.name == name)
        if found:
            return found
        fluid = self.library.fluid(name)
        if fluid is not None and any(record.kind == "fluid" for record in self.records):
            return (fluid,)
        kinds = {record.kind for record in self.records}
        rule = f"is not a {kinds.pop() if len(kinds) == 1 else 'record'} of the library"
        raise InputError("NAME", rule, shown(name), nearest(name, [record.name for record in self.records]))

    def show(self, name: str, *, temperature: Kelvin | None = None) -> list[Shown]:
        """Return records whole; at a temperature with what serves there.

        Raises
        ------
        InputError
            No record has this name.
        """
        from separatrix.told.materials import Shown

        views = []
        for record in self.find(name):
            if temperature is None or record.kind == "friction table":
                views.append(Shown(record=record))
            elif record.kind != "fluid":
                material = self.library.material(record.kind, record.name, temperature)
                taken = (material.record or {}).get("taken", {})
                one = Shown(record=record, taken_at=temperature, taken=taken, cautions=material.cautions)
                views.append(one)
            else:
                cautions = [*contradictions(record.plain(), temperature)]
                views.append(Shown(record=record, taken_at=temperature, cautions=cautions))
        return views


def materials(kind: str | None = None, *, libraries: Libraries = ()) -> Materials:
    """Records of the library: the shipped ones, those of the current folder, and those of `libraries`.

    Parameters
    ----------
    kind : str, optional
        Only ``"bearing material"``, ``"cage material"``, ``"film"``, ``"fluid"`` or ``"friction table"``.
    libraries : sequence of paths
        Library files, or folders of them, besides ``materials.toml`` and the folder ``materials``.

    Raises
    ------
    InputError
        A file is wrong or not there, or the kind is not one of these.
    """
    paths = beside(Path())
    for named in libraries:
        if not str(named) or not Path(named).exists():
            raise InputError("--library", "does not name a file or folder", f'"{named}"')
        paths += library_files(Path(named))
    library = with_files(paths)
    kinds: tuple[str, ...] = KINDS
    if kind is not None:  # in any spelling, and in the plural too
        spelled = kind.strip().casefold().replace("_", " ")
        kinds = tuple(known for known in KINDS if spelled in (known, f"{known}s"))
        if not kinds:
            raise InputError("--kind", "is not a kind of record", shown(kind), nearest(kind, KINDS))
    records = tuple(one for each in kinds for one in library.records(each).values())
    return Materials(library=library, records=records)
