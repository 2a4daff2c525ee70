"""Measures what the actions of a driver cost it, its clients and other nodes. Started by `./ur bench --servers`.

Each client is a process of its own, forked before it initializes ROS, because Fast DDS caches known types per process.
"""

import argparse
import importlib
import json
import os
import signal
import statistics
import sys
import time
from pathlib import Path

import rclpy
from latency import percentile
from process_load import proportional_megabytes, resident_megabytes
from rclpy.action import ActionClient
from rclpy.action.graph import get_action_names_and_types

from ur_ros_rtde_msgs.action import SetPayload

LIMIT = 60.0  # s
STABLE = 1.0  # s without a new endpoint: discovery is complete


def in_child(work):
    """Runs `work()` in a child process and returns its result."""
    read_end, write_end = os.pipe()
    process = os.fork()
    if process == 0:
        try:
            os.write(write_end, json.dumps(work()).encode())
        finally:
            os._exit(0)
    os.close(write_end)
    with os.fdopen(read_end) as answer:
        text = answer.read()
    os.waitpid(process, 0)
    if not text:
        sys.exit("bench: a client failed, see above")
    return json.loads(text)


def wait_until(condition, what):
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"bench: {what} not within {LIMIT:g} s")
        time.sleep(0.005)


def listed(node):
    return {name for name, _ in get_action_names_and_types(node)}


def new_client(expected):
    """Returns the times in s from the start of a client until it has found all actions, and until a goal is accepted."""
    begin = time.monotonic()
    rclpy.init()
    node = rclpy.create_node("new_client")
    client = ActionClient(node, SetPayload, "set_payload")
    wait_until(client.server_is_ready, "the action set_payload")
    response = client.send_goal_async(SetPayload.Goal(mass=0.5))
    rclpy.spin_until_future_complete(node, response, timeout_sec=LIMIT)
    accepted = time.monotonic() - begin
    if not response.done() or not response.result().accepted:
        sys.exit("bench: a goal was not accepted")
    rclpy.spin_until_future_complete(node, response.result().get_result_async(), timeout_sec=LIMIT)
    wait_until(lambda: expected <= listed(node), "all actions")
    found = time.monotonic() - begin
    client.destroy()
    node.destroy_node()  # and with it the participant: this client does not count as killed
    return {"found": found, "accepted": accepted}


def other_node():
    """Returns the memory of a node that has nothing to do with the driver, in MB, and the number of endpoints in its domain."""
    rclpy.init()
    node = rclpy.create_node("other_node")
    known, changed = 0, time.monotonic()
    while time.monotonic() - changed < STABLE:
        found = endpoints(node)
        if found != known:
            known, changed = found, time.monotonic()
        time.sleep(0.05)
    return {"memory": resident_megabytes(os.getpid()), "endpoints": known}


def endpoints(node):
    """Returns the number of endpoints of all nodes of the domain, as the middleware has them: a service has two, as a client has."""
    topics = sum(node.count_publishers(name) + node.count_subscribers(name) for name, _ in node.get_topic_names_and_types())
    services = 2 * sum(node.count_services(name) + node.count_clients(name) for name, _ in node.get_service_names_and_types())
    return topics + services


def kill_clients(count):
    """Kills clients that have found their server."""
    def wait_to_be_killed():
        rclpy.init()
        client = ActionClient(rclpy.create_node("killed_client"), SetPayload, "set_payload")
        wait_until(client.server_is_ready, "the action set_payload")
        os.kill(os.getpid(), signal.SIGSTOP)  # until all of them are killed

    processes = []
    for _ in range(count):
        processes.append(os.fork())
        if processes[-1] == 0:
            try:
                wait_to_be_killed()
            finally:
                os._exit(1)
    stopped = [os.WIFSTOPPED(os.waitpid(process, os.WUNTRACED)[1]) for process in processes]
    for process in processes:
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
    if not all(stopped):
        sys.exit("bench: a client to be killed did not find its server")


def use(actions):
    """Lets a client find the servers of these actions: {name: type}."""
    def work():
        rclpy.init()
        node = rclpy.create_node("user")
        for name, kind in actions.items():
            package, _, short = kind.partition("/action/")
            client = ActionClient(node, getattr(importlib.import_module(f"{package}.action"), short), name)
            wait_until(client.server_is_ready, f"the action {name}")
        return len(actions)
    in_child(work)


def memory(pid):
    return {"memory": resident_megabytes(pid), "own memory": proportional_megabytes(pid)}


def all_actions(expected):
    """Returns the types of the actions by name, when all are listed."""
    def work():
        rclpy.init()
        node = rclpy.create_node("lister")
        wait_until(lambda: expected <= listed(node), "all actions")
        return {name: types[0] for name, types in get_action_names_and_types(node) if name in expected}
    return in_child(work)


def measure(pid, names, clients, killed):
    expected = {f"/{name.lstrip('/')}" for name in names.split(",")}
    figures = {"": memory(pid), "other node": in_child(other_node)}
    kill_clients(killed)
    samples = [in_child(lambda: new_client(expected)) for _ in range(clients)]
    for part in ("found", "accepted"):
        times = [sample[part] for sample in samples]
        figures[part] = {"p50": statistics.median(times), "p90": percentile(times, 0.9), "max": max(times)}
    actions = all_actions(expected)
    use(dict(list(actions.items())[:10]))
    figures["after ten"] = memory(pid)
    use(actions)
    figures["after all"] = memory(pid)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pid", type=int, help="the driver; default: there is none, only the memory of another node is measured")
    parser.add_argument("--actions", default="", help="of the driver, separated by commas")
    parser.add_argument("--clients", type=int, default=20, help="number of new clients (default: 20)")
    parser.add_argument("--killed", type=int, default=0, help="clients that are killed before (default: 0)")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    options = parser.parse_args()
    figures = measure(options.pid, options.actions, options.clients, options.killed) if options.pid else {
        "other node": in_child(other_node)}
    options.output.write_text(json.dumps(figures))


if __name__ == "__main__":
    main()
