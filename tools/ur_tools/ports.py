"""TCP ports of a simulated controller, and the processes that use them."""

import errno
import os
import pathlib
import re
import socket
import struct
from typing import Dict, List, Optional, Tuple

from . import console
from .layout import PROGRAM

PORTS = {"dashboard": 29999, "primary": 30001, "secondary": 30002, "real-time": 30003, "RTDE": 30004,
         "read-only primary": 30011, "read-only secondary": 30012, "read-only real-time": 30013, "interpreter": 30020,
         "control": 30099, "MODBUS": 502}
FIRST_UNPRIVILEGED = 1024
_LISTEN = "0A"


def in_use(address: str, ports: "List[int]") -> List[int]:
    """Returns the ports that are in use. Raises Failure if the machine does not have the address."""
    try:
        socket.inet_aton(address)
    except OSError:
        raise console.Failure(f"--address {address}: not an IPv4 address, as in 127.0.0.2") from None
    found = []
    for port in ports:
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((address, port))
                probe.listen(1)  # bind() succeeds next to a listener that has SO_REUSEADDR
            except OSError as error:
                if error.errno == errno.EADDRNOTAVAIL:
                    raise console.Failure(f"--address {address}: no network interface of this machine has that address. "
                                          "Loopback addresses are 127.0.0.1, 127.0.0.2 and so on.") from None
                if error.errno == errno.EACCES and port < FIRST_UNPRIVILEGED:
                    continue  # the simulator starts without this server
                if error.errno != errno.EADDRINUSE:
                    raise console.Failure(f"port {port} of {address} cannot be opened: {error.strerror}") from None
                found.append(port)
    return found


def _hex(address: str) -> str:
    """Returns the address in the format of /proc/net/tcp."""
    return f"{struct.unpack('=I', socket.inet_aton(address))[0]:08X}"


def _listeners(address: str, port: int) -> List[str]:
    """Returns the inodes of the sockets that listen on the port."""
    locals_v4 = (_hex(address), _hex("0.0.0.0"))
    found = []
    for name in ("tcp", "tcp6"):
        try:
            lines = pathlib.Path("/proc/net", name).read_text().splitlines()[1:]
        except OSError:
            continue
        for fields in (text.split() for text in lines):
            host, _, number = fields[1].partition(":")
            if int(number, 16) == port and fields[3] == _LISTEN and (
                    host in locals_v4 or host == "0" * 32 or host.endswith(locals_v4[0])):
                found.append(fields[9])
    return found


def holder(address: str, port: int) -> Optional[Tuple[int, str]]:
    """Returns id and command of the process that listens on the port; None if its descriptors cannot be read."""
    sockets = {f"socket:[{inode}]" for inode in _listeners(address, port)}
    if not sockets:
        return None
    for link in pathlib.Path("/proc").glob("[0-9]*/fd/*"):
        try:
            if os.readlink(link) in sockets:
                process = link.parents[1]
                command = (process / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
                return int(process.name), command
        except OSError:
            continue
    return None


def another_address(address: str) -> str:
    """Returns the next loopback address with all ports free."""
    match = re.fullmatch(r"127\.(\d+)\.(\d+)\.(\d+)", address)
    first = int(match.group(3)) + 1 if match else 2
    prefix = f"127.{match.group(1)}.{match.group(2)}" if match else "127.0.0"
    for last in range(first, 255):
        if not in_use(f"{prefix}.{last}", list(PORTS.values())):
            return f"{prefix}.{last}"
    return f"{prefix}.{first}"


def explain(address: str, taken: List[int]) -> str:
    """Returns one line for each process that uses some of the ports."""
    names = {number: name for name, number in PORTS.items()}
    by_holder: Dict[Optional[Tuple[int, str]], List[str]] = {}
    for port in taken:
        by_holder.setdefault(holder(address, port), []).append(f"{port} ({names.get(port, 'TCP')})")
    lines = []
    for process, ports in by_holder.items():
        by = f"process {process[0]}: {process[1][:150]}" if process else "a process of another user"
        lines.append(f"port{'s' * (len(ports) > 1)} {', '.join(ports)} of {address}: in use by {by}")
    return "\n".join(lines)


def check(address: str) -> None:
    """Raises Failure if a simulated controller cannot open its ports on the address."""
    taken = in_use(address, list(PORTS.values()))
    if taken:
        raise console.Failure(f"{explain(address, taken)}\nStop that process, or use another address and another ROS domain: "
                              f"ROS_DOMAIN_ID=1 {PROGRAM} … --address {another_address(address)}")
