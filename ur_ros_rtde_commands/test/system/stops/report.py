"""What a case has shown."""

from dataclasses import dataclass, field
from typing import List, Optional, Tuple


@dataclass
class Report:
    """What is known about an executed case."""

    seed: int
    case: str
    kind: str
    event: str
    held: bool
    violations: List[str] = field(default_factory=list)
    excused: List[str] = field(default_factory=list)  # exceeded limits that a stall of the host explains
    latency: Optional[float] = None  # s of the robot, to the first decelerating cycle
    standstill: Optional[float] = None  # s of the robot, from the event
    result: Optional[float] = None  # s, from the standstill, the end of the hold or the event, whichever is last
    outcome: Optional[Tuple[int, int]] = None  # status and error code of the result
    moved: bool = True  # before the event, if that waits for the motion
    ready: Optional[float] = None  # s, until the next goal was accepted
    deceleration: Optional[float] = None
    stall: float = 0.0  # s of the robot, until the arm decelerates
    stall_until_rest: float = 0.0  # s of the robot
    attempts: int = 1
    seconds: float = 0.0  # of the host, for the whole case
