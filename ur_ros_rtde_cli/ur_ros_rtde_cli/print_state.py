"""Prints the state of the robot to stdout."""

import argparse
import itertools
import math
import shutil
import sys
import time
from typing import Any, Dict, Iterator

from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64

from ur_ros_rtde_msgs.msg import ActiveModes, DriverState, RobotMode, SafetyMode

from . import fields
from .errors import OperationFailed
from .interruptions import Interrupted
from .namespaces import other_drivers
from .session import Session

LINE_PERIOD = 1.0  # s, without a terminal
SCREEN_PERIOD = 0.1  # s, on a terminal
# Control sequences of ECMA-48 and xterm: the alternate screen without a cursor leaves what is above it on the terminal as it was.
ENTER_SCREEN, LEAVE_SCREEN = "\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l"
HOME, REST_OF_LINE, REST_OF_SCREEN = "\x1b[H", "\x1b[K", "\x1b[J"

TOPIC_COUNT = 9  # of subscribe()
SILENT = 1.0  # s without joint states


class Latest(Dict[str, Any]):
    """The latest message of each topic."""

    heard = math.inf  # s, of the monotonic clock, when joint_states came last

    def take(self, topic: str, message: Any) -> None:
        self[topic] = message
        if topic == "joint_states":
            self.heard = time.monotonic()


def subscribe(session: Session) -> Latest:
    """Subscribes to all topics."""
    latest = Latest()
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    transient_local = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    for topic, kind, qos in (("joint_states", JointState, best_effort), ("tcp_pose", PoseStamped, best_effort),
                             ("wrench", WrenchStamped, best_effort), ("robot_mode", RobotMode, transient_local),
                             ("safety_mode", SafetyMode, transient_local), ("speed_scaling", Float64, transient_local),
                             ("driver_state", DriverState, transient_local), ("joint_states_are_fake", Bool, transient_local),
                             ("active_modes", ActiveModes, transient_local)):
        session.node.create_subscription(kind, topic, lambda message, topic=topic: latest.take(topic, message), qos)
    return latest


def state_lines(latest: Latest) -> Iterator[str]:
    silence = time.monotonic() - latest.heard
    if silence > SILENT:
        yield f"no joint_states for {silence:.0f} s: the driver has ended or has lost the robot. What follows is old."
    for topic in ("robot_mode", "safety_mode", "driver_state"):
        if topic in latest:
            message = latest[topic]
            yield f"{topic:14} {message.name}" + (f"  {message.message}" if getattr(message, "message", "") else "")
    if "speed_scaling" in latest:
        yield f"{'speed_scaling':14} {100 * latest['speed_scaling'].data:.0f} %"
    if "active_modes" in latest and latest["active_modes"].names:
        yield f"{'active_modes':14} {', '.join(latest['active_modes'].names)}"
    if "joint_states_are_fake" in latest and latest["joint_states_are_fake"].data:
        yield "joint_states has fake positions (digital twin); the robot's are on actual_joint_states:"
    joints = latest.get("joint_states", JointState())
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


def _text(latest: Latest, as_json: bool) -> str:
    return fields.to_json(dict(latest)) if as_json else "\n".join(state_lines(latest))


def _has_no_robot(latest: Latest) -> bool:
    return "driver_state" in latest and latest["driver_state"].name == "DISCONNECTED"


def print_state(session: Session, options: argparse.Namespace) -> int:
    latest = subscribe(session)
    if not session.wait(lambda: "joint_states" in latest or _has_no_robot(latest), options.wait) and "driver_state" not in latest:
        reason = other_drivers(session.node) or ". Does robot_state_receiver run with this ROS_DOMAIN_ID? Is the robot on?"
        raise OperationFailed(f"no joint_states within {options.wait:g} s{reason}")
    session.wait(lambda: len(latest) == TOPIC_COUNT, 0.5)
    if options.watch and sys.stdout.isatty() and not options.json:
        _watch_on_screen(session, latest)
        return 0
    print(_text(latest, options.json))
    if not options.watch:
        return 0 if "joint_states" in latest else 1
    try:
        while True:
            session.wait(lambda: None, LINE_PERIOD)
            print(("" if options.json else "\n") + _text(latest, options.json), flush=True)
    except Interrupted:
        return 0


def _watch_on_screen(session: Session, latest: Latest) -> None:
    sys.stdout.write(ENTER_SCREEN)
    try:
        while True:
            size = shutil.get_terminal_size()
            lines = [*itertools.islice(state_lines(latest), max(size.lines - 3, 1)), "", f"{time.strftime('%H:%M:%S')}  Ctrl-C ends"]
            sys.stdout.write(HOME + "\n".join(line[:size.columns - 1] + REST_OF_LINE for line in lines) + REST_OF_SCREEN)
            sys.stdout.flush()
            session.wait(lambda: None, SCREEN_PERIOD)
    except Interrupted:
        pass
    finally:
        sys.stdout.write(LEAVE_SCREEN)
        sys.stdout.flush()
