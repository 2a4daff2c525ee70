"""docs/use/safety.md names tests that exist, and every action that does not only read."""

import re

from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "use" / "safety.md").read_text()
ACTIONS = (ROOT / "docs" / "use" / "commands" / "README.md").read_text().split("\nThe name of an action")[0]
# They read, show something on the teach pendant, or write a log. Those of the group queries only read.
HARMLESS = {"get_freedrive_status", "robotiq_get_status", "sg_get_width", "tool_contact", *(f"dashboard/{name}" for name in (
    "power_on", "running", "program_state", "get_loaded_program", "is_program_saved", "close_safety_popup", "robot_mode",
    "safety_mode", "safety_status", "popup", "close_popup", "add_to_log", "is_in_remote_control", "get_operational_mode",
    "get_user_role", "get_robot_model", "get_serial_number", "polyscope_version", "version", "generate_flight_report",
    "generate_support_file", "save_log"))}


def existing_tests():
    """Returns the names of all tests of the packages: Suite.Name of GoogleTest, and functions of pytest."""
    names = set()
    for package in ROOT.glob("*/test"):
        for file in package.rglob("*.cpp"):
            names |= {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", file.read_text(), re.M)}
        for file in package.rglob("test_*.py"):
            names |= set(re.findall(r"^def (test_\w+)", file.read_text(), re.M))
    return names


def rows(title):
    section = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    return [line.split("|")[1:-1] for line in section.splitlines() if line.startswith("| ")][1:]


def test_each_row_names_tests_that_exist():
    pattern = r"`((?:\w+Test\.\w+)|(?:test_\w+))`"
    assert set(re.findall(pattern, PAGE)) - existing_tests() == set()
    for title in ("What moves the arm", "What changes how it moves", "Starting and stopping the software"):
        assert rows(title) and [row for row in rows(title) if not re.search(pattern, row[-1])] == []


def test_each_action_that_does_not_only_read_is_listed():
    to_list = set()
    for group, heading, names in re.findall(r"^- \[(\w+)\]\(\w+\.md\)([^:]*):(.*(?:\n  .*)*)", ACTIONS, re.M):
        prefix = "dashboard/" if "dashboard/" in heading else ""
        to_list |= {prefix + name for name in re.findall(r"`(\w+)`", names) if group != "queries"}
    cells = [row[1] for row in rows("What moves the arm") if "topics" not in row[1]]
    cells += [row[0] for row in rows("What changes how it moves")]
    cells += re.findall(r"^(`stop`.*?) end motions\.", PAGE, re.M | re.S)
    assert set(re.findall(r"`([a-z_/]+)`", " ".join(cells))) == to_list - HARMLESS
