"""Measures how long new clients take to find all actions of the driver after other clients were killed (docs/internals/discovery.md)."""

import json
import subprocess
from typing import Dict

from . import bench_session, console, simulation
from .environment import FASTDDS_PROFILES, run_environment
from .layout import ROOT, Layout
from .processes import Program, Programs

CLIENTS = ROOT / "ur_ros_rtde_commands" / "test" / "system" / "discovery_clients.py"
LISTS = ("]: all commands: ", "]: all dashboard commands: ")
TIME_LIMIT = 600.0  # s


def actions(driver: Program) -> str:
    """Returns the actions that the driver serves according to its log, separated by commas."""
    return ",".join(line.partition(text)[2] for text in LISTS for line in driver.output.splitlines() if text in line).replace(" ", "")


def measure(layout: Layout, address: str, killed: int, clients: int) -> Dict[str, float]:
    """Returns median and maximum, s. No robot is needed. As with most users, the clients have no Fast DDS profile."""
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    for variable in FASTDDS_PROFILES:
        env.pop(variable, None)
    with Programs(bench_session.log_folder(layout, address)) as programs:
        driver = simulation.start_node(programs, layout, env, "driver", address, debugged=("command_server", "dashboard_server"))
        programs.wait_until(lambda: all(text in driver.output for text in LISTS), 20.0, "the driver's actions")
        command = [str(layout.python), str(CLIENTS), actions(driver), "--killed", str(killed), "--clients", str(clients)]
        result = subprocess.run(command, env=env, stdout=subprocess.PIPE, text=True, timeout=TIME_LIMIT)
    if result.returncode != 0:
        raise console.Failure("the clients did not find the driver, see above")
    found = json.loads(result.stdout)
    incomplete = [client for client in found if client["missing"]]
    if incomplete:
        raise console.Failure(f"{len(incomplete)} of {len(found)} new clients did not find all actions")
    seconds = sorted(client["seconds"] for client in found)
    return {"p50": seconds[len(seconds) // 2], "max": seconds[-1]}
