"""The scene, through the handles of viser: poses, visibility and colors that a browser receives."""

import time

import numpy as np
import pytest
import yaml
from ur_ros_rtde_description.calibration import FIELDS, JOINT_KEYS
from ur_ros_rtde_description.errors import DescriptionError
from ur_ros_rtde_description.kinematics import Origin, flange_pose, nominal_origins
from ur_ros_rtde_description.models import find_model
from ur_ros_rtde_viewer.arguments import RobotOptions
from ur_ros_rtde_viewer.scene import trail
from ur_ros_rtde_viewer.scene.robot_scene import STOPPED_COLOR, RobotScene
from ur_ros_rtde_viewer.scene.surfaces import OPENING, SIZE, THICKNESS, turn_z_to
from ur_ros_rtde_viewer.scene.urdf import read_description
from ur_ros_rtde_viewer.state.robot_state import Joints, Pose, RobotState

POSITIONS = np.array((0.3, -1.2, 1.4, -0.7, -1.5, 0.9))


def joints(positions):
    return Joints(0.0, np.array(positions, float), np.zeros(6), np.zeros(6))


def rotation(wxyz):
    w, x, y, z = wxyz
    return np.array(((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                     (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                     (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))))


def pose_in_scene(server, path):
    """Returns the pose of a scene node in the scene, as a browser composes it."""
    pose = np.eye(4)
    names = path.strip("/").split("/")
    for depth in range(len(names)):
        handle = server.scene.get_handle_by_name("/" + "/".join(names[:depth + 1]))
        if handle is not None:
            local = np.eye(4)
            local[:3, :3], local[:3, 3] = rotation(handle.wxyz), handle.position
            pose = pose @ local
    return pose


@pytest.fixture
def scene(server):
    created = RobotScene(server.scene, RobotOptions("left", "ur5e", (0.0, 0.4, 0.8), (0.0, 0.0, np.pi / 2)))
    yield created
    created.remove()


def test_robots_have_nodes_of_their_own_for_all_namespaces(server):
    namespaces = ("left", "left/arm", "", "robot", "floor")
    scenes = [RobotScene(server.scene, RobotOptions(namespace, "ur5e"), index) for index, namespace in enumerate(namespaces)]
    roots = [scene.root for scene in scenes]
    assert len(set(roots)) == len(roots) and all(root.count("/") == 1 and root != "/floor" for root in roots)
    scenes.pop(0).remove()
    for scene in scenes:
        assert server.scene.get_handle_by_name(scene.arm.link_path("tool0")) is not None
        scene.remove()


@pytest.mark.parametrize("model", ["ur3e", "ur5e", "ur10e", "ur20"])
def test_the_tool_is_where_forward_kinematics_puts_it(server, model):
    scene = RobotScene(server.scene, RobotOptions("", model))
    scene.update(RobotState(joints=joints(POSITIONS)))
    base, tool = (pose_in_scene(server, scene.arm.link_path(name)) for name in ("base", "tool0"))
    expected = flange_pose(nominal_origins(find_model(model)), POSITIONS)
    assert np.linalg.inv(base) @ tool == pytest.approx(expected, abs=1e-6)
    scene.remove()


def test_the_base_is_mounted_where_the_options_say(server, scene):
    mounted = pose_in_scene(server, scene.arm.link_path("base_link"))
    assert mounted[:3, 3] == pytest.approx((0.0, 0.4, 0.8)) and mounted[:3, 0] == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)


def test_the_arm_appears_with_its_first_positions(server, scene):
    root = server.scene.get_handle_by_name(f"{scene.root}/arm")
    assert not root.visible
    scene.update(RobotState(joints=joints(POSITIONS)))
    assert root.visible and scene.arm.positions == pytest.approx(POSITIONS)


def test_unchanged_positions_send_nothing(server, scene):
    state = RobotState(joints=joints(POSITIONS))
    scene.update(state)
    buffer = server._websock_server._broadcast_buffer
    sent = buffer.message_counter
    scene.update(state)
    assert buffer.message_counter == sent
    scene.update(RobotState(joints=joints(POSITIONS + 0.1)))
    assert buffer.message_counter == sent + 6


def test_the_server_keeps_only_the_newest_values(server, scene, monkeypatch):
    monkeypatch.setattr(trail, "PERIOD", 0.0)  # each step draws the trail
    buffer = server._websock_server._broadcast_buffer

    def kept_after(steps):
        for step in range(steps):
            pose = Pose(np.array((0.001 * step, 0.2, 0.3)), np.array((1.0, 0.0, 0.0, 0.0)))
            scene.update(RobotState(joints=joints(POSITIONS + 0.001 * step), target_joints=joints(POSITIONS), tcp_pose=pose,
                                    wrench=np.full(6, 3.0 + step)))
        return len(buffer.message_from_id)

    assert kept_after(200) == kept_after(400)


def test_the_ghost_shows_the_target_where_it_differs(server, scene):
    ghost = server.scene.get_handle_by_name(f"{scene.root}/ghost")
    scene.update(RobotState(joints=joints(POSITIONS), target_joints=joints(POSITIONS)))
    assert not ghost.visible
    scene.update(RobotState(joints=joints(POSITIONS), target_joints=joints(POSITIONS + 0.2)))
    assert ghost.visible and scene.ghost.positions == pytest.approx(POSITIONS + 0.2)


def test_the_ghost_shows_the_real_joints_beside_fake_ones(scene):
    scene.update(RobotState(joints=joints(POSITIONS + 1.0), actual_joints=joints(POSITIONS), target_joints=joints(POSITIONS + 0.5)))
    assert scene.arm.positions == pytest.approx(POSITIONS + 1.0) and scene.ghost.positions == pytest.approx(POSITIONS)


def test_a_protective_stop_colors_the_arm_until_it_ends(server, scene):
    shape = server.scene.get_handle_by_name(scene.arm.link_path("forearm_link") + "/shape_0")
    original = tuple(shape.color)
    scene.update(RobotState(joints=joints(POSITIONS), safety_mode="PROTECTIVE_STOP"))
    assert tuple(shape.color) == STOPPED_COLOR != original
    scene.update(RobotState(joints=joints(POSITIONS), safety_mode="NORMAL"))
    assert tuple(shape.color) == original


def test_the_force_is_an_arrow_that_pushes_the_tcp(server, scene):
    pose = Pose(np.array((0.1, 0.2, 0.3)), np.array((1.0, 0.0, 0.0, 0.0)))
    arrow = server.scene.get_handle_by_name(scene.arm.link_path("base") + "/tcp/force")
    scene.update(RobotState(joints=joints(POSITIONS), tcp_pose=pose, wrench=np.array((0.0, 0.0, 40.0, 0.0, 0.0, 0.0))))
    assert arrow.visible and arrow.points[0] == pytest.approx(np.array(((0.0, 0.0, -0.2), (0.0, 0.0, 0.0))))
    scene.update(RobotState(joints=joints(POSITIONS), tcp_pose=pose, wrench=np.zeros(6)))
    assert not arrow.visible


def test_the_trail_is_bounded_and_ignores_an_arm_at_rest(server, monkeypatch):
    drawn = trail.Trail(server.scene, "/trail")
    for index in range(3 * trail.POINTS):
        drawn.add(np.array((0.01 * index, 0.0, 0.0)))
    assert len(drawn.points) == trail.POINTS and drawn.points[-1, 0] == pytest.approx(0.01 * (3 * trail.POINTS - 1), rel=1e-5)
    drawn.add(drawn.points[-1] + 1e-4)
    assert len(drawn.points) == trail.POINTS
    monkeypatch.setattr(time, "monotonic", lambda: np.inf)  # the next update is due
    drawn.add(drawn.points[-1] + 1.0)
    assert len(server.scene.get_handle_by_name("/trail").points) == trail.POINTS - 1
    drawn.remove()


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 0.6, 0.8)])
def test_a_surface_is_perpendicular_to_its_normal(normal):
    assert rotation(turn_z_to(normal))[:, 2] == pytest.approx(normal)


def test_surfaces_are_drawn_once_and_removed(server, scene):
    table, wall = ((0.0, 0.0, 0.1), (0.0, 0.0, 1.0)), ((0.5, 0.0, 0.0), (-1.0, 0.0, 0.0))
    base = scene.arm.link_path("base")

    def drawn():
        return [handle for handle in (scene._surfaces._drawn.get(surface) for surface in (table, wall)) if handle is not None]

    scene.show_surfaces([table, wall])
    first = drawn()
    scene.show_surfaces([table])
    assert len(first) == 2 and drawn() == first[:1]
    table_pose = np.linalg.inv(pose_in_scene(server, base)) @ pose_in_scene(server, first[0].name)
    assert table_pose[:3, 3] == pytest.approx((0.0, 0.0, 0.1 - THICKNESS / 2.0))
    scene.show_surfaces([])
    assert not drawn()


def test_the_drawn_part_of_a_surface_is_next_to_the_base_of_the_arm(scene):
    wall = ((0.7, 3.0, -2.0), (-1.0, 0.0, 0.0))
    scene.show_surfaces([wall])
    assert tuple(scene._surfaces._drawn[wall].position) == pytest.approx((0.7 + THICKNESS / 2.0, 0.0, 0.0))


@pytest.mark.parametrize("height, opened", [(0.4, True), (0.0, False), (-0.2, False)])
def test_a_table_leaves_out_the_column_of_the_arm(scene, height, opened):
    table = ((0.0, 0.0, height), (0.0, 0.0, 1.0))
    scene.show_surfaces([table])
    drawn = scene._surfaces._drawn[table]
    if opened:
        triangles = drawn.vertices[drawn.faces][:, :, :2]
        corners = np.roll(triangles, -1, axis=1) - triangles
        assert np.abs(np.linalg.det(corners[:, :2])).sum() / 2.0 == pytest.approx(SIZE**2 - OPENING**2)
        assert np.abs(triangles).max(axis=2).min() == pytest.approx(OPENING / 2.0)
    else:
        assert tuple(drawn.dimensions) == (SIZE, SIZE, THICKNESS)
    scene.show_surfaces([])


def test_calibration_and_tool_are_part_of_the_scene(server, tmp_path):
    origins = [Origin(tuple(np.add(origin.xyz, 1e-3)), origin.rpy) for origin in nominal_origins(find_model("ur5e"))]
    file = tmp_path / "calibration.yaml"
    joint_origins = {key: dict(zip(FIELDS, map(float, (*origin.xyz, *origin.rpy)))) for key, origin in zip(JOINT_KEYS, origins)}
    file.write_text(yaml.safe_dump({"kinematics": {**joint_origins, "hash": "calib_1"}}))
    scene = RobotScene(server.scene, RobotOptions("tooled", "ur5e", kinematics_params_file=str(file), tool_length=0.2))
    scene.update(RobotState(joints=joints(POSITIONS)))
    base, tip = (pose_in_scene(server, scene.arm.link_path(name)) for name in ("base", "tool_tip"))
    expected = flange_pose(origins, POSITIONS) @ Origin((0.0, 0.0, 0.2)).transform()
    assert np.linalg.inv(base) @ tip == pytest.approx(expected, abs=1e-6)
    scene.remove()


def joint(name, parent, child, xyz="0 0 0"):
    return f'<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}"/></joint>'


@pytest.mark.parametrize("joints, message", [
    (joint("a", "base", "palm", "0 0"), "joint a: its origin has a value"),
    (joint("a", "base", "palm", "0 0 high"), "joint a: its origin has a value"),
    (joint("a", "base", "palm") + joint("b", "thumb", "finger"), "joint b: thumb is not connected to base"),
    (joint("a", "base", "palm") + joint("b", "base", "finger") + joint("c", "finger", "palm"), "joint c: .* palm has two parents"),
])
def test_joints_that_are_no_tree_are_rejected(joints, message):
    links = "".join(f'<link name="{name}"/>' for name in ("base", "palm", "finger"))
    with pytest.raises(DescriptionError, match=message):
        read_description(f"<robot name='g'>{links}{joints}</robot>")
