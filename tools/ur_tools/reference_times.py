"""What pytest files take on two cores: duration in s and load in cores. Used until a checkout has its own measurements."""

from typing import Dict, Tuple

REFERENCE: Dict[str, Tuple[float, float]] = {
    "ur_ros_rtde: nodes/test_orientation": (100.0, 0.2),
    "ur_ros_rtde: nodes/test_trajectory_commands": (80.0, 0.3),
    "ur_ros_rtde: typed/test_protective_stop": (50.0, 0.9),
    "ur_ros_rtde_cli: test_cli": (75.0, 0.4),
    "tools: test_chaos": (50.0, 0.4),
    "ur_ros_rtde: nodes/test_streams": (50.0, 0.3),
    "ur_ros_rtde: typed/test_shutdown": (50.0, 0.9),
    "ur_ros_rtde: typed/test_emergency_stop": (40.0, 0.9),
    "ur_ros_rtde: typed/test_good_goals": (42.0, 0.9),
    "ur_ros_rtde: nodes/test_motion_commands": (40.0, 0.3),
    "ur_ros_rtde: nodes/test_until_commands": (40.0, 0.3),
    "tools: test_bench": (38.0, 0.2),
    "tools: test_writing_a_plugin": (40.0, 1.2),
    "ur_ros_rtde: nodes/test_second_driver": (38.0, 0.4),
    "ur_ros_rtde: nodes/test_operation_commands": (37.0, 0.3),
    "ur_ros_rtde_tutorials: test_examples": (30.0, 0.5),
    "tools: test_demo": (32.0, 0.6),
    "ur_ros_rtde: nodes/test_commands": (30.0, 0.3),
    "ur_ros_rtde: nodes/test_client_lost": (30.0, 0.4),
    "ur_ros_rtde: nodes/test_dashboard": (30.0, 0.3),
    "ur_ros_rtde: typed/test_bad_goals": (24.0, 1.2),
    "ur_ros_rtde: typed/test_link_loss": (27.0, 0.9),
    "ur_ros_rtde: nodes/test_lifecycle": (27.0, 0.4),
    "ur_ros_rtde: typed/test_momentary_commands": (26.0, 0.9),
    "ur_ros_rtde: typed/test_controller_death": (20.0, 0.9),
    "ur_ros_rtde: typed/test_cancel": (20.0, 0.9),
    "tools: test_generators": (18.0, 1.0),
}
