#!/usr/bin/env python3
"""Runs public clients of other authors, unmodified, against the simulator, and prints which pass on which version of PolyScope.

docs/internals/testing.md says where the clients come from and how to build them. Clients that are not given are left out. Logs are
kept in --logs.
"""

import argparse
import json
import pathlib
import re
import socket
import subprocess
import sys
from typing import Dict, List, NamedTuple, Tuple

ADDRESS = "127.0.0.1"  # the External Control program and the clients' own servers use the ports from 50001 on
MODBUS_PORT = 1502  # 502 may need privileges
MODELS = {"3": "ur5", "5": "ur5e"}
TIMEOUT = 1800.0  # s for each client
# Replaces the address in the examples of urx, which they contain as a literal. math3d 3 looks for names that Python 3.10 has moved.
URX_EXAMPLE = """
import collections.abc, runpy, sys
collections.Iterable = collections.abc.Iterable
sys.path.insert(0, "..")
import urx
Robot = urx.Robot
urx.Robot = lambda host, *arguments, **options: Robot({address!r}, *arguments, **options)
sys.argv = [{example!r}, "nowait"]
runpy.run_path({example!r}, run_name="__main__")
"""
# Examples of the client library; those that would not end get a number of seconds.
CLIENT_LIBRARY_EXAMPLES = {
    "dashboard_example": [], "direct_torque_control_example": ["5"], "driver_example": [], "external_fts_through_rtde": ["5"],
    "force_mode_example": ["5"], "freedrive_example": ["5"], "instruction_executor": [], "primary_pipeline_calibration_example": [],
    "primary_pipeline_example": ["3"], "rtde_client_example": ["5"], "script_command_interface_example": ["12"],
    "script_sender_example": ["2"], "send_script": [], "spline_example": [], "tool_contact_example": ["8"],
    "trajectory_point_interface_example": [], "trajectory_streaming_example": [],
}
# Does what the program rtde_control_loop.urp does that belongs to the example.
RTDE_CONTROL_PROGRAM = """def rtde_control_loop():
  rtde_set_watchdog("input_int_register_0", 1, "PAUSE")
  write_output_integer_register(0, 1)
  while True:
    if read_input_integer_register(0) == 1:
      setpoint = p[0, 0, 0, 0, 0, 0]
      i = 0
      while i < 6:
        setpoint[i] = read_input_float_register(i)
        i = i + 1
      end
      movel(setpoint, a=1.2, v=0.25)
      write_output_integer_register(0, 0)
      while read_input_integer_register(0) == 1:
        sync()
      end
      write_output_integer_register(0, 1)
    end
    sync()
  end
end
"""
# The example has no end: it passes after five moves. Its host is localhost.
RTDE_CONTROL_LOOP = """
import runpy, socket, sys
moves = 0
def count_moves(text):
    global moves
    moves += text.startswith("Move to confirmed pose")
    if moves == 5:
        sys.exit()
with socket.create_connection(({address!r}, 30002)) as robot:
    robot.sendall({program!r}.encode())
    runpy.run_path("example_control_loop.py", init_globals={{"print": count_moves}})
sys.exit("the robot ended the connection")
"""
WAIT_PROGRAM = "def wait_program():\n  while True:\n    sleep(1)\n  end\nend\n"


class Check(NamedTuple):
    name: str
    folder: pathlib.Path
    command: List[str]


class Simulator:
    """The simulator with the programs that the tests and examples of the client library load."""

    def __init__(self, program: str, version: str, log: pathlib.Path) -> None:
        self._log = log.open("w")
        command = [program, "--address", ADDRESS, "--model", MODELS[version[0]], "--polyscope", version,
                   "--ports", f"modbus={MODBUS_PORT}", "--log"]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line.startswith("ready: "):
            raise RuntimeError(f"the simulator did not start: {line}{self._process.stdout.read()}")
        self._copy = subprocess.Popen(["cat"], stdin=self._process.stdout, stdout=self._log)
        self.control(command="store_program", name="wait_program.urp", script=WAIT_PROGRAM)
        self.control(command="store_external_control", host=ADDRESS, port=50002)

    def control(self, **request: object) -> None:
        with socket.create_connection((ADDRESS, 30099), timeout=5.0) as connection, connection.makefile("rw") as stream:
            stream.write(json.dumps(request) + "\n")
            stream.flush()
            reply = json.loads(stream.readline())
        if not reply["ok"]:
            raise RuntimeError(f"{request['command']}: {reply['error']}")

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait(timeout=10.0)
        self._copy.wait(timeout=10.0)
        self._log.close()


def client_library_example(build: pathlib.Path, name: str, arguments: List[str]) -> Check:
    source, = re.findall(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return Check(f"example {name}", pathlib.Path(source), [str(build / "examples" / name), ADDRESS, *arguments])


def checks(options: argparse.Namespace, version: str) -> List[Check]:
    result = []
    if options.client_library:
        # Tests with a simulated server of their own do not use the robot.
        tests = ["ctest", "--no-tests=error", "--timeout", "60", "-R",
                 "_headless$|_urcap$|RTDEClientTest|PrimaryClientTest|UrDriverTestDeprecated"]
        result.append(Check("Universal Robots Client Library", options.client_library,
                            [*tests, "-E", "[Ff]ake|server_stops|connect_non_running"]))
        result += [client_library_example(options.client_library, name, arguments) for name, arguments in CLIENT_LIBRARY_EXAMPLES.items()]
    if options.rtde_python:
        record = [options.python, "record.py", "--host", ADDRESS, "--samples", "300", "--output", "/dev/null"]
        result.append(Check("RTDE Python Client Library", options.rtde_python / "examples", record))
        loop = RTDE_CONTROL_LOOP.format(address=ADDRESS, program=RTDE_CONTROL_PROGRAM)
        result.append(Check("RTDE Python control loop", options.rtde_python / "examples", [options.python, "-c", loop]))
    if options.pymodbus:
        folder = pathlib.Path(__file__).parent
        result.append(Check("pymodbus", folder, [options.python, "modbus_check.py", ADDRESS, str(MODBUS_PORT)]))
    for example in ("simple.py", "matrices.py", "test_all.py") if options.urx else ():
        program = URX_EXAMPLE.format(address=ADDRESS, example=example)
        result.append(Check(f"urx {example}", options.urx / "examples", [options.python, "-c", program]))
    return result


def run(check: Check, log: pathlib.Path) -> str:
    try:
        process = subprocess.run(check.command, cwd=check.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                 timeout=TIMEOUT)
    except subprocess.TimeoutExpired as expired:
        log.write_text(str(expired.stdout))
        return f"not within {TIMEOUT:g} s"
    log.write_text(process.stdout)
    if tests := re.search(r"(\d+) tests failed out of (\d+)", process.stdout):
        return f"{int(tests[2]) - int(tests[1])} of {tests[2]}"
    return "passed" if process.returncode == 0 else "failed"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--simulator", default="ur_simulator", help="program of the simulator")
    parser.add_argument("--python", default=sys.executable, help="interpreter with the packages math3d, which urx needs, and pymodbus")
    parser.add_argument("--client-library", type=pathlib.Path, help="build folder of the Universal Robots Client Library")
    parser.add_argument("--rtde-python", type=pathlib.Path, help="folder of the RTDE Python Client Library")
    parser.add_argument("--urx", type=pathlib.Path, help="folder of urx")
    parser.add_argument("--pymodbus", action="store_true", help="call the functions of pymodbus")
    parser.add_argument("--versions", default="5.25.1,5.13.0,3.15.8", help="versions of PolyScope")
    parser.add_argument("--only", default="", help="checks whose names contain this text")
    parser.add_argument("--logs", type=pathlib.Path, default=pathlib.Path("client_checks_logs"), help="folder")
    options = parser.parse_args()
    if options.client_library:
        options.client_library = options.client_library.resolve()
    options.logs.mkdir(parents=True, exist_ok=True)
    results: Dict[Tuple[str, str], str] = {}
    for version in options.versions.split(","):
        for check in (check for check in checks(options, version) if options.only in check.name):
            log = options.logs / f"{re.sub('[^a-z]+', '_', check.name.lower())}-{version}.log"
            simulator = Simulator(options.simulator, version, log.with_suffix(".simulator.log"))
            try:
                results[check.name, version] = run(check, log)
            finally:
                simulator.stop()
            print(f"| {check.name} | {version} | {results[check.name, version]} |", flush=True)
    failed = [result for result in results.values() if result != "passed" and not re.fullmatch(r"(\d+) of \1", result)]
    print(f"{len(results) - len(failed)} passed, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
