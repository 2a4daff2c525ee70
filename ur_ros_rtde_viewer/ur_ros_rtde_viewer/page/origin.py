"""Rejects pages of other web sites, and on the network those who do not know the token of the page. Ends lost connections.

A browser lets any site connect to a server on this machine, and viser accepts all.

A request is accepted if its Host is an IP address, localhost or the name of this machine, and its Origin, if it has one, is that host.
The first condition stops sites whose name was made to resolve to this machine (DNS rebinding).

With a token, the first request has it in its URL. The answer sets a cookie, which the browser sends with all others.
"""

import contextlib
import functools
import hmac
import http
import ipaddress
import socket
from http.cookies import CookieError, SimpleCookie
from typing import Any, FrozenSet, Iterator, Optional
from urllib.parse import parse_qs, urlsplit

import websockets.asyncio.server

PARAMETER = "token"  # of the URL
# A connection is lost if the other host does not confirm for LOSS_TIMEOUT that it has received anything. The time for the answer of a ping
# is no measure: on a slow network, a ping waits behind the scene that a browser loads, and is not sent while the buffer is full.
LOSS_TIMEOUT = 5.0  # s
PING_INTERVAL = 2.0  # s; a ping is something to be confirmed
COOKIE = "ur_ros_rtde_token"  # followed by the port: the browser sends a cookie to all ports of a host


@functools.lru_cache(maxsize=1)
def _names_of_this_machine() -> FrozenSet[str]:
    """Asks the name service, which may take seconds: once, before the server starts."""
    own = {socket.gethostname().lower(), socket.getfqdn().lower()}
    short = {name.partition(".")[0] for name in own}
    return frozenset((*own, *short, *(f"{name}.local" for name in short)))


def _is_own_name(host: str) -> bool:
    try:
        parts = urlsplit(f"//{host}")
        name, _ = parts.hostname or "", parts.port  # ValueError: no host, or no port
    except ValueError:
        return False
    try:
        ipaddress.ip_address(name)
        return True
    except ValueError:
        return name == "localhost" or name in _names_of_this_machine()


def is_accepted(host: Optional[str], origin: Optional[str]) -> bool:
    """Whether a request with these headers comes from a page of this server, or from a program that is no browser."""
    if host is None or not _is_own_name(host):
        return False
    return origin is None or urlsplit(origin).netloc == host


def cookie_name(host: Optional[str]) -> str:
    """`host`: the header Host of a request."""
    return f"{COOKIE}_{urlsplit(f'//{host}').port or 80}"


def _cookie_token(cookies: Optional[str], host: Optional[str]) -> str:
    try:
        morsel = SimpleCookie(cookies or "").get(cookie_name(host))
    except CookieError:
        return ""
    return morsel.value if morsel else ""


def has_token(token: str, path: str, cookies: Optional[str], host: Optional[str]) -> bool:
    """Whether a request has the token of the page, in its URL or its cookie. Without one, `token` is empty: every request."""
    given = [*parse_qs(urlsplit(path).query).get(PARAMETER, []), _cookie_token(cookies, host)]
    return not token or any(hmac.compare_digest(token.encode(), text.encode()) for text in given)


@contextlib.contextmanager
def only_own_pages(token: str) -> Iterator[None]:
    """Applies to the server that viser starts within the context. viser itself has no option for it."""
    serve = websockets.asyncio.server.serve
    _names_of_this_machine()

    def serve_checked(*arguments: Any, process_request: Any, **options: Any) -> Any:
        def check(connection: Any, request: Any) -> Any:
            if not is_accepted(request.headers.get("Host"), request.headers.get("Origin")):
                return connection.respond(http.HTTPStatus.FORBIDDEN, "This page belongs to another web site.\n")
            host = request.headers.get("Host")
            if not has_token(token, request.path, request.headers.get("Cookie"), host):
                return connection.respond(http.HTTPStatus.FORBIDDEN, f"Open the address that the viewer printed, with ?{PARAMETER}=...\n")
            response = process_request(connection, request)
            if token and response is not None:
                response.headers["Set-Cookie"] = f"{cookie_name(host)}={token}; HttpOnly; SameSite=Strict; Path=/"
            if response is None:
                stream = connection.transport.get_extra_info("socket")
                stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, round(1e3 * LOSS_TIMEOUT))
            return response

        return serve(*arguments, process_request=check, ping_interval=PING_INTERVAL, **options)

    websockets.asyncio.server.serve = serve_checked
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve
