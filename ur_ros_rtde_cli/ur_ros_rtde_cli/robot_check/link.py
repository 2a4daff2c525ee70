"""The way to the controller: round trips, lost packets, and the network card."""

import fcntl
import pathlib
import socket
import statistics
import struct
import time
from dataclasses import dataclass
from typing import List, Optional

from .finding import Finding, fault, ok, warning
from .rtde import Rtde

ROUND_TRIPS = 20
LONG_ROUND_TRIP = 0.005  # s
SILENCE_LIMIT = 0.1  # s, parameter silence_limit of the driver
MIN_SPEED = 100  # Mbit/s
_TCP_INFO_SIZE = 256
_TOTAL_RETRANSMISSIONS, _DATA_SEGMENTS_IN, _OUT_OF_ORDER = 100, 152, 224  # offsets in struct tcp_info of Linux
_SIOCGIFADDR = 0x8915
SYSTEM = pathlib.Path("/sys/class/net")


@dataclass(frozen=True)
class Packets:
    """Packets of one TCP connection."""

    received: int
    out_of_order: int
    retransmitted: int


def measure_round_trips(rtde: Rtde) -> List[float]:
    """Returns the durations of requests that the controller answers without an effect, s."""
    durations = []
    for _unused in range(ROUND_TRIPS):
        begin = time.monotonic()
        rtde.version()
        durations.append(time.monotonic() - begin)
    return durations


def judge_round_trips(durations: List[float]) -> Finding:
    median, longest = statistics.median(durations), max(durations)
    text = f"the controller answers within {1e3 * median:.2f} ms (median), {1e3 * longest:.2f} ms (max)"
    if median > SILENCE_LIMIT:
        return fault("latency", text, "this is longer than the silence_limit of the driver: use a direct connection, not a tunnel or Wi-Fi")
    if median > LONG_ROUND_TRIP:
        return warning("latency", text, "a cable has less than 1 ms: use a direct connection, not a tunnel or Wi-Fi")
    return ok("latency", text)


def packets(connection: socket.socket) -> Optional[Packets]:
    """Returns the counters of the kernel, None if it does not have them."""
    info = connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _TCP_INFO_SIZE)
    if len(info) < _OUT_OF_ORDER + 4:
        return None
    return Packets(*(struct.unpack_from("=I", info, offset)[0] for offset in (_DATA_SEGMENTS_IN, _OUT_OF_ORDER, _TOTAL_RETRANSMISSIONS)))


def judge_packets(counted: Optional[Packets]) -> Finding:
    if counted is None:
        return ok("packet loss", "not counted by this kernel")
    if counted.out_of_order or counted.retransmitted:
        return warning("packet loss",
                       f"{counted.out_of_order} of {counted.received} packets came out of order and {counted.retransmitted} were repeated, "
                       "so the network loses packets",
                       "replace cable or switch, avoid Wi-Fi, and look for a duplicate address (`arping -D`) and for a wrong duplex "
                       "setting (`ethtool`)")
    return ok("packet loss", f"none in {counted.received} packets")


def interface_of(address: str) -> str:
    """Returns the name of the network interface that has this local address, empty if there is none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        for _index, name in socket.if_nameindex():
            try:
                answer = fcntl.ioctl(probe, _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
            except OSError:
                continue
            if socket.inet_ntoa(answer[20:24]) == address:
                return name
    return ""


def judge_interface(name: str, system: pathlib.Path = SYSTEM) -> Finding:
    """Judges the network card from what the kernel reports about it."""
    folder = system / name
    if not name or not folder.exists():
        return ok("network card", "local connection")
    if (folder / "wireless").exists():
        return warning("network card", f"{name} is Wi-Fi", "connect the robot by cable")
    try:
        speed, duplex = int((folder / "speed").read_text()), (folder / "duplex").read_text().strip()
    except (OSError, ValueError):
        return ok("network card", f"{name}, of unknown speed")
    if 0 < speed < MIN_SPEED or duplex == "half":
        return warning("network card", f"{name} has negotiated {speed} Mbit/s, {duplex} duplex",
                       "replace the cable or the switch, and leave the negotiation automatic on both sides")
    return ok("network card", f"{name}, {speed} Mbit/s, {duplex} duplex" if speed > 0 else f"{name}, of unknown speed")
