import pathlib
import sys

# The helpers of the driver's node tests are used here, too.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
