"""Interface packages that the driver uses where they are installed; the tests' build defines them where they are not."""

import ctypes
import importlib.util
import json
import pathlib
import sys

from support import find_program

BUILD = pathlib.Path(find_program("ur_ros_rtde", "driver")).parents[3] / "build"
# The tests' build of these packages defines the interfaces that are not installed.
DEFINED_BY = {"control_msgs": "ur_ros_rtde_commands", "tf2_msgs": "ur_ros_rtde"}
KINDS = ("generator_c", "typesupport_c", "typesupport_introspection_c", "typesupport_fastrtps_cpp", "typesupport_fastrtps_c",
         "generator_py")


def folder_of(package):
    return BUILD / DEFINED_BY[package] / "test" / package


def provide(package):
    """Makes Python find `package`. Returns the folder of our libraries, or None where the package is installed."""
    if importlib.util.find_spec(package):
        return None
    build = folder_of(package)
    sys.path.insert(0, str(build / "rosidl_generator_py"))
    # rosidl loads the libraries by their names alone; those already loaded are found.
    for kind in KINDS:
        ctypes.CDLL(str(build / f"lib{package}__rosidl_{kind}.so"), ctypes.RTLD_GLOBAL)
    return build


def type_hashes(package):
    """{type: hash} of our definitions."""
    folder = folder_of(package) / "rosidl_generator_type_description" / package
    return {entry["type_name"]: entry["hash_string"]
            for file in folder.rglob("*.json") for entry in json.loads(file.read_text())["type_hashes"]}
