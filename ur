#!/usr/bin/env python3
"""Builds, tests and runs this project: see ./ur --help."""
import locale
import os
import sys

if sys.version_info < (3, 8):
    sys.exit("./ur needs Python 3.8 or newer to start, this is " + sys.version.split()[0])
if not sys.flags.utf8_mode and locale.getpreferredencoding(False).upper() != "UTF-8":  # of all files, and of the output
    os.environ["PYTHONUTF8"] = "1"
    os.execv(sys.executable, [sys.executable, *sys.argv])
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "tools"))

from ur_tools.main import main  # noqa: E402

sys.exit(main())
