"""The two ROS nodes of the viewer, and their executor."""

from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

NAME = "ur_viewer"


class Nodes:
    """`node` is spun: services, actions and topics that are published on changes. `polled` has the subscriptions of LatestTopic.

    All methods except wake() are called in the thread of the viewer's loop.
    """

    def __init__(self) -> None:
        self.context = rclpy.Context()
        rclpy.init(context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        options = {"context": self.context, "enable_rosout": False, "start_parameter_services": False}
        self.node: Any = rclpy.create_node(NAME, **options)
        self.polled: Any = rclpy.create_node(NAME + "_topics", **options)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)

    def spin_once(self, limit: float) -> None:
        """Runs one callback. Returns after `limit` s, or after wake(), if there is none."""
        self._executor.spin_once(timeout_sec=limit)

    def wake(self) -> None:
        """Ends spin_once(). Can be called in any thread."""
        self._executor.wake()

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self.polled.destroy_node()
        self.context.try_shutdown()
