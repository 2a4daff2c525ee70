"""A connection to the page that can freeze, as one whose other host has lost its power: nothing arrives, and nothing is closed."""

import contextlib
import socket
import threading


class FreezingProxy:
    """Forwards connections to a port of this machine while `to_server` and `to_browser` are set."""

    def __init__(self, port):
        self.to_server, self.to_browser = threading.Event(), threading.Event()
        self.thaw()
        self._target = ("127.0.0.1", port)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._start(self._accept)

    @staticmethod
    def _start(function, *arguments):
        threading.Thread(target=function, args=arguments, daemon=True).start()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                browser, _ = self._listener.accept()
                server = socket.create_connection(self._target)
                self._start(self._forward, browser, server, self.to_server)
                self._start(self._forward, server, browser, self.to_browser)

    @staticmethod
    def _forward(source, target, flows):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                flows.wait()
                target.sendall(data)
        with contextlib.suppress(OSError):
            target.shutdown(socket.SHUT_WR)

    def freeze(self):
        self.to_server.clear()
        self.to_browser.clear()

    def thaw(self):
        self.to_server.set()
        self.to_browser.set()

    def close(self):
        self.thaw()
        self._listener.close()
