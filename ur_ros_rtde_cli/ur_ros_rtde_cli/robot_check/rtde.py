"""The part of RTDE (protocol version 2) that the checks need (Universal Robots, "RTDE Guide")."""

import struct
from typing import Any, Dict, List, Sequence, Tuple

from .connection import Connection, ConnectionFailure

PORT = 30004
_HEADER = struct.Struct(">HB")
_FORMATS = {"BOOL": "?", "UINT8": "B", "UINT32": "I", "UINT64": "Q", "INT32": "i", "DOUBLE": "d", "VECTOR3D": "3d", "VECTOR6D": "6d",
            "VECTOR6INT32": "6i", "VECTOR6UINT32": "6I"}
_TEXT, _DATA = ord("M"), ord("U")


class Rtde:
    """A connection that reads outputs, and asks which inputs are free. It never sends a value for an input."""

    def __init__(self, address: str, limit: float):
        self.connection = Connection(address, PORT, limit)
        self._fields: List[str] = []
        self._sizes: List[int] = []
        self._format = struct.Struct(">")
        if self._request("V", struct.pack(">H", 2)) != b"\x01":
            raise ConnectionFailure(f"port {PORT}: rejects version 2 of the protocol, which PolyScope has had since 3.3")

    def __enter__(self) -> "Rtde":
        return self

    def __exit__(self, *_unused: object) -> None:
        self.connection.__exit__()

    def version(self) -> Tuple[int, int, int, int]:
        """Returns the version of the controller: major, minor, bugfix, build."""
        answer = self._request("v")
        if len(answer) < 16:
            raise ConnectionFailure(f"port {PORT}: its answer contains no version")
        return struct.unpack(">4I", answer[:16])

    def input_types(self, names: Sequence[str]) -> Dict[str, str]:
        """Returns the type of each input: NOT_FOUND, IN_USE if another client has it.

        If all of them are free, this connection holds them until it is closed.
        """
        answer = self._request("I", ",".join(names).encode())
        return dict(zip(names, answer[1:].decode(errors="replace").split(",")))

    def set_outputs(self, names: Sequence[str], frequency: float) -> List[str]:
        """Selects the outputs that the controller knows and returns their names."""
        answer = self._request("O", struct.pack(">d", frequency) + ",".join(names).encode())
        types = answer[1:].decode(errors="replace").split(",")
        known = [name for name, kind in zip(names, types) if kind in _FORMATS]
        if len(known) < len(names):
            return self.set_outputs(known, frequency)
        self._fields = known
        self._sizes = [len(struct.unpack(f">{_FORMATS[kind]}", bytes(struct.calcsize(f">{_FORMATS[kind]}")))) for kind in types]
        self._format = struct.Struct(">" + "".join(_FORMATS[kind] for kind in types))
        return known

    def start(self) -> None:
        if self._request("S") != b"\x01":
            raise ConnectionFailure(f"port {PORT}: refuses to send data")

    def values(self) -> Dict[str, Any]:
        """Returns the outputs of the next data package."""
        while True:
            kind, body = self._package()
            if kind == _DATA:
                return self.decode(body)

    def decode(self, body: bytes) -> Dict[str, Any]:
        if len(body) != 1 + self._format.size:
            raise ConnectionFailure(f"port {PORT}: a data package has {len(body)} bytes, {1 + self._format.size} were expected")
        numbers = iter(self._format.unpack(body[1:]))
        return {name: next(numbers) if size == 1 else tuple(next(numbers) for _ in range(size))
                for name, size in zip(self._fields, self._sizes)}

    def _request(self, kind: str, body: bytes = b"") -> bytes:
        self.connection.send(_HEADER.pack(_HEADER.size + len(body), ord(kind)) + body)
        while True:
            found, answer = self._package()
            if found == ord(kind):
                return answer
            if found not in (_TEXT, _DATA):
                raise ConnectionFailure(f"port {PORT}: its answer is not the one of an RTDE server")

    def _package(self) -> Tuple[int, bytes]:
        size, kind = _HEADER.unpack(self.connection.read(_HEADER.size))
        if size < _HEADER.size:
            raise ConnectionFailure(f"port {PORT}: its answer is not an RTDE package")
        return kind, self.connection.read(size - _HEADER.size)
