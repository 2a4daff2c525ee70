"""Rejects pages of other web sites. A browser lets any site connect to a server on this machine, and viser accepts all.

A request is accepted if its Host is an IP address, localhost or the name of this machine, and its Origin, if it has one, is that host.
The first condition stops sites whose name was made to resolve to this machine (DNS rebinding).
"""

import contextlib
import http
import ipaddress
import socket
from typing import Any, Iterator, Optional
from urllib.parse import urlsplit

import websockets.asyncio.server


def _is_own_name(host: str) -> bool:
    name = urlsplit(f"//{host}").hostname or ""
    try:
        ipaddress.ip_address(name)
        return True
    except ValueError:
        own = socket.gethostname().lower()
        return name in ("localhost", own, own.partition(".")[0])


def is_accepted(host: Optional[str], origin: Optional[str]) -> bool:
    """Whether a request with these headers comes from a page of this server, or from a program that is no browser."""
    if host is None or not _is_own_name(host):
        return False
    return origin is None or urlsplit(origin).netloc == host


@contextlib.contextmanager
def only_own_pages() -> Iterator[None]:
    """Applies to the server that viser starts within the context. viser itself has no option for it."""
    serve = websockets.asyncio.server.serve

    def serve_checked(*arguments: Any, process_request: Any, **options: Any) -> Any:
        def check(connection: Any, request: Any) -> Any:
            if not is_accepted(request.headers.get("Host"), request.headers.get("Origin")):
                return connection.respond(http.HTTPStatus.FORBIDDEN, "This page belongs to another web site.\n")
            return process_request(connection, request)

        return serve(*arguments, process_request=check, **options)

    websockets.asyncio.server.serve = serve_checked
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve
