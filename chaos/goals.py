"""Random goals: mostly motions near the home position, some examples of the documentation, a few invalid ones."""

import math
from dataclasses import dataclass
from typing import Optional

import documentation
import messages
import plugins
from support import HOME

LONGEST_WAIT = 1.5  # s, from acceptance to cancel
# Commands that shut the controller down or take control from the driver, or whose effect outlasts the goal.
EXCLUDED = ("dashboard/shutdown", "dashboard/quit", "dashboard/power_off", "dashboard/load", "dashboard/set_user_role",
            "dashboard/set_operational_mode", "force_mode_start", "freedrive_start", "teach_mode_start", "set_watchdog", "set_tcp",
            "set_gravity", "set_payload", "set_target_payload", "trigger_protective_stop", "set_speed_slider")


@dataclass
class Plan:
    name: str
    type: str
    fields: dict
    cancel_after: Optional[float]  # s; None: no cancel request

    def message(self):
        return messages.fill(messages.load(self.type).Goal(), self.fields)

    def text(self):
        cancel = "" if self.cancel_after is None else f", canceled after {self.cancel_after:.2f} s"
        return f"{self.name} {self.fields}{cancel}"


def _near_home(random, spread):
    # A smaller range for shoulder and elbow keeps the arm above its base and free of self-collision.
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
# After a fault the arm is powered on at once. A stand_down that misses the power-off state waits until its timeout.
OVERRIDES = {"stand_down": {"timeout": 20.0}}
HOMEWARD = ("move_j", "servo_j")  # drawn more often, so that relative motions do not lead the arm away
INVALID = {"joint_positions": [math.nan] * 6}


class Mix:
    """Draws the goals of a client. The same seed and client number give the same goals."""

    def __init__(self, random):
        self._random = random
        installed = plugins.find()
        self._motions = [name for name in (*MOTIONS, *HOMEWARD, *HOMEWARD) if name in installed]
        self._examples = [section.example() for section in documentation.sections()
                          if section.name in installed and section.name not in EXCLUDED and not section.scene()
                          and section.setup() == documentation.Setup()]

    def next(self):
        # All values are drawn for every goal, so that the kind of a goal does not change the following ones.
        kind, cancel, wait = (self._random.random() for _ in range(3))
        name = self._random.choice(self._motions)
        fields = MOTIONS[name][1](self._random)
        example = self._random.choice(self._examples) if self._examples else None
        cancel_after = LONGEST_WAIT * wait if cancel < 0.3 else None
        if kind < 0.05:
            return Plan("move_j", "ur_ros_rtde_msgs/action/MoveJ", INVALID, None)
        if kind < 0.3 and example:
            return Plan(example.action, example.type, {**example.goal, **OVERRIDES.get(example.action, {})}, cancel_after)
        return Plan(name, f"ur_ros_rtde_msgs/action/{MOTIONS[name][0]}", fields, cancel_after)
