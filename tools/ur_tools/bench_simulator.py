"""./ur bench --simulator: start-up, load, jitter, scripts and the number of robots of the simulated controller alone."""

import argparse
import json
import pathlib
import re
import socket
import statistics
import subprocess
import sys
import time
from typing import Dict, List

from . import bench_scale, bench_session, console, ports
from .environment import program
from .layout import ROOT, Layout
from .percentile import percentile

STARTS = 10
WINDOW = 5.0  # s of the host for each measurement of load and time
SCRIPT_LINES = 2000
CYCLE = 0.002  # s
FASTEST = 1000  # simulated seconds per second of the host: as many as the host can compute, for memory
WARM_UP = 0.1  # simulated hours
FILL_LOG = "def fill_log():\n  i = 0\n  while i < 1500:\n    textmsg(\"program 'back_and_forth' stopped\")\n    i = i + 1\n  end\nend\n"
MOVING = ("def back_and_forth():\n  q = get_actual_joint_positions()\n  while True:\n"
          "    movej([q[0] + 0.3, q[1], q[2], q[3], q[4], q[5]], a=3, v=2)\n    movej(q, a=3, v=2)\n  end\nend\n")


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("simulator")
    group.add_argument("--simulator", action="store_true",
                       help="only measure the simulator: start-up, load, jitter, scripts, robots in one process, memory "
                            "(about three minutes)")
    group.add_argument("--count", type=int, default=10, metavar="N",
                       help="with --simulator: robots in one process (default: 10)")
    group.add_argument("--hours", type=float, default=1.0, metavar="H",
                       help="with --simulator: simulated hours over which the growth of the memory is measured; "
                            "about a minute each (default: 1)")


def check(options: argparse.Namespace) -> None:
    """Raises Failure if an option is out of range or an address is in use."""
    if not 0.01 <= options.hours <= 1000.0:
        raise console.Failure(f"--hours {options.hours:g} is out of range: give 0.01 to 1000")
    for address in bench_scale.addresses(options, options.count):
        ports.check(address)


class _Simulator:
    """The program with some options, ended at the end of the block."""

    def __init__(self, layout: Layout, options: argparse.Namespace, *arguments: str, lines: int = 1) -> None:
        command = [str(program(layout, "ur_simulator", "ur_simulator")), "--address", options.address, "--model", options.model]
        begin = time.monotonic()
        self.process = subprocess.Popen([*command, *arguments], env=bench_session.environment(layout), stdout=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self._output = self.process.stdout
        for _ in range(lines):
            if not self._output.readline().startswith("ready: "):
                self.process.kill()
                raise console.Failure("the simulator did not start")
        self.start_up = time.monotonic() - begin

    def __enter__(self) -> "_Simulator":
        return self

    def __exit__(self, *_unused: object) -> None:
        self.process.terminate()
        self.process.wait()
        self._output.close()


def _control(address: str, **request: object) -> dict:
    with socket.create_connection((address, 30099), timeout=10.0) as connection, connection.makefile("rw") as lines:
        lines.write(json.dumps(request) + "\n")
        lines.flush()
        return json.loads(lines.readline())


def _robot_time(address: str) -> float:
    return _control(address, command="state")["state"]["timestamp"]


def _control_seconds(address: str, **request: object) -> float:
    begin = time.monotonic()
    reply = _control(address, **request)
    if not reply["ok"]:
        raise console.Failure(reply["error"])
    return time.monotonic() - begin


def _cpu_percent(pid: int, seconds: float) -> float:
    sys.path.insert(0, str(ROOT / "bench"))
    from process_load import cpu_percent
    return cpu_percent({"simulator": pid}, seconds)["simulator"]


def _deviations(times: List[float]) -> List[float]:
    """Deviations of the intervals from a control cycle, ms."""
    return [1e3 * abs(later - earlier - CYCLE) for earlier, later in zip(times, times[1:])]


def _host_deviations(seconds: float) -> List[float]:
    """Of a loop of this process that only sleeps until the next multiple of 2 ms."""
    times, due = [], time.monotonic()
    end = due + seconds
    while due < end:
        due += CYCLE
        time.sleep(max(0.0, due - time.monotonic()))
        times.append(time.monotonic())
    return _deviations(times)


def _cycle_deviations(address: str) -> List[float]:
    cycles = _control(address, command="trace")["cycles"]
    return _deviations([1e-9 * cycle[1] for cycle in cycles])


def _script_seconds(address: str, script: str) -> float:
    """Time to compile a script: median of storing and loading it, less that of storing it."""
    def median(load: bool) -> float:
        return statistics.median(_control_seconds(address, command="store_program", name="bench.script", script=script, load=load)
                                 for _ in range(5))
    return max(0.0, median(True) - median(False))


def _long_script() -> str:
    body = "".join(f"  x{line} = {line} * 2 + {'0' if line == 0 else f'x{line - 1}'}\n" for line in range(SCRIPT_LINES))
    return f"def long():\n{body}end\n"


def _control_script(layout: Layout) -> str:
    """ur_rtde's control program as it is uploaded to PolyScope 5.25: without markers of versions, with register offsets."""
    (found,) = (layout.build / "ur_rtde_vendor" / "source").rglob("rtde_control.script")
    lines = []
    for line in found.read_text().splitlines():
        marker = re.match(r"\$(\d+)\.(\d+)\S*", line)
        if marker and (int(marker[1]), int(marker[2])) > (5, 25):
            continue
        line = line[marker.end():] if marker else line
        lines.append(re.sub(r"#.* register offset$", "0", line))
    return "\n".join(["def rtde_control():", *lines, "end", ""])


def _instructions(layout: Layout, address: str) -> int:
    """Instructions of URScript in a cycle in which ur_rtde's control program waits for a command: median of 50 states."""
    _control(address, command="run_script", script=_control_script(layout))
    counts = [_control(address, command="state")["state"]["program"]["instructions"] for _ in range(51)]
    _control(address, command="stop_program")
    return statistics.median(counts[1:])


def _resident(pid: int) -> int:
    """Memory of a process, KiB."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0])


def _memory(layout: Layout, options: argparse.Namespace) -> "tuple[Dict[str, float], List[float]]":
    """Of a robot that moves as fast as the host can compute it, with a program that is started again every second of the host.

    Returns the figures, and the memory in KiB for each of these seconds.
    """
    status = console.Status()
    samples: List[float] = []
    with _Simulator(layout, options, "--real-time-factor", str(FASTEST)) as simulator:
        def work(hours: float) -> None:
            start, begin = _robot_time(options.address), time.monotonic()
            done = 0.0
            while done < hours:
                _control(options.address, command="run_script", script=MOVING)
                time.sleep(1.0)
                samples.append(_resident(simulator.process.pid))
                done = (_robot_time(options.address) - start) / 3600.0
                left = (time.monotonic() - begin) * (hours / done - 1.0)
                status.show(f"{done:.2f} of {hours:g} simulated hours, {samples[-1]} KiB, about {max(0.0, left):.0f} s left")
            status.clear()
        _control(options.address, command="run_script", script=FILL_LOG)  # the log keeps 1000 entries
        work(WARM_UP)
        del samples[:-1]
        work(options.hours)
    return {"memory": samples[-1] / 1024.0, "growth": (samples[-1] - samples[0]) / options.hours}, samples


def _lost_time(layout: Layout, options: argparse.Namespace) -> Dict[str, float]:
    """Of all robots in one process, while they move."""
    addresses = bench_scale.addresses(options, options.count)
    with _Simulator(layout, options, "--count", str(options.count), lines=options.count) as simulator:
        for address in addresses:
            _control(address, command="run_script", script=MOVING)
        begin = {address: (time.monotonic(), _robot_time(address)) for address in addresses}
        cpu = _cpu_percent(simulator.process.pid, WINDOW)
        lost = []
        for address, (host, robot) in begin.items():
            elapsed = time.monotonic() - host
            lost.append(100.0 * (1.0 - (_robot_time(address) - robot) / elapsed))
    return {"lost time": max(lost), "cpu": cpu}


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    console.step("Measuring the simulator, for about three minutes")
    starts = []
    for _ in range(STARTS):
        with _Simulator(layout, options) as simulator:
            starts.append(simulator.start_up)
    with _Simulator(layout, options) as simulator:
        idle = _cpu_percent(simulator.process.pid, WINDOW)
        deviations = _cycle_deviations(options.address)
        scripts = {"ur_rtde": _script_seconds(options.address, _control_script(layout)),
                   f"{SCRIPT_LINES} lines": _script_seconds(options.address, _long_script())}
        instructions = _instructions(layout, options.address)
        _control(options.address, command="run_script", script=MOVING)
        moving = _cpu_percent(simulator.process.pid, WINDOW)
    host = _host_deviations(WINDOW)
    memory, memory_samples = _memory(layout, options)
    figures = {
        "simulator": {"start-up": statistics.median(starts), "cpu idle": idle, "cpu moving": moving,
                      "cycle p99": percentile(deviations, 0.99), "cycle p99.9": percentile(deviations, 0.999),
                      "host p99": percentile(host, 0.99), "host p99.9": percentile(host, 0.999),
                      "cycle moving": 1e6 * CYCLE * moving / 100.0, "instructions": instructions, **memory},
        "simulator, compiling": {name: 1e3 * seconds for name, seconds in scripts.items()},
        "simulator, robots": _lost_time(layout, options),
    }
    return figures, {"simulator cycle": deviations, "simulator host": host, "simulator memory": memory_samples}
