"""Serve a city's site to this machine's browser."""

import contextlib
import http
import os
import sys
import webbrowser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar, Final

HOST: Final = "127.0.0.1"
FOREVER: Final = ("/assets/", "/blocks/")  # named by content: they never change
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

    def send_head(self) -> Any:
        """Open a file; refuse other hosts' names, and links that lead outside."""
        port = self.connection.getsockname()[1]
        # a page elsewhere may point its own host name at this machine
        if self.headers.get("Host") not in (f"{HOST}:{port}", f"localhost:{port}"):
            self.send_error(http.HTTPStatus.FORBIDDEN)
            return None
        root = Path(self.directory).resolve()
        if not Path(self.translate_path(self.path)).resolve().is_relative_to(root):
            self.send_error(http.HTTPStatus.NOT_FOUND)
            return None
        return super().send_head()

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
    """A server that does not mind browsers which hang up early."""

    daemon_threads = True

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report only what is not a closed connection."""
        if not isinstance(sys.exception(), ConnectionError):
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
    return sys.stdout.isatty() and screen and webbrowser.open(address)


def view(city: Path, *, port: int = 0, browser: bool = True) -> None:
    """Serve a city until it is interrupted.

    Raises:
        NoSiteError: if the city has no site.
        OSError: if the port is taken.
    """
    with server(site_of(city), port=port) as running:
        address = address_of(running)
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
        if browser:
            shown(address)
        with contextlib.suppress(KeyboardInterrupt):
            running.serve_forever()
