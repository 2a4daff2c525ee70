"""A node of rcl_cxx in the ROS graph: names, types, quality of service, /rosout, remapping and shutdown."""

import signal
import time

import pytest
from conftest import eventually
from rcl_interfaces.msg import Log
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ROSOUT = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)

ACTION_SERVICES = {"cancel_goal": "action_msgs/srv/CancelGoal", "get_result": "test_msgs/action/Fibonacci_GetResult",
                   "send_goal": "test_msgs/action/Fibonacci_SendGoal"}
PARAMETER_SERVICES = {"describe_parameters": "DescribeParameters", "get_parameter_types": "GetParameterTypes",
                      "get_parameters": "GetParameters", "list_parameters": "ListParameters",
                      "set_parameters": "SetParameters", "set_parameters_atomically": "SetParametersAtomically"}


def of_node(query, name="test_node", namespace="/"):
    """Returns the result of the query when it has been stable for a while, which means that discovery is complete."""
    def stable():
        try:
            first = dict(query(name, namespace))
            time.sleep(0.1)
            return first if first and first == dict(query(name, namespace)) else None
        except Exception:  # the node is not known yet
            return None
    return eventually(stable)


def test_the_node_has_its_name(ros, test_node):
    eventually(lambda: ("test_node", "/") in ros.node.get_node_names_and_namespaces())


def test_the_node_has_its_services_with_their_types(ros, test_node):
    services = of_node(ros.node.get_service_names_and_types_by_node)
    expected = {"/set_bool": ["std_srvs/srv/SetBool"], "/failing": ["std_srvs/srv/Trigger"],
                "/test_node/log": ["std_srvs/srv/Trigger"],
                "/test_node/declare": ["std_srvs/srv/Trigger"]}
    for action in ("/fibonacci", "/forgetful"):
        expected.update({f"{action}/_action/{name}": [type_] for name, type_ in ACTION_SERVICES.items()})
    expected.update({f"/test_node/{name}": ["rcl_interfaces/srv/" + type_]
                     for name, type_ in PARAMETER_SERVICES.items()})
    assert services == expected


def test_the_node_has_its_topics_with_their_types(ros, test_node):
    published = of_node(ros.node.get_publisher_names_and_types_by_node)
    assert published["/rosout"] == ["rcl_interfaces/msg/Log"]
    assert published["/parameter_events"] == ["rcl_interfaces/msg/ParameterEvent"]
    assert published["/fibonacci/_action/feedback"] == ["test_msgs/action/Fibonacci_FeedbackMessage"]
    assert published["/fibonacci/_action/status"] == ["action_msgs/msg/GoalStatusArray"]
    assert published["/latched"] == ["std_msgs/msg/String"]
    subscribed = of_node(ros.node.get_subscriber_names_and_types_by_node)
    assert subscribed["/say"] == ["std_msgs/msg/String"]
    assert "/clock" not in subscribed


@pytest.mark.parametrize("topic, durability, depth", [
    ("/fibonacci/_action/status", DurabilityPolicy.TRANSIENT_LOCAL, 1),
    ("/fibonacci/_action/feedback", DurabilityPolicy.VOLATILE, 10),
    ("/parameter_events", DurabilityPolicy.VOLATILE, 1000),
    ("/rosout", DurabilityPolicy.TRANSIENT_LOCAL, 1000),
])
def test_topics_have_the_quality_of_service_of_rclcpp(ros, test_node, topic, durability, depth):
    info = eventually(lambda: [info for info in ros.node.get_publishers_info_by_topic(topic)
                               if info.node_name == "test_node"])[0]
    assert info.qos_profile.reliability == ReliabilityPolicy.RELIABLE
    assert info.qos_profile.durability == durability
    assert info.qos_profile.depth in (0, depth), "discovery may omit the depth"


def test_publishes_and_receives_messages(ros, test_node):
    heard = ros.subscribe(String, "/echo", 10)
    publisher = ros.node.create_publisher(String, "/say", 10)

    def echoed():
        publisher.publish(String(data="hello"))
        return heard

    assert eventually(echoed)[0].data == "hello"


def test_late_subscribers_receive_a_transient_local_message(ros, test_node):
    messages = ros.subscribe(String, "/latched", TRANSIENT_LOCAL)
    assert eventually(lambda: messages)[0].data == "from before"


def test_an_incompatible_quality_of_service_is_logged(ros, start_node):
    process = start_node("--ros-args", "-r", "__ns:=/qos")
    ros.node.create_subscription(String, "/qos/echo", lambda _: None, TRANSIENT_LOCAL)
    eventually(lambda: any("an incompatible quality of service (durability" in line for line in process.errors))
    assert process.stop() == 0


def test_services_respond(ros, test_node):
    answer = ros.call(SetBool, "/set_bool", SetBool.Request(data=True))
    assert (answer.success, answer.message) == (True, "on")


def test_a_service_that_throws_responds_and_logs_the_error(ros, test_node):
    assert ros.call(Trigger, "/failing", Trigger.Request()).message == "half done"
    eventually(lambda: any("service failing: the service handler failed" in line for line in test_node.errors))
    assert ros.call(SetBool, "/set_bool", SetBool.Request()).message == "off"


def test_logs_to_console_and_rosout(ros, test_node):
    messages = ros.subscribe(Log, "/rosout", ROSOUT)
    assert ros.call(Trigger, "/test_node/log", Trigger.Request()).success

    def of(name):
        return [message for message in messages if message.name == name]

    warning = eventually(lambda: [message for message in of("test_node") if "warning" in message.msg])[0]
    assert warning.msg == "a warning with 42 and 100 %s"
    assert warning.level == 30
    assert warning.file.endswith("test_node.cpp") and warning.line > 0 and warning.function
    assert not [message for message in messages if "debug" in message.msg]
    assert any("[test_node]: a warning with 42" in line for line in test_node.errors)


def test_the_log_level_can_be_set(start_node):
    process = start_node("--ros-args", "--log-level", "test_node:=fatal", "-p", "use_sim_time:=false")
    assert process.stop() == 0
    assert not [line for line in process.errors if "WARN" in line]


def test_names_are_remapped_and_moved_to_the_namespace(ros, start_node):
    process = start_node("--ros-args", "-r", "__ns:=/left/arm", "-r", "__node:=driver", "-r", "echo:=/loud/echo", "-r",
                          "fibonacci:=count")
    services = of_node(ros.node.get_service_names_and_types_by_node, "driver", "/left/arm")
    assert "/left/arm/set_bool" in services
    assert "/left/arm/driver/log" in services
    assert "/left/arm/driver/list_parameters" in services
    published = of_node(ros.node.get_publisher_names_and_types_by_node, "driver", "/left/arm")
    assert "/loud/echo" in published
    assert process.stop() == 0


@pytest.mark.parametrize("sig, name", [(signal.SIGINT, "SIGINT"), (signal.SIGTERM, "SIGTERM")])
def test_a_signal_stops_the_node_with_exit_code_0(sig, name, start_node):
    process = start_node()
    assert process.stop(sig) == 0
    assert f"stopped by {name}\n" in process.output


def test_the_node_leaves_the_graph(ros, start_node):
    process = start_node("--ros-args", "-r", "__node:=leaving")
    eventually(lambda: ("leaving", "/") in ros.node.get_node_names_and_namespaces())
    assert process.stop() == 0
    eventually(lambda: ("leaving", "/") not in ros.node.get_node_names_and_namespaces())


def test_unknown_ros_arguments_are_reported_and_stop_the_node(start_node):
    process = start_node("--ros-args", "--sped", "1", ready=False)
    assert process.wait() == 2
    assert "unknown ROS arguments: --sped 1" in "".join(process.errors)
