"""The verb `tribometer`: raw logs to friction with its scatter, a friction file and pages of plots."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.cli.console import answer, progress_bar
from separatrix.errors import InputError
from separatrix.staged import staged, writable_folder
from separatrix.units import printable, shown

if TYPE_CHECKING:
    from separatrix.friction.tribometer import ReducedLogs

SUFFIX = ".toml"


@dataclass(frozen=True, slots=True, kw_only=True)
class TribometerOptions:
    """What follows the files on the command line."""

    out: Path | None
    map: Path | None
    plots: Path | None
    run_in: str | None
    join: bool
    json: bool
    quiet: bool
    jobs: int

    @property
    def plots_folder(self) -> Path | None:
        """Folder of the pages: as named, or beside the friction file."""
        beside = None if self.out is None else self.out.with_name(f"{self.out.stem}-plots")
        return beside if self.plots is None else self.plots


def tribometer(paths: Sequence[Path], options: TribometerOptions) -> int:
    """Read and reduce logs, show what was read, write the files; return the exit status.

    Raises
    ------
    InputError
        An option or a file is wrong: the first one, and how many others are; nothing is written.
    """
    if options.out is not None:
        _refuse_out(options.out)
    from separatrix.friction.records import place

    if options.run_in is not None:
        place(options.run_in, "--run-in")
    with contextlib.ExitStack() as folders:
        for folder in (options.out and options.out.parent, options.plots_folder):
            if folder is not None:
                folders.enter_context(writable_folder(folder))
        from separatrix.friction.tribometer import tribometer as reduced  # before the work is timed

        with progress_bar("tribometer", quiet=options.quiet) as progress:
            found = reduced(
                paths,
                column_map=options.map,
                run_in=options.run_in,
                join=options.join,
                complete=options.out is not None,
                jobs=options.jobs,
                progress=progress,
            )
        _deliver(found, options)
    return 0


def _refuse_out(out: Path) -> None:
    from separatrix.friction.file import exists_already

    try:
        folder, exists = out.is_dir(), out.exists() or out.is_symlink()
    except OSError as error:
        where = f"--out {printable(str(out), 200)}"
        raise InputError(where, "cannot be written", error.strerror or type(error).__name__) from None
    if out.suffix != SUFFIX or folder:
        cure = 'Name a file like "friction.toml".'
        raise InputError("--out", f"must name a file that ends in {SUFFIX}", shown(str(out)), cure)
    if exists:
        raise exists_already(out)


def _deliver(found: ReducedLogs, options: TribometerOptions) -> None:
    from separatrix.friction.file import exists_already, friction_text
    from separatrix.present.text.tribometer import tribometer as in_words
    from separatrix.present.tribometer import tribometer as document

    out, plots = options.out, options.plots_folder
    written = None if out is None else str(out)
    if plots is not None:
        _draw(found, options, plots)
    if out is not None and found.friction_tests is not None:
        with staged(out.parent) as stage:
            (stage / out.name).write_text(friction_text(found.friction_tests), encoding="utf-8")
            if out.exists():  # since the first check
                raise exists_already(out)
    if options.json:
        answer(json.dumps(document(found, written=written), indent=1, allow_nan=False) + "\n")
    else:
        answer(in_words(found, written=written, plots=None if plots is None else str(plots)))


def _draw(found: ReducedLogs, options: TribometerOptions, folder: Path) -> None:
    """Write a page of plots for each test, and the data that it is drawn from."""
    from separatrix import figures
    from separatrix.figures.tribometer import page
    from separatrix.present import save
    from separatrix.present.tribometer import page_data

    names: dict[str, int] = {}
    with staged(folder) as stage, progress_bar("pages of plots", quiet=options.quiet) as progress:
        for done, one in enumerate(found.reductions, 1):
            name = file_name(one.log.source)
            names[name] = number = names.get(name, 0) + 1
            path = stage / (name if number == 1 else f"{name}-{number}")
            data = page_data(one)
            save(data, path.with_name(f"{path.name}.nc"))
            figures.save(page(data), path.with_name(f"{path.name}.png"))
            if progress is not None:
                progress(done, len(found.reductions))


def file_name(source: str) -> str:
    """Name of a test as the name of a file: letters, digits, dots and dashes."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in source)
    return "-".join(part for part in plain.split("-") if part).strip(".-")[:100] or "test"
