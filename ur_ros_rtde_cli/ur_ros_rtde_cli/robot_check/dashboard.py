"""Queries of the dashboard server."""

from .connection import Connection, ConnectionFailure

PORT = 29999


class Dashboard:
    """A connection to the dashboard server. Only commands that change nothing are sent."""

    QUERIES = ("PolyscopeVersion", "get robot model", "get serial number", "robotmode", "safetystatus", "safetymode",
               "is in remote control", "programState", "get loaded program", "get operational mode")

    def __init__(self, address: str, limit: float):
        self._connection = Connection(address, PORT, limit)
        greeting = self._connection.read_line()
        if "Dashboard Server" not in greeting:
            raise ConnectionFailure(f"port {PORT}: greets with {greeting[:60]!r}, not as a dashboard server")

    def __enter__(self) -> "Dashboard":
        return self

    def __exit__(self, *_unused: object) -> None:
        self._connection.__exit__()

    def query(self, command: str) -> str:
        """Returns the answer without its title: "Robotmode: RUNNING" becomes "RUNNING". Empty if the command is unknown."""
        assert command in self.QUERIES, command
        self._connection.send(command.encode() + b"\n")
        answer = self._connection.read_line()
        if answer.lower().startswith("could not understand"):
            return ""
        return answer.partition(": ")[2] or answer
