"""What a bug report needs, as Markdown, without private data."""

import getpass
import ipaddress
import os
import pathlib
import platform
import re
import socket
import sys
import time
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple

from .errors import CliError, OperationFailed
from .namespaces import NODES, other_drivers
from .version import version_line

PROGRAMS = ("driver", *NODES)
VARIABLES = ("ROS_", "RMW_", "FASTDDS_", "FASTRTPS_", "CYCLONEDDS_", "ZENOH_")
LOG_LINES = 200
DISCOVERY = 2.0  # s
DIAGNOSTICS = 1.5  # s; they are published once a second
ANSWER = 2.0  # s

_IPV4 = re.compile(r"(?<![\d.])(?!127\.|0\.0\.0\.0\b)(?:(?:25[0-5]|2[0-4]\d|1?\d?\d)\.){3}(?:25[0-5]|2[0-4]\d|1?\d?\d)(?!\d|\.\d)")
_IPV6 = re.compile(r"(?<![\w:.])[0-9a-f]*:[0-9a-f:]+(?![\w:])", re.I)  # times, too
_MAC = re.compile(r"\b(?:[0-9a-f]{2}:){5}[0-9a-f]{2}\b", re.I)
_SERIAL_NUMBER = re.compile(r"\b20\d{9}\b")  # of a robot: the year of its production, then nine digits


def without_private_data(text: str, robots: Iterable[str] = ()) -> str:
    """Replaces the home folder, the names of user, host and robots, addresses and serial numbers, equal ones by equal words."""
    home = str(pathlib.Path.home())
    text = text.replace(home, "~") if home != "/" else text
    names = ((socket.gethostname(), "<host>"), (_user(), "<user>"), *((robot, "<robot>") for robot in robots))
    for name, word in sorted(names, key=lambda pair: -len(pair[0])):  # a host may be called like the beginning of another
        if len(name) > 2 and name not in ("root", "localhost") and not _is_address(name):
            text = re.sub(rf"(?<![A-Za-z0-9]){re.escape(name)}(?![A-Za-z0-9])", word, text)
    for pattern, what in ((_MAC, "MAC address"), (_IPV4, "address"), (_IPV6, "IPv6 address"), (_SERIAL_NUMBER, "serial number")):
        text = _numbered(text, pattern, what)
    return text


def _numbered(text: str, pattern: "re.Pattern[str]", what: str) -> str:
    numbers: Dict[str, int] = {}

    def word(match: "re.Match[str]") -> str:
        value = match.group()
        if pattern is _IPV6 and not _is_in_a_network(value):
            return value
        return f"<{what} {numbers.setdefault(value, len(numbers) + 1)}>"

    return pattern.sub(word, text)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _is_in_a_network(text: str) -> bool:
    """Neither a time of day nor an address of every host."""
    return _is_address(text) and not ipaddress.ip_address(text).is_loopback and not ipaddress.ip_address(text).is_unspecified


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # a container without an entry for its user
        return ""


def _section(title: str, lines: Iterable[str]) -> str:
    return f"## {title}\n\n```\n" + "\n".join(lines) + "\n```\n"


def _versions() -> Iterator[str]:
    from rclpy.utilities import get_rmw_implementation_identifier
    yield f"{version_line()}, {get_rmw_implementation_identifier()}"
    yield f"Python {platform.python_version()}, {_operating_system()}, kernel {platform.release()} {platform.version()}"
    yield f"{platform.machine()}, {len(os.sched_getaffinity(0))} processors, load {' '.join(f'{load:.1f}' for load in os.getloadavg())}"


def _operating_system() -> str:
    try:
        return re.search(r'^PRETTY_NAME="?([^"\n]*)', pathlib.Path("/etc/os-release").read_text(), re.M)[1]  # type: ignore[index]
    except (OSError, TypeError):
        return platform.system()


def _environment() -> List[str]:
    return [f"{name}={value}" for name, value in sorted(os.environ.items()) if name.startswith(VARIABLES)] or ["no variable of ROS"]


def _driver_nodes(session: Any) -> List[Tuple[str, str]]:
    """Returns name and namespace of each node of the driver."""
    namespace = session.node.get_namespace()
    return sorted({(name, space) for name, space in session.node.get_node_names_and_namespaces()
                   if name in NODES and space == namespace})


def _call(session: Any, kind: Any, name: str, **fields: Any) -> Any:
    """Returns the response of a service, or None."""
    client = session.node.create_client(kind, name)
    try:
        if not session.wait(client.service_is_ready, ANSWER):
            return None
        return session.result(client.call_async(kind.Request(**fields)), ANSWER)
    finally:
        session.node.destroy_client(client)


def _parameters(session: Any, node: str) -> Optional[Dict[str, Any]]:
    from rcl_interfaces.srv import GetParameters, ListParameters
    from rclpy.parameter import parameter_value_to_python
    listed = _call(session, ListParameters, f"{node}/list_parameters")
    names = list(listed.result.names) if listed else []
    values = _call(session, GetParameters, f"{node}/get_parameters", names=names) if names else None
    return dict(zip(names, map(parameter_value_to_python, values.values))) if values else None


def _node_lines(session: Any, parameters: Dict[str, Optional[Dict[str, Any]]]) -> Iterator[str]:
    if not parameters:
        yield f"no node of the driver was found with this namespace and ROS_DOMAIN_ID{other_drivers(session.node)}"
    for node, values in parameters.items():
        yield node
        yield from ["    no answer"] if values is None else [f"    {name}: {value}" for name, value in sorted(values.items())]


def _state(session: Any) -> List[str]:
    from .print_state import TOPIC_COUNT, state_lines, subscribe
    latest = subscribe(session)
    session.wait(lambda: len(latest) == TOPIC_COUNT, ANSWER)
    return list(state_lines(latest)) if "joint_states" in latest else ["no joint_states"]


def _diagnostics(session: Any) -> Iterator[str]:
    from diagnostic_msgs.msg import DiagnosticArray
    found: Dict[str, Any] = {}
    session.node.create_subscription(DiagnosticArray, "/diagnostics", lambda m: found.update((s.name, s) for s in m.status), 10)
    session.wait(lambda: None, DIAGNOSTICS)
    if not found:
        yield "none"
    for name, status in sorted(found.items()):
        yield f"{('OK', 'WARN', 'ERROR', 'STALE')[int.from_bytes(status.level, 'little')]:5} {name}: {status.message}"
        yield from (f"      {value.key}: {value.value}" for value in status.values)


def _robot(address: str) -> List[str]:
    if not address:
        return ["no address: the driver does not run, and --robot is not given"]
    from .robot_check.checks import Options, RobotCheck
    return [finding.line() for finding in RobotCheck(Options(address)).findings()]


def _log_folder(environment: Mapping[str, str]) -> pathlib.Path:
    """As rcl_logging chooses it."""
    home = environment.get("ROS_HOME") or pathlib.Path.home() / ".ros"
    return pathlib.Path(environment.get("ROS_LOG_DIR") or pathlib.Path(home) / "log").expanduser()


def _running() -> Dict[str, pathlib.Path]:
    """Returns the log folders of the driver's processes of this user in this ROS domain, by their number."""
    found = {}
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (process / "comm").read_text().strip() not in {program[:15] for program in PROGRAMS}:
                continue
            variables = (process / "environ").read_text(errors="replace").split("\0")
        except OSError:
            continue  # it has ended, or is of another user
        environment = dict(variable.split("=", 1) for variable in variables if "=" in variable)
        if environment.get("ROS_DOMAIN_ID", "0") == os.environ.get("ROS_DOMAIN_ID", "0"):
            found[process.name] = _log_folder(environment)
    return found


def _log_files(program: str, running: Mapping[str, pathlib.Path]) -> List[pathlib.Path]:
    """Returns the logs of the running processes of a program, otherwise all, the newest last."""
    own = [file for process, folder in running.items() for file in folder.glob(f"{program}_{process}_*.log")]
    return sorted(own or _log_folder(os.environ).glob(f"{program}_*.log"), key=lambda path: path.stat().st_mtime)


def _logs() -> Iterator[str]:
    """Yields the last lines of the newest log of each program of the driver."""
    folder, running = _log_folder(os.environ), _running()
    found = False
    for program in PROGRAMS:
        logs = _log_files(program, running)
        if not logs:
            continue
        found = True
        try:
            lines = logs[-1].read_text(errors="replace").splitlines()
        except OSError as error:
            yield f"{logs[-1].name} cannot be read: {error.strerror}"
            continue
        yield f"{logs[-1].name}, {len(lines)} lines:"
        yield from lines[-LOG_LINES:]
    if not found:
        yield f"no log of the driver in {folder}"
    for stop in sorted(file for where in {folder, *running.values()} for file in where.glob("ur_stop_*.csv")):
        yield f"states before a stop, to attach: {stop}"


def collect(session: Any, robot: str, say: Callable[[str], None]) -> str:
    """Returns the report. `robot`: address, empty for that of the driver. Tells what it does with `say`."""
    say("looking for the nodes of the driver")
    session.wait(lambda: len(_driver_nodes(session)) == len(NODES), DISCOVERY)
    parameters = {f"{space.rstrip('/')}/{name}": _parameters(session, f"{space.rstrip('/')}/{name}")
                  for name, space in _driver_nodes(session)}
    addresses = [values["robot_ip"] for values in parameters.values() if values and values.get("robot_ip")]
    address = robot or next(iter(addresses), "")
    say("reading the state and the diagnostics")
    state, diagnostics = _state(session), list(_diagnostics(session))
    say(f"checking {address}" if address else "no robot to check")
    sections = (("Versions", _versions()), ("Environment", _environment()), ("Nodes and parameters", _node_lines(session, parameters)),
                ("State", state), ("Diagnostics", diagnostics), ("Robot and network", _robot(address)), ("Log", _logs()))
    title = f"# Report of ur_ros_rtde, {time.strftime('%Y-%m-%d %H:%M UTC', time.gmtime())}\n"
    return without_private_data("\n".join((title, *(_section(*section) for section in sections))), [robot, *addresses])


def _may_write(file: pathlib.Path, agreed: bool) -> bool:
    if agreed:
        return True
    if not sys.stdin.isatty():
        raise CliError(f"{file} is not written: without a terminal, the report cannot be read first. Give --yes to write it anyway.")
    print(f"Write this to {file}? [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def run(file: pathlib.Path, namespace: str, robot: str, agreed: bool) -> int:
    """Shows the report and writes it to `file`, if the user agrees."""
    if not file.parent.is_dir():
        raise CliError(f"{file.parent} is no folder")
    from . import fastdds_profile, lazy_imports
    lazy_imports.enable()
    fastdds_profile.use()
    from .session import session
    with session(namespace) as created:
        text = collect(created, robot, lambda step: print(step, file=sys.stderr, flush=True))
    print(text, flush=True)
    if not _may_write(file, agreed):
        return 1
    try:
        file.write_text(text)
    except OSError as error:
        raise OperationFailed(f"{file} cannot be written: {error.strerror}") from error
    print(f"written to {file}; read it again before you publish it", file=sys.stderr)
    return 0
