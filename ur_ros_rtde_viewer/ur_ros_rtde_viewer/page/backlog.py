"""Messages for a browser that connects, in bounded time.

viser numbers the messages of a page and keeps the newest one of each element. For a browser that connects, it looks up every number
since the start of the server, and nothing else runs in its event loop meanwhile: STOP in another tab would wait. Here, the numbers of
each connection begin with the messages that are kept.
"""

from typing import Any, Optional

from viser.infra._async_message_buffer import AsyncMessageBuffer


class _Numbers:
    """Numbers of one connection: first those of the kept messages, without gaps, then those of new messages."""

    def __init__(self, buffer: AsyncMessageBuffer):
        with buffer.buffer_lock:
            self._kept = tuple(buffer.message_from_id)  # ascending
            self._first_new = buffer.message_counter

    def of_server(self, number: int) -> int:
        if number < 0:
            return number
        return self._kept[number] if number < len(self._kept) else self._first_new + number - len(self._kept)

    def count(self, of_server: int) -> int:
        """Returns how many numbers the connection has, if the server has `of_server`."""
        return len(self._kept) + of_server - self._first_new


class _Messages:
    def __init__(self, buffer: AsyncMessageBuffer, numbers: _Numbers):
        self._buffer, self._numbers = buffer, numbers

    def get(self, number: int, default: Any) -> Any:
        return self._buffer.message_from_id.get(self._numbers.of_server(number), default)


class _Cursors:
    """The last number that each connection has received. viser's garbage collector uses the numbers of the server."""

    def __init__(self, buffer: AsyncMessageBuffer, numbers: _Numbers):
        self._buffer, self._numbers = buffer, numbers

    def __setitem__(self, client_id: int, number: int) -> None:
        self._buffer.generator_cursors[client_id] = self._numbers.of_server(number)

    def pop(self, client_id: int, default: Any) -> Any:
        return self._buffer.generator_cursors.pop(client_id, default)


class _ConnectionView:
    """The buffer as the generator of one connection uses it."""

    window_generator = AsyncMessageBuffer.window_generator
    _window_loop = AsyncMessageBuffer._window_loop

    def __init__(self, buffer: AsyncMessageBuffer):
        self._buffer, self._numbers = buffer, _Numbers(buffer)
        self.message_from_id, self.generator_cursors = _Messages(buffer, self._numbers), _Cursors(buffer, self._numbers)

    @property
    def message_counter(self) -> int:
        return self._numbers.count(self._buffer.message_counter)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._buffer, name)


def bound_backlog(server: Any) -> None:
    """Lets a connection cost as much as the messages that are kept, however long the server has run. Called before the first one."""
    buffer: AsyncMessageBuffer = server._websock_server._broadcast_buffer

    def window_generator(client_id: int, backlog_done_message: Optional[Any] = None) -> Any:
        return _ConnectionView(buffer).window_generator(client_id, backlog_done_message)

    buffer.window_generator = window_generator
