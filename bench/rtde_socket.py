"""Receives RTDE packages with nothing but a socket: the lower bound of the latency of any driver."""

import socket
import struct
import time

PORT = 30004
REQUEST_PROTOCOL, SETUP_OUTPUTS, START, DATA = ord("V"), ord("O"), ord("S"), ord("U")
HEADER = struct.Struct(">HB")


def _exchange(connection, kind, payload):
    connection.sendall(HEADER.pack(HEADER.size + len(payload), kind) + payload)
    while True:
        received, _ = _receive(connection)
        if received == kind:
            return


def _receive(connection):
    """Returns the type of the next package, and the time in ns at which its first bytes were read."""
    head = _read(connection, HEADER.size)
    when = time.time_ns()
    size, kind = HEADER.unpack(head)
    _read(connection, size - HEADER.size)
    return kind, when


def _read(connection, size):
    data = b""
    while len(data) < size:
        part = connection.recv(size - len(data))
        if not part:
            raise SystemExit("bench: the simulator closed the RTDE connection")
        data += part
    return data


def receive_from_socket(address, seconds):
    """Returns the times in ns at which packages with one variable were received."""
    with socket.create_connection((address, PORT), timeout=5.0) as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        _exchange(connection, REQUEST_PROTOCOL, struct.pack(">H", 2))
        _exchange(connection, SETUP_OUTPUTS, struct.pack(">d", 500.0) + b"timestamp")
        _exchange(connection, START, b"")
        times, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            kind, when = _receive(connection)
            if kind == DATA:
                times.append(when)
        return times
