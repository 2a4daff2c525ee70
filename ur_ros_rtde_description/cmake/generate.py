"""Writes the URDF and the xacro macro of each model into a folder."""

import pathlib
import sys

from ur_ros_rtde_description.models import models
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.urdf import make_urdf, make_xacro

folder = pathlib.Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)
for name in models():
    (folder / f"{name}.urdf").write_text(make_urdf(read_options(name)))
    (folder / f"{name}.xacro").write_text(make_xacro(read_options(name)))
