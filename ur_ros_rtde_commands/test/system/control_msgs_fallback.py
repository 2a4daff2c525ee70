"""Makes control_msgs importable: the installed package, or the definitions built with the tests.

Import this before control_msgs. If control_msgs is not installed, PLUGIN is the library of follow_joint_trajectory and
LIBRARIES the folder of the interface libraries. Otherwise both are None.
"""

from interface_fallback import provide

LIBRARIES = provide("control_msgs")
PLUGIN = LIBRARIES / "libur_ros_rtde_moveit_commands.so" if LIBRARIES else None
