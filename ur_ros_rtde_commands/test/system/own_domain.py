"""Reserves a ROS domain for this process and its children. `./ur test` has done so; `colcon test` and pytest have not."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "rcl_cxx/test/support"))
from ros_domain import Domain, reserve

__all__ = ["Domain"]

reserve()  # before rclpy is used for the first time
