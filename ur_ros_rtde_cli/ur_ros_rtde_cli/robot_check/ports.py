"""Whether the ports of a controller can be reached, and what disables those that cannot."""

import enum
import errno
import socket
from dataclasses import dataclass
from typing import Dict, List

from .finding import Finding, fault, ok, warning


class Outcome(enum.Enum):
    OPEN = "open"
    REFUSED = "refused"
    SILENT = "no answer"
    UNREACHABLE = "unreachable"
    UNKNOWN = "unknown name"


@dataclass(frozen=True)
class Service:
    name: str  # as in the settings of PolyScope
    used_for: str
    required: bool


# Settings > Security > Services exists from PolyScope 5.10 on.
SERVICES = {29999: Service("Dashboard Server", "power, brakes, unlocking and programs", True),
            30001: Service("Primary Client", "the model and calibration of the arm, and error messages of scripts", True),
            30002: Service("Secondary Client", "nothing in this driver", False),
            30003: Service("Real-Time Client", "the upload of the control program", True),
            30004: Service("RTDE", "the state of the robot, and all commands", True)}
WHERE = "in PolyScope under Settings > Security > Services"


def probe(address: str, port: int, limit: float) -> Outcome:
    try:
        socket.create_connection((address, port), limit).close()
        return Outcome.OPEN
    except (socket.timeout, TimeoutError):
        return Outcome.SILENT
    except ConnectionRefusedError:
        return Outcome.REFUSED
    except (socket.gaierror, UnicodeError):  # the codec of host names raises UnicodeError for a name that cannot be one
        return Outcome.UNKNOWN
    except OSError as error:
        return Outcome.SILENT if error.errno == errno.ETIMEDOUT else Outcome.UNREACHABLE


def probe_all(address: str, limit: float) -> Dict[int, Outcome]:
    """Probes the ports in their order. Without an answer of the host, the others are not waited for."""
    outcomes: Dict[int, Outcome] = {}
    for port in SERVICES:
        outcomes[port] = probe(address, port, limit)
        if outcomes[port] in (Outcome.UNREACHABLE, Outcome.UNKNOWN):
            return {other: outcomes[port] for other in SERVICES}
    return outcomes


def judge(address: str, outcomes: Dict[int, Outcome]) -> List[Finding]:
    """Returns one finding for the address, or one for each port that is not open."""
    found = set(outcomes.values())
    if found == {Outcome.OPEN}:
        return [ok("ports", f"{', '.join(map(str, outcomes))} are open")]
    if found == {Outcome.UNKNOWN}:
        return [fault("address", f"{address} is neither an IPv4 address nor a host name that this host can resolve",
                      "give the address that PolyScope shows under Settings > System > Network")]
    if found == {Outcome.UNREACHABLE}:
        return [fault("address", f"{address} cannot be reached from this host",
                      "give this host an address in the network of the robot, and check the cable (`ip addr`, `ip route`)")]
    if found == {Outcome.SILENT}:
        return [fault("address", f"{address} does not answer",
                      "check that the controller has booted, its address (PolyScope: Settings > System > Network), the cable, and "
                      "firewalls between it and this host")]
    if found == {Outcome.REFUSED}:
        return [fault("address", f"{address} answers, but refuses all ports of a controller",
                      "wait until the controller has booted, and check that the address is that of the robot, not of another device")]
    return [_closed(port, outcome) for port, outcome in outcomes.items() if outcome is not Outcome.OPEN]


def _closed(port: int, outcome: Outcome) -> Finding:
    service = SERVICES[port]
    report = fault if service.required else warning
    use = f"it is needed for {service.used_for}" if service.required else f"it is used for {service.used_for}"
    if outcome is Outcome.REFUSED:
        return report("ports", f"port {port} is refused while others are open, so the service {service.name} is disabled ({use})",
                      f"enable it {WHERE}")
    return report("ports", f"port {port} ({service.name}) does not answer while others are open, so a firewall blocks it ({use})",
                  f"allow TCP port {port} on the way to the robot")
