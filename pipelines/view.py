"""Serve a city's site to this machine's browser."""

import contextlib
import http
import os
import socket
import sys
import threading
import webbrowser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar, Final

HOST: Final = "127.0.0.1"
FOREVER: Final = (
    "/assets/",
    "/blocks/",
    "/far/",
    "/finder/",
    "/records/",
)  # named by content: they never change
LONGEST: Final = 1000  # letters of a path; ours have 90
WAIT_S: Final = 30.0  # for a request, or for whoever reads the answer
MOST_OPEN: Final = 100  # connections; a browser opens six
NEEDED: Final = ("index.html", "site.json", "tileset.json")


class NoSiteError(FileNotFoundError):
    """A folder without a site, with the command that makes one."""


def site_of(city: Path) -> Path:
    """Find the site in a city folder, or take the folder itself if it is one.

    Raises:
        NoSiteError: if there is none.
    """
    for folder in (city / "site", city):
        if all((folder / name).is_file() for name in NEEDED):
            return folder.resolve()
    what = "is no folder" if not city.is_dir() else "holds no site yet"
    raise NoSiteError(f"{city} {what}; run `nostalgin build {city}` first")


class Site(SimpleHTTPRequestHandler):
    """Files of one folder, and nothing else: no listings, no way out of it."""

    extensions_map: ClassVar[dict[str, str]] = {  # pyright: ignore[reportIncompatibleVariableOverride]
        "": "application/octet-stream",
        ".css": "text/css; charset=utf-8",
        ".glb": "model/gltf-binary",
        ".html": "text/html; charset=utf-8",
        ".jpg": "image/jpeg",
        ".js": "text/javascript; charset=utf-8",
        ".json": "application/json",
        ".png": "image/png",
        ".webp": "image/webp",
        ".woff2": "font/woff2",
    }
    protocol_version = "HTTP/1.1"
    timeout = WAIT_S
    path = ""  # until a request has told one

    def parse_request(self) -> bool:
        """Read a request, and be the connection that was heard of last."""
        if isinstance(self.server, Server):
            self.server.heard(self.connection)
        return super().parse_request()

    def send_head(self) -> Any:
        """Open a file; refuse other hosts' names, and links that lead outside."""
        port = self.connection.getsockname()[1]
        # a page elsewhere may point its own host name at this machine
        if self.headers.get("Host") not in (f"{HOST}:{port}", f"localhost:{port}"):
            self.send_error(http.HTTPStatus.FORBIDDEN)
            return None
        if len(self.path) > LONGEST:
            self.send_error(http.HTTPStatus.REQUEST_URI_TOO_LONG)
            return None
        try:
            inside = self.inside()
        except (ValueError, RuntimeError, OSError):  # no name, or links in a circle
            inside = False
        if not inside:
            self.send_error(http.HTTPStatus.NOT_FOUND)
            return None
        return super().send_head()

    def inside(self) -> bool:
        """Tell whether a path leads to something in the folder."""
        path, root = Path(self.translate_path(self.path)), Path(self.directory)
        return path.resolve().is_relative_to(root.resolve())

    def list_directory(self, path: Any) -> None:
        """Tell nobody what else is there."""
        del path
        self.send_error(http.HTTPStatus.NOT_FOUND)

    def end_headers(self) -> None:
        """Let the browser keep what never changes."""
        lasting = self.path.startswith(FOREVER)
        caching = "public, max-age=31536000, immutable" if lasting else "no-cache"
        self.send_header("Cache-Control", caching)
        self.send_header("X-Content-Type-Options", "nosniff")
        super().end_headers()

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002
        """Stay quiet."""


class Server(ThreadingHTTPServer):
    """A server that does not mind browsers which hang up early, or never.

    Each connection is a thread: of too many, the one goes that was silent for longest.
    """

    daemon_threads = True
    request_queue_size = 128

    def __init__(self, *given: Any) -> None:
        """Listen."""
        super().__init__(*given)
        self._open: dict[socket.socket, None] = {}  # the longest silent first
        self._turn = threading.Lock()

    def process_request(self, request: Any, client_address: Any) -> None:
        """Make room for a connection."""
        with self._turn:
            self._open[request] = None
            if len(self._open) > MOST_OPEN:
                silent = next(iter(self._open))
                del self._open[silent]
                with contextlib.suppress(OSError):  # its thread ends by itself
                    silent.shutdown(socket.SHUT_RDWR)
        super().process_request(request, client_address)

    def heard(self, request: socket.socket) -> None:
        """Put a connection behind all others that may have to go."""
        with self._turn:
            if request in self._open:
                del self._open[request]
                self._open[request] = None

    def shutdown_request(self, request: Any) -> None:
        """Forget a connection that is done."""
        with self._turn:
            self._open.pop(request, None)
        super().shutdown_request(request)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report only what is not a closed connection, or one that stood still."""
        if not isinstance(sys.exception(), (ConnectionError, TimeoutError)):
            super().handle_error(request, client_address)


def server(site: Path, *, port: int = 0) -> Server:
    """Make a server of one folder for this machine alone; port 0 takes a free one."""

    def handler(*args: Any) -> Site:
        return Site(*args, directory=str(site))

    return Server((HOST, port), handler)


def address_of(running: Server) -> str:
    """Tell where a server answers."""
    return f"http://{HOST}:{running.server_address[1]}/"


def shown(address: str) -> bool:
    """Open a browser where there is a terminal and a screen; tell whether it worked."""
    screen = sys.platform in ("darwin", "win32") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    )
    if not (sys.stdout.isatty() and screen):
        return False
    try:
        return webbrowser.open(address)
    except (webbrowser.Error, OSError):  # none is found, or it does not start
        return False


def view(
    city: Path, *, port: int = 0, browser: bool = True, announced: bool = True
) -> None:
    """Name a city's address, if it is to be, and serve it until it is interrupted.

    Raises:
        NoSiteError: if the city has no site.
        OSError: if the port is taken.
    """
    with server(site_of(city), port=port) as running:
        address = address_of(running)
        if announced:
            with contextlib.suppress(OSError):  # whoever gave the port knows it
                print(address, flush=True)  # noqa: T201
        if browser:  # one in a terminal ends only when its reader does
            threading.Thread(target=shown, args=(address,), daemon=True).start()
        with contextlib.suppress(KeyboardInterrupt):
            running.serve_forever()
