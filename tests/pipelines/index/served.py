"""A web server on this machine that behaves, or misbehaves, as it is told."""

import contextlib
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

Answer = Callable[[BaseHTTPRequestHandler], None]


@dataclass
class Server:
    """What a server answers by path, and what it was asked, in order."""

    url: str
    answers: dict[str, Answer] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)
    most_at_once: int = 0
    ended: threading.Event = field(default_factory=threading.Event)


@contextlib.contextmanager
def served() -> Iterator[Server]:
    """Serve on loopback, until the block ends."""
    at_once = 0

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            nonlocal at_once
            at_once += 1
            server.most_at_once = max(server.most_at_once, at_once)
            server.asked.append(self.path)
            try:
                server.answers.get(self.path, missing)(self)
            except (BrokenPipeError, ConnectionResetError):
                pass
            finally:
                at_once -= 1

        def log_message(self, *words: object) -> None:
            del words

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as http:
        http.daemon_threads = True
        http.block_on_close = False
        server = Server(f"http://127.0.0.1:{http.server_address[1]}")
        thread = threading.Thread(target=http.serve_forever, args=(0.02,), daemon=True)
        thread.start()
        try:
            yield server
        finally:
            server.ended.set()
            http.shutdown()
            thread.join()


def gives(data: bytes, kind: str = "application/json", status: int = 200) -> Answer:
    def answer(to: BaseHTTPRequestHandler) -> None:
        to.send_response(status)
        to.send_header("Content-Type", kind)
        to.send_header("Content-Length", str(len(data)))
        to.end_headers()
        to.wfile.write(data)

    return answer


def leads(where: str) -> Answer:
    def answer(to: BaseHTTPRequestHandler) -> None:
        to.send_response(302)
        to.send_header("Location", where)
        to.send_header("Content-Length", "0")
        to.end_headers()

    return answer


def busy(times: int, then: Answer) -> Answer:
    """Answer 503 so many times first."""
    left = [times]

    def answer(to: BaseHTTPRequestHandler) -> None:
        left[0] -= 1
        (gives(b"later", "text/plain", 503) if left[0] >= 0 else then)(to)

    return answer


def endless(to: BaseHTTPRequestHandler) -> None:
    to.send_response(200)
    to.send_header("Content-Type", "image/jpeg")
    to.end_headers()
    while True:
        to.wfile.write(b"\xff\xd8\xff" + bytes(1 << 16))


def trickling(ended: threading.Event) -> Answer:
    """Answer a letter at a time, so that no socket ever times out."""

    def answer(to: BaseHTTPRequestHandler) -> None:
        to.send_response(200)
        to.send_header("Content-Type", "application/json")
        to.end_headers()
        while not ended.wait(0.05):
            to.wfile.write(b" ")
            to.wfile.flush()

    return answer


missing: Answer = gives(b"no such thing", "text/plain", 404)
