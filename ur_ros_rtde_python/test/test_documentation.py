"""Runs the examples in docs/use/python.md, in their order, with one robot."""

import pathlib
import re
import tempfile

DRIVER_PARAMETERS = ["stream_timeout:=1.0"]  # the pauses of a busy host are shorter
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "use" / "python.md"


def test_the_examples_run(arm, simulator, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.S)
    assert len(blocks) >= 9
    scope = {}
    for block in blocks:
        scope["arm"] = arm  # the first example creates a Robot of its own and closes it
        if "force_mode" in block:
            simulator.control("place_surface", z=arm.state.tcp_pose[2] - 0.005, stiffness=20000.0)
        exec(compile(block, str(PAGE), "exec"), scope)
    output = capsys.readouterr().out
    assert "speed 9.0 above 0 and at most 3.14 rad/s" in output
    assert "canceled by a client" in output
    simulator.control("clear_surfaces")


def test_the_attributes_exist(arm):
    section = PAGE.read_text().split("## State")[1].split("## Recordings")[0]
    names = [name for row in re.findall(r"^\| (`.*?) \|", section, re.M) for name in re.findall(r"`(\w+)[`(]", row)]
    assert len(names) > 15 and all(hasattr(arm.state, name) for name in names if name != "arm"), names


def test_the_members_of_a_goal_exist(arm):
    goal = arm.start.stop()
    names = re.findall(r"`goal\.(\w+)", PAGE.read_text())
    assert len(names) >= 5 and all(hasattr(goal, name) for name in names)
    goal.result(10.0)
