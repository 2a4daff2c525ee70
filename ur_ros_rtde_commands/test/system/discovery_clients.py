"""Measures how long new clients take to discover the actions of a driver, optionally after other clients were killed.

Prints the times in seconds as JSON. Each client is a separate process, forked before it initializes ROS, because Fast DDS
caches known types per process.
"""

import argparse
import json
import os
import signal
import sys
import time

import rclpy
from rclpy.action import ActionClient
from rclpy.action.graph import get_action_names_and_types

from ur_ros_rtde_msgs.action import MoveJ

GROUP = 20  # new clients
STARTUP_LIMIT = 30.0  # s, for the clients to be killed to find their server


def fork_child(work):
    """Runs `work(write)` in a child process. Returns the process id and the file from which its output is read."""
    read_end, write_end = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(read_end)
        try:
            work(lambda text: os.write(write_end, text.encode()))
        finally:
            os._exit(0)
    os.close(write_end)
    return process, os.fdopen(read_end)


def action_client(name):
    rclpy.init()
    node = rclpy.create_node(name)
    return node, ActionClient(node, MoveJ, "move_j")


def wait_to_be_killed(write):
    node, client = action_client("killed_client")
    write("ready\n" if client.wait_for_server(STARTUP_LIMIT) else "late\n")
    rclpy.spin(node)


def find_actions(expected, limit, write):
    begin = time.monotonic()
    node, client = action_client("new_client")
    while True:
        found = {name for name, _ in get_action_names_and_types(node)}
        elapsed = time.monotonic() - begin
        if (expected <= found and client.server_is_ready()) or elapsed > limit:
            break
        time.sleep(0.02)
    write(json.dumps({"seconds": elapsed, "missing": sorted(expected - found)}))
    rclpy.shutdown()


def kill_clients(count):
    clients = [fork_child(wait_to_be_killed) for _ in range(count)]
    late = [answer.readline() for _, answer in clients].count("late\n")
    for process, _ in clients:
        os.kill(process, signal.SIGKILL)
    for process, answer in clients:
        os.waitpid(process, 0)
        answer.close()
    if late:
        sys.exit(f"{late} of the {count} clients to be killed did not find move_j within {STARTUP_LIMIT:g} s")


def measure(expected, limit):
    process, answer = fork_child(lambda write: find_actions(expected, limit, write))
    with answer:
        result = json.loads(answer.read())
    os.waitpid(process, 0)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("actions", help="comma-separated names of the actions that each client has to discover")
    parser.add_argument("--clients", type=int, default=10, help="number of new clients, started one after another")
    parser.add_argument("--killed", type=int, default=0, help=f"clients that wait for move_j and are killed, before each {GROUP} new ones")
    parser.add_argument("--limit", type=float, default=30.0, help="timeout of a new client in seconds")
    options = parser.parse_args()
    expected = {f"/{name}" for name in options.actions.split(",")}
    found = []
    for number in range(options.clients):
        if number % GROUP == 0:  # the driver forgets those that were killed
            kill_clients(options.killed)
        found.append(measure(expected, options.limit))
    print(json.dumps(found))


if __name__ == "__main__":
    main()
