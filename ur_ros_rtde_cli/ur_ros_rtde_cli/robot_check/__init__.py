"""Checks of a robot over the network. They read only: nothing moves, and no program of the robot is started or stopped.

Depends on the standard library alone, except for the comparison with a calibration file, and neither on ROS nor on ur_rtde.
"""
