"""Records fields of the robot's state into a CSV file, until Ctrl-C or for a given time.

    ur record run.csv timestamp actual_q actual_TCP_force --time 10
"""

import argparse
import pathlib
import sys
from typing import Any

from .interruptions import Interrupted
from .problem import Problem


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=pathlib.Path, help="on the machine of robot_state_receiver; must not exist yet")
    parser.add_argument("fields", nargs="*", help="RTDE fields (default: timestamp actual_q actual_qd actual_TCP_pose)")
    parser.add_argument("--time", type=float, default=None, metavar="S", help="how long (default: until Ctrl-C)")
    parser.add_argument("--frequency", type=float, default=0.0, metavar="HZ", help="rows a second (default: each package)")


def _call(session: Any, kind: Any, name: str, **request: Any) -> Any:
    client = session.node.create_client(kind, name)
    if not session.wait(client.service_is_ready, 5.0):
        raise Problem(f"no server of {name}. Does robot_state_receiver run, in this ROS_DOMAIN_ID?")
    answer = session.result(client.call_async(kind.Request(**request)), 10.0)
    if answer is None:
        raise Problem(f"{name} did not answer")
    if not answer.success:
        raise Problem(answer.message)
    return answer


def run(options: argparse.Namespace) -> int:
    from ur_ros_rtde_msgs.srv import StartRecording, StopRecording  # only here: --help needs no ROS

    from .session import session
    with session(options.namespace) as use:
        _call(use, StartRecording, "start_recording", filename=str(options.file.absolute()), fields=options.fields,
              frequency=options.frequency)
        print("recording" + ("" if options.time is not None else ", Ctrl-C ends it"), file=sys.stderr)
        try:
            use.wait(lambda: None, options.time)
        except Interrupted:
            pass
        done = _call(use, StopRecording, "stop_recording")
        print(f"{done.filename}: {done.rows} rows" + (f", {done.lost} lost" if done.lost else ""))
        return 0
