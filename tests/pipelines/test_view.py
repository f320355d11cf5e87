import http.client
import threading
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
