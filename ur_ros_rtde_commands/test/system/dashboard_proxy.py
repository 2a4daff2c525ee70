"""A robot whose dashboard server is behind a proxy, which delays or changes requests and answers."""

import contextlib
import socket
import socketserver
import threading

import robot_fixtures
from programs import Simulator, start_node
from ros_client import Client

DASHBOARD_PORT = 29999
PORT_BEHIND = 29998  # of the simulator's dashboard server


class PassesOn(socketserver.StreamRequestHandler):
    """Passes everything on to the dashboard server of the simulator."""

    def handle(self):
        with socket.create_connection((self.server.server_address[0], PORT_BEHIND)) as self.behind, \
                self.behind.makefile("rb") as self.answers:
            self.wfile.write(self.answers.readline())
            for line in self.rfile:
                self.wfile.write(self.answer(line))

    def answer(self, line):
        self.behind.sendall(line)
        return self.answers.readline()


class DashboardProxy(socketserver.ThreadingTCPServer):
    allow_reuse_address = True
    daemon_threads = True


@contextlib.contextmanager
def robot_behind(handler, addresses, processes, namespace, *parameters):
    """Yields a client of a driver that is ready, and its simulator. `handler` passes on what the driver sends to the dashboard server."""
    simulator = processes(Simulator(addresses[1], "--ports", f"dashboard={PORT_BEHIND}"))
    with DashboardProxy((addresses[1], DASHBOARD_PORT), handler) as proxy:
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        driver = processes(start_node("driver", addresses[1], "ur_type:=ur10e", *parameters, namespace=namespace))
        client = Client(namespace)
        try:
            robot_fixtures.make_ready(client)
            yield client, simulator
        finally:
            client.close()
            driver.stop()
            proxy.shutdown()
