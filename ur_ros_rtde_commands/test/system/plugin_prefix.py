"""Ament prefixes with plugin packages."""

import contextlib
import os
import pathlib
import shutil

from programs import find_program, start_node

# Commands that are built with the tests (test/plugins), and their package.
TEST_COMMANDS = "test_commands"
_CLASSES = {"slow_to_look": "SlowToLook", "never_looks": "NeverLooks", "outlasts_the_link": "OutlastsTheLink",
            "calls_speed_j": "CallsSpeedJ",
            "calls_move_j_relative": "CallsMoveJRelative", "calls_itself": "CallsItself",
            "calls_without_the_arm": "CallsWithoutTheArm", "leaves_turning": "LeavesTurning", "moves_on": "MovesOn",
            "turns_as_mode": "TurnsAsMode", "turns_as_output": "TurnsAsOutput", "turns_and_hangs": "TurnsAndHangs",
            "starts_speed_l": "StartsSpeedL", "starts_force_mode": "StartsForceMode", "fails": "Fails",
            "slow_to_check": "SlowToCheck", "very_slow_to_check": "VerySlowToCheck", "blocks_callbacks": "BlocksCallbacks",
            "asks_during_a_motion": "AsksDuringAMotion", "checks_again": "ChecksAgain", "ends_its_scope": "EndsItsScope",
            "watches_a_door": "WatchesADoor", "tells_frame": "TellsFrame", "waits_for_output": "WaitsForOutput",
            "uses_another_tool": "UsesAnotherTool", "fails_to_set_the_tool": "FailsToSetTheTool", "dashboard/hangs": "Hangs",
            "dashboard/slow_to_check": "DashboardSlowToCheck"}
_SLOW_TO_START = {"calls_one_that_starts_late": "CallsOneThatStartsLate", "starts_late": "StartsLate"}  # only where a test names them


def create_plugin_prefix(prefix, package, description, libraries=()):
    """Creates an ament prefix with one plugin package: its plugin description and libraries. Returns the prefix."""
    index = prefix / "share" / "ament_index" / "resource_index"
    for kind, content in (("ur_ros_rtde__pluginlib__plugin", f"share/{package}/plugins.xml\n"), ("packages", "")):
        (index / kind).mkdir(parents=True, exist_ok=True)
        (index / kind / package).write_text(content)
    (prefix / "share" / package).mkdir(parents=True)
    (prefix / "share" / package / "plugins.xml").write_text(description)
    (prefix / "lib").mkdir(exist_ok=True)
    for library in libraries:
        shutil.copy(library, prefix / "lib")
    return prefix


def prepend_path(variable, folder):
    """Returns {variable: value} with the folder in front of the current value of a path variable."""
    return {variable: os.pathsep.join([str(folder), os.environ.get(variable, "")])}


def _base(name):
    return "DashboardPlugin" if name.startswith("dashboard/") else "CommandPlugin"


def environment_of_test_commands(prefix, classes=None):
    """Creates the prefix of the commands that are built with the tests. Returns the environment in which a driver finds them,
    which is empty if they have not been built."""
    install = pathlib.Path(find_program("ur_ros_rtde", "driver")).parents[2]
    build = install.with_name(install.name.replace("install", "build", 1))  # also those of a sanitizer: install-thread
    library = build / "ur_ros_rtde_commands" / "test" / "plugins" / f"lib{TEST_COMMANDS}.so"
    if not library.is_file():
        return {}
    plugins = "".join(f'<class name="{name}" type="ur_ros_rtde::{kind}" base_class_type="ur_ros_rtde::{_base(name)}"/>'
                      for name, kind in (classes or _CLASSES).items())
    description = f'<library path="{TEST_COMMANDS}">{plugins}</library>'
    return prepend_path("AMENT_PREFIX_PATH", create_plugin_prefix(prefix, TEST_COMMANDS, description, [library]))


@contextlib.contextmanager
def driver_of_test_commands(simulator, folder, *plugins):
    """Yields a driver with these plugins, which may be the commands of test/plugins. Prints its output at the end."""
    environment = environment_of_test_commands(folder / "prefix", {**_CLASSES, **_SLOW_TO_START})
    assert environment, "the test commands have not been built"
    driver = start_node("driver", simulator.address, "ur_type:=ur10e", f"plugins:=[{','.join(plugins)}]", env=environment)
    yield driver
    driver.stop()
    print(driver.output())
