"""The names in docs/migration.md exist, and every interface of the published ur_ros_rtde is listed."""

import re

import pytest
from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "migration.md").read_text()
COMMANDS = (ROOT / "docs" / "commands" / "README.md").read_text().split("\nThe name of an action")[0]
INTERFACES = (ROOT / "docs" / "interfaces.md").read_text()
LAUNCH = "".join(file.read_text() for file in (*(ROOT / "ur_ros_rtde" / "launch").glob("*.py"),
                                               *(ROOT / "ur_ros_rtde_description" / "launch").glob("*.py"),
                                               *(ROOT / "ur_ros_rtde" / "ur_ros_rtde").glob("*.py"),
                                               *(ROOT / "ur_ros_rtde_description" / "ur_ros_rtde_description").glob("*.py")))
# The plugins of the published package, of its gripper and of its tutorial.
PUBLISHED = """MoveJ MoveJRelative MoveL MoveLRelative MoveUntilContact MoveUntilForce MoveUntilTorque ExecuteTrajectory
ExecuteParametrizedTrajectory ExecutePath ServoJ ServoStop SetDigitalPin SetFreedrive SetPayload SetSpeedSlider SendCustomScript
ResetForceTorqueSensor AddToLog LoadUrp Popup GetLoadedProgram GetRobotModel GetSerialNumber PolyscopeVersion ProgramState RobotMode
SafetyMode SafetyStatus IsInRemoteControl IsProgramSaved Running BrakeRelease ClosePopup CloseSafetyPopup Pause Play PowerOff PowerOn
RestartSafety Shutdown Stop UnlockProtectiveStop SgGrip SgRelease SgGetWidth MoveDownUntilForce""".split()


def rows():
    """Yields the names on both sides of each row of the tables with three columns."""
    for line in PAGE.splitlines():
        cells = line.strip("|").split(" | ")
        if line.startswith("| ") and len(cells) >= 3 and "---" not in line:
            yield tuple(re.findall(r"`([^`]+)`", cell) for cell in cells[:2])


def existing_names():
    actions = set()
    for heading, cell in re.findall(r"^\| \[\w+\]\(\w+\.md\)([^|]*)\| (.*) \|$", COMMANDS, re.M):
        prefix = "dashboard/" if "dashboard/" in heading else ""
        actions |= {prefix + name for name in re.findall(r"`(\w+)`", cell)}
    return actions | set(re.findall(r"`([a-z_]+)`", INTERFACES)) | set(re.findall(r"\"([a-z_]+)\"", LAUNCH))


def test_every_new_name_exists():
    known = existing_names() | {file.name for file in (ROOT / "ur_ros_rtde" / "launch").glob("*.py")}
    new = {name.split(":=")[0] for _, names in rows() for name in names}
    assert len(new) > 90
    assert new - known - {"gain", "lookahead_time"} == set()


@pytest.mark.parametrize("name", PUBLISHED)
def test_every_published_action_is_listed_once(name):
    section = PAGE.split("### Actions")[1].split("###")[0]
    assert section.count(f"| `{name}` |") == 1


def test_a_row_without_a_counterpart_says_so():
    for line in PAGE.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if line.startswith("| `") and len(cells) == 3:
            assert "`" in cells[1] or (cells[1] == "none" and cells[2]), line
