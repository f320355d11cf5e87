"""Bytes from a server of somebody else's: asked politely, and believed in nothing.

One request at a time; a server that is busy is asked again, ever later. A server may
answer never, slowly, endlessly, with a page in place of a picture, or lead elsewhere:
each is an error in words, within the time and the size that are allowed.
"""

import ipaddress
import socket
import threading
from concurrent.futures import Future, wait
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import urljoin, urlsplit

if TYPE_CHECKING:  # slow to load, and most lists are files
    import requests

SCHEMES: Final = ("http", "https")
HOPS: Final = 5  # redirects
AGAIN: Final = 4  # times a server is asked once more
BUSY: Final = (429, 500, 502, 503, 504)
LATEST_S: Final = 30  # that a server may ask us to wait
CHUNK: Final = 1 << 16
HTML: Final = ("text/html", "application/xhtml+xml")


class Unfetched(ValueError):  # noqa: N818 - it reads as what it is about
    """What a server did not give, and why."""


@dataclass(frozen=True)
class Patience:
    """How long a server is waited for."""

    connect_s: float = 10.0
    silent_s: float = 30.0  # between two pieces of an answer
    whole_s: float = 300.0  # for one thing, all repetitions and redirects together
    pause_s: float = 0.5  # before a server is asked again, doubled each time


def is_web(source: str) -> bool:
    """Tell whether a source is an address on the web and no path of this machine."""
    return urlsplit(source).scheme.casefold() in SCHEMES


def fetch(url: str, most: int, *, asked: str = "", patience: Patience) -> bytes:
    """Get what lies at a URL, in at most so many bytes.

    `asked` is the URL that a person named; what that leads to may lie on this machine
    or its own network only if it does, too.

    Raises:
        Unfetched: if the server gives no such thing.
    """
    import requests

    gone = threading.Event()
    answer: Future[bytes] = Future()

    def work() -> None:
        try:
            answer.set_result(followed(url, most, asked or url, patience, gone))
        except (requests.RequestException, OSError, ValueError) as problem:
            answer.set_exception(problem)
        finally:
            answer.cancel()  # a mistake of ours tells itself, and nobody waits for it

    # A server that trickles keeps every timeout of a socket; whoever waits need not.
    threading.Thread(target=work, daemon=True).start()
    if not wait([answer], patience.whole_s).done:
        gone.set()
        raise Unfetched(f"{url}: no answer within {patience.whole_s:g} seconds")
    try:
        return answer.result()
    except Unfetched:
        raise
    except (requests.RequestException, OSError, ValueError) as problem:
        raise Unfetched(f"{url}: {plain(problem)}") from problem


def followed(
    url: str, most: int, asked: str, patience: Patience, gone: threading.Event
) -> bytes:
    """Follow a server's redirects, each looked at before it is followed.

    Raises:
        Unfetched: if one leads where none may, or to nothing.
    """
    at = url
    with session(patience) as open_session:
        for _ in range(HOPS + 1):
            allowed(at, asked)
            limits = (patience.connect_s, patience.silent_s)
            with open_session.get(
                at, stream=True, timeout=limits, allow_redirects=False
            ) as answer:
                if answer.is_redirect:
                    at = urljoin(at, answer.headers["location"])
                    continue
                if answer.status_code != 200:
                    told = f"{answer.status_code} {answer.reason or ''}".strip()
                    raise Unfetched(f"{at}: the server answers {told}")
                return body(answer, at, most, gone)
    raise Unfetched(f"{url}: more than {HOPS} redirects")


def body(
    answer: "requests.Response", at: str, most: int, gone: threading.Event
) -> bytes:
    """Read an answer that is no page and not too large.

    Raises:
        Unfetched: if it is either.
    """
    kind = answer.headers.get("content-type", "").partition(";")[0].strip().casefold()
    if kind in HTML:
        raise Unfetched(f"{at}: a page for people ({kind}): name what it shows itself")
    length = answer.headers.get("content-length", "")
    too_large = f"{at}: larger than the {most:,} bytes that are read"
    if length.isdecimal() and len(length) < 20 and int(length) > most:
        raise Unfetched(too_large)
    data = bytearray()
    for chunk in answer.iter_content(CHUNK):
        data += chunk
        if len(data) > most:
            raise Unfetched(too_large)
        if gone.is_set():
            break
    return bytes(data)


def session(patience: Patience) -> "requests.Session":
    """Open a session that asks a busy server again, ever later."""
    import requests
    from requests.adapters import HTTPAdapter
    from urllib3.util import Retry

    again = Retry(
        AGAIN,
        redirect=0,
        backoff_factor=patience.pause_s,
        backoff_max=LATEST_S,
        status_forcelist=BUSY,
        retry_after_max=LATEST_S,
        raise_on_status=False,
        raise_on_redirect=False,
    )
    made = requests.Session()
    made.headers["User-Agent"] = f"nostalgin/{version('nostalgin')}"
    for scheme in SCHEMES:
        made.mount(f"{scheme}://", HTTPAdapter(max_retries=again))
    return made


def allowed(url: str, asked: str) -> None:
    """Insist that a URL leads to the web, and to this machine only if it was asked to.

    Raises:
        Unfetched: if it does not.
    """
    try:
        parts, first = urlsplit(url), urlsplit(asked)
        host, named = parts.hostname or "", first.hostname or ""
    except ValueError as problem:
        raise Unfetched(f"{url[:200]!r} is no address: {problem}") from problem
    if parts.scheme.casefold() not in SCHEMES or not host:
        raise Unfetched(f"{url[:200]!r} is no address on the web (http, https)")
    if host != named and inward(host) and not inward(named):
        raise Unfetched(f"{url[:200]}: {named} leads into this machine's own network")


@cache
def inward(host: str) -> bool:
    """Tell whether a host is this machine, or stands in its own network."""
    addresses: set[Any] = set()
    with suppress(OSError, UnicodeError):  # one that nobody knows is asked in vain
        addresses = {one[4][0] for one in socket.getaddrinfo(host, None)}
    return any(not ipaddress.ip_address(str(one)).is_global for one in addresses)


def plain(problem: Exception) -> str:
    """Tell in one line why a server could not be reached."""
    words = " ".join(str(problem).split())
    inner = words.rpartition(": ")[2].strip("')\" ")
    return (inner or type(problem).__name__)[:200]
