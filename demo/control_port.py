"""Client of the simulator's control port: one JSON object per line, one answer per line (docs/use/simulator.md)."""

import json
import socket


class ControlPortError(RuntimeError):
    pass


class ControlPort:
    def __init__(self, address, port=30099, timeout=5.0):
        self._where = f"{address}:{port}"
        try:
            self._socket = socket.create_connection((address, port), timeout)
        except OSError as error:
            raise ControlPortError(f"no simulator answers at {self._where} ({error}): start one with ./ur sim") from error
        self._lines = self._socket.makefile("r", encoding="utf-8")

    def request(self, command, **fields):
        line = json.dumps({"command": command, **fields}) + "\n"
        self._socket.sendall(line.encode())
        answer = self._lines.readline()
        if not answer:
            raise ControlPortError(f"the simulator at {self._where} closed the connection after '{command}'")
        answer = json.loads(answer)
        if not answer.get("ok"):
            raise ControlPortError(f"the simulator rejected '{command}': {answer.get('error', answer)}")
        return answer

    def close(self):
        self._lines.close()
        self._socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
