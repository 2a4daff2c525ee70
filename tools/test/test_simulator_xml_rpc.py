"""rpc_factory() of a program on the simulator, with the XML-RPC server of Python."""

import contextlib
import json
import os
import socket
import subprocess
import threading
import xmlrpc.server

import pytest
from ur_tools.environment import program, run_environment
from ur_tools.layout import Layout

BACKGROUND = True
LAYOUT = Layout.of_environment()
ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.206")


class Camera:
    """Functions that programs call, as in the example of the script manual."""

    def __init__(self):
        self.received = []
        self.release = threading.Event()

    def initialize(self, *arguments):
        self.received.append(arguments)
        return True

    def getTarget(self):
        return {"x": 0.5, "y": -0.25, "z": 0.75, "rx": 0.0, "ry": 3.0, "rz": 0.0}

    def getPoints(self):
        return [[1, 2], [3, 4]]

    def wait(self):
        self.release.wait(30.0)
        return "late"


@contextlib.contextmanager
def serving(camera):
    with xmlrpc.server.SimpleXMLRPCServer((ADDRESS, 0), logRequests=False, allow_none=True) as server:
        server.register_instance(camera)
        thread = threading.Thread(target=server.serve_forever, args=(0.05,))
        thread.start()
        try:
            yield server.server_address[1]
        finally:
            camera.release.set()
            server.shutdown()
            thread.join()


@pytest.fixture
def robot():
    with subprocess.Popen([program(LAYOUT, "ur_simulator", "ur_simulator"), "--address", ADDRESS], env=run_environment(LAYOUT),
                          stdout=subprocess.PIPE, text=True) as process:
        process.stdout.readline()
        try:
            yield
        finally:
            process.terminate()


def control(**request):
    with socket.create_connection((ADDRESS, 30099), timeout=10.0) as connection, connection.makefile("rw") as lines:
        lines.write(json.dumps(request) + "\n")
        lines.flush()
        return json.loads(lines.readline())


def run(script):
    assert control(command="run_script", script=script)["ok"]


def wait_for_log(text, limit=20.0):
    """Waits in the robot's time."""
    end = control(command="state")["state"]["timestamp"] + limit
    while control(command="state")["state"]["timestamp"] < end:
        texts = [entry["text"] for entry in control(command="log")["entries"]]
        if any(text in line for line in texts):
            return
    raise AssertionError(f"not in the log: {text}\n" + "\n".join(texts))


def test_a_program_calls_functions_of_a_server(robot):
    camera = Camera()
    with serving(camera) as port:
        run(f'''def take():
  camera = rpc_factory("xmlrpc", "http://{ADDRESS}:{port}/RPC2")
  if (! camera.initialize("RGB", True, 3, 0.5, p[1, 2, 3, 0, 0, 0], [1, "a"])):
    popup("Camera was not initialized")
  end
  target = camera.getTarget()
  textmsg("target ", pose_trans(target, p[0, 0, 0, 0, 0, 0]))
  points = camera.getPoints()
  textmsg("element ", points[1, 0])
  camera.closeXMLRPCClientConnection()
  textmsg("again ", camera.initialize())
end
''')
        wait_for_log("again True")
        wait_for_log("target p[0.5,-0.25,0.75,0,3,0]")
        wait_for_log("element 3")
    pose = {"x": 1.0, "y": 2.0, "z": 3.0, "rx": 0.0, "ry": 0.0, "rz": 0.0}
    assert camera.received == [("RGB", True, 3, 0.5, pose, [1, "a"]), ()]


def test_an_unknown_function_ends_the_program(robot):
    with serving(Camera()) as port:
        run(f'def p():\n  rpc = rpc_factory("xmlrpc", "http://{ADDRESS}:{port}")\n  rpc.missing(1)\n  textmsg("not reached")\nend\n')
        wait_for_log("missing")
    wait_for_log("fault")
    assert control(command="state")["state"]["program"]["state"] == "STOPPED"


def test_a_server_that_cannot_be_reached_ends_the_program(robot):
    invalid = ("https://localhost/", "http://:80/", "http://host:99999/", "nonsense")
    for url, reason in ((f"http://{ADDRESS}:1/RPC2", "Connection refused"),
                        *((url, f'url must be http://host:port/path, is "{url}"') for url in invalid)):
        run(f'def p():\n  rpc = rpc_factory("xmlrpc", "{url}")\n  rpc.f()\nend\n')
        wait_for_log(reason)


def test_stopping_the_program_cancels_a_call(robot):
    with serving(Camera()) as port:
        run(f'def p():\n  rpc = rpc_factory("xmlrpc", "http://{ADDRESS}:{port}")\n  textmsg("calling")\n  rpc.wait()\nend\n')
        wait_for_log("calling")
        assert control(command="stop_program")["ok"]
        run("def next():\n  textmsg(\"next runs\")\nend\n")
        wait_for_log("next runs")


def test_the_robot_keeps_its_cycle_while_a_call_waits(robot):
    with serving(Camera()) as port:
        run('def p():\n'
            '  thread count():\n    i = 0\n    while i < 100:\n      i = i + 1\n      sync()\n    end\n    textmsg("counted")\n  end\n'
            f'  h = run count()\n  rpc = rpc_factory("xmlrpc", "http://{ADDRESS}:{port}")\n  rpc.wait()\nend\n')
        wait_for_log("counted")
