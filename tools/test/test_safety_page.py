"""docs/safety.md names tests that exist, and every action of the documentation."""

import re

from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "safety.md").read_text()
ACTIONS = (ROOT / "docs" / "commands" / "README.md").read_text().split("\nThe name of an action")[0]
READING_GROUPS = ("queries",)


def existing_tests():
    """Returns the names of all tests of the packages: Suite.Name of GoogleTest, and functions of pytest."""
    names = set()
    for package in ROOT.glob("*/test"):
        for file in package.rglob("*.cpp"):
            names |= {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", file.read_text(), re.M)}
        for file in package.rglob("test_*.py"):
            names |= set(re.findall(r"^def (test_\w+)", file.read_text(), re.M))
    return names


def documented_actions():
    """Returns the actions by group, those of the dashboard with their prefix."""
    groups = {}
    for group, heading, cell in re.findall(r"^\| \[(\w+)\]\(\w+\.md\)([^|]*)\| (.*) \|$", ACTIONS, re.M):
        prefix = "dashboard/" if "dashboard/" in heading else ""
        groups[group] = [prefix + name for name in re.findall(r"`(\w+)`", cell)]
    return groups


def section(title):
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def test_each_named_test_exists():
    named = set(re.findall(r"`((?:\w+Test\.\w+)|(?:test_\w+))`", PAGE))
    assert len(named) > 50
    assert named - existing_tests() == set()


def test_each_row_names_a_test():
    for title, column in (("What moves the arm", -1), ("What changes how it moves", -1), ("Starting and stopping the software", -1)):
        rows = [line.strip("|").split("|") for line in section(title).splitlines() if line.startswith("| ")][1:]
        assert rows and all(re.search(r"`(\w+Test\.|test_)\w+`", row[column]) for row in rows), title


def test_each_action_that_affects_the_arm_is_listed():
    listed = re.findall(r"`((?:dashboard/)?[a-z_]+)`", section("What moves the arm") + section("What changes how it moves"))
    groups = documented_actions()
    assert len(groups) >= 11 and "dashboard/play" in groups["dashboard"]
    for group, actions in groups.items():
        if group in READING_GROUPS:
            assert not set(actions) & set(listed), group
        elif group != "dashboard":
            assert set(actions) - set(listed) - {"get_freedrive_status", "robotiq_get_status", "sg_get_width"} == set(), group
    # The actions of the dashboard that are not listed only read, or show something on the pendant.
    harmless = {f"dashboard/{name}" for name in (
        "power_on", "running", "program_state", "get_loaded_program", "is_program_saved", "close_safety_popup", "robot_mode",
        "safety_mode", "safety_status", "popup", "close_popup", "add_to_log", "is_in_remote_control", "get_operational_mode",
        "get_user_role", "get_robot_model", "get_serial_number", "polyscope_version", "version", "generate_flight_report",
        "generate_support_file", "save_log")}
    assert set(groups["dashboard"]) - set(listed) == harmless


def test_every_listed_action_exists():
    known = {action for actions in documented_actions().values() for action in actions}
    rows = [line.split("|") for line in section("What moves the arm").splitlines() if line.startswith("| ")][1:]
    actions = {name for row in rows if "topics" not in row[2] for name in re.findall(r"`([a-z_/]+)`", row[2])}
    assert len(actions) > 40 and actions <= known
