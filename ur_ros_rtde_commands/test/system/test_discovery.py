"""New clients discover the actions, also after other clients were killed. See docs/internals/discovery.md."""

import contextlib
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

import pytest
from programs import start_node
from support import NAMES_COMMANDS, TIMEOUT_FACTOR, wait_for

CLIENTS = pathlib.Path(__file__).parent / "discovery_clients.py"
PROFILES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")
LIMIT = 2.0  # s, allows for other tests running at the same time
FAST_DDS_3 = os.environ.get("ROS_DISTRO", "") >= "kilted"


@pytest.fixture
def no_profile(monkeypatch):
    """Removes the Fast DDS profile that `./ur` sets from the environment."""
    for variable in PROFILES:
        monkeypatch.delenv(variable, raising=False)
    return monkeypatch


def actions(driver):
    """Returns the comma-separated actions of the driver, from its log."""
    lists = [driver.wait_for_output(text).partition(text)[2] for text in ("]: all commands: ", "]: all dashboard commands: ")]
    return ",".join(lists).replace(" ", "")


def test_new_clients_find_all_actions_after_others_were_killed(no_profile, addresses, processes):
    driver = processes(start_node("driver", addresses[3], arguments=NAMES_COMMANDS))
    command = [sys.executable, str(CLIENTS), actions(driver), "--clients", "10", "--killed", "5",
               "--limit", str(10.0 * TIMEOUT_FACTOR)]
    result = subprocess.run(command, stdout=subprocess.PIPE, timeout=200.0 * TIMEOUT_FACTOR, text=True, check=True)
    found = json.loads(result.stdout)
    assert len(found) == 10
    assert not [client["missing"] for client in found if client["missing"]]
    # On a busy host, the first client waits until the driver has sent its announcements to the killed ones (measured: 2.7 to 4.7 s).
    assert statistics.median(client["seconds"] for client in found) < LIMIT * TIMEOUT_FACTOR, found


def flow_controllers(process):
    """Yields the threads of the flow controllers, as folders in /proc."""
    for thread in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # other threads may end in the meantime
            if (thread / "comm").read_text().startswith("dds.asyn"):
                yield thread


def announcement_threads(process):
    """Returns the scheduling policies of the flow controllers' threads. The profile of the nodes sets the policy."""
    return [os.sched_getscheduler(int(thread.name)) for thread in flow_controllers(process)]


@pytest.mark.skipif(not FAST_DDS_3, reason="the profile for Fast DDS 2 has no flow controller")
@pytest.mark.parametrize("environment", [{}, {"FASTDDS_DEFAULT_PROFILES_FILE": os.environ.get("FASTDDS_DEFAULT_PROFILES_FILE", "")}],
                         ids=["none", "clients"])
def test_nodes_use_the_profile_for_nodes(environment, no_profile, addresses, processes):
    """Even if the profile for clients is in the environment."""
    driver = processes(start_node("driver", addresses[3], env=environment))
    driver.wait_for_output("]: commands: ")
    assert os.SCHED_BATCH in announcement_threads(driver)


@pytest.mark.skipif(not FAST_DDS_3, reason="up to Jazzy, the middleware requires them")
def test_nodes_load_no_introspection_type_supports(addresses, processes):
    """With them, the middleware also keeps a description of each type. Together they take 9 MB."""
    driver = processes(start_node("driver", addresses[3]))
    driver.wait_for_output("]: commands: ")
    libraries = pathlib.Path(f"/proc/{driver.pid}/maps").read_text()
    assert "libur_ros_rtde_msgs__rosidl_typesupport_fastrtps_cpp.so" in libraries
    assert "libur_ros_rtde_msgs__rosidl_typesupport_introspection_cpp.so" not in libraries


def wake_ups(process):
    """Returns how often the flow controllers' threads have woken up so far."""
    status = [(thread / "status").read_text() for thread in flow_controllers(process)]
    return sum(int(re.search(r"^voluntary_ctxt_switches:\s+(\d+)", text, re.M)[1]) for text in status)


@pytest.mark.skipif(not FAST_DDS_3, reason="the profile for Fast DDS 2 has no flow controller")
def test_the_flow_controller_costs_an_idle_node_little(addresses, processes):
    """Its thread wakes up once per period. 200 wake-ups/s took 0.5 % of a core in each node."""
    driver = processes(start_node("driver", addresses[3]))
    driver.wait_for_output("]: commands: ")
    before, begin = wake_ups(driver), time.monotonic()
    time.sleep(1.0)
    assert 0.0 < (wake_ups(driver) - before) / (time.monotonic() - begin) < 150.0


def write_profile(tmp_path, text):
    file = tmp_path / "own.xml"
    file.write_text(f'<dds xmlns="http://www.eprosima.com"><profiles><participant profile_name="own" is_default_profile="true">'
                    f"<rtps>{text}</rtps></participant></profiles></dds>")
    return str(file)


DISABLED = """<propertiesPolicy><properties><property><name>fastdds.type_propagation</name><value>disabled</value></property>
</properties></propertiesPolicy>"""


@pytest.mark.skipif(not FAST_DDS_3, reason="Fast DDS 2 has no type propagation")
@pytest.mark.parametrize("text, expected", [("<name>own</name>", True), (DISABLED, False)])
def test_warns_of_a_user_profile_that_leaves_type_propagation_enabled(no_profile, addresses, processes, tmp_path, text, expected):
    file = write_profile(tmp_path, text)
    driver = processes(start_node("driver", addresses[3], env={"FASTDDS_DEFAULT_PROFILES_FILE": file}))
    driver.wait_for_output("]: commands: ")
    assert ("leaves fastdds.type_propagation enabled" in driver.output()) == expected
    assert (file in driver.output()) == expected
    assert os.SCHED_BATCH not in announcement_threads(driver)


def test_uses_the_profile_in_the_working_directory(no_profile, addresses, processes, tmp_path):
    pathlib.Path(write_profile(tmp_path, "<name>own</name>")).rename(tmp_path / "DEFAULT_FASTDDS_PROFILES.xml")
    no_profile.chdir(tmp_path)
    driver = processes(start_node("driver", addresses[3]))
    wait_for(lambda: "]: commands: " in driver.output(), 15.0, "the driver to start")
    warned = "DEFAULT_FASTDDS_PROFILES.xml leaves fastdds.type_propagation enabled" in driver.output()
    assert warned == FAST_DDS_3, driver.output()
