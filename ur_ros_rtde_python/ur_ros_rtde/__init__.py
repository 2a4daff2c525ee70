"""Python interface of ur_ros_rtde.

    from ur_ros_rtde import Robot

    with Robot() as arm:
        arm.move_j([0.0, -1.57, 1.57, -1.57, -1.57, 0.0], speed=0.5)

Units are SI units: rad, m, s, N, Nm. rclpy is imported when a Robot is created.
"""

from .conversions import pose, trajectory
from .errors import CommandFailed, NoDriver, Rejected, RobotError, StreamEnded, Timeout, UnknownCommand
from .goal import Goal, wait_for_all
from .recording import Recording, read_recording
from .robot import Robot

__all__ = ["CommandFailed", "Goal", "NoDriver", "Recording", "Rejected", "Robot", "RobotError", "StreamEnded", "Timeout", "UnknownCommand",
           "pose", "read_recording", "trajectory", "wait_for_all"]
