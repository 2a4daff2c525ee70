"""An action server of rcl_cxx with action clients of rclpy."""

import threading

import pytest
from action_msgs.msg import GoalStatus, GoalStatusArray
from action_msgs.srv import CancelGoal
from conftest import LIMIT, eventually, result_of
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from test_msgs.action import Fibonacci
from unique_identifier_msgs.msg import UUID

RUN_UNTIL_CANCELED, REJECT_CANCEL, SUCCEED_ON_CANCEL, ABORT, DROP_HANDLE, THROW, THROW_IN_GOAL, FINISH_TWICE, \
    CANCELED_UNASKED, CANCEL_IN_HANDLER = range(1000, 1010)


class Client:
    """rclpy's action client and its services."""

    def __init__(self, ros, name):
        self.ros = ros
        self.name = name
        self.client = ros.call_in_executor(lambda: ActionClient(ros.node, Fibonacci, name))
        assert self.client.wait_for_server(LIMIT)

    def send(self, order, feedback=None):
        callback = (lambda message: feedback.append(message.feedback)) if feedback is not None else None
        return result_of(self.start(order, callback))

    def start(self, order, feedback_callback=None):
        return self.ros.call_in_executor(lambda: self.client.send_goal_async(Fibonacci.Goal(order=order),
                                                                        feedback_callback=feedback_callback))

    def result(self, goal):
        """Returns a future of the result."""
        return self.ros.call_in_executor(goal.get_result_async)

    def cancel_goal(self, goal):
        return result_of(self.ros.call_in_executor(goal.cancel_goal_async))

    def run(self, order):
        return result_of(self.result(self.send(order)))

    def cancel(self, goal_id=None, stamp=None):
        request = CancelGoal.Request()
        if goal_id is not None:
            request.goal_info.goal_id = goal_id
        if stamp is not None:
            request.goal_info.stamp = stamp
        return self.ros.call(CancelGoal, self.name + "/_action/cancel_goal", request)

    def result_by_id(self, goal_id):
        service = Fibonacci.Impl.GetResultService
        return self.ros.call(service, self.name + "/_action/get_result", service.Request(goal_id=goal_id))


@pytest.fixture
def client(ros, test_node):
    client = Client(ros, "/fibonacci")
    yield client
    client.cancel()
    ros.call_in_executor(client.client.destroy)


def ids(goals):
    return sorted(bytes(goal.goal_id.uuid) for goal in goals)


def test_a_goal_has_feedback_and_a_result(client):
    def run():
        feedback = []
        goal = client.send(8, feedback)
        assert goal.accepted
        assert goal.stamp.sec > 0
        answer = result_of(client.result(goal))
        assert answer.status == GoalStatus.STATUS_SUCCEEDED
        assert list(answer.result.sequence) == [0, 1, 1, 2, 3, 5, 8, 13]
        return feedback

    # The server sends feedback only to discovered subscriptions. The first goals of a client may precede the discovery.
    feedback = eventually(lambda: [message for message in [run()] if len(message) == 6])[0]
    assert [len(message.sequence) for message in feedback] == [3, 4, 5, 6, 7, 8]
    assert list(feedback[-1].sequence) == [0, 1, 1, 2, 3, 5, 8, 13]


def test_a_result_can_be_requested_before_and_after_the_end_and_repeatedly(client):
    goal = client.send(20)
    before = [client.result(goal), client.result(goal)]
    assert [result_of(future).status for future in before] == [GoalStatus.STATUS_SUCCEEDED] * 2
    after = result_of(client.result(goal))
    assert after.status == GoalStatus.STATUS_SUCCEEDED
    assert after.result == result_of(before[0]).result


def test_a_rejected_goal_is_logged_with_the_reason(client, test_node):
    assert not client.send(-3).accepted
    eventually(lambda: any("/fibonacci: goal" in line and "rejected: order is -3, it must not be negative" in line
                           for line in test_node.errors))


def test_a_goal_whose_check_throws_is_rejected(client, test_node):
    assert not client.send(THROW_IN_GOAL).accepted
    eventually(lambda: any("the goal handler failed" in line for line in test_node.errors))


def test_many_goals_run_at_the_same_time(client):
    # At most 10 at a time, the queue depth of services.
    goals = [client.start(order) for order in range(20, 28)]
    handles = [result_of(goal) for goal in goals]
    assert all(handle.accepted for handle in handles)
    results = [result_of(client.result(handle)) for handle in handles]
    assert [len(result.result.sequence) for result in results] == list(range(20, 28))


def test_cancels_a_goal(client):
    goal = client.send(RUN_UNTIL_CANCELED)
    result = client.result(goal)
    answer = client.cancel_goal(goal)
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert ids(answer.goals_canceling) == [bytes(goal.goal_id.uuid)]
    assert result_of(result).status == GoalStatus.STATUS_CANCELED


def test_a_server_may_reject_a_cancel_request(client):
    goal = client.send(REJECT_CANCEL)
    answer = client.cancel_goal(goal)
    assert answer.return_code == CancelGoal.Response.ERROR_REJECTED
    assert not answer.goals_canceling
    assert result_of(client.result(goal)).status == GoalStatus.STATUS_SUCCEEDED


def test_a_canceled_goal_may_succeed(client):
    goal = client.send(SUCCEED_ON_CANCEL)
    assert client.cancel_goal(goal).return_code == CancelGoal.Response.ERROR_NONE
    assert result_of(client.result(goal)).status == GoalStatus.STATUS_SUCCEEDED


def test_a_goal_may_be_canceled_by_the_handler_itself(client):
    goal = client.send(CANCEL_IN_HANDLER)
    answer = client.cancel_goal(goal)
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert len(answer.goals_canceling) == 1
    assert result_of(client.result(goal)).status == GoalStatus.STATUS_CANCELED


def test_a_finished_goal_cannot_be_canceled(client):
    goal = client.send(3)
    result_of(client.result(goal))
    answer = client.cancel_goal(goal)
    assert answer.return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_an_unknown_goal_cannot_be_canceled_and_has_no_result(client):
    unknown = UUID(uuid=list(range(16)))
    assert client.cancel(unknown).return_code == CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
    assert client.result_by_id(unknown).status == GoalStatus.STATUS_UNKNOWN


def test_cancels_all_goals_with_one_request(client):
    goals = [client.send(RUN_UNTIL_CANCELED) for _ in range(3)]
    answer = client.cancel()
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert ids(answer.goals_canceling) == ids(goals)
    for goal in goals:
        assert result_of(client.result(goal)).status == GoalStatus.STATUS_CANCELED
    nothing = client.cancel()
    assert nothing.return_code == CancelGoal.Response.ERROR_NONE
    assert not nothing.goals_canceling


def test_cancels_goals_up_to_a_stamp(client):
    early, middle, late = (client.send(RUN_UNTIL_CANCELED) for _ in range(3))
    assert ids(client.cancel(stamp=middle.stamp).goals_canceling) == ids([early, middle])
    assert result_of(client.result(middle)).status == GoalStatus.STATUS_CANCELED
    assert ids(client.cancel().goals_canceling) == ids([late])


def test_cancels_goals_up_to_a_stamp_and_the_goal_with_the_given_id(client):
    early, middle, late = (client.send(RUN_UNTIL_CANCELED) for _ in range(3))
    assert ids(client.cancel(late.goal_id, early.stamp).goals_canceling) == ids([early, late])
    assert ids(client.cancel().goals_canceling) == ids([middle])


def test_each_goal_ends_once_when_cancel_requests_race_with_results(client):
    outcomes = set()
    for order in range(2, 14):
        goal = client.send(order)
        result = client.result(goal)
        answer = client.cancel_goal(goal)
        status = result_of(result).status
        outcomes.add(status)
        if answer.return_code == CancelGoal.Response.ERROR_NONE:
            assert status in (GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_SUCCEEDED)
        else:
            assert answer.return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED
            assert status == GoalStatus.STATUS_SUCCEEDED
    assert outcomes


def test_several_clients_have_goals_and_cancel_them_concurrently(ros, client):
    failures = []

    def use(number):
        try:
            for round_ in range(5):
                goal = client.send(RUN_UNTIL_CANCELED if (number + round_) % 2 else 6)
                client.cancel_goal(goal)
                assert result_of(client.result(goal)).status in (GoalStatus.STATUS_CANCELED,
                                                                     GoalStatus.STATUS_SUCCEEDED)
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=use, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(3 * LIMIT)
        assert not thread.is_alive()
    assert not failures


@pytest.mark.parametrize("order, status", [
    (ABORT, GoalStatus.STATUS_ABORTED),
    (DROP_HANDLE, GoalStatus.STATUS_ABORTED),
    (THROW, GoalStatus.STATUS_ABORTED),
    (CANCELED_UNASKED, GoalStatus.STATUS_ABORTED),
    (FINISH_TWICE, GoalStatus.STATUS_SUCCEEDED),
])
def test_each_accepted_goal_has_one_result(client, order, status):
    assert client.run(order).status == status


def test_misuse_of_a_goal_handle_is_logged(client, test_node):
    client.run(FINISH_TWICE)
    client.run(DROP_HANDLE)
    eventually(lambda: any("second result: false" in line for line in test_node.errors))
    eventually(lambda: any("is succeeded, it cannot become aborted" in line for line in test_node.errors))
    eventually(lambda: any("its handle was released without a result" in line for line in test_node.errors))


def test_late_subscribers_receive_the_goal_status(ros, client):
    goal = client.send(RUN_UNTIL_CANCELED)
    transient_local = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    arrays = ros.subscribe(GoalStatusArray, "/fibonacci/_action/status", transient_local)

    def status():
        return {bytes(entry.goal_info.goal_id.uuid): entry.status for array in arrays[-1:]
                for entry in array.status_list}.get(bytes(goal.goal_id.uuid))

    eventually(lambda: status() == GoalStatus.STATUS_EXECUTING)
    client.cancel_goal(goal)
    eventually(lambda: status() == GoalStatus.STATUS_CANCELED)
    seen = [entry.status for array in arrays for entry in array.status_list
            if bytes(entry.goal_info.goal_id.uuid) == bytes(goal.goal_id.uuid)]
    assert seen == sorted(seen), "the status must not return to an earlier state"


def test_results_expire(ros, test_node):
    client = Client(ros, "/forgetful")
    goal = client.send(3)
    assert result_of(client.result(goal)).status == GoalStatus.STATUS_SUCCEEDED
    assert client.result_by_id(goal.goal_id).status == GoalStatus.STATUS_SUCCEEDED
    eventually(lambda: client.result_by_id(goal.goal_id).status == GoalStatus.STATUS_UNKNOWN)


def test_active_goals_do_not_expire(ros, test_node):
    client = Client(ros, "/forgetful")
    goal = client.send(RUN_UNTIL_CANCELED)
    short = client.send(2)
    result_of(client.result(short))
    eventually(lambda: client.result_by_id(short.goal_id).status == GoalStatus.STATUS_UNKNOWN)
    assert client.cancel_goal(goal).return_code == CancelGoal.Response.ERROR_NONE
    assert result_of(client.result(goal)).status == GoalStatus.STATUS_CANCELED


def test_goals_receive_a_result_when_the_node_shuts_down(ros, start_node):
    process = start_node("--ros-args", "-r", "__ns:=/ending")
    client = Client(ros, "/ending/fibonacci")
    goals = [client.send(RUN_UNTIL_CANCELED) for _ in range(3)]
    results = [client.result(goal) for goal in goals]
    # The server receives a request before it answers a later request of the same client.
    client.result_by_id(UUID(uuid=list(range(16))))
    assert process.stop() == 0
    assert [result_of(result).status for result in results] == [GoalStatus.STATUS_ABORTED] * 3
