"""The rows of ./ur bench. To add one, add it here, and return its value from the measurement.

A value is at figures[name][part], or at figures[name] if there is no part. Smaller values are better in all rows.
"""

from typing import List, NamedTuple, Optional, Tuple


class Row(NamedTuple):
    name: str
    part: Optional[str]
    target: Optional[float]
    unit: str

    @property
    def title(self) -> str:
        return f"{self.name} {self.part}" if self.part else self.name


# Conditions of --stress, and what runs beside the driver in each.
CONDITIONS = {
    "alone": "nothing else",
    "cpu load": "a busy loop on each core",
    "Python subscriber": "an rclpy node that subscribes to all topics",
    "20 subscribers": "20 more subscribers to joint_states, each a process",
}
# Conditions of --viewer, and what runs beside the driver in each.
VIEWER_CONDITIONS = {"without viewer": (), "with viewer": ("viewer",), "with viewer and browser": ("viewer", "browser")}
QOS = ("best effort", "reliable")
# Numbers of robots of --scale, and the processes of each robot.
ROBOTS = (1, 4, 8)
HOSTING = {"driver": ("driver",), "three processes": ("robot_state_receiver", "command_server", "dashboard_server")}


# Values of the parameter `servers`, in --servers.
SERVERS = ("on_demand", "always")


def servers_name(servers: str, part: str) -> str:
    """`part`: what is measured, or nothing for the driver before its first client."""
    return f"servers:={servers}{part and ', '}{part}"


def scale_name(robots: int, hosting: str) -> str:
    return f"{robots} robot{'s' * (robots > 1)}, {hosting}"


def stress_name(condition: str, qos: str) -> str:
    return f"{condition}, {qos}"


# Parts of the servo stream: part, target, unit.
STREAM: Tuple[Tuple[str, float, str], ...] = (
    ("answer p50", 0.3, "ms from a package to its target"),
    ("answer p99.9", 0.5, "ms from a package to its target"),
    ("off package", 0.1, "% of the intervals differ by more than 0.2 ms from those of the packages that they answer"),
    ("off 2 ms", 0.1, "% of the intervals differ by more than 0.2 ms from 2 ms"),
    ("cycles off 2 ms", 0.1, "% of the simulated controller's cycles differ by more than 0.2 ms from 2 ms"),
    ("not once a cycle", 0.1, "% of the cycles received no target, or several"),
    ("tracking error", 0.02, "rad"),
)
STREAMS = ("servo stream", "servo stream, real-time")
STRESSED_STREAMS = ("servo stream, cpu load", "servo stream, cpu load, real-time")
# Parts of --scale and of --stress.
SCALE: Tuple[Tuple[str, float, str], ...] = (
    ("package p50", 0.5, "ms to a C++ subscriber of one robot"),
    ("package p99", 2.0, "ms to a C++ subscriber of one robot"),
    ("cpu", 10.0, "% of a core per robot"),
    ("memory", 120.0, "MB per robot, resident"),
    ("ready", 10.0, "s from the start of the first driver until all robots are ready"),
    ("own memory", 100.0, "MB per robot, shared pages divided among the processes"),
)
STRESS: Tuple[Tuple[str, float, str], ...] = (
    ("p50", 0.3, "ms from a package to a C++ subscriber"),
    ("p99", 1.0, "ms from a package to a C++ subscriber"),
    ("p99.9", 2.0, "ms from a package to a C++ subscriber"),
    ("missing", 0.1, "% of the packages did not reach the subscriber"),
)
# What --servers measures: name, part, unit.
SERVER_PARTS: Tuple[Tuple[str, str, str], ...] = (
    ("", "start", "s until the driver is ready"),
    ("", "memory", "MB of the driver without a client"),
    ("", "own memory", "MB of the driver without a client, shared pages divided among the processes"),
    ("", "endpoints", "in the domain, without a client"),
    ("", "other node", "MB more in another node of the domain than without a driver"),
    *(("accepted", p, "s until a new client has its first goal accepted, after clients were killed") for p in ("p50", "p90", "max")),
    *(("found", p, "s until it has also found all actions") for p in ("p50", "p90", "max")),
    *((part, memory, "MB of the driver") for part in ("after ten", "after all") for memory in ("memory", "own memory")),
)
# Interruptions of --recovery, and the targets.
RECOVERY = {"links closed": 10.0, "controller restarted": 30.0, "node restarted": 500.0}
# Parts of --simulator.
SIMULATOR: Tuple[Tuple[str, Optional[float], str], ...] = (
    ("start-up", 0.15, "s until all ports are open"),
    ("cpu idle", 5.0, "% of a core"),
    ("cpu moving", 5.0, "% of a core"),
    ("cycle p99", None, "ms deviation of a control cycle from 2 ms"),
    ("cycle p99.9", None, "ms deviation of a control cycle from 2 ms"),
    ("host p99", None, "ms deviation of a loop that only sleeps"),
    ("host p99.9", None, "ms deviation of a loop that only sleeps"),
    ("cycle moving", None, "us of processor time for each control cycle of a moving robot, with its sockets"),
    ("instructions", None, "of URScript in a cycle in which ur_rtde's control program waits"),
    ("memory", None, "MiB, resident, of a moving robot"),
    ("growth", 64.0, "KiB of memory per simulated hour of --hours"),
)

ROWS: Tuple[Row, ...] = (
    Row("package to C++ subscriber", "p50", 0.3, "ms"),
    Row("package to C++ subscriber", "p99", 1.0, "ms"),
    Row("package to rclpy subscriber", "p50", 0.3, "ms"),
    Row("package to rclpy subscriber", "p99", 1.0, "ms"),
    Row("goal of C++ client to command", "p50", 0.4, "ms"),
    Row("goal of C++ client to command", "p99", 0.8, "ms"),
    Row("goal of rclpy client to command", "p50", 0.4, "ms"),
    Row("goal of rclpy client to command", "p99", 0.8, "ms"),
    Row("cancel to deceleration", "p50", 5.0, "ms"),
    Row("end of motion to result", "p50", 6.0, "ms from the last cycle in which the target moves"),
    *(Row(stream, *part) for stream in STREAMS for part in STREAM),
    Row("cpu", "simulator", 10.0, "% of a core"),
    Row("cpu", "robot_state_receiver", 10.0, "% of a core"),
    Row("cpu", "command_server", 10.0, "% of a core"),
    Row("cpu", "dashboard_server", 10.0, "% of a core"),
    Row("memory", "command_server", 55.0, "MB"),
    Row("start to ready", None, 2.0, "s"),
    Row("new client finds all actions", "p50", 0.5, "s, after clients were killed"),
    Row("new client finds all actions", "max", 1.0, "s, after clients were killed"),
    *(Row(servers_name(servers, name), part, None, unit) for servers in SERVERS for name, part, unit in SERVER_PARTS),
    *(Row(scale_name(robots, hosting), *part) for hosting in HOSTING for robots in ROBOTS for part in SCALE),
    Row("many goals", "growth", 1.0, "MB of the driver's memory over the second half of the goals"),
    Row("many goals", "duration", None, "ms per goal, from sending it to its result"),
    *(Row(stress_name(condition, qos), *part) for condition in CONDITIONS for qos in QOS for part in STRESS),
    *(Row(stress_name(condition, qos), *part) for condition in VIEWER_CONDITIONS for qos in QOS for part in STRESS),
    Row("viewer", "cpu", 25.0, "% of a core at 30 updates per second, with a page open, while the arm moves"),
    Row("browser", "cpu", None, "% of a core; without a GPU, it draws a hundredth of the scene's pixels"),
    *(Row(stream, *part) for stream in STRESSED_STREAMS for part in STREAM),
    *(Row(name, part, target, "ms until the next joint_states")
      for name, target in RECOVERY.items() for part in ("p50", "max")),
    *(Row("simulator", *part) for part in SIMULATOR),
    Row("simulator, compiling", "ur_rtde", None, "ms for ur_rtde's control program"),
    Row("simulator, compiling", "2000 lines", None, "ms"),
    Row("simulator, robots", "lost time", 1.0, "% of the time of the slowest of --count moving robots in one process"),
    Row("simulator, robots", "cpu", None, "% of a core for all of them"),
)


def value(figures: dict, row: Row) -> Optional[float]:
    """Returns None if the row was not measured, or without a result."""
    found = figures.get(row.name)
    return found.get(row.part) if row.part is not None and found is not None else found


def values(runs: List[dict], row: Row) -> List[float]:
    """Returns the values of a row in all runs that have one."""
    found = (value(run["figures"], row) for run in runs)
    return [one for one in found if one is not None]


def failed(runs: List[dict], row: Row) -> bool:
    """Returns whether the row was measured, but without a result in any run."""
    return any(row.name in run["figures"] for run in runs) and not values(runs, row)
