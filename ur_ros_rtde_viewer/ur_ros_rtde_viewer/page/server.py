"""The web server of the page."""

import contextlib
import io
import ipaddress
import secrets
import socket

import viser

from ..errors import ViewerError
from .backlog import bound_backlog
from .origin import PARAMETER, only_own_pages

TITLE = "ur_ros_rtde"


def _check_address(address: str, port: int) -> None:
    """Raises ViewerError if the address cannot be used. viser would try the next ports, or wait forever."""
    try:
        family = socket.AF_INET6 if ipaddress.ip_address(address).version == 6 else socket.AF_INET
    except ValueError:
        raise ViewerError(f"--address {address}: expected an IP address, such as 127.0.0.1 (this machine) or 0.0.0.0 (all networks)"
                          ) from None
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, port))
            probe.listen(1)
        except PermissionError:
            raise ViewerError(f"--port {port}: ports below 1024 need privileges; choose a larger one") from None
        except OSError as error:
            raise ViewerError(f"{address}:{port} cannot be used: {error.strerror}. If another viewer or program has the port, end it or "
                              "choose another one: --port 0 selects a free one") from None


def new_token(address: str) -> str:
    """Returns what a page that the network can reach asks for; empty for a page that only this machine can reach."""
    try:
        return "" if ipaddress.ip_address(address).is_loopback else secrets.token_urlsafe(12)
    except ValueError:
        return ""  # start_server() reports it


def start_server(address: str, port: int, token: str = "", dark: bool = False) -> viser.ViserServer:
    """Returns a running server without content. Raises ViewerError if the address or the port cannot be used."""
    _check_address(address, port)
    with contextlib.redirect_stdout(io.StringIO()), only_own_pages(token):  # viser prints a banner; the viewer prints the address itself
        server = viser.ViserServer(host=address, port=port, label=TITLE, verbose=False)
    if port not in (0, server.get_port()):
        server.stop()
        raise ViewerError(f"{address}:{port} was taken by another program during the start: start again, or choose another --port")
    bound_backlog(server)
    server.request_share_url = _do_not_share
    server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large", dark_mode=dark)
    server.scene.set_up_direction("+z")
    return server


def _do_not_share(verbose: bool = True) -> None:
    """viser can publish a page through a server on the internet. A page that shows or moves a robot must not be published."""
    del verbose


def stop_server(server: viser.ViserServer) -> None:
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()


def url(server: viser.ViserServer, token: str = "") -> str:
    host = server.get_host()
    shown = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{shown}:{server.get_port()}" + (f"/?{PARAMETER}={token}" if token else "")
