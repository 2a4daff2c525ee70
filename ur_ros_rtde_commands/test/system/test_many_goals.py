"""Nothing in the driver grows with the number of goals that it has served. `./ur bench --scale` does the same with 10,000."""

import pathlib
import time

import pytest
from action_msgs.msg import GoalStatus
from support import TIMEOUT_FACTOR, wait_for

from ur_ros_rtde_msgs.action import SetPayload

BACKGROUND = True
PLUGINS = "plugins:=[move_j,set_payload]"

# The driver keeps a result for 10 s. Goals are sent in bursts that are shorter, and a burst begins when the driver keeps no
# results: all bursts need the same memory.
BURSTS, GOALS = 4, 250
RESULT_LIMIT = 30.0  # s, until the driver has discarded a result
END_LIMIT = 5.0  # s, until the last thread of a goal has ended
RETRY_INTERVAL = 0.25  # s, between two requests for a result
MOST_GROWTH = 0.5  # MB from the second burst to the last one: 1 KB per goal


def resources(pid):
    """Returns resident memory in MB, threads and descriptors of a process."""
    lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
    values = {name: text.split()[0] for name, _, text in (line.partition(":") for line in lines) if text.strip()}
    return int(values["VmRSS"]) / 1024.0, int(values["Threads"]), len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir()))


def is_discarded(client, goal):
    """Returns whether the driver no longer has the result of a goal that has ended."""
    future = client.call_in_executor(goal.handle.get_result_async)
    answer = wait_for(lambda: future.done() and future.result(), 10.0, "the result")
    time.sleep(RETRY_INTERVAL)
    return answer.status == GoalStatus.STATUS_UNKNOWN


def send_burst(client):
    """Sends goals one after the other, and returns when the driver has discarded the results of all of them."""
    for number in range(GOALS):
        goal = client.send(SetPayload, "set_payload", mass=0.5 + 0.01 * (number % 10))
        goal.succeeded()
    wait_for(lambda: is_discarded(client, goal), RESULT_LIMIT, "the driver to discard the last result")


@pytest.mark.skipif(TIMEOUT_FACTOR > 1.0, reason="a sanitizer keeps freed memory")
def test_memory_threads_and_descriptors_do_not_grow(robot, driver):
    found = []
    for _ in range(BURSTS):
        send_burst(robot)
        found.append(resources(driver.pid))
    print(f"MB, threads, descriptors after each {GOALS} goals: {found}")
    assert found[-1][0] - found[1][0] < MOST_GROWTH
    _, threads, descriptors = found[0]

    def has_not_grown():  # a thread may be about to end
        _, threads_now, descriptors_now = resources(driver.pid)
        return threads_now <= threads and descriptors_now <= descriptors

    wait_for(has_not_grown, END_LIMIT, f"at most {threads} threads and {descriptors} descriptors")
