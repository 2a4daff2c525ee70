"""A subscription that is polled: most messages of a 500 Hz topic are never converted to Python."""

from typing import Any, Optional

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class LatestTopic:
    """Keeps only the newest message, in the middleware. `node` must not be spun: an executor would take each message."""

    def __init__(self, node: Node, message_type: Any, topic: str):
        self._type = message_type
        self._node = node
        self._subscription = node.create_subscription(message_type, topic, lambda _message: None, NEWEST)

    def take(self) -> Optional[Any]:
        """Returns the newest message, or None if none has arrived since the last call."""
        with self._subscription.handle:
            taken = self._subscription.handle.take_message(self._type, False)
        return taken[0] if taken else None

    def close(self) -> None:
        self._node.destroy_subscription(self._subscription)
