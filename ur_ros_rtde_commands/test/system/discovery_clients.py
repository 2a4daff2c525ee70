"""Measures how soon new clients find the actions of a driver, also after other clients were killed. Prints JSON: seconds.

Each client is a process of its own, forked before it uses ROS: Fast DDS keeps the types that it knows for a whole process.
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

STARTUP_LIMIT = 30.0  # s, for the clients that are killed to find their server


def child(work):
    """Runs `work(write)` in a process of its own. Returns its process id and the file to which it writes."""
    reading, writing = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(reading)
        try:
            work(lambda text: os.write(writing, text.encode()))
        finally:
            os._exit(0)
    os.close(writing)
    return process, os.fdopen(reading)


def action_client(name):
    rclpy.init()
    node = rclpy.create_node(name)
    return node, ActionClient(node, MoveJ, "move_j")


def wait_to_be_killed(write):
    node, client = action_client("killed_client")
    write("ready\n" if client.wait_for_server(STARTUP_LIMIT) else "late\n")
    rclpy.spin(node)


def find(expected, limit, write):
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
    clients = [child(wait_to_be_killed) for _ in range(count)]
    late = [answer.readline() for _, answer in clients].count("late\n")
    for process, _ in clients:
        os.kill(process, signal.SIGKILL)
    for process, answer in clients:
        os.waitpid(process, 0)
        answer.close()
    if late:
        sys.exit(f"{late} of the {count} clients that were to be killed did not find move_j within {STARTUP_LIMIT:g} s")


def measure(expected, limit):
    process, answer = child(lambda write: find(expected, limit, write))
    with answer:
        result = json.loads(answer.read())
    os.waitpid(process, 0)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("actions", help="the names that each client must find, with commas between")
    parser.add_argument("--clients", type=int, default=10, help="new clients, one after the other")
    parser.add_argument("--killed", type=int, default=0, help="clients that wait for move_j and are killed before")
    parser.add_argument("--limit", type=float, default=30.0, help="seconds that a new client has")
    options = parser.parse_args()
    expected = {f"/{name}" for name in options.actions.split(",")}
    kill_clients(options.killed)
    print(json.dumps([measure(expected, options.limit) for _ in range(options.clients)]))


if __name__ == "__main__":
    main()
