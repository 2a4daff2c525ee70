"""The Python package of ur_simulator: a wheel with the built program, its command, its fixture and the examples of its README.

The wheel packages the program of the build tree, so that nothing is compiled. `pip install ./ur_simulator` compiles it again with
fmt and the C++ library inside (ur_simulator/cmake/wheel.cmake).
"""

import os
import re
import shutil
import subprocess
import sys
import zipfile

import pytest
from ur_tools.environment import program, run_environment
from ur_tools.layout import ROOT, SANITIZERS, Layout

BACKGROUND = True
LAYOUT = Layout.of_environment()
pytestmark = pytest.mark.skipif(LAYOUT.variant in SANITIZERS, reason="programs of others do not load the sanitizer")
SOURCE = ROOT / "ur_simulator"
README = (SOURCE / "README.md").read_text()
ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.204")


def run(*command, cwd, env, timeout=300):
    result = subprocess.run([str(part) for part in command], cwd=cwd, env=env, capture_output=True, text=True, timeout=timeout)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def examples(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.S)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    # The folder of the sources must stay clean: pip builds in it.
    sources = folder / "ur_simulator"
    shutil.copytree(SOURCE, sources, ignore=shutil.ignore_patterns("src", "test", "include"))
    setting = f"cmake.define.UR_SIMULATOR_PROGRAM={program(LAYOUT, 'ur_simulator', 'ur_simulator')}"
    run(LAYOUT.python, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "--disable-pip-version-check",
        "--config-settings", setting, "--wheel-dir", folder, sources, cwd=folder, env=run_environment(LAYOUT))
    (found,) = folder.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The environment in which the wheel is installed."""
    folder = tmp_path_factory.mktemp("installed")
    env = run_environment(LAYOUT)
    run(LAYOUT.python, "-m", "pip", "install", "--no-deps", "--no-index", "--disable-pip-version-check", "--target", folder, wheel,
        cwd=folder, env=env)
    env["PYTHONPATH"] = os.pathsep.join([str(folder), env.get("PYTHONPATH", "")])
    env["PATH"] = os.pathsep.join([str(folder / "bin"), env["PATH"]])
    return env


def test_the_wheel_can_be_published(wheel):
    assert re.fullmatch(r"ur_simulator-[\d.]+-py3-none-linux_\w+\.whl", wheel.name)
    assert wheel.stat().st_size < 10e6
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(next(name for name in names if name.endswith("METADATA"))).decode()
    assert "License-Expression: Apache-2.0" in metadata
    assert "# ur-simulator" in metadata  # the description is the README
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert "ur_simulator/bin/ur_simulator" in names
    assert not [name for name in names if name.endswith((".hpp", ".a", ".so"))]
    assert (SOURCE / "LICENSE").read_text() == (ROOT / "LICENSE").read_text()


def test_the_command_starts_the_program(installed, tmp_path):
    assert "--model" in run("ur-simulator", "--help", cwd=tmp_path, env=installed)
    failed = subprocess.run(["ur-simulator", "--model", "ur99"], cwd=tmp_path, env=installed, capture_output=True, text=True)
    assert failed.returncode == 1 and "ur99" in failed.stderr


def test_the_examples_in_python_run(installed, tmp_path):
    tests = [example for example in examples("python") if "def test_" in example]
    scripts = [example for example in examples("python") if "def test_" not in example]
    assert len(tests) == 1 and len(scripts) == 1
    (tmp_path / "test_example.py").write_text(tests[0] + SELECTED_ROBOT)
    assert "3 passed" in run(sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_example.py", cwd=tmp_path,
                             env=installed)
    (tmp_path / "example.py").write_text(scripts[0])
    assert "reached" in run(sys.executable, "example.py", cwd=tmp_path, env=installed)


SELECTED_ROBOT = '''

import pytest
from ur_simulator import SimulatedRobot, SimulatorError


@pytest.mark.ur_robot(model="ur5", polyscope="3.15", options=["--powered-off"])
def test_marker_selects_the_robot(ur_robot):
    assert ur_robot.state()["robot_mode"] == "POWER_OFF"
    with socket.create_connection((ur_robot.address, 29999)) as client, client.makefile("rw") as lines:
        lines.readline()
        lines.write("get robot model\\n")
        lines.flush()
        assert lines.readline() == "UR5\\n"


def test_errors_are_reported(ur_robot):
    with pytest.raises(SimulatorError, match="'fly' is not known"):
        ur_robot.control("fly")
    with pytest.raises(SimulatorError, match="ur99"):
        SimulatedRobot("ur99")
    with pytest.raises(SimulatorError, match="is in use"):
        SimulatedRobot(address=ur_robot.address)
    ur_robot.control("protective_stop")
    assert ur_robot.wait_for(lambda state: state["safety_mode"] == "PROTECTIVE_STOP")
    with pytest.raises(TimeoutError):
        ur_robot.wait_for(lambda state: False, timeout=0.1)
'''


def test_the_example_with_ur_rtde_runs(installed, tmp_path):
    (example,) = examples("cpp")
    (tmp_path / "example.cpp").write_text(example.replace("127.0.0.1", ADDRESS))
    prefix = LAYOUT.install
    headers = prefix / "include" / "ur_rtde_vendor"
    (library,) = prefix.rglob("libur_rtde_vendor.so")
    run("g++", "-std=c++20", "-O0", "-DUR_RTDE_VENDOR", "-I", headers, "example.cpp", library, f"-Wl,-rpath,{library.parent}",
        "-lboost_system", "-lboost_thread", "-pthread", "-o", "example", cwd=tmp_path, env=installed)
    with subprocess.Popen(["ur-simulator", "--address", ADDRESS], env=installed, stdout=subprocess.PIPE, text=True) as simulator:
        try:
            assert simulator.stdout.readline().startswith("ready: ")
            run(tmp_path / "example", cwd=tmp_path, env=installed)
        finally:
            simulator.terminate()
