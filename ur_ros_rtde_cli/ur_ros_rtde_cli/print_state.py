"""Prints the state of the robot to stdout."""

import argparse
import math
import sys
from typing import Any, Dict, Iterator

from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64

from ur_ros_rtde_msgs.msg import DriverState, RobotMode, SafetyMode

from .errors import CliError
from .interruptions import Interrupted
from .session import Session

TOPIC_COUNT = 8  # of _subscribe()


def _subscribe(session: Session) -> Dict[str, Any]:
    """Subscribes to all topics. Returns a dictionary that holds the latest message of each topic."""
    latest: Dict[str, Any] = {}
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    transient_local = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    for topic, kind, qos in (("joint_states", JointState, best_effort), ("tcp_pose", PoseStamped, best_effort),
                             ("wrench", WrenchStamped, best_effort), ("robot_mode", RobotMode, transient_local),
                             ("safety_mode", SafetyMode, transient_local), ("speed_scaling", Float64, transient_local),
                             ("driver_state", DriverState, transient_local), ("joint_states_are_fake", Bool, transient_local)):
        session.node.create_subscription(kind, topic, lambda message, topic=topic: latest.__setitem__(topic, message), qos)
    return latest


def _lines(latest: Dict[str, Any]) -> Iterator[str]:
    for topic in ("robot_mode", "safety_mode", "driver_state"):
        if topic in latest:
            message = latest[topic]
            yield f"{topic:14} {message.name}" + (f"  {message.message}" if getattr(message, "message", "") else "")
    if "speed_scaling" in latest:
        yield f"{'speed_scaling':14} {100 * latest['speed_scaling'].data:.0f} %"
    if "joint_states_are_fake" in latest and latest["joint_states_are_fake"].data:
        yield "joint_states has fake positions (digital twin); the robot's are on actual_joint_states:"
    joints = latest["joint_states"]
    width = max(map(len, ("tcp orientation", *joints.name)))
    for name, position, velocity in zip(joints.name, joints.position, joints.velocity):
        yield f"{name:{width}} {position:9.4f} rad  {math.degrees(position):8.2f} deg  {velocity:8.4f} rad/s"
    if "tcp_pose" in latest:
        pose = latest["tcp_pose"].pose
        yield f"{'tcp position':{width}} {pose.position.x:9.4f} {pose.position.y:9.4f} {pose.position.z:9.4f} m"
        q = pose.orientation
        yield f"{'tcp orientation':{width}} {q.x:9.4f} {q.y:9.4f} {q.z:9.4f} {q.w:9.4f}"
    if "wrench" in latest:
        force, torque = latest["wrench"].wrench.force, latest["wrench"].wrench.torque
        yield f"{'force':{width}} {force.x:9.2f} {force.y:9.2f} {force.z:9.2f} N"
        yield f"{'torque':{width}} {torque.x:9.3f} {torque.y:9.3f} {torque.z:9.3f} Nm"


def print_state(session: Session, options: argparse.Namespace) -> int:
    latest = _subscribe(session)
    if not session.wait(lambda: "joint_states" in latest, options.wait):
        raise CliError(f"no joint_states within {options.wait:g} s. Does robot_state_receiver run with this ROS_DOMAIN_ID? Is "
                       "the robot on?")
    session.wait(lambda: len(latest) == TOPIC_COUNT, 0.5)
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
