"""The command `app`: the local page of a folder of studies."""

from __future__ import annotations

import contextlib
import webbrowser
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from separatrix.cli.console import answer
from separatrix.cli.verbs import WHOLE
from separatrix.errors import InputError

HELP = "Open the page: edit, run and look at the studies of a folder in a browser."
EPILOG = (
    "It is served on 127.0.0.1 only, to who has the link that is printed; nothing leaves this machine. Jobs "
    "keep their finished runs: a page that is ended in the middle of one goes on when it is asked again. "
    'Needs the extra app: pip install "separatrix[app]".'
)
FOLDER_HELP = "Where the studies are [default: here]."
NEEDED = ("fastapi", "uvicorn", "plotly", "tomlkit")
MOST_PORT = 65535


def page(
    folder: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", help="Where the studies are [default: here].", show_default=False),
    ] = Path("."),
    port: Annotated[Any, typer.Option(**WHOLE, help="Port to listen on [default: any that is free].")] = None,
    open_it: Annotated[bool, typer.Option("--open", help="Open it in the browser, too.")] = False,
) -> int:
    """Serve the page until Ctrl-C, and return the exit status."""
    if not folder.is_dir():
        raise InputError(str(folder), "is not a folder", cure="Name the folder of your studies.")
    if port is not None and not 1 <= port <= MOST_PORT:
        raise InputError("--port", f"must lie between 1 and {MOST_PORT}", got=str(port))
    if lacking := [name for name in NEEDED if find_spec(name) is None]:
        cure = 'Install the extra: pip install "separatrix[app]".'
        raise InputError("separatrix app", f"needs {', '.join(lacking)}", cure=cure)
    from separatrix.app.server import Server

    server = Server(folder.resolve(), port=port or 0)
    answer(f"The page of {folder.resolve()} is at\n\n  {server.link}\n\nCtrl-C ends it.\n")
    if open_it:
        webbrowser.open(server.link)
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
        server.serve_until_ended()
    return 0
