"""robot_state_receiver: topics, services, fake joint states, and reconnection."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped
from programs import Simulator, start_node
from ros_client import Client
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from std_srvs.srv import SetBool
from support import FEW_PLUGINS, HOME, JOINTS, robot_seconds, seconds, wait_for

from ur_ros_rtde_msgs.msg import ErrorCode, IOState
from ur_ros_rtde_msgs.srv import GetIOState, GetJointState, GetTcpPose, GetWrench


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address, "tf_prefix:=left_")
    yield receiver
    receiver.stop()
    print(receiver.output())


def collect(client, message, topic, number, limit=15.0):
    messages = client.subscribe(message, topic)
    wait_for(lambda: len(messages) >= number, limit, f"{number} messages of {topic}")
    return list(messages)


def test_joint_states_have_the_names_and_the_order_of_the_robot_description(receiver, client):
    state = collect(client, JointState, "joint_states", 1)[0]
    assert list(state.name) == [f"left_{name}" for name in JOINTS]
    assert list(state.position) == pytest.approx(HOME, abs=0.01)
    assert len(state.velocity) == len(state.effort) == 6


def test_efforts_are_the_torques_that_hold_the_arm(receiver, client):
    effort = collect(client, JointState, "joint_states", 1)[0].effort
    assert all(map(math.isfinite, effort))
    assert 20.0 < abs(effort[1]) < 400.0  # shoulder_lift_joint of a UR10e at home


def test_tcp_pose_is_in_the_base_frame(receiver, client, simulator):
    pose = collect(client, PoseStamped, "tcp_pose", 1)[0]
    assert pose.header.frame_id == "left_base"
    tcp = simulator.state()["actual_tcp_pose"]
    position = pose.pose.position
    assert (position.x, position.y, position.z) == pytest.approx(tcp[:3], abs=1e-3)
    q = pose.pose.orientation
    assert math.hypot(q.x, q.y, q.z, q.w) == pytest.approx(1.0, abs=1e-9)
    angle = math.hypot(*tcp[3:])
    assert 2.0 * math.acos(min(1.0, abs(q.w))) == pytest.approx(min(angle, 2.0 * math.pi - angle), abs=1e-3)


def test_wrench_is_in_the_tool_frame(receiver, client, simulator):
    wrenches = client.subscribe(WrenchStamped, "wrench")
    simulator.control("push", force=[0.0, 0.0, 30.0], duration=2.0, frame="tool")
    wait_for(lambda: any(w.wrench.force.z > 25.0 for w in list(wrenches)), 10.0, "the push along the tool's axis")
    strongest = max(list(wrenches), key=lambda w: w.wrench.force.z)
    assert strongest.header.frame_id == "left_tool0_controller"
    assert abs(strongest.wrench.force.x) < 8.0 and abs(strongest.wrench.force.y) < 8.0


def test_io_state_contains_the_inputs_by_pin(receiver, client, simulator):
    messages = client.subscribe(IOState, "io_state")
    for pin in (0, 9, 17):
        simulator.control("set_digital_input", number=pin, value=True)
        wait_for(lambda p=pin: messages and messages[-1].digital_inputs[p], 10.0, f"input {pin}")
        simulator.control("set_digital_input", number=pin, value=False)
        wait_for(lambda p=pin: not messages[-1].digital_inputs[p], 10.0, f"input {pin} to be off")


def test_all_messages_of_a_cycle_have_one_stamp(receiver, client):
    topics = {name: client.subscribe(kind, name) for name, kind in (("joint_states", JointState), ("tcp_pose", PoseStamped),
                                                                    ("wrench", WrenchStamped), ("io_state", IOState))}
    wait_for(lambda: all(topics.values()), 20.0, "a message of each topic")
    first = max(seconds(messages[0].header.stamp) for messages in topics.values())

    def stamps(messages):
        return [stamp for stamp in (seconds(message.header.stamp) for message in list(messages)) if stamp >= first]

    wait_for(lambda: all(len(stamps(messages)) > 100 for messages in topics.values()), 20.0, "100 messages of each topic")
    common = set.intersection(*(set(stamps(messages)) for messages in topics.values()))
    assert all(len(common.intersection(stamps(messages)[:60])) > 48 for messages in topics.values())


def assert_rate(client, topic, number, expected):
    """Asserts the rate in Hz of robot time, by the stamps. The first message is ignored: discovery may delay it.

    If packages queue up on a busy machine, only the newest is published: this reduces the mean rate, but not the shortest of the
    intervals."""
    states = client.subscribe(JointState, topic)
    wait_for(lambda: len(states) > number, 60.0, f"{number} messages of {topic}")
    stamps = [robot_seconds(state.header.stamp) for state in list(states)][1:]
    assert stamps == sorted(stamps)
    assert (len(stamps) - 1) / (stamps[-1] - stamps[0]) < 1.05 * expected
    intervals = sorted(after - before for before, after in zip(stamps, stamps[1:]))
    assert intervals[len(intervals) // 10] < 1.0 / (0.6 * expected)


def test_publishes_at_the_rate_of_the_controller(receiver, simulator, client):
    assert_rate(client, "joint_states", 1500, 500.0)


@pytest.mark.parametrize("frequency", [10.0, 300.0])
def test_publishes_at_the_configured_rate(simulator, client, processes, frequency):
    name = f"at_{frequency:.0f}_hz"
    processes(start_node("robot_state_receiver", simulator.address, f"rtde_frequency:={frequency}", namespace=name))
    number = 20 if frequency < 100 else 900
    assert_rate(client, f"/{name}/joint_states", number, frequency)


def test_the_driver_publishes_at_the_configured_rate(simulator, client, processes):
    processes(start_node("driver", simulator.address, FEW_PLUGINS, "rtde_frequency:=40.0", namespace="in_one"))
    assert_rate(client, "/in_one/joint_states", 80, 40.0)


@pytest.mark.parametrize("service, name, field", [
    (GetJointState, "get_joint_state", lambda a: list(a.joint_state.position) == pytest.approx(HOME, abs=0.01)),
    (GetTcpPose, "get_tcp_pose", lambda a: a.tcp_pose.header.frame_id == "left_base"),
    (GetWrench, "get_wrench", lambda a: a.wrench.header.frame_id == "left_tool0_controller"),
    (GetIOState, "get_io_state", lambda a: not any(a.io_state.digital_outputs)),
], ids=lambda value: value if isinstance(value, str) else "")
def test_services_return_the_newest_sample(receiver, client, service, name, field):
    collect(client, JointState, "joint_states", 1)
    answer = client.call(service, name)
    assert answer.success and answer.error_code == ErrorCode.NONE, answer.message
    assert field(answer)


def test_fake_joint_states_replace_joint_states_but_not_the_services(receiver, client):
    shown = client.subscribe(JointState, "joint_states")
    is_fake = client.subscribe(Bool, "joint_states_are_fake", transient_local=True)
    reported = client.subscribe(DiagnosticArray, "/diagnostics")
    publisher = client.node.create_publisher(JointState, "fake_joint_states", 10)
    wait_for(lambda: publisher.get_subscription_count(), 10.0, "the subscription of fake_joint_states")
    wait_for(lambda: is_fake and not is_fake[-1].data, 10.0, "real joint states")
    assert client.call(SetBool, "publish_fake_joint_states", data=True).success
    try:
        wait_for(lambda: is_fake[-1].data, 10.0, "joint_states_are_fake")
        wait_for(lambda: any("joint_states has fake positions" in status.message for array in list(reported)
                             for status in array.status), 10.0, "the warning in /diagnostics")
        # A subset of the joints in another order.
        publisher.publish(JointState(name=["left_elbow_joint", "left_shoulder_pan_joint"], position=[0.25, -0.5]))
        wait_for(lambda: shown and shown[-1].position[2] == 0.25, 10.0, "the fake elbow position")
        assert list(shown[-1].position) == pytest.approx([-0.5, HOME[1], 0.25, *HOME[3:]], abs=0.01)
        assert list(shown[-1].velocity) == [0.0] * 6
        actual = client.call(GetJointState, "get_joint_state")
        assert actual.success and list(actual.joint_state.position) == pytest.approx(HOME, abs=0.01)
        # An invalid message is reported and ignored.
        publisher.publish(JointState(name=["left_elbow_joint", "nonsense"], position=[1.0, 1.0]))
        receiver.wait_for_output('there is no joint "nonsense"')
        publisher.publish(JointState(name=["left_elbow_joint"], position=[]))
        number = len(shown)
        wait_for(lambda: len(shown) > number + 50, 10.0, "more joint states")
        assert shown[-1].position[2] == 0.25
    finally:
        assert client.call(SetBool, "publish_fake_joint_states", data=False).success
    wait_for(lambda: shown[-1].position[2] == pytest.approx(HOME[2], abs=0.01), 10.0, "the actual elbow position")
    assert not is_fake[-1].data


def test_actual_joint_states_are_published_along_with_fake_joint_states(receiver, client):
    shown, actual = client.subscribe(JointState, "joint_states"), client.subscribe(JointState, "actual_joint_states")
    wait_for(lambda: len(shown) > 50 and len(actual) > 50, 20.0, "joint states of both topics")
    by_stamp = {seconds(state.header.stamp): state for state in list(shown)}
    # Both topics are identical without fake joint states.
    assert sum(by_stamp.get(seconds(state.header.stamp)) == state for state in list(actual)) > 25

    assert client.call(SetBool, "publish_fake_joint_states", data=True).success
    try:
        publisher = client.node.create_publisher(JointState, "fake_joint_states", 10)
        wait_for(lambda: publisher.get_subscription_count(), 10.0, "the subscription of fake_joint_states")
        publisher.publish(JointState(name=["left_elbow_joint"], position=[0.25]))
        wait_for(lambda: shown[-1].position[2] == 0.25, 10.0, "the fake elbow position")
        stamp = seconds(shown[-1].header.stamp)
        wait_for(lambda: seconds(actual[-1].header.stamp) > stamp, 10.0, "a later actual state")
        assert list(actual[-1].name) == [f"left_{name}" for name in JOINTS]
        assert list(actual[-1].position) == pytest.approx(HOME, abs=0.01)
        assert any(actual[-1].effort)  # efforts of fake joint states are zero
    finally:
        assert client.call(SetBool, "publish_fake_joint_states", data=False).success


def test_several_receivers_can_connect_to_one_robot(simulator, client, processes):
    names = [f"watcher_{i}" for i in range(4)]
    for name in names:
        processes(start_node("robot_state_receiver", simulator.address, "rtde_frequency:=50.0", namespace=name))
    for name in names:
        assert collect(client, JointState, f"/{name}/joint_states", 20)


def test_starts_without_the_controller_and_reconnects(addresses, processes):
    address = addresses[1]
    receiver = processes(start_node("robot_state_receiver", address, namespace="early"))
    client = Client("early")
    try:
        answer = client.call(GetJointState, "get_joint_state")
        assert not answer.success and answer.error_code == ErrorCode.LINK_LOST
        assert address in wait_for(lambda: client.call(GetJointState, "get_joint_state").message, 15.0, "the reason")
        receiver.wait_for_output(address)

        simulator = Simulator(address)
        states = client.subscribe(JointState, "joint_states")
        wait_for(lambda: len(states) > 10, 15.0, "the first joint states")
        assert client.call(GetJointState, "get_joint_state").success

        simulator.kill()
        answer = wait_for(lambda: _if_failed(client.call(GetJointState, "get_joint_state")), 10.0, "the loss of the connection")
        assert answer.error_code == ErrorCode.LINK_LOST and "no data has been received from the controller for" in answer.message
        assert list(answer.joint_state.position) == pytest.approx(HOME, abs=0.01)

        processes(simulator.start())
        number = len(states)
        wait_for(lambda: len(states) > number + 10, 15.0, "joint states after the reconnection")
        assert client.call(GetJointState, "get_joint_state").success
        assert receiver.running()
    finally:
        client.close()


def _if_failed(answer):
    return None if answer.success else answer


def test_fake_joint_states_are_published_without_a_robot(addresses, client, processes):
    processes(start_node("robot_state_receiver", addresses[2], namespace="nowhere"))
    shown = client.subscribe(JointState, "/nowhere/joint_states")
    publisher = client.node.create_publisher(JointState, "/nowhere/fake_joint_states", 10)
    wait_for(lambda: publisher.get_subscription_count(), 15.0, "the subscription of fake_joint_states")
    assert client.call(SetBool, "/nowhere/publish_fake_joint_states", data=True).success
    publisher.publish(JointState(name=[JOINTS[5]], position=[0.75]))
    wait_for(lambda: shown, 10.0, "a joint state")
    assert shown[-1].position[5] == 0.75
