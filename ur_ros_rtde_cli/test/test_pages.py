"""Runs the commands of docs/use/first_day.md and doctor.md with a simulated robot, in their order."""

import os
import pathlib
import re
import shlex

from robot_fixtures import simulated_robot
from ur_program import ur

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "docs" / "use"
ADDRESS = "192.168.56.101"  # of the robot on the pages
LIMIT = 90.0  # s, of a command


def commands(page):
    """Yields the arguments of each `ur …` in a code block."""
    for block in re.findall(r"```bash\n(.*?)```", (FOLDER / page).read_text(), re.S):
        yield from re.findall(r"^ *ur (.*)$", block, re.M)


def test_the_commands_succeed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PWD", str(tmp_path))
    found = [*commands("first_day.md"), *commands("doctor.md")]
    assert len(found) >= 6
    with simulated_robot("ur_type:=ur5e", model="ur5e") as simulator:
        for line in found:
            code, output = ur(*shlex.split(os.path.expandvars(line.replace(ADDRESS, simulator.address))), limit=LIMIT)
            assert code == 0, f"{line}\n{output}"
