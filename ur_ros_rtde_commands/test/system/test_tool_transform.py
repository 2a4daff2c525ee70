"""Tests of the transform base -> tool0_controller on /tf."""

import pytest
from geometry_msgs.msg import PoseStamped
from programs import start_node
from rclpy.node import NodeNameNonExistentError
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool
from support import seconds, wait_for
from tf2_msgs.msg import TFMessage


def transforms(messages, child):
    return [t for message in list(messages) for t in message.transforms if t.child_frame_id == child]


def matches_tcp(simulator, transform):
    tcp = simulator.state()["actual_tcp_pose"]
    t = transform.transform.translation
    return (t.x, t.y, t.z) == pytest.approx(tcp[:3], abs=1e-3)


def get_published_topics(client, namespace):
    """Returns the published topics of the receiver, once discovery is complete. The receiver creates its subscription last."""
    receiver = ("robot_state_receiver", namespace)

    def complete():
        try:
            subscribed = client.node.get_subscriber_names_and_types_by_node(*receiver)
        except NodeNameNonExistentError:
            return False
        return f"{namespace}/fake_joint_states" in dict(subscribed)

    wait_for(complete, 15.0, f"{namespace}/robot_state_receiver")
    return dict(client.node.get_publisher_names_and_types_by_node(*receiver))


def test_broadcasts_the_pose_and_the_stamp_of_tcp_pose(simulator, client, processes):
    processes(start_node("robot_state_receiver", simulator.address, "tf_prefix:=left_", namespace="with_tf"))
    poses = client.subscribe(PoseStamped, "/with_tf/tcp_pose")
    tf = client.subscribe(TFMessage, "/tf")
    child = "left_tool0_controller"
    wait_for(lambda: len(tf) > 100 and len(poses) > 100, 20.0, "100 transforms and poses")
    assert all(len(message.transforms) == 1 for message in list(tf))
    by_stamp = {seconds(pose.header.stamp): pose for pose in list(poses)}
    matching = [(t, by_stamp[seconds(t.header.stamp)]) for t in transforms(tf, child) if seconds(t.header.stamp) in by_stamp]
    assert len(matching) > 50
    for transform, pose in matching:
        assert transform.header.frame_id == pose.header.frame_id == "left_base"
        t, p = transform.transform.translation, pose.pose.position
        assert (t.x, t.y, t.z) == (p.x, p.y, p.z)
        assert transform.transform.rotation == pose.pose.orientation
    assert matches_tcp(simulator, matching[-1][0])


def test_qos_is_compatible_with_tf2_listeners(simulator, client, processes):
    processes(start_node("robot_state_receiver", simulator.address, "qos:=best_effort", namespace="best_effort"))
    assert "/tf" in get_published_topics(client, "/best_effort")
    publishers = client.node.get_publishers_info_by_topic("/tf")
    assert [publisher.node_namespace for publisher in publishers] == ["/best_effort"]
    # tf2_ros::TransformListener requests reliable messages.
    assert publishers[0].qos_profile.reliability == ReliabilityPolicy.RELIABLE
    assert publishers[0].qos_profile.durability == DurabilityPolicy.VOLATILE


def test_broadcasts_the_actual_pose_along_with_fake_joint_states(simulator, client, processes):
    processes(start_node("robot_state_receiver", simulator.address, "tf_prefix:=faked_", namespace="faked"))
    shown = client.subscribe(JointState, "/faked/joint_states")
    tf = client.subscribe(TFMessage, "/tf")
    publisher = client.node.create_publisher(JointState, "/faked/fake_joint_states", 10)
    wait_for(lambda: publisher.get_subscription_count() and shown, 15.0, "the receiver")
    assert client.call(SetBool, "/faked/publish_fake_joint_states", data=True).success
    publisher.publish(JointState(name=["faked_elbow_joint"], position=[0.25]))
    wait_for(lambda: shown[-1].position[2] == 0.25, 10.0, "the fake elbow position")
    number = len(tf)
    wait_for(lambda: len(tf) > number + 20, 10.0, "later transforms")
    assert matches_tcp(simulator, transforms(tf, "faked_tool0_controller")[-1])


def test_tf_can_be_remapped_into_the_namespace(simulator, client, processes):
    processes(start_node("robot_state_receiver", simulator.address, namespace="own", arguments=["-r", "/tf:=tf"]))
    tf = client.subscribe(TFMessage, "/own/tf")
    assert wait_for(lambda: transforms(tf, "tool0_controller"), 15.0, "a transform")


def test_publish_tf_false_disables_the_broadcast(simulator, client, processes):
    processes(start_node("robot_state_receiver", simulator.address, "publish_tf:=false", namespace="quiet"))
    assert "/tf" not in get_published_topics(client, "/quiet")
