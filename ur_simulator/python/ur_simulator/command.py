"""The command ur-simulator: runs the program in the place of this process."""

import os
import sys

from .robot import program


def main() -> None:
    executable = str(program())
    os.execv(executable, [executable, *sys.argv[1:]])
