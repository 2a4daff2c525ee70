"""package.xml declares all packages that CMake files find and Python files import."""

import ast
import re
import sys
import xml.etree.ElementTree as xml

from ur_tools import packages
from ur_tools.layout import ROOT

BACKGROUND = True
PACKAGES = packages.discover(ROOT)
BUILD = {"depend", "build_depend", "buildtool_depend"}
RUN = {"depend", "exec_depend"}
ANY = packages.DEPENDENCIES

# Where a CMake package, target or Python module and the rosdep key have different names.
KEYS = {"Boost": "libboost-dev", "CLI11": "cli11", "Eigen3": "eigen", "GTest": "gtest", "GTest::gmock": "libgmock-dev",
        "Git": "git", "Python3": "python3", "nlohmann_json": "nlohmann-json-dev", "tl-expected": "libexpected-dev",
        "matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "pytest": "python3-pytest", "yaml": "python3-yaml"}
MODULES = {"ur_ros_rtde": "ur_ros_rtde_python", "ur_ros_rtde_launch": "ur_ros_rtde"}  # Python modules and their packages
NOT_DECLARED = {"Threads",  # part of CMake
                "copp_py", "toppra",  # solvers that oracle.py compares with
                # No rosdep key for rosbags, and viser, which requires the others; the programs say how to install them.
                "rosbags", "viser", "websockets", "msgspec", "zstandard",
                "playwright"}  # installed by `./ur test` for the browser tests


def declared(name, kinds):
    tree = xml.parse(PACKAGES[name].folder / "package.xml").getroot()
    return {name, *(node.text.strip() for node in tree if node.tag in kinds)}


def files(name, *patterns):
    folder = PACKAGES[name].folder
    ignored = [path.parent for path in folder.rglob("COLCON_IGNORE")]
    ignored += [path.parent / "python" for path in folder.glob("pyproject.toml")]  # installed by pip, which reads pyproject.toml
    found = [path for pattern in patterns for path in folder.rglob(pattern)]
    return [path for path in found if path.is_file() and not any(parent in ignored for parent in path.parents)]


def is_test(path):
    return "test" in path.parts or "bench" in path.parts


def found_packages(text):
    """Returns the packages of find_package(), also in a loop over a list, and gmock, which GTest's package file includes."""
    text = re.sub(r'"[^"]*"', '""', text)  # messages may mention find_package()
    names = set(re.findall(r"find_package\(([\w-]+)", text))
    for variable in re.findall(r"foreach\(dependency IN LISTS (\w+)\)", text):
        names.update(re.search(rf"set\({variable}\s([^)]*)\)", text).group(1).split())
    return names | set(re.findall(r"GTest::gmock\b", text))


def imported(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module.split(".")[0]


def undeclared(names, known):
    return {KEYS.get(name, name) for name in set(names) - NOT_DECLARED} - known


def reported(path, names):
    """Returns a line for each name that package.xml of this file does not declare."""
    return [f"{path.relative_to(ROOT)}: {name}" for name in sorted(names)]


def test_cmake_packages_are_declared():
    missing = []
    for name in PACKAGES:
        for path in files(name, "CMakeLists.txt", "*.cmake"):
            known = declared(name, ANY if is_test(path) else BUILD)
            missing += reported(path, undeclared(found_packages(path.read_text()), known))
    assert not missing, "\n".join(missing)


def test_imported_python_modules_are_declared():
    missing = []
    for name in PACKAGES:
        local = {path.stem for path in files(name, "*.py")} | {path.parent.name for path in files(name, "__init__.py")}
        local |= {path.stem for path in files("ur_ros_rtde_commands", "*.py") if "system" in path.parts} | {"stops", "ros_domain"}
        for path in files(name, "*.py"):
            known = declared(name, ANY if is_test(path) else RUN)
            modules = set(imported(path)) - local - set(sys.stdlib_module_names)
            missing += reported(path, undeclared({MODULES.get(module, module) for module in modules}, known))
    assert not missing, "\n".join(missing)


def test_executables_that_launch_files_start_are_declared():
    missing = []
    for name in PACKAGES:
        for path in files(name, "*.launch.py"):
            text = path.read_text()
            required = re.search(r"^PACKAGES = \((.*?)\)", text, re.M | re.S)  # whether they are installed
            known = declared(name, RUN) | set(re.findall(r'"(\w+)"', required.group(1) if required else ""))
            missing += reported(path, set(re.findall(r'package="(\w+)"', text)) - known)
    assert not missing, "\n".join(missing)


def test_the_build_tool_of_each_package_is_declared():
    for name, package in PACKAGES.items():
        build_type = xml.parse(package.folder / "package.xml").getroot().findtext("export/build_type")
        assert build_type in declared(name, {"buildtool_depend"}), name
