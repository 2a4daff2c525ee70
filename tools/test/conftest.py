import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from ur_tools import build, isolation, main

isolation.ros_domain.reserve()


@pytest.fixture
def run_without_build(monkeypatch, capsys):
    """Returns a function that runs `./ur` with a build that fails the test, and returns its status and output."""
    monkeypatch.setattr(build, "build", lambda *_: pytest.fail("it builds"))

    def run(*arguments):
        try:
            status = main.main([str(argument) for argument in arguments])
        except SystemExit as wrong_option:
            status = wrong_option.code
        printed = capsys.readouterr()
        return status, printed.out + printed.err

    return run
