"""Command line and page server: valid and invalid input."""

import argparse
import contextlib
import socket
import urllib.request

import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from ur_ros_rtde_viewer.arguments import RobotOptions, add_arguments, robots
from ur_ros_rtde_viewer.errors import ViewerError
from ur_ros_rtde_viewer.page.origin import is_accepted
from ur_ros_rtde_viewer.page.server import start_server, stop_server, url
from ur_ros_rtde_viewer.program import main
from ur_ros_rtde_viewer.simulator import may_be_simulator, read_surfaces


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


@pytest.mark.parametrize("arguments, message", [
    (["--robot", "left,modl=ur5e"], "modl=ur5e"),
    (["--robot", "left,x=near"], 'x is "near"'),
    (["--robot", "left,x=nan"], "finite"),
    (["--port", "http"], "expected a port"),
    (["--port", "70000"], "expected a port"),
    (["--rate", "0"], "1 to 60"),
])
def test_wrong_arguments_are_refused_with_the_value(arguments, message, capsys):
    with pytest.raises(SystemExit):
        parse(*arguments)
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("arguments, message", [
    (["--robot", "a", "--robot", "a"], "2 times"),
    (["--robot", "a", "--model", "ur5e"], "--robot replaces"),
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
    ("127.0.0.1:8080", "http://example.com", False),
    ("127.0.0.1:8080", "http://127.0.0.1:9999", False),
    ("127.0.0.1:8080", "null", False),
    ("example.com:8080", "http://example.com:8080", False),  # a name that resolves to this machine
    (None, None, False),
])
def test_only_pages_of_the_server_are_accepted(host, origin, accepted):
    assert is_accepted(host, origin) == accepted


def test_another_web_site_cannot_connect(server):
    address = url(server).replace("http", "ws")
    own = {"subprotocols": [f"viser-v{viser.__version__}"], "open_timeout": 60, "max_size": None}
    with connect(address, origin=url(server), **own) as connection:
        assert connection.recv(timeout=60)
    with pytest.raises(InvalidStatus) as refusal:
        connect(address, origin="http://example.com", **own)
    assert refusal.value.response.status_code == 403


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
