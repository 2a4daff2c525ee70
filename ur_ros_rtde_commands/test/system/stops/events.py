"""What ends a goal: requests of clients, operators and the safety system, lost programs and connections, the end of the driver."""

import signal
from dataclasses import dataclass
from typing import Any, Callable, Optional, Tuple

from support import wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, Decelerate, Stop, Trigger
from ur_ros_rtde_msgs.msg import ErrorCode as E

BEGIN_LIMIT = 0.02  # s of the robot, from a request to the first decelerating cycle
RECOVERY_LIMIT = 20.0  # s
SUSPENSION = 800_000_000  # ns
CYCLES_TO_BEGIN = 10  # from the end of the control program to the begin of a script
CONTROL_PROGRAM = "rtde_control"


@dataclass(frozen=True)
class Event:
    """`cause` executes the event, and returns when it was sent, ns since the epoch."""

    name: str
    cause: Callable[[Any], int]  # function of the lane
    weight: float
    codes: Tuple[int, ...]  # error codes of a goal that it ends
    begin_limit: Optional[float] = None  # s of the robot; None: depends on a connection that has to be found dead, or on a lease
    rest_limit: float = 1.0  # s of the robot, to the standstill, without the time of the deceleration
    asks: str = ""  # whose deceleration is asked for: that of the "goal", of the "stop", or the "default"
    keeps_program: bool = False  # the next goal is accepted at once
    recover: Optional[Callable[[Any], None]] = None
    needs_client: str = ""  # the goal is sent by a client of its own, which ends so: "exit", "kill"
    ends_driver: bool = False
    profile: str = ""  # the only one in which it occurs
    has_result: bool = True
    slows_time: bool = False  # the speed scaling falls: an arm that accelerates still does so at first
    is_silent: bool = False  # is noticed after the silence_limit
    is_left_to_the_watchdog: bool = False  # of the robot
    cuts_off: bool = False  # the driver no longer sees the arm
    attempts_to_stop: float = 0.0  # s, for those of the driver that have no answer
    breaks_off: bool = False  # the motion of the control program, without a deceleration
    stops_robot: bool = False  # the safety system does: no program runs until the operator acts
    ends_waiting: bool = True  # also ends a goal that waits for the arm
    in_local_control: bool = True  # possible there


def _cancel(lane) -> int:
    return lane.running.cancel()


def _stop(lane) -> int:
    return lane.send_in_executor(Stop, "stop", **lane.case.stop)


def _cancel_then(request: Callable[[Any], int]) -> Callable[[Any], int]:
    def cause(lane) -> int:
        when = lane.running.cancel()
        lane.sleep_until(when + 1e9 * lane.case.second_delay)
        lane.second_request = request(lane)
        return when

    return cause


def _dashboard(name: str) -> Callable[[Any], int]:
    return lambda lane: lane.send_in_executor(DashboardCommand, f"dashboard/{name}")


def _send_empty(action, name: str) -> Callable[[Any], int]:
    return lambda lane: lane.send_in_executor(action, name)


def _page_stop(lane) -> int:
    return lane.press_stop_of_the_page()


def _control(command: str, **fields: Any) -> Callable[[Any], int]:
    def cause(lane) -> int:
        when = lane.now()
        lane.simulator.control(command, **fields)
        return when

    return cause


def _press(button: Callable[[Any], bool]) -> Callable[[Any], int]:
    """Presses the button until there is a program that obeys: between the control program and a script, there is none."""
    def cause(lane) -> int:
        def pressed() -> int:
            when = lane.now()
            return when if button(lane.simulator) else 0

        return wait_for(pressed, 2.0, "a program that obeys")

    return cause


def _stop_button(simulator) -> bool:
    """A control program that has ended in the same cycle, for a script that then begins, has not obeyed."""
    if simulator.control("stop_program")["program"] != "PLAYING":
        return False
    cycle = simulator.state()["cycle"]
    wait_for(lambda: simulator.state()["cycle"] > cycle + CYCLES_TO_BEGIN, 2.0, "a script that is about to begin")
    program = simulator.state()["program"]
    return program["state"] != "PLAYING" or program["name"] == CONTROL_PROGRAM


def _pause_button(simulator) -> bool:
    return simulator.may("pause_program")


def _play_another_program(lane) -> int:
    when = lane.now()
    lane.simulator.control("run_script", script="def another():\n  sleep(0.3)\nend\n")
    return when


def _signal(number: int) -> Callable[[Any], int]:
    def cause(lane) -> int:
        when = lane.now()
        lane.driver.signal(number)
        return when

    return cause


def _suspend_driver(lane) -> int:
    """For longer than every watchdog: it has to stop the arm, and the driver must not move it when it goes on."""
    when = lane.now()
    lane.driver.pause()
    lane.took_effect = lane.now()
    lane.sleep_until(lane.took_effect + SUSPENSION)
    lane.driver.resume()
    return when


def _end_client(how: str) -> Callable[[Any], int]:
    def cause(lane) -> int:
        client, when = lane.running.client, lane.now()
        client.signal(signal.SIGKILL if how == "kill" else signal.SIGTERM)
        client.wait(20.0)
        lane.took_effect = lane.now()
        return when

    return cause


def _preempt(lane) -> int:
    return lane.preempt()


def _is_normal(lane) -> bool:
    return lane.simulator.state()["safety_mode"] == "NORMAL"


def _unlock(lane) -> None:
    wait_for(lane.simulator.unlock_protective_stop, RECOVERY_LIMIT, "the protective stop to be unlocked")
    wait_for(lambda: _is_normal(lane), RECOVERY_LIMIT, "a normal safety mode")


def _release_emergency_stop(lane) -> None:
    lane.simulator.control("emergency_stop", pressed=False)
    wait_for(lambda: _is_normal(lane), RECOVERY_LIMIT, "a normal safety mode")
    _power_on(lane)


def _close_safeguard(lane) -> None:
    lane.simulator.control("safeguard", open=False)
    wait_for(lambda: _is_normal(lane), RECOVERY_LIMIT, "a normal safety mode")


def _end_stall(lane) -> None:
    lane.simulator.control("stall_links", stalled=False)


def _press_play(lane) -> None:
    """Unless the driver has ended the paused program, and perhaps started its own."""
    if lane.simulator.state()["program"]["state"] == "PAUSED":
        lane.simulator.may("play")


def _power_on(lane) -> None:
    lane.simulator.control("power", to="running")


def _restart_driver(lane) -> None:
    lane.restart_driver()


EVENTS = (
    # Requests of clients
    Event("cancel", _cancel, 22.0, (E.CANCELED,), BEGIN_LIMIT, asks="goal", keeps_program=True, ends_waiting=False),
    Event("stop", _stop, 20.0, (E.PREEMPTED,), BEGIN_LIMIT, asks="stop", keeps_program=True),
    Event("stop_j", _send_empty(Decelerate, "stop_j"), 3.0, (E.PREEMPTED,), BEGIN_LIMIT, asks="default", keeps_program=True),
    Event("stop_l", _send_empty(Decelerate, "stop_l"), 3.0, (E.PREEMPTED,), BEGIN_LIMIT, asks="default", keeps_program=True),
    Event("cancel, then stop", _cancel_then(_stop), 8.0, (E.CANCELED, E.PREEMPTED), BEGIN_LIMIT, keeps_program=True, ends_waiting=False),
    Event("STOP of the page", _page_stop, 5.0, (E.PREEMPTED,), BEGIN_LIMIT, asks="default", keeps_program=True),
    Event("preempted", _preempt, 40.0, (E.PREEMPTED,), BEGIN_LIMIT, asks="goal", keeps_program=True, profile="preempt",
          ends_waiting=False, in_local_control=False),
    Event("stand_down", _send_empty(DashboardCommand, "stand_down"), 2.0, (E.PREEMPTED,), BEGIN_LIMIT, recover=_power_on,
          stops_robot=True, in_local_control=False),
    Event("trigger_protective_stop", _send_empty(Trigger, "trigger_protective_stop"), 2.0, (E.PROTECTIVE_STOP,), recover=_unlock,
          stops_robot=True, in_local_control=False),
    Event("dashboard stop", _dashboard("stop"), 5.0, (E.PROGRAM_STOPPED, E.PREEMPTED), in_local_control=False),
    Event("dashboard pause", _dashboard("pause"), 2.0, (E.PROGRAM_STOPPED,), recover=_press_play, slows_time=True,
          ends_waiting=False, in_local_control=False),
    # The safety system
    Event("protective stop", _control("protective_stop", reason="test"), 5.0, (E.PROTECTIVE_STOP,), BEGIN_LIMIT, recover=_unlock,
          stops_robot=True),
    Event("safeguard stop", _control("safeguard"), 5.0, (E.SAFEGUARD_STOP,), BEGIN_LIMIT, recover=_close_safeguard, stops_robot=True),
    Event("emergency stop", _control("emergency_stop"), 4.0, (E.EMERGENCY_STOP,), BEGIN_LIMIT, recover=_release_emergency_stop,
          stops_robot=True),
    # Operators and other programs
    Event("program stopped", _press(_stop_button), 5.0, (E.PROGRAM_STOPPED,), BEGIN_LIMIT),
    Event("program paused", _press(_pause_button), 5.0, (E.PROGRAM_STOPPED,), BEGIN_LIMIT, recover=_press_play, slows_time=True),
    Event("program replaced", _play_another_program, 3.0, (E.PROGRAM_STOPPED,), BEGIN_LIMIT, breaks_off=True, in_local_control=False),
    # Connections. With "control link dropped", the driver ends the program, and starts it for the goal that waits.
    Event("control link dropped", _control("drop_links", which="rtde", clients="control"), 4.0, (E.LINK_LOST,), cuts_off=True,
          ends_waiting=False),
    Event("RTDE links dropped", _control("drop_links", which="rtde"), 3.0, (E.LINK_LOST,), cuts_off=True),
    Event("all links dropped", _control("drop_links", which="all"), 2.0, (E.LINK_LOST,), cuts_off=True),
    Event("RTDE links silent", _control("stall_links", which="rtde"), 3.0, (E.LINK_LOST,), rest_limit=3.5, recover=_end_stall,
          is_silent=True, cuts_off=True),
    Event("all links silent", _control("stall_links", which="all"), 2.0, (E.LINK_LOST,), recover=_end_stall, is_silent=True,
          cuts_off=True, is_left_to_the_watchdog=True, attempts_to_stop=3.0),
    # The ends of clients and of the driver
    Event("client exits", _end_client("exit"), 1.5, (E.CLIENT_LOST,), rest_limit=1.5, asks="goal", keeps_program=True,
          needs_client="exit", ends_waiting=False),
    Event("client killed", _end_client("kill"), 1.0, (E.CLIENT_LOST,), rest_limit=6.0, asks="goal", keeps_program=True,
          needs_client="kill", ends_waiting=False),
    Event("driver suspended", _suspend_driver, 2.0, (E.PROGRAM_STOPPED, E.LINK_LOST), is_silent=True, cuts_off=True,
          is_left_to_the_watchdog=True),
    Event("driver interrupted", _signal(signal.SIGINT), 1.0, (E.SHUTDOWN,), rest_limit=2.0, recover=_restart_driver, ends_driver=True),
    Event("cancel, then Ctrl-C", _cancel_then(_signal(signal.SIGINT)), 0.8, (E.CANCELED, E.SHUTDOWN), rest_limit=2.5,
          recover=_restart_driver, ends_driver=True, ends_waiting=False),
    Event("driver killed", _signal(signal.SIGKILL), 1.0, (), recover=_restart_driver, ends_driver=True, has_result=False,
          is_left_to_the_watchdog=True),
)
