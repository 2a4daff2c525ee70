"""Records RTDE outputs of the robot to a CSV file until Ctrl-C or for a given time.

    ur record run.csv timestamp actual_q actual_TCP_force --time 10
    ur record --stop                       ends one that goes on after its program was killed
"""

import argparse
import math
import pathlib
from typing import Any

from .errors import CliError, OperationFailed
from .interruptions import Interrupted
from .namespaces import other_drivers

RESPONSE_TIMEOUT = 10.0  # s, of a service


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=pathlib.Path, nargs="?", help="CSV file on the machine of robot_state_receiver; must not exist")
    parser.add_argument("fields", nargs="*", help="RTDE outputs (default: timestamp actual_q actual_qd actual_TCP_pose)")
    parser.add_argument("--time", type=_duration, default=None, metavar="S", help="duration of the recording (default: until Ctrl-C)")
    parser.add_argument("--stop", action="store_true", help="end the recording that runs, of any client")
    parser.add_argument("--frequency", type=float, default=0.0, metavar="HZ",
                        help="rows per second (default: one for each RTDE package)")


def _duration(text: str) -> float:
    seconds = float(text)
    if not 0.0 < seconds < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 s")
    return seconds


class _NoResponse(OperationFailed):
    """The request may still be executed."""


def remedy(namespace: str) -> str:
    """Returns how to end a recording that may be running."""
    return "if it is running, end it: ur record --stop" + (f" --namespace {namespace.strip('/')}" if namespace.strip("/") else "")


def _send(session: Any, kind: Any, name: str, **request: Any) -> Any:
    """Sends a request and returns the future of its response."""
    client = session.node.create_client(kind, name)
    if not session.wait(client.service_is_ready, 5.0):
        reason = other_drivers(session.node) or ". Does robot_state_receiver run with this ROS_DOMAIN_ID?"
        raise OperationFailed(f"there is no service {name}{reason}")
    return client.call_async(kind.Request(**request))


def _response(session: Any, future: Any, name: str) -> Any:
    response = session.result(future, RESPONSE_TIMEOUT)
    if response is None:
        raise _NoResponse(f"the service {name} did not respond within {RESPONSE_TIMEOUT:g} s")
    if not response.success:
        raise OperationFailed(response.message)
    return response


def _stop(session: Any, kind: Any) -> Any:
    """Returns the response of stop_recording. The request is sent even after an interruption."""
    try:
        request = _send(session, kind, "stop_recording")
    except Interrupted:
        request = _send(session, kind, "stop_recording")
    return _response(session, request, "stop_recording")


def _end(session: Any, kind: Any, started: Any, file: pathlib.Path) -> Any:
    """Stops the recording if its start is confirmed: without that, it may be a recording of another user."""
    from .feedback import write  # imported here because --help does not need ROS
    try:
        _response(session, started, "start_recording")
        return _stop(session, kind)
    except (_NoResponse, Interrupted):
        write(f"the end of the recording {file} is not confirmed: {remedy(session.node.get_namespace())}\n")
        raise


def _print(stopped: Any) -> None:
    print(f"{stopped.filename}: {stopped.rows} rows" + (f", {stopped.lost} lost" if stopped.lost else ""))


def run(options: argparse.Namespace) -> int:
    from ur_ros_rtde_msgs.srv import StartRecording, StopRecording  # imported here, as below, because --help does not need ROS

    from .feedback import write
    from .session import session
    if options.stop == (options.file is not None):
        raise CliError("give the file of a recording, or --stop to end the one that runs")
    with session(options.namespace) as created:
        if options.stop:
            _print(_stop(created, StopRecording))
            return 0
        started = _send(created, StartRecording, "start_recording", filename=str(options.file.absolute()), fields=options.fields,
                        frequency=options.frequency)
        exit_code = 0
        try:
            _response(created, started, "start_recording")
            write("recording" + ("" if options.time is not None else ", press Ctrl-C to end") + "\n")
            created.wait(lambda: None, options.time)
        except Interrupted:
            pass
        except _NoResponse as error:
            write(f"{error}: a recording that starts late is stopped\n")
            exit_code = error.exit_status
        _print(_end(created, StopRecording, started, options.file.absolute()))
        return exit_code
