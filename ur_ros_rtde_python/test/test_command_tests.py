"""MovingCommandTests in a pytest run of its own, as in the package of a user."""

import subprocess
import sys
import xml.etree.ElementTree as xml

import pytest

TESTS = '''
from ur_ros_rtde.command_tests import MovingCommandTests
from ur_ros_rtde.testing import HOME

pytest_plugins = ["ur_ros_rtde.testing"]


class TestMotion(MovingCommandTests):
    command = "move_j"
    goal = {"joint_positions": (1.0, *HOME[1:]), "speed": 0.5}


class TestNoMotion(MovingCommandTests):
    command = "move_j"
    goal = {"joint_positions": HOME}
'''
LIMIT = 300.0  # s; the run takes 15 s on an idle machine


@pytest.fixture(scope="module")
def failures(tmp_path_factory):
    """Returns the messages of the failures by class and test; None of tests that have passed."""
    folder = tmp_path_factory.mktemp("package")
    (folder / "test_move_j.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={folder / 'report.xml'}", str(folder)]
    run = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT)
    print(run.stdout)
    found = {"TestMotion": {}, "TestNoMotion": {}}
    for case in xml.parse(folder / "report.xml").iter("testcase"):
        failure = case.find("failure") if case.find("error") is None else case.find("error")
        found[case.get("classname").rpartition(".")[2]][case.get("name")] = None if failure is None else failure.get("message")
    return found


def test_a_command_of_the_driver_passes(failures):
    assert len(failures["TestMotion"]) == 8 and not any(failures["TestMotion"].values()), failures["TestMotion"]


def test_a_goal_that_does_not_move_the_arm_is_no_test(failures):
    found = dict(failures["TestNoMotion"])
    assert found.pop("test_numbers_that_are_not_finite_are_rejected") is None
    assert len(found) == 7 and all(message and "has ended without a motion" in message for message in found.values()), found
