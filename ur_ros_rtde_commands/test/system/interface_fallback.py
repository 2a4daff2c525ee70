"""Optional interface packages. The definitions built with the tests replace packages that are not installed."""

import ctypes
import importlib.util
import json
import pathlib
import sys

from support import find_program

BUILD = pathlib.Path(find_program("ur_ros_rtde", "driver")).parents[3] / "build"
# The packages whose test build defines the interfaces.
DEFINED_BY = {"control_msgs": "ur_ros_rtde_commands", "tf2_msgs": "ur_ros_rtde"}
KINDS = ("generator_c", "typesupport_c", "typesupport_introspection_c", "typesupport_fastrtps_cpp", "typesupport_fastrtps_c",
         "generator_py")


def build_folder(package):
    return BUILD / DEFINED_BY[package] / "test" / package


def provide(package):
    """Makes `package` importable. Returns the folder of the libraries built with the tests, or None if the package is installed."""
    if importlib.util.find_spec(package):
        return None
    build = build_folder(package)
    sys.path.insert(0, str(build / "rosidl_generator_py"))
    # rosidl loads the libraries by name without a path, which succeeds for libraries that are already loaded.
    for kind in KINDS:
        ctypes.CDLL(str(build / f"lib{package}__rosidl_{kind}.so"), ctypes.RTLD_GLOBAL)
    return build


def type_hashes(package):
    """Returns {type name: type hash} of the definitions built with the tests."""
    folder = build_folder(package) / "rosidl_generator_type_description" / package
    return {entry["type_name"]: entry["hash_string"]
            for file in folder.rglob("*.json") for entry in json.loads(file.read_text())["type_hashes"]}
