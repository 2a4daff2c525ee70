"""The faster interface generators of the build on wheels (wheels/generators)."""

import os
import pathlib
import subprocess
import sys

GENERATORS = pathlib.Path(__file__).parents[2] / "wheels" / "generators"
# What a generator does for one file. Its name decides whether sitecustomize.py takes effect.
GENERATOR = """
import sys, rosidl_pycommon
rosidl_pycommon.expand_template(sys.argv[1], {"name": sys.argv[2]}, sys.argv[3], minimum_timestamp=float("inf"))
"""


def generate(folder, name):
    script, template, output = folder / "rosidl_generator_test", folder / "greeting.em", folder / "greeting.txt"
    script.write_text(GENERATOR)
    template.write_text("hello @(name)\n")
    subprocess.run([sys.executable, str(script), str(template), name, str(output)], check=True, timeout=60,
                   env={**os.environ, "PYTHONPATH": str(GENERATORS)})
    return output


def test_a_file_that_does_not_change_keeps_its_time(tmp_path):
    output = generate(tmp_path, "arm")
    os.utime(output, (1000, 1000))
    generate(tmp_path, "arm")
    assert output.stat().st_mtime == 1000


def test_a_file_that_changes_is_written(tmp_path):
    output = generate(tmp_path, "arm")
    os.utime(output, (1000, 1000))
    assert generate(tmp_path, "robot").read_text() == "hello robot\n"
    assert output.stat().st_mtime > 1000
