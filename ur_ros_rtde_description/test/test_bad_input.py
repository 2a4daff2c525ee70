"""Invalid input is rejected with the field, the value and the remedy, and nothing is written."""

import math
import os
import pathlib
import shlex
import subprocess
import sys

import pytest
from helpers import calibration, write_calibration
from ur_ros_rtde_description.errors import DescriptionError
from ur_ros_rtde_description.kinematics import nominal_origins
from ur_ros_rtde_description.launch_arguments import ARGUMENTS, check_names, description_options, is_true, xacro_arguments
from ur_ros_rtde_description.models import find_model, models
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.program import main

BACKGROUND = True


def rejection(model="ur10e", **options):
    with pytest.raises(DescriptionError) as error:
        read_options(model, **options)
    return str(error.value)


def nominal(model="ur10e"):
    return calibration(nominal_origins(find_model(model)))


@pytest.mark.parametrize("name, hint", [("ur5f", "did you mean ur5"), ("kuka", "The models are: ur3, ur5"), ("", "The models")])
def test_an_unknown_model_is_rejected_with_the_most_similar_one(name, hint):
    text = rejection(name)
    assert f'model is "{name}"' in text and hint in text


@pytest.mark.parametrize("name", ["UR8 Long", "ur8_long", "UR8-LONG"])
def test_the_name_of_a_model_may_have_any_spelling(name):
    assert read_options(name).model.name == "ur8long"


@pytest.mark.parametrize("field", ["tf_prefix", "parent"])
@pytest.mark.parametrize("value", ["left arm", "left-", "${x}", "ä", "a\nb", '"'])
def test_a_name_with_other_characters_is_rejected(field, value):
    assert f'{field} is "{value}", it may contain letters' in rejection(**{field: value})


def test_the_parent_is_no_link_of_the_arm():
    assert 'parent is "left_tool0"' in rejection(parent="left_tool0", tf_prefix="left_")
    assert 'parent is "tool_tip"' in rejection(parent="tool_tip", tool_length=0.1)
    read_options("ur10e", parent="tool0", tf_prefix="left_")  # a link of another arm


@pytest.mark.parametrize("field", ["xyz", "rpy"])
def test_a_mounting_pose_is_finite(field):
    assert f"{field} is [0.0, nan, 0.0]" in rejection(**{field: (0.0, math.nan, 0.0)})


@pytest.mark.parametrize("options, mentions", [
    ({"tool_length": 0.0}, "tool_length is 0, it must be above 0"), ({"tool_length": math.inf}, "tool_length is inf"),
    ({"tool_length": 0.1, "tool_radius": -1.0}, "tool_radius is -1"), ({"tool_length": 0.1, "tool_mass": math.nan}, "tool_mass is nan"),
    ({"tool_mass": 1.0}, "tool_length is missing"), ({"tool": "a.urdf", "tool_length": 0.1}, "either a file or a cylinder"),
])
def test_an_invalid_cylinder_is_rejected(options, mentions):
    assert mentions in rejection(**options)


@pytest.mark.parametrize("text, mentions", [
    ("<robot", "not XML"), ("<sdf/>", "the element is <sdf>"), ("<robot/>", "0 links have no parent"),
    ('<robot><link name="a"/><link name="b"/></robot>', "2 links have no parent (a, b)"),
    ('<robot><link name="a"/><joint name="j"><parent link="a"/><child link="b"/></joint></robot>', 'the link "b", which does not exist'),
    ('<robot><link name="a"/><link name="a"/></robot>', '2 links with the name "a"'),
    ('<robot><link name="a"/><link name="b"/><link name="c"/><joint name="j"><parent link="b"/><child link="c"/></joint>'
     '<joint name="k"><parent link="c"/><child link="b"/></joint></robot>', "the link b is part of a loop"),
    ('<robot><link name="flange"/></robot>', 'a link has the name "flange"'),
    ('<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>', "convert it first: xacro"),
])
def test_an_invalid_tool_is_rejected(text, mentions, tmp_path):
    file = tmp_path / "tool.urdf"
    file.write_text(text)
    found = rejection(tool=str(file))
    assert mentions in found and str(file) in found


def test_a_missing_file_is_rejected(tmp_path):
    for field in ("tool", "kinematics_params_file"):
        assert f'{field} is "{tmp_path}/none": No such file' in rejection(**{field: f"{tmp_path}/none"})
        assert "Is a directory" in rejection(**{field: str(tmp_path)})


@pytest.mark.parametrize("change, mentions", [
    (lambda content: content.pop("kinematics"), "the field kinematics is missing"),
    (lambda content: content["kinematics"].pop("forearm"), "the field kinematics.forearm is missing"),
    (lambda content: content["kinematics"]["wrist_1"].pop("yaw"), "the field kinematics.wrist_1.yaw is missing"),
    (lambda content: content["kinematics"]["wrist_1"].update(yaw=math.nan), "kinematics.wrist_1.yaw is nan, it must be a finite number"),
    (lambda content: content["kinematics"]["wrist_1"].update(x="far"), "kinematics.wrist_1.x is 'far'"),
    (lambda content: content["kinematics"]["wrist_1"].update(x=True), "kinematics.wrist_1.x is True"),
    (lambda content: content["kinematics"]["wrist_1"].update(x=[1]), "kinematics.wrist_1.x is [1]"),
    (lambda content: content["kinematics"]["wrist_1"].update(w=1.0), "kinematics.wrist_1 has the unknown field w"),
    (lambda content: content["kinematics"].update(fore_arm={}), "the unknown field fore_arm; did you mean forearm?"),
    (lambda content: content.update(kinematics=[1]), "kinematics is [1], it must be a mapping"),
])
def test_an_invalid_calibration_is_rejected(change, mentions, tmp_path):
    content = nominal()
    change(content)
    file = write_calibration(tmp_path, content)
    text = rejection(kinematics_params_file=file)
    assert mentions in text and file in text


@pytest.mark.parametrize("text, mentions", [("", "the content is None"), ("[", ":1: not YAML"), ("7", "the content is 7"),
                                            ("{kinematics: }", "the field kinematics is missing")])
def test_a_file_that_is_no_calibration_is_rejected(text, mentions, tmp_path):
    file = tmp_path / "calibration.yaml"
    file.write_text(text)
    assert mentions in rejection(kinematics_params_file=str(file))


@pytest.mark.parametrize("owner", models())
@pytest.mark.parametrize("model", models())
def test_the_calibration_of_another_model_is_rejected(owner, model, tmp_path):
    file = write_calibration(tmp_path, nominal(owner))
    if nominal_origins(find_model(owner)) == nominal_origins(find_model(model)):
        read_options(model, kinematics_params_file=file)
        return
    text = rejection(model, kinematics_params_file=file)
    assert f"does not belong to the model {model}" in text and owner in text.split("It fits")[1]


def test_the_program_prints_the_error_and_writes_nothing(tmp_path, capsys):
    output = tmp_path / "arm.urdf"
    output.write_text("before")
    assert main(["--model", "ur5e", "--tf-prefix", "a b", "--output", str(output)]) == 2
    assert capsys.readouterr().err == 'tf_prefix is "a b", it may contain letters, digits, \'_\' and \'/\'\n'
    assert output.read_text() == "before" and list(tmp_path.iterdir()) == [output]


def test_the_program_writes_a_file(tmp_path):
    output = tmp_path / "arm.urdf"
    assert main(["--model", "ur5e", "--xyz", "0", "-0.5", "0.8", "--output", str(output)]) == 0
    assert 'xyz="0 -0.5 0.8"' in output.read_text() and list(tmp_path.iterdir()) == [output]


@pytest.mark.parametrize("length, status", [(255, 0), (256, 2)])
def test_the_name_of_the_output_has_the_length_that_the_file_system_allows(length, status, tmp_path, capsys):
    output = tmp_path / ("a" * length)
    assert main(["--model", "ur5e", "--output", str(output)]) == status
    assert ("File name too long" in capsys.readouterr().err) == (status == 2) == (list(tmp_path.iterdir()) == [])


@pytest.mark.parametrize("output, mentions", [("none/arm.urdf", "No such file or directory"), (os.devnull, "not a file"),
                                              (".", "not a file"), (f"{os.devnull}/arm.urdf", "Not a directory")])
def test_an_output_that_cannot_be_written_is_rejected(output, mentions, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["--model", "ur5e", "--output", output]) == 2
    assert f'output is "{pathlib.Path(output)}": ' in (text := capsys.readouterr().err) and mentions in text
    assert list(tmp_path.iterdir()) == [] and pathlib.Path(os.devnull).is_char_device()


def test_the_help_needs_only_the_standard_library():
    code = """
import sys
for missing in ("numpy", "yaml"):
    sys.modules[missing] = None
from ur_ros_rtde_description import arguments
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def launch_values(**given):
    return {**{argument.name: argument.default for argument in ARGUMENTS}, "ur_type": "ur5e", **given}


def test_launch_arguments_become_options():
    options = description_options(launch_values(tf_prefix="left_", xyz="0 -0.5 8e-1", parent="table"))
    assert (options.tf_prefix, options.parent, options.mount.xyz) == ("left_", "table", (0.0, -0.5, 0.8))
    assert is_true("launch_rviz", launch_values()) and not is_true("meshes", launch_values())


def test_xacro_reads_the_calibration_of_a_relative_path(tmp_path, monkeypatch):
    """xacro looks for a relative path in the folder of ur.urdf.xacro."""
    monkeypatch.chdir(tmp_path)
    pathlib.Path(write_calibration(tmp_path, nominal("ur5e"))).rename("my robot.yaml")
    values = launch_values(kinematics_params_file="my robot.yaml", tf_prefix="left_", meshes="true")
    assert shlex.split(xacro_arguments(values, description_options(values))) == [
        "name:=ur5e", "ur_type:=ur5e", "tf_prefix:=left_", f"kinematics_params:={tmp_path}/my robot.yaml"]
    values = launch_values(meshes="true")
    assert shlex.split(xacro_arguments(values, description_options(values))) == ["name:=ur5e", "ur_type:=ur5e", "tf_prefix:="]


@pytest.mark.parametrize("name, value", [("xyz", "0 0"), ("rpy", "0 0 x"), ("meshes", "yes"), ("ur_type", "ur6"), ("tf_prefix", "a b")])
def test_an_invalid_launch_argument_is_rejected(name, value):
    with pytest.raises(DescriptionError, match=f'(model|{name}) is "{value}"'):
        values = launch_values(**{name: value})
        description_options(values), is_true("meshes", values)


def test_an_unknown_launch_argument_is_rejected():
    check_names(["ur_type", "launch-prefix"])
    with pytest.raises(DescriptionError, match="no launch argument prefix; did you mean tf_prefix"):
        check_names(["prefix"])
