"""control_msgs, where it is installed; else the interfaces of that name that the tests' build defines.

Import this before control_msgs. PLUGIN is the library of follow_joint_trajectory where it is not installed, LIBRARIES
the folder of the interfaces' libraries.
"""

from interface_fallback import provide

LIBRARIES = provide("control_msgs")
PLUGIN = LIBRARIES / "libur_ros_rtde_moveit_commands.so" if LIBRARIES else None
