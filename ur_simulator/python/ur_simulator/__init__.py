"""A simulated Universal Robots controller for tests and examples without a robot."""

from .robot import SimulatedRobot, SimulatorError, program

__all__ = ["SimulatedRobot", "SimulatorError", "program"]
