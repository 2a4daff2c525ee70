"""Runs two programs on two hosts that a slow or lossy link connects: network namespaces and a forwarder between two TUN devices.

    slow_link.py --drop-every 50 --rate 10e6 -- SERVER ... -- CLIENT ...

The server has the address 10.0.0.1, the client 10.0.0.2. The output is the one of the client. The kernel's own emulation (tc netem)
is not available everywhere.
"""

import argparse
import collections
import ctypes
import fcntl
import os
import select
import struct
import subprocess
import sys
import time

CLONE_NEWNET = 0x40000000
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000


def make_host(address, peer):
    """Moves this process into a new network namespace and returns the descriptor of its only link."""
    if ctypes.CDLL(None, use_errno=True).unshare(CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "unshare: " + os.strerror(ctypes.get_errno()))
    tunnel = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tunnel, TUNSETIFF, struct.pack("16sH22x", b"tun0", IFF_TUN | IFF_NO_PI))
    for command in (f"ip address add {address} peer {peer} dev tun0", "ip link set tun0 up", "ip link set lo up"):
        subprocess.run(command.split(), check=True)
    return tunnel


class Direction:
    """Forwards packets from one end of the link to the other one."""

    def __init__(self, source, target, options):
        self.source, self._target, self._options = source, target, options
        self._queue = collections.deque()  # times of delivery and packets
        self._free_at = 0.0
        self._count = 0

    def receive(self):
        try:
            packet = os.read(self.source, 65536)
        except BlockingIOError:
            return
        self._count += 1
        if self._options.drop_every and self._count % self._options.drop_every == 0:
            return
        self._free_at = max(self._free_at, time.monotonic()) + (8.0 * len(packet) / self._options.rate if self._options.rate else 0.0)
        self._queue.append((self._free_at + self._options.delay, packet))

    def deliver(self):
        """Returns the time until the next delivery, None if there is none."""
        while self._queue and self._queue[0][0] <= time.monotonic():
            os.write(self._target, self._queue.popleft()[1])
        return max(0.0, self._queue[0][0] - time.monotonic()) if self._queue else None


def forward(directions, client):
    while client.poll() is None:
        waits = [wait for wait in (direction.deliver() for direction in directions) if wait is not None]
        readable, _, _ = select.select([direction.source for direction in directions], [], [], min([0.05, *waits]))
        for direction in directions:
            if direction.source in readable:
                direction.receive()


def main():
    arguments = sys.argv[1:]
    first = arguments.index("--")
    second = arguments.index("--", first + 1)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drop-every", type=int, default=0, help="drops every n-th packet of each direction")
    parser.add_argument("--rate", type=float, default=0.0, help="bit/s")
    parser.add_argument("--delay", type=float, default=0.0, help="s, of each direction")
    options = parser.parse_args(arguments[:first])
    robot = make_host("10.0.0.1", "10.0.0.2")
    server = subprocess.Popen(arguments[first + 1:second], stdout=subprocess.PIPE, text=True)
    assert server.stdout.readline().startswith("ready"), "the server has not started"
    try:
        host = make_host("10.0.0.2", "10.0.0.1")
        client = subprocess.Popen(arguments[second + 1:])
        forward([Direction(robot, host, options), Direction(host, robot, options)], client)
        return client.returncode
    finally:
        server.terminate()
        server.wait(10.0)


if __name__ == "__main__":
    sys.exit(main())
