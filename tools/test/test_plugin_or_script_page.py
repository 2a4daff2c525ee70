"""docs/use/plugin_or_script.md agrees with the programs that it compares, and with the test that measures them."""

import ast
import re

from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "use" / "plugin_or_script.md").read_text()
TUTORIALS = ROOT / "ur_ros_rtde_tutorials"
PROGRAMS = {"plugin": "src/move_down_until_force.cpp", "one program": "examples/urscript_loop.py",
            "two programs": "examples/two_snippets.py"}


def cells(first):
    """Returns the cells of the comparison in the row that begins with this text."""
    line, = [line for line in PAGE.splitlines() if line.startswith(f"| {first}|")]
    return [cell.strip() for cell in line.split("|")[2:-1]]


def test_the_numbers_of_lines_are_those_of_the_programs():
    """Without empty lines and comments."""
    lines = {way: sum(not re.match(r"\s*(#(?!include)|//|$)", line) for line in (TUTORIALS / name).read_text().splitlines())
             for way, name in PROGRAMS.items()}
    counts = dict(zip(cells(""), cells("lines of code ")))
    assert {way: count for way, count in counts.items() if way in lines} == {way: str(count) for way, count in lines.items()}
    assert all(f"({name})" in PAGE.replace("../../ur_ros_rtde_tutorials/", "") for name in PROGRAMS.values())


def test_the_surface_of_the_measurement_is_that_of_the_test():
    test = TUTORIALS / "test" / "test_three_ways.py"
    values = {node.targets[0].id: ast.literal_eval(node.value) for node in ast.parse(test.read_text()).body
              if isinstance(node, ast.Assign) and node.targets[0].id in ("SURFACE", "THRESHOLD")}
    assert f"{test.relative_to(ROOT)}` prints" in PAGE
    assert f"on a surface of {values['SURFACE']['stiffness'] / 1000:g} N/mm" in PAGE
    assert f"until a force of {values['THRESHOLD']:g} N" in PAGE
