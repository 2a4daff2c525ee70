"""Publishes messages at a fixed rate."""

import threading
import time

from rclpy.qos import QoSProfile
from support import wait_for


class Publisher(threading.Thread):
    """Publishes `message(t)`, where t is the time since the start in s, at a fixed rate until `duration` has passed or stop(). Publishes
    nothing where it is None."""

    def __init__(self, client, kind, topic, message, rate=50.0, duration=60.0):
        super().__init__(daemon=True)
        self._message, self._duration = message, duration
        self._period, self.times = 1.0 / rate, []  # times of publication in ns since the epoch
        self._publisher = client.node.create_publisher(kind, topic, QoSProfile(depth=1))
        self._stop_event = threading.Event()
        wait_for(lambda: self._publisher.get_subscription_count() > 0, 10.0, f"a subscription of {topic}")
        self.start()

    def run(self):
        begin = time.monotonic()
        number = 0
        while not self._stop_event.is_set() and (now := time.monotonic()) - begin < self._duration:
            number += 1
            if (message := self._message(now - begin)) is not None:
                self._publisher.publish(message)
                self.times.append(time.time_ns())
            self._stop_event.wait(max(0.0, begin + number * self._period - time.monotonic()))

    def stop(self):
        self._stop_event.set()
        self.join(5.0)
        return time.time()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
