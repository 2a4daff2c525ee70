"""Exceptions of this package. Each message states the cause, and the remedy if there is one."""

import functools
import re
from typing import Any

from ur_ros_rtde_cli import interface_files

REMEDIES = {"BUSY": "wait for the running goal, or end it with stop()",
            "NOT_READY": "make_ready()",
            "PROTECTIVE_STOP": "remove the cause, then make_ready()",
            "EMERGENCY_STOP": "release the button, then make_ready()",
            "SAFEGUARD_STOP": "close the safeguard, then repeat the command",
            "PROGRAM_STOPPED": "make_ready(), or start the program on the teach pendant",
            "LINK_LOST": "check the controller and its network: ur doctor --robot ADDRESS",
            "SAFETY_VIOLATION": "inspect the robot, then make_ready(restart_safety=True)"}

INVALID_GOAL, BUSY, TIMEOUT = 1, 2, 6  # of ur_ros_rtde_msgs/msg/ErrorCode

# The driver's message about a field: "speed is 9 rad/s, it must be above 0 and at most 3.14 rad/s".
_FIELD = re.compile(r"(?P<field>[a-z]\w*(?:\.\w+|\[\d+\])*)(?: \(\w+\))? (?:is|has) (?P<value>[-+]?(?:\d[\d.]*(?:e[-+]?\d+)?|nan|inf))\b"
                    r".*?, it (?:must be|must have|may be|has to be) (?P<limit>[^:]+)", re.S)


@functools.lru_cache(maxsize=1)
def _names() -> dict[int, str]:
    constants = interface_files.constants("ur_ros_rtde_msgs/msg/ErrorCode")
    return {int(constant.value): constant.name for constant in constants.values()}


# One without a number: "pose.position is (nan, 0, 0) m, it must be finite".
_FIELD_ALONE = re.compile(r"(?P<field>[a-z]\w*(?:\.\w+|\[\d+\])*) (?:is|has) ")


class RobotError(Exception):
    """Base class of all exceptions of this package."""


class _Coded(RobotError):
    def __init__(self, command: str, code: int, message: str):
        self.command = command
        self.code = code  # value of ur_ros_rtde_msgs/msg/ErrorCode
        self.name = _names().get(code, str(code))
        self.message = message
        self.remedy = REMEDIES.get(self.name, "")
        super().__init__(f"{command}: {message} ({self.name})")

    def __reduce__(self) -> Any:  # for another process
        return type(self), (self.command, self.code, self.message)


class Rejected(_Coded):
    """A goal or a setpoint that was not accepted: nothing moves because of it.

    `field`, `value` and `limit` are None if the message names none.
    """

    def __init__(self, command: str, code: int, message: str, field: str | None = None):
        super().__init__(command, code, message)
        found = _FIELD.match(message)
        named = found or (_FIELD_ALONE.match(message) if field is None else None)
        self.field = named["field"] if named else field
        self.value = float(found["value"]) if found else None
        self.limit = found["limit"].strip() if found else None

    def __reduce__(self) -> Any:
        return type(self), (self.command, self.code, self.message, self.field)


class CommandFailed(_Coded):
    """A goal that was accepted and did not succeed. The message says why, and if the arm may still move.

    `result` is the result message, which contains the final state of the arm.
    """

    def __init__(self, command: str, result: Any):
        super().__init__(command, getattr(result, "error_code", 0), getattr(result, "message", "") or "failed")
        self.result = result

    def __reduce__(self) -> Any:
        return type(self), (self.command, self.result)


class StreamEnded(_Coded):
    """A stream of setpoints that has ended before the end of its block. The message says why; the arm decelerates or is at standstill."""


class NoDriver(RobotError, ConnectionError):
    """No driver answers."""


class Timeout(RobotError, TimeoutError):
    """A wait has exceeded its timeout. The goal of the wait has been canceled."""


class UnknownCommand(RobotError, AttributeError):
    """No installed plugin and no action of the driver has this name."""
