"""Selection of plugins, and error messages for plugins that cannot be loaded."""

from plugin_prefix import prepend_path
from programs import start_node
from support import HOME, NAMES_COMMANDS, wait_for

from ur_ros_rtde_msgs.action import MoveJ, SetDigitalOutput

CLASS = '<class name="{name}" type="test::{type}" base_class_type="ur_ros_rtde::CommandPlugin"/>'


def test_unknown_names_are_reported_with_a_suggestion(addresses, processes):
    server = processes(start_node("command_server", addresses[3], "plugins:=[move_j,move_jik]", "plugins_blacklist:=[speed_k]"))
    line = server.wait_for_output('"move_jik"')
    assert "parameter plugins " in line and '"move_j_ik"' in line
    assert '"speed_j"' in server.wait_for_output('"speed_k"')
    assert server.wait(15.0) == 2
    assert "commands: move_j" not in server.output()


def test_an_unknown_name_in_the_blacklist_is_only_reported(addresses, processes):
    server = processes(start_node("command_server", addresses[3], "plugins:=[move_j]", "plugins_blacklist:=[speed_k]"))
    assert "ERROR" in server.wait_for_output('"speed_k"')
    assert server.wait_for_output("commands:").endswith("commands: move_j")


def test_one_list_may_contain_plugins_of_both_servers(addresses, processes):
    server = processes(start_node("driver", addresses[3], "plugins:=[move_j,dashboard/power_on]"))
    assert server.wait_for_output(" commands:").endswith(" commands: move_j")
    assert server.wait_for_output("dashboard commands:").endswith("dashboard commands: dashboard/power_on")
    assert not [line for line in list(server.lines) if "ERROR" in line and "plugin" in line], server.output()


def test_a_blacklisted_plugin_is_not_loaded(addresses, processes):
    server = processes(start_node("command_server", addresses[3], "plugins_blacklist:=[move_j,move_l]", arguments=NAMES_COMMANDS))
    loaded = server.wait_for_output(" all commands: ").split(" commands: ")[1].split(", ")
    assert "stop" in loaded and "move_j" not in loaded and "move_l" not in loaded


def test_a_broken_library_is_reported_and_other_plugins_are_loaded(addresses, client, processes, plugin_prefix):
    prefix = plugin_prefix("broken_plugins", '<library path="broken">' + CLASS.format(name="broken", type="Broken") + "</library>")
    (prefix / "lib" / "libbroken.so").write_bytes(b"\x7fELF this is no library")
    server = processes(start_node("command_server", addresses[3], env=prepend_path("AMENT_PREFIX_PATH", prefix), arguments=NAMES_COMMANDS))
    line = server.wait_for_output("plugin broken of package broken_plugins is left out")
    assert "libbroken.so" in line
    assert "move_j" in server.wait_for_output(" all commands:")
    assert not client.send(MoveJ, "move_j", joint_positions=HOME).accepted  # the server responds


def test_a_parameter_of_a_plugin_that_is_left_out_does_not_prevent_the_start(addresses, processes, plugin_prefix):
    prefix = plugin_prefix("missing", '<library path="nowhere">' + CLASS.format(name="watchdog", type="Watchdog") + "</library>")
    server = processes(start_node("command_server", addresses[3], "watchdog.frequency:=1.0", "plugins:=[move_j]",
                                  env=prepend_path("AMENT_PREFIX_PATH", prefix)))
    server.wait_for_output("parameter watchdog.frequency is set, but no node of this process has it")
    assert server.wait_for_output("commands:").endswith("commands: move_j")


def test_a_missing_library_and_a_malformed_description_are_reported(addresses, processes, plugin_prefix):
    prefix = plugin_prefix("missing", '<library path="nowhere">' + CLASS.format(name="gone", type="Gone") + "</library>")
    (prefix / "share" / "malformed").mkdir()
    (prefix / "share" / "malformed" / "plugins.xml").write_text("<library path='x'><class name=")
    index = prefix / "share" / "ament_index" / "resource_index" / "ur_ros_rtde__pluginlib__plugin" / "malformed"
    index.write_text("share/malformed/plugins.xml\n")
    server = processes(start_node("command_server", addresses[3], env=prepend_path("AMENT_PREFIX_PATH", prefix), arguments=NAMES_COMMANDS))
    server.wait_for_output("libnowhere.so")
    server.wait_for_output("share/malformed/plugins.xml")
    assert "move_j" in server.wait_for_output(" all commands:")


def test_a_duplicate_action_name_is_reported(addresses, processes, plugin_prefix):
    prefix = plugin_prefix("zz_other", '<library path="other">' + CLASS.format(name="move_j", type="Other") + "</library>")
    server = processes(start_node("command_server", addresses[3], env=prepend_path("AMENT_PREFIX_PATH", prefix), arguments=NAMES_COMMANDS))
    line = server.wait_for_output("plugin move_j of package zz_other")
    assert "package ur_ros_rtde_commands has one of that name already" in line
    assert "move_j" in server.wait_for_output(" all commands:")


def test_every_plugin_of_the_package_is_loaded(addresses, client, processes):
    server = processes(start_node("driver", addresses[3], arguments=NAMES_COMMANDS))
    loaded = set(server.wait_for_output(" all commands: ").split(" commands: ")[1].split(", "))
    assert server.wait_for_output("]: commands: ").endswith(f"]: commands: {len(loaded)}, listed by `ur plugins`")
    assert {"move_j", "move_l", "stop", "servo_j", "speed_l", "set_digital_output", "zero_ft_sensor", "set_payload",
            "set_speed_slider"} <= loaded
    server.wait_for_output("dashboard commands:")
    wait_for(lambda: client.send(SetDigitalOutput, "set_digital_output", pin=0).accepted is False, 10.0, "an answer")
    assert "left out" not in server.output()
