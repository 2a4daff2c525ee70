"""What a test starts reaches no nodes of others (rcl_cxx/test/support/ros_domain.py) and does not outlive it."""

import contextlib
import os
import pathlib
import socket
import subprocess
import sys

import pytest
from ur_tools import isolation, runner
from ur_tools.isolation import ros_domain
from ur_tools.layout import ROOT, Layout

RTPS_PORTS = {"first participant": 10, "later participant": 24, "multicast": 0}
WITHOUT_DOMAIN = {name: value for name, value in os.environ.items() if name not in ("ROS_DOMAIN_ID", "UR_TEST_DOMAIN")}


def test_concurrent_domains_differ():
    with isolation.Domain() as first, isolation.Domain() as second:
        assert first.number != second.number and first.address != second.address
        assert 1 <= min(first.number, second.number) and max(first.number, second.number) <= ros_domain.LAST_DOMAIN


def test_does_not_reserve_a_domain_of_another_process():
    code = ("import sys; sys.path[:0] = %r\n"
            "from ur_tools.isolation import Domain\n"
            "with Domain() as domain:\n"
            "    print(domain.number, flush=True)\n"
            "    sys.stdin.readline()\n" % sys.path)
    other = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                             universal_newlines=True)
    taken = int(other.stdout.readline())
    with isolation.Domain() as domain:
        assert domain.number != taken
    other.communicate("\n", timeout=20.0)


@contextlib.contextmanager
def node(offset, family=socket.AF_INET):
    """Yields the highest free domain, in which a node like that of a driver runs: it binds a UDP port."""
    with isolation.Domain() as domain, socket.socket(family, socket.SOCK_DGRAM) as participant:
        participant.bind(("", 7400 + 250 * domain.number + offset))
        domain.close()
        yield domain.number


def domain_of_tools():
    with isolation.Domain() as domain:
        return domain.number


def domain_of_python_module():
    from ur_ros_rtde.testing import own_domain

    with own_domain() as number:
        return number


def domain_of_program():
    program = Layout.of_environment().build / "rcl_cxx" / "test" / "test_values"
    result = subprocess.run([program, "--gtest_list_tests"], env={**WITHOUT_DOMAIN, "ROS_DOMAIN_ID": "7"}, capture_output=True, text=True)
    return int(result.stdout.split("\n")[0].partition("ROS_DOMAIN_ID=")[2])


@pytest.mark.parametrize("reserved", [domain_of_tools, domain_of_python_module, domain_of_program])
@pytest.mark.parametrize("port", RTPS_PORTS)
def test_a_domain_with_a_node_is_not_reserved(reserved, port):
    with node(RTPS_PORTS[port]) as number:
        assert reserved() != number


def test_a_domain_with_a_node_on_ipv6_is_not_reserved():
    with node(10, socket.AF_INET6) as number:
        assert domain_of_tools() != number


def test_an_isolated_process_finds_no_nodes_of_other_hosts():
    user = {"ROS_DOMAIN_ID": "0", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_STATIC_PEERS": "10.0.0.1",
            "ROS_DISCOVERY_SERVER": "10.0.0.1:11811", "FASTRTPS_DEFAULT_PROFILES_FILE": "/home/profiles.xml",
            "FASTDDS_DEFAULT_PROFILES_FILE": "/opt/share/ur_ros_rtde/config/fastdds.xml"}
    with isolation.Domain() as domain:
        for distribution, more in (("humble", {"ROS_LOCALHOST_ONLY": "1"}), ("jazzy", {})):
            environment = {**user, "ROS_DISTRO": distribution}
            domain.isolate(environment)
            number = str(domain.number)
            assert environment == {"ROS_DISTRO": distribution, "ROS_DOMAIN_ID": number, "UR_TEST_DOMAIN": number, **more,
                                   "UR_TEST_ADDRESS": domain.address, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
                                   "FASTDDS_DEFAULT_PROFILES_FILE": user["FASTDDS_DEFAULT_PROFILES_FILE"]}


@pytest.mark.parametrize("given, kept", [({}, False), ({"ROS_DOMAIN_ID": "5"}, False),
                                         ({"ROS_DOMAIN_ID": "5", "UR_TEST_DOMAIN": "5"}, True)])
def test_only_a_domain_that_was_reserved_is_kept(given, kept):
    """That of the user is that of a robot."""
    code = "import os, ros_domain; ros_domain.reserve(); print(os.environ['ROS_DOMAIN_ID'])"
    found = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "rcl_cxx/test/support", env={**WITHOUT_DOMAIN, **given},
                           capture_output=True, text=True)
    assert (found.stdout.strip() == "5") is kept and found.stdout.strip(), found.stderr


# --- Processes and shared memory --------------------------------------------------------------------------------------------


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Returns a function that runs a program as a test. The program writes the process id of what it starts to the file `child`."""
    monkeypatch.setattr(runner, "ROOT", tmp_path)

    def run(code):
        test = runner.Test("a: test", [sys.executable, "-c", f"import os, pathlib, subprocess, sys\n{code}"], tmp_path, 30.0)
        with runner.Runner(Layout(Layout.of_environment().ros), tmp_path) as started:
            return started.run(test)

    return run


def start(command, session):
    return (f"child = subprocess.Popen({command}, start_new_session={session})\n"
            "pathlib.Path('child').write_text(str(child.pid))\n")


def is_running(pid):
    with contextlib.suppress(OSError):
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    return False


@pytest.mark.parametrize("session", [True, False])
def test_a_test_that_leaves_a_process_fails_and_the_process_ends(run, tmp_path, monkeypatch, session):
    monkeypatch.setattr(runner, "LEAVING_LIMIT", 0.1)
    found = run(start(["sleep", "60"], session))
    assert found.cases.failures == ["left processes behind"] and "left behind: sleep 60\n" in found.output
    assert not is_running((tmp_path / "child").read_text())


def test_a_process_that_ends_by_itself_after_the_test_is_in_order(run, tmp_path):
    """It sees the end of the test."""
    child = "import os, time\nwhile os.getppid() == int(os.environ['TEST']): time.sleep(0.01)"
    found = run("os.environ['TEST'] = str(os.getpid())\n" + start([sys.executable, "-c", child], True))
    assert found.cases == runner.Cases(1, []), found.output
    assert not is_running((tmp_path / "child").read_text())


def test_a_run_kills_what_a_killed_run_has_left(tmp_path, monkeypatch):
    monkeypatch.setattr(isolation, "_SHARED_MEMORY", tmp_path)
    dead = subprocess.Popen(["true"])
    dead.wait()
    runs = {"dead": dead.pid, "living": os.getppid()}
    left = {name: subprocess.Popen(["sleep", "60"], env={isolation.MARK: f"{run}:0"}) for name, run in runs.items()}
    try:
        with isolation.CleanUp():
            assert left["dead"].wait(20.0) < 0 and left["living"].poll() is None
    finally:
        left["living"].kill()
        left["living"].wait()


def test_clean_up_removes_only_unused_shared_memory_of_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr(isolation, "_SHARED_MEMORY", tmp_path)
    (tmp_path / "fastrtps_old").write_text("")
    with isolation.CleanUp():
        (tmp_path / "fastrtps_orphan").write_text("")
        (tmp_path / "someone_elses").write_text("")
    assert sorted(os.listdir(tmp_path)) == ["fastrtps_old", "someone_elses"]


def test_a_fresh_folder_is_empty(tmp_path):
    folder = tmp_path / "logs"
    folder.mkdir()
    (folder / "old").write_text("")
    assert list(isolation.fresh_folder(folder).iterdir()) == []
