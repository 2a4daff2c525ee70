#!/usr/bin/env python3
"""Follows waypoints, cancels the motion, follows them to the end, and recovers from a stop of the robot.

ros2 run ur_ros_rtde_tutorials arm_in_ten_lines.py
"""

import numpy as np
from ur_ros_rtde import CommandFailed, Robot

with Robot() as arm:
    waypoints = arm.state.joint_positions + np.linspace(0.0, -0.3, 5)[:, None] * [1, 0, 0, 0, 0, 2]
    goal = arm.start.execute_trajectory(waypoints, blend_tolerance=0.05)
    goal.wait(0.5)
    print("canceled at", goal.cancel().final_state.joint_positions)
    try:
        arm.execute_trajectory(waypoints, approach=True, on_progress=lambda progress: print(f"{progress.time_left:.1f} s left"))
    except CommandFailed as failed:  # a protective stop, for example
        input(f"{failed} {failed.remedy} Remove the cause, then press Enter: ")
        arm.make_ready()
