#!/usr/bin/env python3
"""Moves down until a force of 20 N, without a plugin: the way with a driver that only passes URScript on. Two programs are sent to the
robot, one that moves and one that stops, and this program watches the force and the standstill.

ros2 run ur_ros_rtde_tutorials two_snippets.py 192.168.56.101
"""

import socket
import sys
import time

from ur_ros_rtde import Rejected, Robot

MOVE = """def move_down():
  pose = get_actual_tcp_pose()
  pose[2] = pose[2] - 0.3
  movel(pose, a=0.1, v=0.1)
end
"""
STOP = """def stop_now():
  stopj(5.0)
end
"""
SECONDARY_PORT = 30002
CYCLE = 0.002  # s


def wait_for(condition, limit, what):
    end = time.monotonic() + limit
    while not condition():
        if time.monotonic() > end:
            raise SystemExit(f"{what} within {limit} s")
        time.sleep(CYCLE)


def has_driver_back(arm):
    """Each program has replaced that of the driver."""
    try:
        arm.reupload_script()
    except Rejected as rejected:
        if rejected.name not in ("PROGRAM_STOPPED", "NOT_READY"):  # a protective stop, because the second program came too late
            raise
        return False  # the second program has not ended, or the driver is starting its own
    return True


def main():
    with Robot() as arm, socket.create_connection((sys.argv[1], SECONDARY_PORT), 5.0) as port:
        arm.zero_ft_sensor()
        port.sendall(MOVE.encode())
        try:
            wait_for(lambda: abs(arm.state.wrench[2]) > 20.0, 30.0, "there was no force")
        finally:
            port.sendall(STOP.encode())
        force = arm.state.wrench[2]
        # No answer tells when a program has ended, or that it has failed.
        wait_for(lambda: max(abs(arm.state.joint_velocities)) < 0.005, 30.0, "there was no standstill")
        wait_for(lambda: has_driver_back(arm), 30.0, "the driver did not get the robot back")
        print(f"stopped at {force:.1f} N")


if __name__ == "__main__":
    main()
