"""Random goals: mostly motions about the home position, some of the documentation's examples, a few that are wrong."""

import math
from dataclasses import dataclass
from typing import Optional

import documentation
import messages
import plugins
from support import HOME

LONGEST_WAIT = 1.5  # s from acceptance to cancel
# What would end the controller or take it from the driver, and what goes on after its goal has ended.
LEFT_OUT = ("dashboard/shutdown", "dashboard/quit", "dashboard/power_off", "dashboard/load", "dashboard/set_user_role",
            "dashboard/set_operational_mode", "force_mode_start", "freedrive_start", "set_watchdog", "set_tcp", "set_gravity",
            "set_payload", "set_target_payload", "trigger_protective_stop", "set_speed_slider")


@dataclass
class Plan:
    name: str
    type: str
    fields: dict
    cancel_after: Optional[float]  # s; None: not at all

    def message(self):
        return messages.fill(messages.load(self.type).Goal(), self.fields)

    def text(self):
        cancel = "" if self.cancel_after is None else f", canceled after {self.cancel_after:.2f} s"
        return f"{self.name} {self.fields}{cancel}"


def _near_home(random, spread):
    # Shoulder and elbow less: the arm is to stay above its base, clear of itself.
    return [angle + random.uniform(-1.0, 1.0) * spread * (0.3 if joint in (1, 2) else 1.0) for joint, angle in enumerate(HOME)]


def _vector(random, length):
    direction = [random.gauss(0.0, 1.0) for _ in range(3)]
    norm = math.hypot(*direction) or 1.0
    return dict(zip("xyz", (length * value / norm for value in direction)))


MOTIONS = {
    "move_j": ("MoveJ", lambda r: {"joint_positions": _near_home(r, 0.8), "speed": r.uniform(0.5, 3.0),
                                   "acceleration": r.uniform(1.0, 15.0)}),
    "servo_j": ("ServoJ", lambda r: {"joint_positions": _near_home(r, 0.6), "time": r.uniform(1.0, 2.5)}),
    "speed_l": ("SpeedL", lambda r: {"twist": {"linear": _vector(r, r.uniform(0.02, 0.15))}, "time": r.uniform(0.2, 1.0)}),
    "speed_j": ("SpeedJ", lambda r: {"joint_velocities": [r.uniform(-0.3, 0.3) for _ in HOME], "time": r.uniform(0.2, 1.0)}),
    "move_j_relative": ("MoveJRelative", lambda r: {"joint_offsets": [r.uniform(-0.2, 0.2) for _ in HOME], "speed": 1.0,
                                                    "acceleration": 4.0}),
    "move_l_relative": ("MoveLRelative", lambda r: {"translation": _vector(r, 0.08), "frame": r.randrange(2), "speed": 0.25}),
    "jog": ("Jog", lambda r: {"twist": {"linear": _vector(r, 0.1)}, "frame": r.randrange(2), "time": r.uniform(0.2, 1.0)}),
    "stop": ("Stop", lambda r: {"joint_deceleration": r.uniform(1.0, 10.0)}),
}
# The arm is powered up again at once after a fault: a stand_down that does not see it off in between waits for its timeout.
SHORTER = {"stand_down": {"timeout": 20.0}}
HOMEWARD = ("move_j", "servo_j")  # more often, so that the relative ones do not lead the arm away
WRONG = {"joint_positions": [math.nan] * 6}


class Mix:
    """A client's goals: the same for the same seed and number of the client."""

    def __init__(self, random):
        self._random = random
        there = plugins.find()
        self._motions = [name for name in (*MOTIONS, *HOMEWARD, *HOMEWARD) if name in there]
        self._examples = [section.example() for section in documentation.sections()
                          if section.name in there and section.name not in LEFT_OUT and not section.scene()
                          and section.setup() == documentation.Setup()]

    def next(self):
        # Everything is drawn for every goal, so that one of another kind does not shift those that follow.
        kind, cancel, wait = (self._random.random() for _ in range(3))
        name = self._random.choice(self._motions)
        fields = MOTIONS[name][1](self._random)
        example = self._random.choice(self._examples) if self._examples else None
        cancel_after = LONGEST_WAIT * wait if cancel < 0.3 else None
        if kind < 0.05:
            return Plan("move_j", "ur_ros_rtde_msgs/action/MoveJ", WRONG, None)
        if kind < 0.3 and example:
            return Plan(example.action, example.type, {**example.goal, **SHORTER.get(example.action, {})}, cancel_after)
        return Plan(name, f"ur_ros_rtde_msgs/action/{MOTIONS[name][0]}", fields, cancel_after)
