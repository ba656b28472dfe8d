"""The server of the local page: its routes behind the guard, on this machine only."""

from __future__ import annotations

import contextlib
import secrets
import socket
import threading
import warnings
from collections.abc import AsyncIterator
from importlib.util import find_spec
from pathlib import Path

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import FileResponse, Response
from fastapi.staticfiles import StaticFiles

from separatrix.app import editing, exploring, logs, results
from separatrix.app.guard import Guard
from separatrix.app.jobs import Jobs
from separatrix.app.page import TEMPLATES, Folder, Page
from separatrix.app.worker import Task
from separatrix.chain.solution import solve
from separatrix.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.figures.space_page import VIEW
from separatrix.study_file import read_study

HOST = "127.0.0.1"
MOST_CONNECTIONS = 200
IDLE = 10
"""Time after which an idle connection is closed [s]."""

MOST_READY = 12
"""Answers that are read before they are looked at; reading one takes up to a second."""

STATIC = Path(__file__).with_name("static")
A_DAY = {"cache-control": "max-age=86400"}


def plotly_file() -> Path:
    """Return the file of JavaScript in the Python package of Plotly, without importing the package."""
    found = find_spec("plotly")
    if found is None or found.origin is None:
        cure = 'Install it: pip install "separatrix[app]".'
        raise InputError("separatrix app", "needs its extra", cure=cure)
    return Path(found.origin).parent / "package_data" / "plotly.min.js"


def application(root: Path) -> FastAPI:
    """Return the page of a folder, unguarded."""
    page, drawing = Page(folder=Folder(root=root), jobs=Jobs(root)), plotly_file()

    def read(task: Task) -> None:
        if task.verb in results.READ:
            page.dataset(task.folder / f"{task.verb}.nc")

    page.jobs.after = read

    @contextlib.asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        threading.Thread(target=made_ready, args=(page,), daemon=True).start()
        yield
        page.jobs.close()

    app = FastAPI(lifespan=life, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.root, app.state.page = root, page
    for routes in (editing.routes, results.routes, exploring.routes, logs.routes):
        app.include_router(routes(page))

    @app.exception_handler(SeparatrixError)
    def refused(request: Request, error: SeparatrixError) -> Response:
        problems = error.problems if isinstance(error, InputError) and error.problems else (error,)
        template = "refusal.html" if "hx-request" in request.headers else "refused.html"
        found = page.html(template, faults=[str(one) for one in problems])
        found.status_code = 422
        return found

    @app.get("/static/plotly.min.js")
    def plotly() -> FileResponse:
        return FileResponse(drawing, media_type="text/javascript", headers=A_DAY)

    app.mount("/static/space", StaticFiles(directory=VIEW))
    app.mount("/static", StaticFiles(directory=STATIC))
    return app


def made_ready(page: Page) -> None:
    """Load what the first views need, while the page answers already.

    These are the templates, the newest answers that have figures, and the kernels that the sliders use.
    """
    warnings.simplefilter("ignore", ValidityWarning)  # shown in the page, where an answer has some
    for name in TEMPLATES.list_templates():
        TEMPLATES.get_template(name)
    for path in page.newest(results.READ)[:MOST_READY]:
        page.dataset(path)
    found = solve(read_study("cryogenic-turbopump"))
    _ = found.restitution, found.friction  # computed when asked for


def listening(port: int) -> socket.socket:
    """Return a socket that listens on this machine only; port 0 takes any free one.

    Raises
    ------
    InputError
        The port is taken.
    """
    found = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        found.bind((HOST, port))
    except OSError as error:
        found.close()
        cure = "Choose another one, or leave it out for any that is free."
        raise InputError("--port", "cannot be used", got=f"{port} ({error.strerror})", cure=cure) from None
    found.listen(128)
    return found


class Server(uvicorn.Server):
    """The page of a folder behind its guard; `link` opens it."""

    def __init__(self, root: Path, *, port: int = 0) -> None:
        self.socket, token = listening(port), secrets.token_urlsafe(24)
        port = self.socket.getsockname()[1]
        self.link = f"http://{HOST}:{port}/?token={token}"
        guarded = Guard(application(root), token=token, port=port)
        super().__init__(
            uvicorn.Config(
                guarded,
                log_level="warning",
                access_log=False,
                server_header=False,
                limit_concurrency=MOST_CONNECTIONS,
                timeout_keep_alive=IDLE,
                timeout_graceful_shutdown=3,
                lifespan="on",
            )
        )

    def serve_until_ended(self) -> None:
        """Serve until Ctrl-C."""
        self.run(sockets=[self.socket])
