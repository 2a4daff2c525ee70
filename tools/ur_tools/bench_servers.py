"""./ur bench --servers: what a driver with all actions costs itself, its clients and other nodes, with each value of `servers`.

Both values are measured in each run: --runs N measures them in turns.
"""

import argparse
import time
from typing import Dict, List

from . import bench_discovery, bench_session, console, simulation
from .bench_rows import SERVERS, servers_name
from .layout import Layout
from .processes import Programs

KILLED_CLIENTS, NEW_CLIENTS = 20, 20


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("action servers")
    group.add_argument("--servers", action="store_true",
                       help="only measure memory, start and discovery with servers:=on_demand and servers:=always (about 2 min)")


def _client(programs: Programs, layout: Layout, options: argparse.Namespace, arguments: List[str]) -> dict:
    return bench_session.run_script(programs, layout, options, "measure_servers.py", arguments, 600.0)


def _measure(layout: Layout, options: argparse.Namespace, servers: str) -> Dict[str, dict]:
    env = bench_session.environment(layout)
    with Programs(bench_session.log_folder(layout, options.address)) as programs:
        simulation.start_simulator(programs, layout, env, options.address, options.model)
        alone = _client(programs, layout, options, [])["other node"]
        begin = time.monotonic()
        driver = simulation.start_node(programs, layout, env, "driver", options.address, f"servers:={servers}",
                                       debugged=("command_server", "dashboard_server"))
        bench_session.wait_until_ready(programs, driver)
        ready = time.monotonic() - begin
        found = _client(programs, layout, options, ["--pid", str(driver.process.pid), "--actions", bench_discovery.actions(driver),
                                                    "--clients", str(NEW_CLIENTS), "--killed", str(KILLED_CLIENTS)])
        programs.check()
    other = found.pop("other node")
    found[""].update({"start": ready, "endpoints": other["endpoints"], "other node": other["memory"] - alone["memory"]})
    return {servers_name(servers, part): figures for part, figures in found.items()}


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    figures: Dict[str, dict] = {}
    for servers in SERVERS:
        console.step(f"Measuring servers:={servers}")
        figures.update(_measure(layout, options, servers))
    return figures, {}
