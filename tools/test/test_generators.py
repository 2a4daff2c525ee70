"""The interface generators write the same files with and without wheels/generators, which makes them fast."""

import json
import os
import pathlib
import subprocess
import sys

import pytest
from ur_tools.layout import ROOT

BACKGROUND = True
PREFIX = pathlib.Path(sys.prefix)
FAST = ROOT / "wheels" / "generators"
BUILD = next(PREFIX.parent.glob("build*/ur_ros_rtde_msgs"))  # of any variant
INTERFACES = ["action/MoveL.action", "action/ExecuteTrajectory.action", "msg/ArmState.msg", "srv/GetTcpPose.srv"]


@pytest.fixture
def folder(tmp_path):
    """A folder with the .idl files of some interfaces."""
    source = BUILD / "rosidl_adapter" / "ur_ros_rtde_msgs"
    for name in INTERFACES:
        idl = pathlib.Path(name).with_suffix(".idl")
        (tmp_path / "idl" / idl).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "idl" / idl).write_text((source / idl).read_text())
    return tmp_path


def generate(folder, generator, output, fast):
    """Returns the files that a generator writes: {name: text}."""
    arguments = json.loads((BUILD / f"{generator}__arguments.json").read_text())
    idls = [pathlib.Path(name).with_suffix(".idl") for name in INTERFACES]
    arguments["idl_tuples"] = [f"{folder / 'idl'}:{idl}" for idl in idls]
    arguments["output_dir"] = str(folder / output)
    arguments["target_dependencies"] = []
    file = folder / f"{output}.json"
    file.write_text(json.dumps(arguments))
    program = PREFIX / "lib" / generator / generator
    extra = ["--typesupports", "rosidl_typesupport_fastrtps_cpp"] if generator == "rosidl_typesupport_cpp" else []
    env = {**os.environ, "PYTHONPATH": str(FAST) if fast else ""}
    result = subprocess.run([sys.executable, program, "--generator-arguments-file", file, *extra], env=env, timeout=300,
                            capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return {str(path.relative_to(folder / output)): path.read_text() for path in (folder / output).rglob("*") if path.is_file()}


@pytest.mark.parametrize("generator", ["rosidl_generator_c", "rosidl_generator_cpp", "rosidl_typesupport_cpp",
                                       "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"])
def test_the_generated_files_are_the_same(folder, generator):
    plain = generate(folder, generator, "plain", fast=False)
    assert plain
    assert generate(folder, generator, "first", fast=True) == plain
    assert sorted(path.suffix for path in (folder / "idl").rglob("*.parsed")) == [".parsed"] * len(INTERFACES)
    assert generate(folder, generator, "from_parsed", fast=True) == plain


@pytest.mark.parametrize("damage", [b"", b"not a pickle", b"\x80\x04."])
def test_a_damaged_cache_file_is_ignored(folder, damage):
    plain = generate(folder, "rosidl_generator_cpp", "plain", fast=False)
    for name in INTERFACES:
        (folder / "idl" / name).with_suffix(".parsed").write_bytes(damage)
    assert generate(folder, "rosidl_generator_cpp", "fast", fast=True) == plain


def test_a_changed_interface_is_parsed_again(folder):
    generate(folder, "rosidl_generator_cpp", "before", fast=True)
    idl = folder / "idl" / "msg" / "ArmState.idl"
    idl.write_text(idl.read_text().replace("struct ArmState {", "struct ArmState {\n      double added_field;", 1))
    assert "added_field" in generate(folder, "rosidl_generator_cpp", "after", fast=True)["msg/detail/arm_state__struct.hpp"]
