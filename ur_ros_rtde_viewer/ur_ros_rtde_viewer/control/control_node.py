"""The ROS node with everything that can move an arm, and its thread.

The thread does nothing else, so that STOP does not wait for the scene or the plots.
"""

import threading
from typing import Any, Callable

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

JOIN_LIMIT = 5.0  # s


class ControlNode:
    def __init__(self, context: rclpy.Context):
        self.node: Any = rclpy.create_node("ur_viewer_control", context=context, enable_rosout=False, start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, name="control", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            pass

    def post(self, function: Callable[[], Any]) -> None:
        """Calls `function` in the thread of the node. rclpy loses a response that arrives while another thread still sends
        the request, so every request is sent in this thread."""
        self._executor.create_task(function)

    def close(self) -> None:
        self._executor.shutdown()
        self._thread.join(JOIN_LIMIT)
        self.node.destroy_node()
