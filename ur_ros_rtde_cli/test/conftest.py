import pathlib
import sys

# These tests use the helpers of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from ur_program import at_home, running

__all__ = ["at_home", "running"]
