"""Converts the goal of `./ur plan` to JSON for plan_trajectory. Runs with the Python of the build, which has ROS."""

import json
import sys
from typing import Any, Dict, List

from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.fields import Document

from ur_ros_rtde_msgs.action import ExecuteParametrizedTrajectory, ExecuteTrajectory

JOINTS = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
LIMITS = ("max_velocity", "max_acceleration", "max_jerk")


def _limits(goal: Any) -> Dict[str, Any]:
    """Returns the given limits: an empty list stands for the default."""
    return {name: list(getattr(goal, name)) for name in LIMITS if getattr(goal, name)}


def _path(goal: Any) -> Dict[str, Any]:
    return {"waypoints": [list(waypoint.positions) for waypoint in goal.waypoints], "speed_fraction": goal.speed_fraction,
            "blend_tolerance": goal.blend_tolerance, **_limits(goal)}


def _joint_order(names: List[str]) -> List[int]:
    """Returns the index of each joint in `names`. As in the driver: any order and one common prefix, or no names."""
    if not names:
        return list(range(len(JOINTS)))
    order = [next((index for index, name in enumerate(names) if name.endswith(joint)), None) for joint in JOINTS]
    found = [index for index in order if index is not None]
    prefixes = {names[index][:-len(joint)] for index, joint in zip(order, JOINTS) if index is not None}
    if len(names) != len(JOINTS) or len(found) != len(JOINTS) or len(prefixes) != 1:
        raise CliError(f"trajectory.joint_names is {', '.join(names)}: expected {', '.join(JOINTS)} in any order, with one common "
                      "prefix or none")
    return found


def _seconds(duration: Any) -> float:
    return duration.sec + 1e-9 * duration.nanosec


def _timed(goal: Any) -> Dict[str, Any]:
    order = _joint_order(list(goal.trajectory.joint_names))
    points = []
    for index, message in enumerate(goal.trajectory.points):
        point: Dict[str, Any] = {"time": _seconds(message.time_from_start)}
        for field in ("positions", "velocities", "accelerations"):
            values = list(getattr(message, field))
            if field != "positions" and not values:
                continue
            if len(values) != len(JOINTS):
                raise CliError(f"trajectory.points[{index}].{field} has {len(values)} values: expected {len(JOINTS)}")
            point[field] = [values[joint] for joint in order]
        points.append(point)
    if not points:
        raise CliError("trajectory.points is empty: expected 2 points or more")
    if points[0]["time"] > 0.0:
        raise CliError(f"trajectory.points[0].time_from_start is {points[0]['time']:g} s: expected 0, because a plan "
                      "without a robot starts at the first point")
    return {"points": points, **_limits(goal)}


def convert(document: Document) -> Dict[str, Any]:
    """Converts a goal of execute_parametrized_trajectory if it has a trajectory, otherwise of execute_trajectory."""
    if "model" in document.names:
        raise CliError("there is no field model: use the option --model")
    if "trajectory" in document.names:
        return _timed(document.fill(ExecuteParametrizedTrajectory.Goal()))
    return _path(document.fill(ExecuteTrajectory.Goal()))


def main(file: str, model: str) -> int:
    try:
        goal = convert(Document.of_file(file))
    except CliError as error:
        text = str(error)
        print(text if text.startswith(file) else f"{file}: {text}", file=sys.stderr)
        return 1
    json.dump({"model": model, **goal}, sys.stdout)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
