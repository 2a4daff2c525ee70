import functools
import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))

import documentation  # noqa: E402
import messages  # noqa: E402
import plugins  # noqa: E402
from cells import Cells, Outcomes  # noqa: E402


def pytest_addoption(parser):
    parser.addoption("--plugin", action="append", default=[], metavar="NAME", help="only this one; may be repeated")
    parser.addoption("--cells", type=int, default=int(os.environ.get("UR_TEST_CELLS", "3")), metavar="N",
                     help="simulators and drivers at once")


@functools.lru_cache
def examples():
    """Of each plugin that is there and documented, test_documentation.py names those that are not; but for actions of others,
    whose results are not ours."""
    found = {}
    for section in documentation.sections():
        if section.name in plugins.find():
            try:
                found[section.name] = section.example()
            except ValueError:
                pass
    return {name: example for name, example in found.items() if messages.is_ours(example.type)}


def pytest_generate_tests(metafunc):
    """A module may say for which examples it is: `concerns(example)`."""
    if "plugin" in metafunc.fixturenames:
        chosen = metafunc.config.getoption("--plugin")
        concerns = getattr(metafunc.module, "concerns", lambda example: True)
        metafunc.parametrize("plugin", [name for name, example in sorted(examples().items())
                                        if concerns(example) and (not chosen or name in chosen)])


@pytest.fixture(scope="session")
def cells(request):
    cells = Cells(request.config.getoption("--cells"))
    yield cells
    cells.close()


@pytest.fixture(scope="module")
def outcomes(request, cells):
    """Of the module's function `scenario`, for all plugins whose tests are to run."""
    names = {item.callspec.params["plugin"] for item in request.session.items
             if item.module is request.module and "plugin" in getattr(getattr(item, "callspec", None), "params", {})}
    return Outcomes(cells, request.module.scenario, [examples()[name] for name in sorted(names)])


@pytest.fixture
def outcome(outcomes, plugin):
    return outcomes.of(plugin)
