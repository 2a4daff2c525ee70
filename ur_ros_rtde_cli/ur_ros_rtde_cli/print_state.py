"""Prints the state of the robot."""

import argparse
import math
import sys
from typing import Any, Dict, Iterator

from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from ur_ros_rtde_msgs.msg import DriverState, RobotMode, SafetyMode

from .interruptions import Interrupted
from .problem import Problem
from .session import Session


def _subscribe(session: Session) -> Dict[str, Any]:
    """The newest message of each topic, by topic."""
    latest: Dict[str, Any] = {}
    stream = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    for topic, kind, qos in (("joint_states", JointState, stream), ("tcp_pose", PoseStamped, stream),
                             ("wrench", WrenchStamped, stream), ("robot_mode", RobotMode, latched),
                             ("safety_mode", SafetyMode, latched), ("speed_scaling", Float64, latched),
                             ("driver_state", DriverState, latched)):
        session.node.create_subscription(kind, topic, lambda message, topic=topic: latest.__setitem__(topic, message), qos)
    return latest


def _lines(latest: Dict[str, Any]) -> Iterator[str]:
    for topic in ("robot_mode", "safety_mode", "driver_state"):
        if topic in latest:
            message = latest[topic]
            yield f"{topic:14} {message.name}" + (f"  {message.message}" if getattr(message, "message", "") else "")
    if "speed_scaling" in latest:
        yield f"{'speed_scaling':14} {100 * latest['speed_scaling'].data:.0f} %"
    joints = latest["joint_states"]
    for name, position, velocity in zip(joints.name, joints.position, joints.velocity):
        yield f"{name:22} {position:9.4f} rad  {math.degrees(position):8.2f} deg  {velocity:8.4f} rad/s"
    if "tcp_pose" in latest:
        pose = latest["tcp_pose"].pose
        yield f"{'tcp position':22} {pose.position.x:9.4f} {pose.position.y:9.4f} {pose.position.z:9.4f} m"
        turn = pose.orientation
        yield f"{'tcp orientation':22} {turn.x:9.4f} {turn.y:9.4f} {turn.z:9.4f} {turn.w:9.4f}"
    if "wrench" in latest:
        force, torque = latest["wrench"].wrench.force, latest["wrench"].wrench.torque
        yield f"{'force':22} {force.x:9.2f} {force.y:9.2f} {force.z:9.2f} N"
        yield f"{'torque':22} {torque.x:9.3f} {torque.y:9.3f} {torque.z:9.3f} Nm"


def print_state(session: Session, options: argparse.Namespace) -> int:
    latest = _subscribe(session)
    everything = 7
    if not session.wait(lambda: "joint_states" in latest, options.wait):
        raise Problem(f"no joint_states within {options.wait:g} s. Does robot_state_receiver run, in this ROS_DOMAIN_ID, and "
                      "is the robot on?")
    session.wait(lambda: len(latest) == everything, 0.5)
    shown = list(_lines(latest))
    print("\n".join(shown))
    try:
        while options.watch:
            session.wait(lambda: None, 0.2)
            sys.stdout.write(f"\x1b[{len(shown)}A\x1b[J" if sys.stdout.isatty() else "\n")
            shown = list(_lines(latest))
            print("\n".join(shown), flush=True)
    except Interrupted:
        pass
    return 0
