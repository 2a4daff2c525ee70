#!/usr/bin/env python3
"""t02: reads the state of the robot from its topics. Prints the height of the tool and the force along its axis ten times.

ros2 run ur_ros_rtde_tutorials t02_read_the_state.py
"""

import sys
import time

import rclpy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data


class StateListener(Node):
    def __init__(self):
        super().__init__("t02_read_the_state")
        self.height = self.force = None
        self.samples = 0
        self.create_subscription(PoseStamped, "tcp_pose", self.on_pose, qos_profile_sensor_data)
        self.create_subscription(WrenchStamped, "wrench", self.on_wrench, qos_profile_sensor_data)

    def on_pose(self, message):
        self.height = message.pose.position.z
        self.samples += 1

    def on_wrench(self, message):
        self.force = message.wrench.force.z


def main():
    rclpy.init()
    node = StateListener()
    lines = 0
    next_line, deadline = time.monotonic() + 1.0, time.monotonic() + 20.0
    while lines < 10 and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=0.1)
        if time.monotonic() >= next_line and None not in (node.height, node.force):
            next_line += 1.0
            lines += 1
            print(f"{node.samples:4d} samples   height {node.height:7.3f} m   force along the tool {node.force:7.2f} N")
            node.height = node.force = None  # the next line needs new messages
            node.samples = 0
    node.destroy_node()
    rclpy.try_shutdown()
    if lines < 10:
        print("no more messages are received: check that robot_state_receiver is running and connected to a robot")
    return 0 if lines == 10 else 1


if __name__ == "__main__":
    sys.exit(main())
