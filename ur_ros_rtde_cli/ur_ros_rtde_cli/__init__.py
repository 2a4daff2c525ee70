"""The command line of ur_ros_rtde."""

import os

# Messages look at what is put into them only if they are asked to before they are imported.
os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
