import functools
import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))

import documentation
import messages
import plugins
from cell_pool import CellPool, Outcomes


def pytest_addoption(parser):
    parser.addoption("--plugin", action="append", default=[], metavar="NAME", help="test only this plugin; can be given several times")
    parser.addoption("--cells", type=int, default=int(os.environ.get("UR_TEST_CELLS", "3")), metavar="N",
                     help="number of parallel cells, each with a simulator and a driver")


@functools.lru_cache
def examples():
    """Returns the examples of all installed plugins that are documented.

    test_documentation.py reports undocumented plugins. Actions of other packages, whose results differ, are omitted.
    """
    found = {}
    for section in documentation.sections():
        if section.name in plugins.find():
            try:
                found[section.name] = section.example()
            except ValueError:
                pass
    return {name: example for name, example in found.items() if messages.has_standard_result(example.type)}


def pytest_generate_tests(metafunc):
    """Parametrizes `plugin`. A module restricts the examples with a function `applies_to(example)`."""
    if "plugin" in metafunc.fixturenames:
        chosen = metafunc.config.getoption("--plugin")
        applies_to = getattr(metafunc.module, "applies_to", lambda example: True)
        metafunc.parametrize("plugin", [name for name, example in sorted(examples().items())
                                        if applies_to(example) and (not chosen or name in chosen)])


@pytest.fixture(scope="session")
def cell_pool(request):
    pool = CellPool(request.config.getoption("--cells"))
    yield pool
    pool.close()


@pytest.fixture(scope="module")
def outcomes(request, cell_pool):
    """The outcomes of the module's function `scenario` for all selected plugins."""
    names = {item.callspec.params["plugin"] for item in request.session.items
             if item.module is request.module and "plugin" in getattr(getattr(item, "callspec", None), "params", {})}
    return Outcomes(cell_pool, request.module.scenario, [examples()[name] for name in sorted(names)])


@pytest.fixture
def outcome(request, outcomes, plugin):
    if getattr(request.node, "execution_count", 1) > 1:  # the test is repeated because the host stalled
        outcomes.repeat(plugin)
    try:
        return outcomes.get(plugin)
    finally:
        request.node.began = outcomes.began.get(plugin)  # before the test, for host_stalls
