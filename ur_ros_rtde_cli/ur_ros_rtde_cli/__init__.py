"""The command line of ur_ros_rtde."""

import os

# Messages check the values of their fields only if this is set before they are imported.
os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
