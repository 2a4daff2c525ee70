#!/usr/bin/env python3
"""A client in a process of its own: reads one goal as JSON from stdin, sends it, prints its id, and spins until it is terminated."""

import json
import pathlib
import sys

import rclpy
from rclpy.action import ActionClient

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "every_command"))

import messages


def main():
    rclpy.init()
    node = rclpy.create_node("client_that_ends", start_parameter_services=False, enable_rosout=False)
    print("ready", flush=True)
    request = json.loads(sys.stdin.readline())
    action = messages.load(request["type"])
    client = ActionClient(node, action, request["action"])
    assert client.wait_for_server(timeout_sec=20.0)
    sent = client.send_goal_async(messages.fill(action.Goal(), request["fields"]))
    rclpy.spin_until_future_complete(node, sent)
    handle = sent.result()
    print("goal" if handle.accepted else "rejected", bytes(handle.goal_id.uuid).hex(), flush=True)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
