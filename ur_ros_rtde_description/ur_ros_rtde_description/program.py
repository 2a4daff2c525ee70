"""Prints the URDF of an arm, or a xacro macro.

    urdf --model ur10e > ur10e.urdf
    urdf --model ur5e --tf-prefix left_ --parent table --xyz 0 0.4 0.8 --output left.urdf

Links and joints have the names and frames of ur_description. The geometry consists of cylinders and spheres.
"""

import argparse
import contextlib
import os
import pathlib
import sys
from typing import List, Optional

from .arguments import add_arguments
from .errors import DescriptionError
from .options import read_options
from .urdf import make_urdf, make_xacro


def describe(arguments: argparse.Namespace) -> str:
    """Returns the URDF or the macro. Raises DescriptionError if an argument is invalid."""
    options = read_options(arguments.model, arguments.tf_prefix, arguments.kinematics_params_file, arguments.parent, arguments.xyz,
                           arguments.rpy, arguments.tool, arguments.tool_length, arguments.tool_radius, arguments.tool_mass)
    return make_xacro(options) if arguments.xacro else make_urdf(options)


def write(file: pathlib.Path, text: str) -> None:
    """Writes a file as a whole or not at all."""
    temporary = file.parent / f".{os.getpid()}.urdf"
    try:
        if file.exists() and not file.is_file():
            raise DescriptionError(f"output is \"{file}\": it exists and is not a file")
        temporary.write_text(text)
        os.replace(temporary, file)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise DescriptionError(f"output is \"{file}\": {error.strerror}") from None


def run(arguments: argparse.Namespace) -> int:
    try:
        text = describe(arguments)
        if arguments.output is None:
            sys.stdout.write(text)
        else:
            write(arguments.output, text)
    except DescriptionError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="urdf", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    return run(parser.parse_args(arguments))
