"""Compares the kinematics of the controller with the description in use."""

import pathlib
from typing import Optional

from .finding import Finding, fault, ok, warning
from .primary import ControllerKinematics


def judge(kinematics: Optional[ControllerKinematics], model: str, file: str) -> Finding:
    """`file`: the calibration in use, empty for the nominal kinematics of the model."""
    if kinematics is None:
        return warning("calibration", "the controller does not report its kinematics", "compare tcp_pose with the URDF in some positions")
    try:
        from ur_ros_rtde_description import controller_calibration  # imported here because it needs numpy and PyYAML
        from ur_ros_rtde_description.errors import DescriptionError
    except ImportError as error:
        return warning("calibration", f"not compared: the Python module {error.name} is missing",
                       "run it in `./ur shell`, or install numpy and PyYAML")
    try:
        deviation = controller_calibration.deviation(kinematics, model, pathlib.Path(file) if file else None)
    except DescriptionError as error:
        return fault("calibration", str(error), "extract the calibration of this robot with `ur calibration`")
    text = f"{1e3 * deviation.distance:.2f} mm and {deviation.angle:.5f} rad"
    used = f"the calibration {file}" if file else f"the nominal kinematics of a {model}"
    if deviation.is_negligible():
        return ok("calibration", f"the arm agrees with {used}")
    return warning("calibration", f"the flange deviates by up to {text} from {used}",
                   "`ur calibration --robot ADDRESS --output FILE` saves the calibration of this arm; use FILE as kinematics_params_file "
                   "of the description")
