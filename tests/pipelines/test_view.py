import contextlib
import http.client
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from pipelines import view


@pytest.fixture
def running(tmp_path: Path) -> Iterator[view.Server]:
    folder = tmp_path / "city" / "site"
    (folder / "blocks").mkdir(parents=True)
    for name in view.NEEDED:
        (folder / name).write_text("{}")
    (folder / "blocks" / "1.glb").write_bytes(b"glTF")
    (tmp_path / "secret").write_text("secret")
    (folder / "link").symlink_to(tmp_path / "secret")
    (folder / "circle").symlink_to("circle")
    with view.server(view.site_of(tmp_path / "city")) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


def got(
    server: view.Server, path: str, host: str | None = None
) -> tuple[http.client.HTTPResponse, bytes]:
    port = server.server_address[1]
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request("GET", path, headers={"Host": host} if host else {})
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer, body


def test_files_come_with_their_types(running: view.Server) -> None:
    answer, body = got(running, "/blocks/1.glb")
    assert (answer.status, body) == (200, b"glTF")
    assert answer.headers["Content-Type"] == "model/gltf-binary"
    assert "immutable" in answer.headers["Cache-Control"]
    answer, _ = got(running, "/")
    assert answer.headers["Content-Type"].startswith("text/html")
    assert answer.headers["Cache-Control"] == "no-cache"


@pytest.mark.parametrize(
    "path",
    [
        "/../../secret",
        "/%2e%2e/%2e%2e/secret",
        "/..%2f..%2fsecret",
        "/blocks/../../../secret",
        "/link",
        "//etc/passwd",
        "/blocks/",
        "/nowhere",
        "/%00",
        "/blocks/%00.glb",
        "/%ed%b0%80",
        "/%ff",
        "/circle",
        "/" + "a" * 900,
    ],
)
def test_nothing_else_is_served(running: view.Server, path: str) -> None:
    answer, body = got(running, path)
    assert answer.status in (301, 404)
    assert b"secret" not in body
    assert b"1.glb" not in body


def test_another_hosts_name_is_refused(running: view.Server) -> None:
    answer, _ = got(running, "/", host="evil.example")
    assert answer.status == 403


def said(server: view.Server, request: bytes) -> bytes:
    """Say anything to a server, and read the first line of its answer."""
    address = ("127.0.0.1", server.server_address[1])
    with socket.create_connection(address, timeout=10) as connection:
        connection.sendall(request)
        return connection.makefile("rb").readline()


@pytest.mark.parametrize("letters", [1_001, 60_000, 70_000])
def test_a_path_without_an_end_is_refused(running: view.Server, letters: int) -> None:
    host = f"Host: localhost:{running.server_address[1]}"
    request = f"GET /{'a' * letters} HTTP/1.1\r\n{host}\r\n\r\n"
    assert b" 414 " in said(running, request.encode())


@pytest.mark.parametrize("request_", [b"\x16\x03\x01\r\n", b"GET / HTTP/9.9\r\n"])
def test_what_is_no_request_is_told_so(
    running: view.Server, request_: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    line = said(running, request_ + b"\r\n")
    assert b" 400 " in line or b" 505 " in line or line.startswith(b"<")
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("begun", [b"", b"GET / HT"])
def test_idle_connections_keep_no_visitor_out(
    running: view.Server, begun: bytes
) -> None:
    address = ("127.0.0.1", running.server_address[1])
    with contextlib.ExitStack() as opened:
        for _ in range(300):
            idle = socket.create_connection(address, timeout=10)
            opened.enter_context(idle).sendall(begun)
        assert got(running, "/")[0].status == 200
        handlers = [t for t in threading.enumerate() if "process_request" in t.name]
        assert len(handlers) <= 2 * view.MOST_OPEN  # some are about to end


def until_taken(running: view.Server, idle: socket.socket) -> None:
    """Wait until the server has taken a connection, however busy the machine is."""
    mine = idle.getsockname()
    while True:
        with running._turn:
            if mine in {one.getpeername() for one in running._open}:
                return
        time.sleep(0.001)


def test_a_connection_in_use_outlives_idle_ones(running: view.Server) -> None:
    port = running.server_address[1]
    used = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    with contextlib.ExitStack() as opened:
        for _ in range(20):
            used.request("GET", "/")
            assert used.getresponse().read() == b"{}"
            for _ in range(view.MOST_OPEN // 4):
                idle = socket.create_connection(("127.0.0.1", port), timeout=10)
                opened.enter_context(idle)
                until_taken(running, idle)
        assert used.sock is not None
    used.close()


def test_only_this_machine_is_served(running: view.Server) -> None:
    assert running.server_address[0] == "127.0.0.1"
    assert view.address_of(running).startswith("http://127.0.0.1:")


def test_a_folder_without_a_site_names_the_remedy(tmp_path: Path) -> None:
    with pytest.raises(view.NoSiteError, match="nostalgin build"):
        view.site_of(tmp_path)
    with pytest.raises(view.NoSiteError, match="is no folder"):
        view.site_of(tmp_path / "nowhere")


def test_no_browser_is_opened_without_a_terminal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(view.webbrowser, "open", lambda _: pytest.fail("opened"))
    monkeypatch.setattr(view.sys.stdout, "isatty", lambda: False, raising=False)
    assert not view.shown("http://127.0.0.1:1/")
