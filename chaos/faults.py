"""Random faults of the controller, its links, its operators and the host, each with a random duration."""

from dataclasses import dataclass
from typing import Callable

LINKS = ("rtde", "dashboard", "script", "realtime", "all")


@dataclass(frozen=True)
class Kind:
    name: str
    weight: float
    max_duration: float  # s; 0: an event without a duration
    cause: Callable  # function of the robot and of a random number generator


def _control(command, **fields):
    return lambda robot, random: robot.simulator.control(command, **fields)


def _drop(robot, random):
    robot.simulator.control("drop_links", which=random.choice(LINKS), reset=random.random() < 0.5)


def _stall(robot, random):
    robot.simulator.control("stall_links", which=random.choice(LINKS))


def _half_open(robot, random):
    """The links are silent first. When they work again, the controller has dropped the connections."""
    robot.simulator.control("stall_links", which="all")
    robot.after_fault(lambda: robot.simulator.control("drop_links", which="all", reset=True))


def _garbage(robot, random):
    robot.simulator.control("send_garbage", which=random.choice(LINKS[:2]), bytes=random.randrange(1, 2000))


def _refuse(robot, random):
    robot.simulator.control("refuse_connections")
    robot.simulator.control("drop_links")


def _push(robot, random):
    force = [random.uniform(-150.0, 150.0) for _ in range(3)]
    robot.simulator.control("push", force=force, duration=random.uniform(0.05, 0.5))


def _pause_program(robot, random):
    try:
        robot.simulator.control("pause_program")
    except AssertionError as refused:
        if "no program is running" not in str(refused):
            raise


def _kill_simulator(robot, random):
    robot.simulator.kill()


def _pause_simulator(robot, random):
    robot.simulator.process.pause()


def _pause_driver(robot, random):
    robot.driver.pause()


KINDS = (
    Kind("drop", 3.0, 0.0, _drop),
    Kind("stall", 3.0, 1.5, _stall),
    Kind("half-open", 1.0, 1.5, _half_open),
    Kind("garbage", 2.0, 0.0, _garbage),
    Kind("refused connections", 1.0, 1.0, _refuse),
    Kind("reboot", 0.5, 0.0, _control("reboot", duration=0.5)),
    Kind("protective stop", 1.0, 0.5, _control("protective_stop", reason="chaos")),
    Kind("emergency stop", 1.0, 0.5, _control("emergency_stop")),
    Kind("safeguard stop", 1.5, 0.5, _control("safeguard")),
    Kind("program stopped", 2.0, 0.0, _control("stop_program")),
    Kind("program paused", 1.0, 0.5, _pause_program),
    Kind("local control", 1.0, 0.5, _control("remote_control", on=False)),
    Kind("speed slider at 0", 1.0, 1.0, _control("speed_slider", fraction=0.0)),
    Kind("push", 2.0, 0.0, _push),
    Kind("controller killed", 1.0, 0.5, _kill_simulator),
    Kind("controller paused", 1.0, 1.0, _pause_simulator),
    Kind("driver paused", 2.0, 0.3, _pause_driver),
)


@dataclass(frozen=True)
class Fault:
    kind: Kind
    delay: float  # s, without a fault before this one
    duration: float  # s
    quiet: bool  # no new goals until the fault is over, so that the arm must come to rest
    seed: int  # seed of the random values of its kind

    def text(self):
        return f"{self.kind.name} for {self.duration:.2f} s{', no new goals' if self.quiet else ''}"


def sequence(random):
    """Yields faults without end. The same seed gives the same faults."""
    while True:
        kind = random.choices(KINDS, [kind.weight for kind in KINDS])[0]
        min_duration = min(0.05, kind.max_duration)
        yield Fault(kind, random.uniform(0.1, 0.8), random.uniform(min_duration, kind.max_duration), random.random() < 0.5,
                    random.randrange(2**32))
