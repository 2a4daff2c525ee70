"""A TCP connection with time limits."""

import socket
import time


class ConnectionFailure(Exception):
    """The controller does not answer as its protocol demands. The text states what is missing."""


class Connection:
    """A connection whose waits end at a common limit for each message."""

    def __init__(self, address: str, port: int, limit: float):
        self._limit = limit
        self._received = b""
        try:
            self.socket = socket.create_connection((address, port), limit)
        except UnicodeError:  # "192.168.56..101"
            raise ConnectionFailure(f"{address} is no address") from None
        except OSError as error:
            raise ConnectionFailure(f"port {port}: {error.strerror or 'no answer'}") from None
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._port = port

    def __enter__(self) -> "Connection":
        return self

    def __exit__(self, *_unused: object) -> None:
        self.socket.close()

    def send(self, data: bytes) -> None:
        try:
            self.socket.sendall(data)
        except OSError as error:
            raise ConnectionFailure(f"port {self._port}: {error.strerror}") from None

    def read(self, size: int) -> bytes:
        """Returns exactly `size` bytes."""
        deadline = time.monotonic() + self._limit
        while len(self._received) < size:
            self._receive(deadline)
        data, self._received = self._received[:size], self._received[size:]
        return data

    def read_line(self) -> str:
        deadline = time.monotonic() + self._limit
        while b"\n" not in self._received:
            self._receive(deadline)
        line, _, self._received = self._received.partition(b"\n")
        return line.decode(errors="replace").strip()

    def take_received(self) -> bytes:
        """Returns data that has been received but not read."""
        data, self._received = self._received, b""
        return data

    def put_back(self, data: bytes) -> None:
        """Makes the next read return this data, which was received directly from the socket, first."""
        self._received = data + self._received

    def _receive(self, deadline: float) -> None:
        left = deadline - time.monotonic()
        try:
            if left <= 0.0:
                raise TimeoutError
            self.socket.settimeout(left)
            data = self.socket.recv(65536)
        except (TimeoutError, socket.timeout):
            raise ConnectionFailure(f"port {self._port}: no answer within {self._limit:g} s") from None
        except OSError as error:
            raise ConnectionFailure(f"port {self._port}: {error.strerror}") from None
        if not data:
            raise ConnectionFailure(f"port {self._port}: the controller has closed the connection")
        self._received += data
