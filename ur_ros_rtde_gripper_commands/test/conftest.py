import pathlib
import sys

# The helpers and fixtures of the driver's node tests are used here, too.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from robot_fixtures import addresses, client, driver, listening_ends_with_the_test, robot, simulator  # noqa: E402

__all__ = ["addresses", "client", "driver", "listening_ends_with_the_test", "robot", "simulator"]
