"""The page answers its own browser on this machine, and nobody else: each guard, by what it stops."""

import contextlib
import http.client
import os
import socket
import subprocess
import sys
import threading
from urllib.parse import parse_qs, quote, urlsplit

import pytest
from commands import PATIENCE, SMALL, wait_until

from separatrix.front.page.server import MOST_BYTES, Server

SCRIPT = "<script>alert(1)</script><img src=x onerror=alert(2)>"
HOSTILE = f'title = "{SCRIPT}"\n'
OWN = f"""extends = "cryogenic-turbopump"
[[ranking.candidates]]
name = "{SCRIPT}"
friction = {{ "{SCRIPT}" = {{ mean = 7, source = "{SCRIPT}" }} }}
material = {{ "{SCRIPT}" = 1, source = "{SCRIPT}" }}
[[ranking.candidates]]
name = ["{SCRIPT}"]
material = "{SCRIPT}"
"""
TESTED = '[ranking]\nfriction = "tests.toml"\n'
TESTS = f"""[[test]]
material = "{SCRIPT}"
counterface = "440C"
medium = "air"
friction = 0.2
"""


class Client:
    """A program that talks to the server as it likes."""

    def __init__(self, link):
        self.port, self.token = urlsplit(link).port, parse_qs(urlsplit(link).query)["token"][0]
        self.host = f"127.0.0.1:{self.port}"
        self.own = {"Cookie": f"separatrix-{self.port}={self.token}", "Origin": f"http://{self.host}"}

    def ask(self, place, method="GET", body=None, **headers):
        """Return status, headers and text of an answer; a header of None is left out."""
        given = {name.replace("_", "-"): value for name, value in {**self.own, **headers}.items()}
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, place, body, {k: v for k, v in given.items() if v is not None})
        answer = connection.getresponse()
        found = answer.status, dict(answer.getheaders()), answer.read().decode("utf-8", "replace")
        connection.close()
        return found

    def answers(self):
        """Return whether the page is there."""
        with contextlib.suppress(OSError):
            return self.ask("/")[0] == 200


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a study whose texts are scripts, a file beside it, and a link that leads out of it."""
    outside = tmp_path_factory.mktemp("outside")
    (outside / "secret.toml").write_text("[bearing]\n# secret\n")
    root = outside / "studies"
    root.mkdir()
    (root / "hostile.toml").write_text(HOSTILE + SMALL.replace("title =", "# title ="))
    (root / "<b>bold.toml").write_text(SMALL)
    (root / "own.toml").write_text(OWN)
    (root / "tested.toml").write_text(SMALL.partition("[ranking]")[0] + TESTED)
    (root / "tests.toml").write_text(TESTS)
    (root / "variant.toml").write_text('extends = "own.toml"\n')
    (root / "sub").mkdir()
    tables = (outside / "secret.csv", root / ".hidden.csv", root / "cases.csv", root / "sub" / "a.csv")
    for path in tables:
        path.write_text("film.thickness\n1 um\n")
    (root / "leads-out.csv").symlink_to(outside / "secret.csv")
    (root / "link.toml").symlink_to(outside / "secret.toml")
    (root / "linked").symlink_to(outside)
    return root


@pytest.fixture(scope="module")
def client(folder):
    """A client of a running server."""
    server = Server(folder)
    thread = threading.Thread(target=server.serve_until_ended, daemon=True)
    thread.start()
    wait_until(lambda: server.started)
    yield Client(server.link)
    server.should_exit = True
    thread.join(20)


def test_the_link_gives_a_cookie_and_hides_the_token(client):
    """The token leaves the address at once; scripts cannot read the cookie, other sites not send it."""
    status, headers, _ = client.ask(f"/?token={client.token}", Cookie=None, Origin=None)
    assert (status, headers["location"]) == (303, "/")
    assert {"HttpOnly", "SameSite=Strict"} <= set(headers["set-cookie"].split("; "))
    assert client.ask("/", Origin=None)[0] == 200


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        *(({"Cookie": one}, 403) for one in (None, "separatrix-1=x")),
        *(({"Host": one}, 421) for one in ("evil.example", "evil.example:80")),
        *(({"Origin": one}, 403) for one in ("http://evil.example", "null")),
        *(({"Sec_Fetch_Site": one}, 403) for one in ("cross-site", "same-site")),
    ],
)
def test_a_stranger_gets_nothing(client, headers, status):
    """Without the token, under another name, or from another site: refused, and the study is not shown."""
    found, _, text = client.ask("/study/hostile.toml", **headers)
    assert (found, "ball_diameter" in text) == (status, False)


@pytest.mark.parametrize("origin", [None, "http://evil.example", "http://127.0.0.1:1"])
def test_nothing_is_changed_for_another_site(client, folder, origin):
    """A form of another site that posts to us brings another origin, or none, and changes nothing."""
    before = sorted(folder.iterdir())
    assert client.ask("/new", "POST", "name=evil", Origin=origin)[0] == 403
    assert sorted(folder.iterdir()) == before


OUTSIDE = """
/file/../secret.toml /file/..%2fsecret.toml /file/%2e%2e/secret.toml /file//etc/passwd /file/%2fetc%2fpasswd
/file/link.toml /file/linked/secret.toml /file/hostile.toml%00.png /study/../secret.toml /study/link.toml
/study/linked/secret.toml /study/..%5csecret.toml /static/..%2fserver.py /static/%2e%2e/server.py
"""


@pytest.mark.parametrize("place", OUTSIDE.split())
def test_only_files_of_the_folder_are_reachable(client, place):
    """Neither dots, nor links, nor absolute names lead out of the folder."""
    status, _, text = client.ask(place)
    assert status in (404, 422), text
    assert "secret]" not in text
    assert "Application" not in text


def test_a_study_cannot_name_a_file_outside(client):
    """What `extends` names is read only inside the folder; the refusal shows nothing of the file."""
    version = client.ask("/study/%3Cb%3Ebold.toml")[2].partition('name="version" value="')[2][:16]
    body = f"field=.extends&value={quote('../secret.toml')}&version={version}"
    status, _, text = client.ask("/edit/%3Cb%3Ebold.toml", "POST", body)
    assert (status, "is outside the folder" in text, "# secret" in text) == (200, True, False)
    client.ask("/discard/%3Cb%3Ebold.toml", "POST")


@pytest.mark.parametrize(
    "table", ["../secret.csv", "linked/secret.csv", "leads-out.csv", ".hidden.csv", "/etc/passwd", "none.csv"]
)
def test_cases_are_read_from_tables_of_the_folder_only(client, table):
    """Neither dots, nor links, nor absolute names lead out of it."""
    status, _, text = client.ask("/run/%3Cb%3Ebold.toml", "POST", f"verb=sweep&cases={quote(table, safe='')}")
    assert (status, "in this folder" in text) == (422, True)


def test_scripts_in_texts_are_text(client):
    """Titles and names that are scripts are shown, not run; inline scripts may not."""
    studies = ("hostile.toml", "%3Cb%3Ebold.toml", "own.toml", "tested.toml", "variant.toml")
    for place in ("/", *(f"/study/{name}" for name in studies)):
        _, headers, text = client.ask(place)
        assert "<script>alert" not in text
        assert "<img src=x" not in text
        assert "<b>bold" not in text
        policy = headers["content-security-policy"]
        assert "script-src 'self';" in policy
        assert "default-src 'none'" in policy
    for name, count in {"hostile.toml": 1, "own.toml": 8, "variant.toml": 1}.items():
        assert client.ask(f"/study/{name}")[2].count("&lt;script&gt;alert") >= count


def test_an_upload_is_bounded_by_what_it_says_and_by_what_it_sends(client, folder):
    """A gigabyte is refused before any of it is sent; without a length it is cut off, and nothing is kept."""
    assert client.ask("/new", "POST", "", Content_Length=str(1024**3))[0] == 413
    assert client.ask("/new", "POST", "", Content_Length="-5")[0] in (400, 413)
    sent, piece, before = 0, b"x" * 1024**2, sorted(folder.iterdir())
    with socket.create_connection(("127.0.0.1", client.port), timeout=20) as line:
        head = "POST /new HTTP/1.1\r\nTransfer-Encoding: chunked\r\n"
        head += "".join(f"{k}: {v}\r\n" for k, v in {"Host": client.host, **client.own}.items())
        line.sendall(head.encode() + b"\r\n")
        with contextlib.suppress(OSError):  # it is cut off
            while sent < 1024:
                line.sendall(b"100000\r\n" + piece + b"\r\n")
                sent += 1
    assert sent < MOST_BYTES / 1024**2 + 50  # what the sockets hold, besides
    assert sorted(folder.iterdir()) == before
    assert client.ask("/")[0] == 200


def test_a_thousand_connections_do_not_end_it(client):
    """Idle connections, as many as the system gives up to 1000: afterwards the page answers as before."""
    lines = []
    try:
        while len(lines) < 1000:
            lines += [socket.create_connection(("127.0.0.1", client.port), timeout=5)]
    except OSError:
        assert len(lines) > 100
    for line in lines:
        line.close()
    wait_until(client.answers, 15.0)


def test_it_listens_on_this_machine_only(client):
    """No other address of this machine reaches it."""
    found = subprocess.run(["hostname", "-I"], capture_output=True, text=True, check=False).stdout.split()
    others = [one for one in found if ":" not in one and not one.startswith("127.")] + ["127.0.0.2"]
    for address in others:
        with pytest.raises((ConnectionError, TimeoutError)):
            socket.create_connection((address, client.port), timeout=2).close()


TRACE = """
import sys
def note(event, arguments):
    if event in ("socket.connect", "socket.getaddrinfo", "socket.sendto"):
        with open({path!r}, "a") as file:
            file.write(f"{{event}} {{arguments[1:]}}\\n")
sys.addaudithook(note)
"""


def test_no_connection_leaves_the_machine(tmp_path, folder):
    """The command and its computing process run a verb; every connection that either opens is noted."""
    trace, hook = tmp_path / "trace.txt", tmp_path / "hook"
    hook.mkdir()
    (hook / "sitecustomize.py").write_text(TRACE.format(path=str(trace)))
    environment = os.environ | {"PYTHONPATH": f"{hook}:{os.environ.get('PYTHONPATH', '')}"}
    root = tmp_path / "studies"
    root.mkdir()
    (root / "small.toml").write_text(SMALL)
    command = [sys.executable, "-c", "import socket; socket.getaddrinfo('127.0.0.1', 1)"]
    subprocess.run(command, env=environment, check=True)
    assert "getaddrinfo" in trace.read_text()  # the trace sees what there is
    trace.write_text("")
    command = [sys.executable, "-m", "separatrix", "app", str(root)]
    server = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
    try:
        client = Client(next(line.strip() for line in server.stdout if "token=" in line))
        wait_until(client.answers)
        assert client.ask("/run/small.toml", "POST", "verb=bearing")[0] == 200
        wait_until((root / "small" / "bearing.json").exists)
        assert client.ask("/answer/bearing/small.toml")[0] == 200
    finally:
        server.terminate()
        server.communicate(timeout=PATIENCE)
    assert trace.read_text() == ""
