"""control_msgs, where it is installed; else the interfaces of that name that the tests' build defines.

Import this before control_msgs. PLUGIN is the library of follow_joint_trajectory where it is not installed, LIBRARIES
the folder of the interfaces' libraries.
"""

import ctypes
import pathlib
import sys

from support import program

BUILD = pathlib.Path(program("ur_ros_rtde", "driver")).parents[3] / "build" / "ur_ros_rtde" / "test" / "control_msgs"
PLUGIN = None
LIBRARIES = None

try:
    import control_msgs.action  # noqa: F401
except ImportError:
    PLUGIN = BUILD / "libur_ros_rtde_moveit_commands.so"
    LIBRARIES = BUILD
    sys.path.insert(0, str(BUILD / "rosidl_generator_py"))
    # rosidl loads them by their names alone; what is loaded already is found.
    for kind in ("generator_c", "typesupport_c", "typesupport_introspection_c", "typesupport_fastrtps_cpp",
                 "typesupport_fastrtps_c", "generator_py"):
        ctypes.CDLL(str(BUILD / f"libcontrol_msgs__rosidl_{kind}.so"), ctypes.RTLD_GLOBAL)
