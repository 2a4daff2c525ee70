"""The parameters of a node of rcl_cxx, accessed with rclpy."""

import pytest
from conftest import LIMIT, eventually, result_of
from rcl_interfaces.msg import ParameterEvent, ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameter_events
from std_srvs.srv import Trigger

try:
    from rclpy.parameter_client import AsyncParameterClient
except ImportError:
    AsyncParameterClient = None

pytestmark = pytest.mark.skipif(AsyncParameterClient is None, reason="rclpy of Humble has no client of parameters")
NAMES = ["bytes", "count", "flags", "home", "integers", "limit", "model", "names", "robot.host", "robot.tool.mass",
         "speed", "switch", "use_sim_time"]


@pytest.fixture(scope="module")
def client(ros, test_node):
    client = AsyncParameterClient(ros.node, "/test_node")
    assert client.wait_for_services(LIMIT)
    return client


def get(client, *names):
    return list(result_of(client.get_parameters(list(names))).values)


def set_one(client, name, value, type_=None):
    return result_of(client.set_parameters([Parameter(name, type_, value)])).results[0]


def test_lists_all_parameters(client):
    answer = result_of(client.list_parameters()).result
    assert sorted(name for name in answer.names if not name.startswith("declared_")) == NAMES
    assert sorted(answer.prefixes) == ["robot", "robot.tool"]


@pytest.mark.parametrize("prefixes, depth, names", [
    (["robot"], 1, ["robot.host"]),
    (["robot"], 0, ["robot.host", "robot.tool.mass"]),
    ([], 1, [name for name in NAMES if "." not in name]),
])
def test_lists_parameters_by_prefix_and_depth(client, prefixes, depth, names):
    assert sorted(result_of(client.list_parameters(prefixes, depth)).result.names) == names


def test_returns_the_types_of_parameters(client):
    names = ["switch", "count", "speed", "robot.host", "bytes", "flags", "integers", "home", "names"]
    types = list(result_of(client.get_parameter_types(names)).types)
    assert types == [ParameterType.PARAMETER_BOOL, ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_DOUBLE,
                     ParameterType.PARAMETER_STRING, ParameterType.PARAMETER_BYTE_ARRAY,
                     ParameterType.PARAMETER_BOOL_ARRAY, ParameterType.PARAMETER_INTEGER_ARRAY,
                     ParameterType.PARAMETER_DOUBLE_ARRAY, ParameterType.PARAMETER_STRING_ARRAY]


def test_returns_the_values_of_parameters(client):
    switch, host, home, flags, data = get(client, "switch", "robot.host", "home", "flags", "bytes")
    assert switch.bool_value is True
    assert host.string_value == "localhost"
    assert list(home.double_array_value) == [0.0, -1.57, 0.0]
    assert list(flags.bool_array_value) == [True, False]
    assert [bytes(byte)[0] for byte in data.byte_array_value] == [1, 255]


def test_returns_the_descriptors_of_parameters(client):
    speed, count, model = result_of(client.describe_parameters(["speed", "count", "model"])).descriptors
    assert (speed.name, speed.type) == ("speed", ParameterType.PARAMETER_DOUBLE)
    assert speed.description == "in m/s"
    assert speed.additional_constraints == "slow is smooth"
    assert (speed.floating_point_range[0].from_value, speed.floating_point_range[0].to_value) == (0.0, 3.0)
    assert (count.integer_range[0].from_value, count.integer_range[0].to_value, count.integer_range[0].step) == \
        (0, 10, 1)
    assert model.read_only and not speed.read_only
    assert not speed.dynamic_typing


def test_unknown_parameters_give_empty_responses_as_in_rclcpp(ros, test_node):
    assert not ros.call(GetParameters, "/test_node/get_parameters", GetParameters.Request(names=["nothing"])).values
    assert not ros.call(DescribeParameters, "/test_node/describe_parameters",
                        DescribeParameters.Request(names=["speed", "nothing"])).descriptors
    assert not ros.call(ListParameters, "/test_node/list_parameters",
                        ListParameters.Request(prefixes=["nothing"])).result.names


def test_sets_parameters(client):
    assert set_one(client, "speed", 1.5).successful
    assert get(client, "speed")[0].double_value == 1.5
    assert set_one(client, "names", ["x"]).successful
    assert list(get(client, "names")[0].string_array_value) == ["x"]


@pytest.mark.parametrize("name, value, reason", [
    ("speed", 3.5, "range 0 to 3, it cannot be 3.5"),
    ("speed", float("nan"), "range 0 to 3"),
    ("count", 11, "range 0 to 10"),
    ("speed", "fast", "of type double, it cannot be 'fast'"),
    ("speed", 1, "of type double, it cannot be 1"),
    ("model", "ur3e", "read-only"),
    ("nothing", 1, "'nothing' cannot be set because it was not declared"),
])
def test_an_invalid_value_is_rejected_with_the_reason(client, name, value, reason):
    before = get(client, name)
    answer = set_one(client, name, value)
    assert not answer.successful
    assert reason in answer.reason
    assert get(client, name) == before


def test_sets_several_parameters_independently(client):
    answers = result_of(client.set_parameters([Parameter("count", value=4), Parameter("model", value="x"),
                                               Parameter("limit", value=5)])).results
    assert [answer.successful for answer in answers] == [True, False, True]
    assert [value.integer_value for value in get(client, "count", "limit")] == [4, 5]


def test_sets_several_parameters_atomically(client):
    count = get(client, "count")[0].integer_value
    rejected = result_of(client.set_parameters_atomically([Parameter("count", value=count + 1),
                                                          Parameter("speed", value=99.0)])).result
    assert not rejected.successful and "'speed'" in rejected.reason
    assert get(client, "count")[0].integer_value == count
    assert result_of(client.set_parameters_atomically([Parameter("count", value=count + 1),
                                                       Parameter("speed", value=2.0)])).result.successful
    assert get(client, "count")[0].integer_value == count + 1


def test_publishes_parameter_events_for_changes(ros, client):
    events = ros.subscribe(ParameterEvent, "/parameter_events", qos_profile_parameter_events)

    def announced():
        set_one(client, "switch", False)  # repeatedly: the publisher may not have matched the subscription yet
        return [event for event in events if event.node == "/test_node"]

    event = eventually(announced)[0]
    assert [parameter.name for parameter in event.changed_parameters] == ["switch"]
    assert event.changed_parameters[0].value.bool_value is False
    assert event.stamp.sec > 0
    assert not event.new_parameters and not event.deleted_parameters


def test_publishes_parameter_events_for_declarations(ros, test_node):
    events = ros.subscribe(ParameterEvent, "/parameter_events", qos_profile_parameter_events)

    def announced():
        assert ros.call(Trigger, "/test_node/declare", Trigger.Request()).success
        return [event for event in events if event.node == "/test_node" and event.new_parameters]

    parameter = eventually(announced)[0].new_parameters[0]
    assert parameter.name.startswith("declared_")
    assert parameter.value.integer_value == 5


def test_command_line_and_parameter_file_override_defaults(ros, tmp_path, start_node):
    file = tmp_path / "parameters.yaml"
    file.write_text("/**/test_node:\n  ros__parameters:\n    speed: 2\n    robot: {host: from_file}\n")
    process = start_node("--ros-args", "-r", "__ns:=/robot", "--params-file", str(file), "-p", "count:=9", "-p",
                          "switch:=false")
    client = AsyncParameterClient(ros.node, "/robot/test_node")
    assert client.wait_for_services(LIMIT)
    speed, host, count, switch = get(client, "speed", "robot.host", "count", "switch")
    assert (speed.double_value, host.string_value, count.integer_value, switch.bool_value) == \
        (2.0, "from_file", 9, False)
    assert process.stop() == 0


@pytest.mark.parametrize("override, message", [
    ("speed:=9.0", "parameter 'speed' is limited to the range 0 to 3, it cannot be 9.0"),
    ("count:=many", "parameter 'count' is of type integer, it cannot be 'many'"),
])
def test_an_invalid_override_stops_the_node_with_a_message(override, message, start_node):
    process = start_node("--ros-args", "-p", override, ready=False)
    assert process.wait() == 2
    assert message in "".join(process.errors)


def test_responds_to_requests_without_parameters(ros, test_node):
    assert ros.call(SetParameters, "/test_node/set_parameters", SetParameters.Request()).results == []
