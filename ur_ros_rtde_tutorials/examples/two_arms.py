#!/usr/bin/env python3
"""Moves two arms that start at the same time. If one of them stops, the other one stops too.

The drivers are in the namespaces left and right:
ros2 run ur_ros_rtde_tutorials two_arms.py
"""

import time

import numpy as np
from ur_ros_rtde import CommandFailed, Robot, trajectory, wait_for_all

times = np.linspace(0.0, 4.0, 41)
swing = 0.15 * (1.0 - np.cos(np.pi * times / 2.0))  # rad, there and back


def path(arm, direction):
    return {"positions": arm.state.joint_positions + np.outer(swing, direction), "joint_names": arm.state.joint_names}


with Robot("left") as left, Robot("right") as right:
    paths = path(left, [1, 0, 0, 0, 0, 0]), path(right, [-1, 0, 0, 0, 0, 0])
    start_at = time.time() + 1.0  # both goals have to arrive before
    plans = [trajectory(times, **path, start_at=start_at) for path in paths]
    try:
        with left.start.follow_joint_trajectory(plans[0]) as one, right.start.follow_joint_trajectory(plans[1]) as other:
            wait_for_all(one, other)
        print("both arms have arrived")
    except CommandFailed as failed:
        print(f"both arms are at rest: {failed}")
        raise SystemExit(1) from None
