"""Command line and page server: valid and invalid input."""

import argparse
import base64
import contextlib
import os
import socket
import subprocess
import urllib.error
import urllib.request

import msgspec
import pytest
import viser
import zstandard
from programs import find_program
from support import TIMEOUT_FACTOR, wait_for
from ur_ros_rtde_viewer.arguments import RobotOptions, add_arguments, robots
from ur_ros_rtde_viewer.errors import ViewerError
from ur_ros_rtde_viewer.page import origin
from ur_ros_rtde_viewer.page.origin import is_accepted
from ur_ros_rtde_viewer.page.server import new_token, start_server, stop_server, url
from ur_ros_rtde_viewer.program import main
from ur_ros_rtde_viewer.simulator import may_be_simulator, read_surfaces
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

A_DAY = 25_000_000  # messages, at 280 per second


def parse(*arguments):
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return parser.parse_args(arguments)


def test_one_robot_without_a_namespace_is_the_default():
    assert robots(parse()) == (RobotOptions(),)
    assert robots(parse("--namespace", "/left/", "--model", "ur5e")) == (RobotOptions("left", "ur5e"),)
    assert parse().address == "127.0.0.1"


def test_robots_have_models_and_poses():
    left, right = robots(parse("--robot", "left,model=ur5e,y=0.4,yaw=1.57", "--robot", "right"))
    assert left == RobotOptions("left", "ur5e", (0.0, 0.4, 0.0), (0.0, 0.0, 1.57)) and right == RobotOptions("right")
    tooled, = robots(parse("--robot", "left,kinematics_params_file=left.yaml,tool_length=0.2"))
    assert tooled == RobotOptions("left", kinematics_params_file="left.yaml", tool_length=0.2)
    assert robots(parse("--tool", "gripper.urdf"))[0].tool == "gripper.urdf"


def test_a_tool_with_an_invalid_shape_is_rejected(tmp_path, capfd):
    tool = tmp_path / "gripper.urdf"
    tool.write_text('<robot name="g"><link name="palm"><visual><geometry><sphere radius="big"/></geometry></visual></link></robot>')
    assert main(["--port", "0", "--model", "ur5e", "--tool", str(tool)]) == 2
    assert "link palm: a visual element has a value" in capfd.readouterr().err


@pytest.mark.parametrize("arguments", [["--help"], ["--port", "0"]], ids=" ".join)
def test_an_output_that_cannot_be_written_is_reported(arguments):
    with open("/dev/full", "w") as full:
        ended = subprocess.run([find_program("ur_ros_rtde_viewer", "view"), *arguments], stdout=full, stderr=subprocess.PIPE, text=True,
                               timeout=TIMEOUT_FACTOR * 60.0)
    assert ended.returncode == 1 and "the output cannot be written: No space left on device" in ended.stderr, ended.stderr
    assert "Traceback" not in ended.stderr and "Exception" not in ended.stderr


@pytest.mark.parametrize("arguments, message", [
    (["--robot", "left,modl=ur5e"], "modl=ur5e"),
    (["--robot", "left,x=near"], 'x is "near"'),
    (["--robot", "left,x=nan"], "finite"),
    (["--port", "http"], "expected a port"),
    (["--port", "70000"], "expected a port"),
    (["--rate", "0"], "1 to 60"),
    (["--token", ""], "8 or more letters"),
    (["--namespace", "my-robot"], '"my-robot" is no namespace'),
    (["--robot", "1left"], '"1left" is no namespace'),
])
def test_wrong_arguments_are_rejected_with_the_value(arguments, message, capsys):
    with pytest.raises(SystemExit):
        parse(*arguments)
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("arguments, message", [
    (["--robot", "a", "--robot", "a"], "2 times"),
    (["--robot", "a", "--model", "ur5e"], "--robot replaces --model: write --robot NAMESPACE,model=ur5e"),
    (["--robot", "a", "--tool-length", "0.2"], "write --robot NAMESPACE,tool_length=0.2"),
    (["--model", "ur5e", "--tool", "missing.urdf"], "missing.urdf"),
    (["--model", "ur5e", "--tool-length", "-1"], "tool_length is -1"),
    (["--model", "ur5e", "--kinematics-params-file", "missing.yaml"], "missing.yaml"),
    (["--model", "ur99"], "ur99"),
    (["--address", "localhost"], "expected an IP address"),
    (["--address", "192.0.2.1"], "192.0.2.1"),
    (["--plan", "missing.json", "--model", "ur5e"], "missing.json"),
])
def test_the_program_ends_with_2_and_the_reason(arguments, message, capfd):
    assert main(["--port", "0", *arguments]) == 2
    assert message in capfd.readouterr().err


def test_a_port_in_use_is_named_with_the_remedy(capfd):
    with contextlib.closing(socket.create_server(("127.0.0.1", 0))) as other:
        port = other.getsockname()[1]
        assert main(["--port", str(port)]) == 2
    assert f"127.0.0.1:{port}" in (message := capfd.readouterr().err) and "--port 0" in message


def test_the_page_is_served_and_never_shared_on_the_internet(server):
    with urllib.request.urlopen(url(server), timeout=30) as page:
        assert b"<html" in page.read()
    assert server.request_share_url() is None


@pytest.mark.parametrize("host, origin, accepted", [
    ("127.0.0.1:8080", "http://127.0.0.1:8080", True),
    ("localhost:9000", "http://localhost:9000", True),  # a forwarded port
    ("[::1]:8080", "http://[::1]:8080", True),
    ("192.168.0.5:8080", None, True),  # no browser
    (f"{socket.gethostname().partition('.')[0]}.local:8080", None, True),
    ("127.0.0.1:8080", "http://example.com", False),
    ("127.0.0.1:8080", "http://127.0.0.1:9999", False),
    ("127.0.0.1:8080", "null", False),
    ("example.com:8080", "http://example.com:8080", False),  # a name that resolves to this machine
    ("127.0.0.1:99999", None, False),
    ("[::1", None, False),
    (None, None, False),
])
def test_only_pages_of_the_server_are_accepted(host, origin, accepted):
    assert is_accepted(host, origin) == accepted


def test_another_web_site_cannot_connect(server):
    address = url(server).replace("http", "ws")
    own = {"subprotocols": [f"viser-v{viser.__version__}"], "open_timeout": 60, "max_size": None}
    with connect(address, origin=url(server), **own) as connection:
        assert connection.recv(timeout=60)
    with pytest.raises(InvalidStatus) as rejection:
        connect(address, origin="http://example.com", **own)
    assert rejection.value.response.status_code == 403


OWN = {"subprotocols": [f"viser-v{viser.__version__}"], "open_timeout": 60, "max_size": None}


def connect_without_reading(port):
    """Returns a connection over which nothing is received once its small buffer is full."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.connect(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    headers = (f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade", f"Sec-WebSocket-Key: {key}",
               "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Protocol: viser-v{viser.__version__}")
    connection.sendall("\r\n".join(("GET / HTTP/1.1", *headers, "", "")).encode())
    assert b" 101 " in connection.recv(100)
    return connection


def test_a_connection_over_which_nothing_is_received_is_ended(monkeypatch):
    monkeypatch.setattr(origin, "LOSS_TIMEOUT", 3.0)
    server = start_server("127.0.0.1", 0)
    connections = server._websock_server._live_connections
    for _ in range(20):
        server.gui.add_markdown(os.urandom(300_000).hex())  # more than the buffers of the system
    try:
        with connect(url(server).replace("http", "ws"), origin=url(server), **OWN) as reading, \
             contextlib.closing(connect_without_reading(server.get_port())):
            wait_for(lambda: len(connections) == 2, 10.0, "both connections")
            received = 0
            while received < 5_000_000:
                received += len(reading.recv(timeout=60))
            wait_for(lambda: len(connections) < 2, 30.0, "the end of the connection")
            assert list(connections) == [0]
    finally:
        stop_server(server)


def test_each_connection_has_something_to_confirm(server):
    with connect(url(server).replace("http", "ws"), origin=url(server), **OWN):
        connections = server._websock_server._live_connections
        wait_for(lambda: connections, 10.0, "the connection")
        connection, = connections.values()
        timeout = connection.transport.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT)
        assert (connection.ping_interval, timeout) == (origin.PING_INTERVAL, 1e3 * origin.LOSS_TIMEOUT)
        assert connection.ping_timeout > origin.LOSS_TIMEOUT


def test_a_page_on_the_network_needs_its_token():
    assert new_token("127.0.0.1") == new_token("::1") == ""
    token = new_token("0.0.0.0")
    assert len(token) >= 16 and token != new_token("0.0.0.0")
    server = start_server("127.0.0.1", 0, token)
    try:
        plain, own = url(server), {"subprotocols": [f"viser-v{viser.__version__}"], "open_timeout": 60, "max_size": None}
        for path in ("/", "/?token=other", "/index.html"):
            with pytest.raises(urllib.error.HTTPError) as rejection:
                urllib.request.urlopen(plain + path)
            assert rejection.value.code == 403 and "?token=" in rejection.value.read().decode()
        with pytest.raises(InvalidStatus):
            connect(plain.replace("http", "ws"), origin=plain, **own)
        with urllib.request.urlopen(url(server, token)) as answer:
            cookie = answer.headers["Set-Cookie"].partition(";")[0]
        with connect(plain.replace("http", "ws"), origin=plain, additional_headers={"Cookie": cookie}, **own) as connection:
            assert connection.recv(timeout=60)
    finally:
        stop_server(server)


def names(window):
    """Returns the names of the new frames in a window as viser encodes it."""
    size = int.from_bytes(window[8:16], "little")
    messages = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(window[16:16 + size]))["messages"]
    return [message["name"] for message in messages if message["type"] == "FrameMessage"]


class CountingDict(dict):
    lookups = 0

    def get(self, *arguments):
        self.lookups += 1
        return super().get(*arguments)


def test_a_connection_after_a_day_costs_the_messages_that_are_kept(server):
    buffer = server._websock_server._broadcast_buffer
    server.scene.add_frame("/before")
    buffer.message_counter = A_DAY
    server.scene.add_frame("/newest")
    buffer.message_from_id = counting = CountingDict(buffer.message_from_id)
    received = []
    own = {"subprotocols": [f"viser-v{viser.__version__}"], "open_timeout": 60, "max_size": None}
    with connect(url(server).replace("http", "ws"), origin=url(server), **own) as connection:
        while "/newest" not in received:
            received += names(connection.recv(timeout=60))
        server.scene.add_frame("/live")
        while "/live" not in received:
            received += names(connection.recv(timeout=60))
        cursor, = buffer.generator_cursors.values()
        assert cursor >= A_DAY  # viser's garbage collector compares it with numbers of the server
    assert [received.count(name) for name in ("/before", "/newest", "/live")] == [1, 1, 1]
    assert counting.lookups < 2 * len(counting) + 100


def test_another_version_of_viser_is_named_with_the_remedy(monkeypatch, capfd):
    monkeypatch.setattr(viser, "__version__", "2.0.0")
    assert main(["--port", "0"]) == 2
    assert "viser 2.0.0 is installed" in (message := capfd.readouterr().err) and "pip install viser==" in message


@pytest.mark.parametrize("dark", [False, True])
def test_the_page_is_dark_on_request(dark):
    server = start_server("127.0.0.1", 0, dark=dark)
    messages = server._websock_server._broadcast_buffer.message_from_id.values()
    assert [message.dark_mode for message in messages if hasattr(message, "dark_mode")] == [dark]
    stop_server(server)


def test_a_stopped_server_releases_its_port():
    first = start_server("127.0.0.1", 0)
    port = first.get_port()
    with pytest.raises(ViewerError, match=str(port)):
        start_server("127.0.0.1", port)
    stop_server(first)
    stop_server(start_server("127.0.0.1", port))


def test_only_addresses_of_this_machine_are_asked_for_surfaces():
    assert may_be_simulator("127.0.0.2") and may_be_simulator("localhost")
    assert not may_be_simulator("192.168.0.10") and not may_be_simulator("robot")


def test_surfaces_are_read_from_the_answer_of_the_simulator():
    assert read_surfaces('{"ok": true, "state": {"surfaces": [{"id": 1, "point": [0, 0, 1], "normal": [0, 0, 1]}]}}') == (
        ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)),)
    with pytest.raises(KeyError):
        read_surfaces('{"ok": true, "state": {}}')
