import pathlib
import sys

# These tests use the helpers and fixtures of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from robot_fixtures import addresses, client, destroy_subscriptions_after_test, driver, processes, robot, simulator

__all__ = ["addresses", "client", "driver", "destroy_subscriptions_after_test", "processes", "robot", "simulator"]
