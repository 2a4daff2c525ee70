"""What moves the arm: a goal of each motion command, stream, extension, script, mode, teleoperation topic and test command.

The fields of a goal are mappings for `messages.fill`, so that they can be sent to a client in another process.
"""

import math
from dataclasses import dataclass
from random import Random
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple

from plugin_prefix import TEST_COMMANDS
from support import HOME, JOINTS

Fields = Dict[str, Any]
JOINT, LINEAR, PATH, MODE = "joint", "linear", "path", "mode"
HAND_GUIDED = ("freedrive", "teach_mode")  # no goal preempts them
DEFAULT_DECELERATION = 2.0  # rad/s^2, m/s^2
OF_UNTIL_FORCE = 5.0  # m/s^2, of move_until_force, which vacuum_pick calls
FAR = 2.2  # rad, of the base joint
SPEED = "speed of the source"  # m/s or rad/s: no field of the goal


class Scene:
    """The pose of the TCP at home, to which the poses of goals are relative."""

    def __init__(self, tcp_pose: Sequence[float]):
        self._position, rotation = tcp_pose[:3], tcp_pose[3:]
        angle = math.hypot(*rotation)
        factor = math.sin(0.5 * angle) / angle if angle > 0.0 else 0.0
        self._orientation = {**dict(zip("xyz", (factor * value for value in rotation))), "w": math.cos(0.5 * angle)}

    @property
    def height(self) -> float:
        return self._position[2]

    def pose(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Fields:
        position = [value + offset for value, offset in zip(self._position, (x, y, z))]
        return {"position": dict(zip("xyz", position)), "orientation": dict(self._orientation)}


@dataclass(frozen=True)
class GoalKind:
    name: str
    action: str  # name of the action, or of the topic
    type: str
    fields: Callable[[Random, Scene], Fields]
    space: str = LINEAR  # in which the driver's stop decelerates
    # Of a cancel. None: that of the controller, because the driver ends a program.
    deceleration: Callable[[Fields], Optional[float]] = lambda _fields: DEFAULT_DECELERATION
    weight: float = 1.0
    before: Sequence[Tuple[str, str, Fields]] = ()  # goals that have to succeed first
    around: Callable[[Scene], Sequence[Mapping[str, Any]]] = lambda _scene: ()  # commands for the simulator, once the goal is accepted
    is_topic: bool = False
    source: str = ""  # topic of the poses that the goal follows
    runs_script: bool = False  # in place of the control program: not with the URCap; in local control, only the watchdog ends it
    turns: bool = False  # the base joint leads: a stop of the TCP decelerates its rotation, in rad/s^2
    has_corner: bool = False  # in which the arm slows down and accelerates again
    succeeds_if_ended: bool = False  # a cancel is its regular end
    package: str = "ur_ros_rtde_commands"
    limits: Callable[[Fields], Tuple[float, float]] = lambda _fields: (1.4, 100.0)  # of PATH: acceleration, jerk

    @property
    def has_pauses(self) -> bool:
        """In which the arm rests."""
        return self.space == MODE

    @property
    def keeps_program(self) -> bool:
        """A stop leaves the control program running."""
        return not self.runs_script and self.space != MODE

    @property
    def is_streamed(self) -> bool:
        """The host sends setpoints. The arm slows down, as its servo loop does, when they are late."""
        return self.space == PATH or self.is_topic or bool(self.source) or self.action.startswith("servo_")


def home_plus(*angles: float) -> List[float]:
    return [home + angle for home, angle in zip(HOME, [*angles, *[0.0] * (6 - len(angles))])]


def _sign(random: Random) -> float:
    return random.choice((-1.0, 1.0))


def _own(fields: Fields) -> Optional[float]:
    return fields["deceleration"]


def _unspecified(_fields: Fields) -> Optional[float]:
    return None


def _joints(random: Random) -> List[float]:
    turn = _sign(random) * FAR
    return home_plus(turn, 0.0, 0.0, *(random.uniform(-0.1, 0.1) * FAR for _ in range(3)))


def _move_j(random: Random, _scene: Scene) -> Fields:
    return {"joint_positions": _joints(random), "speed": random.uniform(0.3, 1.2), "acceleration": random.uniform(1.0, 6.0)}


def _move_j_relative(random: Random, _scene: Scene) -> Fields:
    return {"joint_offsets": [_sign(random) * FAR, 0.0, 0.0, 0.0, 0.1, 0.2], "speed": random.uniform(0.3, 1.2),
            "acceleration": random.uniform(1.0, 6.0)}


def _far_pose(random: Random, scene: Scene) -> Fields:
    return scene.pose(y=_sign(random) * 0.35, z=random.uniform(-0.1, 0.1))


def _line(random: Random) -> Fields:
    return {"speed": random.uniform(0.1, 0.3), "acceleration": random.uniform(0.5, 3.0)}


def _move_j_ik(random: Random, scene: Scene) -> Fields:
    return {"pose": _far_pose(random, scene), "speed": 0.3, "acceleration": random.uniform(1.0, 4.0)}


def _move_l(random: Random, scene: Scene) -> Fields:
    return {"pose": _far_pose(random, scene), **_line(random)}


def _move_l_fk(random: Random, _scene: Scene) -> Fields:
    return {"joint_positions": home_plus(_sign(random) * 0.5), **_line(random)}


def _move_l_relative(random: Random, _scene: Scene) -> Fields:
    return {"translation": {"y": _sign(random) * 0.35}, **_line(random)}


def _move_p(random: Random, scene: Scene) -> Fields:
    side = _sign(random)
    return {"poses": [scene.pose(y=side * 0.15), scene.pose(y=side * 0.3, z=-0.1)], "blend_radius": 0.02, **_line(random)}


def _move_c(random: Random, scene: Scene) -> Fields:
    side = _sign(random)
    return {"via": scene.pose(y=side * 0.15, z=0.08), "pose": scene.pose(y=side * 0.3), **_line(random)}


def _move_path(random: Random, scene: Scene) -> Fields:
    side = _sign(random)
    return {"waypoints": [{"type": 0, "joint_positions": home_plus(side * 0.15), "speed": 0.6, "acceleration": 2.0, "blend_radius": 0.02},
                          {"type": 1, "pose": scene.pose(y=side * 0.3), **_line(random)}]}


def _speed_j(random: Random, _scene: Scene) -> Fields:
    return {"joint_velocities": [_sign(random) * random.uniform(0.2, 0.6), 0.0, 0.0, 0.05, 0.0, 0.1],
            "acceleration": random.uniform(1.0, 5.0), "time": 3.0, "deceleration": random.uniform(1.0, 8.0)}


def _never_looks(random: Random, scene: Scene) -> Fields:
    return {**_speed_j(random, scene), "time": 2.5}


def _twist(random: Random) -> Fields:
    return {"linear": {"y": _sign(random) * random.uniform(0.08, 0.15)}}


def _speed_l(random: Random, _scene: Scene) -> Fields:
    return {"twist": _twist(random), "acceleration": random.uniform(0.5, 3.0), "time": 2.5, "deceleration": random.uniform(1.0, 6.0)}


def _jog(random: Random, _scene: Scene) -> Fields:
    return {"twist": _twist(random), "acceleration": random.uniform(0.5, 3.0), "time": 2.5}


def _servo_j(random: Random, _scene: Scene) -> Fields:
    return {"joint_positions": home_plus(_sign(random) * 1.2), "time": random.uniform(2.5, 4.0), "deceleration": random.uniform(2.0, 8.0)}


def _servo_l(random: Random, scene: Scene) -> Fields:
    return {"pose": scene.pose(y=_sign(random) * 0.3), "time": random.uniform(2.5, 4.0), "deceleration": random.uniform(2.0, 8.0)}


def _servo_c(random: Random, scene: Scene) -> Fields:
    return {"pose": scene.pose(y=_sign(random) * 0.3), **_line(random), "deceleration": random.uniform(2.0, 8.0)}


def _execute_trajectory(random: Random, _scene: Scene) -> Fields:
    side = _sign(random)
    positions = (HOME, home_plus(side * 1.0, 0.1), home_plus(side * FAR))
    return {"waypoints": [{"positions": values} for values in positions], "start_tolerance": 0.05}


def _gently(random: Random, _scene: Scene) -> Fields:
    """From 0.5 rad/s with these limits, the arm needs up to 6 s to stop."""
    velocity, acceleration, jerk = random.choice(((0.5, 0.2, 0.05), (0.5, 0.2, 0.2), (0.3, 0.5, 0.5), (0.5, 1.0, 2.0)))
    return {"waypoints": [{"positions": HOME}, {"positions": home_plus(_sign(random) * FAR)}], "start_tolerance": 0.05,
            "max_velocity": [velocity] * 6, "max_acceleration": [acceleration] * 6, "max_jerk": [jerk] * 6}


def _cartesian_path(random: Random, scene: Scene) -> Fields:
    side = _sign(random)
    return {"poses": [scene.pose(), scene.pose(y=side * 0.15), scene.pose(y=side * 0.3, z=-0.05)], "blend_radius": 0.03, "speed": 0.15}


def _trajectory(random: Random) -> Fields:
    end = home_plus(_sign(random) * 1.0, 0.0, 0.0, 0.1)
    seconds = random.randrange(3, 5)
    rest = [0.0] * 6
    return {"joint_names": JOINTS,
            "points": [{"positions": HOME, "velocities": rest}, {"positions": end, "velocities": rest,
                                                                 "time_from_start": {"sec": seconds}}]}


def _parametrized(random: Random, _scene: Scene) -> Fields:
    return {"trajectory": _trajectory(random), "start_tolerance": 0.05}


def _follow(random: Random, _scene: Scene) -> Fields:
    return {"trajectory": _trajectory(random)}


def _until_force(random: Random, _scene: Scene) -> Fields:
    return {"twist": _twist(random), "acceleration": random.uniform(0.5, 3.0), "deceleration": random.uniform(1.0, 6.0),
            "distance": 0.35, "threshold": 80.0}


def _until_contact(random: Random, _scene: Scene) -> Fields:
    return {"twist": _twist(random), "acceleration": random.uniform(0.5, 3.0), "distance": 0.35}


def _force_mode(random: Random, _scene: Scene) -> Fields:
    return {"compliant": [False, False, True, False, False, False], "wrench": {"force": {"z": random.uniform(-15.0, -5.0)}},
            "limits": [0.1, 0.1, 0.08, 0.5, 0.5, 0.5]}


def _no_fields(_random: Random, _scene: Scene) -> Fields:
    return {}


def _torque(random: Random, _scene: Scene) -> Fields:
    return {"joint_torques": [_sign(random) * 8.0, 0.0, 0.0, 0.0, 0.0, 0.0], "duration": 2.0, "max_joint_speed": 2.5}


def _script(random: Random, _scene: Scene) -> Fields:
    target = home_plus(_sign(random) * FAR)
    body = random.choice((f"movej({target}, a=2, v=0.6)", "while True:\n  speedj([0.4, 0, 0, 0, 0, 0], 2, 0.1)\nend"))
    return {"script": body, "timeout": 20.0}


def _down(random: Random, _scene: Scene) -> Fields:
    return {"force": 50.0, "distance": 0.25, "speed": 0.1, "acceleration": random.uniform(0.2, 1.0)}


def _spiral(_random: Random, _scene: Scene) -> Fields:
    return {"radius": 0.06, "pitch": 0.02, "speed": 0.05, "force": 80.0}


def _insert(random: Random, _scene: Scene) -> Fields:
    return {"force": random.uniform(5.0, 20.0), "radius": 0.03, "speed": random.uniform(0.02, 0.05)}


def _plate(scene: Scene) -> Sequence[Mapping[str, Any]]:
    return [{"command": "place_surface", "z": scene.height - 0.01, "stiffness": 5000.0}]


def _pick(random: Random, _scene: Scene) -> Fields:
    return {"force": 50.0, "distance": 0.2, "speed": random.uniform(0.03, 0.05)}


def _watch(random: Random, _scene: Scene) -> Fields:
    return {"tolerance": 0.0005, "settling_time": 10.0, SPEED: _sign(random) * random.uniform(0.1, 0.3)}


def _speed_of_topic(random: Random, _scene: Scene) -> Fields:
    return {SPEED: _sign(random) * random.uniform(0.1, 0.3)}


PACKAGE = "ur_ros_rtde_msgs/action/"
FORCE_MODE = {"compliant": [False, False, True, False, False, False], "limits": [0.1, 0.1, 0.02, 0.5, 0.5, 0.5]}
PUSH: Sequence[Mapping[str, Any]] = [{"command": "push", "force": [40.0, 60.0, 0.0], "duration": 4.0}]
TUTORIALS = "ur_ros_rtde_tutorials"

KINDS: Sequence[GoalKind] = (
    GoalKind("move_j", "move_j", PACKAGE + "MoveJ", _move_j, JOINT, weight=2.0),
    GoalKind("move_j_ik", "move_j_ik", PACKAGE + "MoveJIK", _move_j_ik, JOINT),
    GoalKind("move_j_relative", "move_j_relative", PACKAGE + "MoveJRelative", _move_j_relative, JOINT),
    GoalKind("move_l", "move_l", PACKAGE + "MoveL", _move_l, weight=1.5),
    GoalKind("move_l_fk", "move_l_fk", PACKAGE + "MoveLFK", _move_l_fk, turns=True),
    GoalKind("move_l_relative", "move_l_relative", PACKAGE + "MoveLRelative", _move_l_relative),
    GoalKind("move_p", "move_p", PACKAGE + "MoveP", _move_p, deceleration=_unspecified, runs_script=True),
    GoalKind("move_c", "move_c", PACKAGE + "MoveC", _move_c, deceleration=_unspecified, runs_script=True),
    GoalKind("move_path", "move_path", PACKAGE + "MovePath", _move_path, deceleration=_unspecified, runs_script=True, has_corner=True),
    GoalKind("speed_j", "speed_j", PACKAGE + "SpeedJ", _speed_j, JOINT, _own),
    GoalKind("speed_l", "speed_l", PACKAGE + "SpeedL", _speed_l, LINEAR, _own),
    GoalKind("jog", "jog", PACKAGE + "Jog", _jog, succeeds_if_ended=True),
    GoalKind("servo_j", "servo_j", PACKAGE + "ServoJ", _servo_j, JOINT, _own),
    GoalKind("servo_l", "servo_l", PACKAGE + "ServoL", _servo_l, LINEAR, _own),
    GoalKind("servo_c", "servo_c", PACKAGE + "ServoC", _servo_c, LINEAR, _own),
    GoalKind("execute_trajectory", "execute_trajectory", PACKAGE + "ExecuteTrajectory", _execute_trajectory, PATH),
    GoalKind("gentle trajectory", "execute_trajectory", PACKAGE + "ExecuteTrajectory", _gently, PATH,
             limits=lambda fields: (fields["max_acceleration"][0], fields["max_jerk"][0])),
    GoalKind("execute_cartesian_path", "execute_cartesian_path", PACKAGE + "ExecuteCartesianPath", _cartesian_path, PATH),
    GoalKind("execute_parametrized", "execute_parametrized_trajectory", PACKAGE + "ExecuteParametrizedTrajectory", _parametrized, PATH,
             limits=lambda _fields: (5.0, 100.0)),
    GoalKind("follow_joint_trajectory", "follow_joint_trajectory", "control_msgs/action/FollowJointTrajectory", _follow, PATH,
             limits=lambda _fields: (5.0, 100.0)),
    GoalKind("move_until_force", "move_until_force", PACKAGE + "MoveUntilForce", _until_force, LINEAR, _own),
    GoalKind("move_until_contact", "move_until_contact", PACKAGE + "MoveUntilContact", _until_contact, deceleration=_unspecified,
             runs_script=True),
    GoalKind("move_until_torque", "move_until_torque", PACKAGE + "MoveUntilForce", _until_force, LINEAR, _own),
    GoalKind("force_mode", "force_mode", PACKAGE + "ForceMode", _force_mode, MODE, _unspecified, succeeds_if_ended=True),
    GoalKind("move_j in force mode", "move_j", PACKAGE + "MoveJ", _move_j, JOINT,
             before=[("force_mode_start", PACKAGE + "ForceMode", FORCE_MODE)]),
    GoalKind("freedrive", "freedrive", PACKAGE + "Freedrive", _no_fields, MODE, _unspecified, around=lambda _scene: PUSH,
             succeeds_if_ended=True),
    GoalKind("teach_mode", "teach_mode", PACKAGE + "TeachMode", _no_fields, MODE, _unspecified, around=lambda _scene: PUSH,
             succeeds_if_ended=True),
    GoalKind("direct_torque", "direct_torque", PACKAGE + "DirectTorque", _torque, MODE, _unspecified),
    GoalKind("send_script", "send_script", PACKAGE + "SendScript", _script, JOINT, _unspecified, runs_script=True),
    GoalKind("move_down_until_force", "move_down_until_force", f"{TUTORIALS}/action/MoveDownUntilForce", _down, package=TUTORIALS),
    GoalKind("spiral_search", "spiral_search", f"{TUTORIALS}/action/SpiralSearch", _spiral, MODE, _unspecified, package=TUTORIALS),
    GoalKind("insert_peg", "insert_peg", f"{TUTORIALS}/action/InsertPeg", _insert, MODE, _unspecified, around=_plate, package=TUTORIALS),
    GoalKind("vacuum_pick", "vacuum_pick", f"{TUTORIALS}/action/VacuumPick", _pick, deceleration=lambda _fields: OF_UNTIL_FORCE,
             package=TUTORIALS),
    GoalKind("visual_servo", "visual_servo", f"{TUTORIALS}/action/VisualServo", _watch, source="visual_servo/target", package=TUTORIALS),
    GoalKind("topic servo_joint", "servo_joint", "sensor_msgs/msg/JointState", _speed_of_topic, JOINT, is_topic=True),
    GoalKind("topic servo_pose", "servo_pose", "geometry_msgs/msg/PoseStamped", _speed_of_topic, is_topic=True),
    GoalKind("topic twist", "twist", "geometry_msgs/msg/TwistStamped", _speed_of_topic, is_topic=True),
    GoalKind("plugin slow to look", "slow_to_look", PACKAGE + "SpeedJ", _speed_j, JOINT, _own, package=TEST_COMMANDS),
    GoalKind("plugin never looks", "never_looks", PACKAGE + "SpeedJ", _never_looks, JOINT, _own, package=TEST_COMMANDS),
    GoalKind("plugin calls speed_j", "calls_speed_j", PACKAGE + "SpeedJ", _speed_j, JOINT, _own, package=TEST_COMMANDS),
)


def of_packages(packages: Sequence[str]) -> List[GoalKind]:
    """The kinds that a machine can execute, given which optional packages it has."""
    return [kind for kind in KINDS if kind.package == "ur_ros_rtde_commands" or kind.package in packages]
