"""Checks the sources: formatting of C++, Python with ruff and mypy, the Dockerfile with hadolint, machine-specific paths, clang-tidy."""

import pathlib
import re
import shutil
import subprocess
from dataclasses import dataclass
from typing import List

from . import console, git
from .build import Options, build, cmake_arguments
from .environment import build_environment
from .layout import ROOT, Layout

CPP = (".cpp", ".hpp", ".h", ".c")
# Paths of one machine, and addresses of package registries, which pip and apt are configured with.
_MACHINE_SPECIFIC = re.compile(r"(?<![\w.])/(?:work|root|tmp|home/[a-z]\w*)/[\w.-]|files\.pythonhosted|pypi\.org/simple")


@dataclass
class Check:
    name: str
    ok: bool
    text: str = ""


def cpp_files() -> List[pathlib.Path]:
    return [path for path in git.files(ROOT) if path.suffix in CPP]


def _run_tool(layout: Layout, program: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([str(layout.venv / "bin" / program), *arguments], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True)


def _clang_format(layout: Layout, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return _run_tool(layout, "clang-format", *arguments, *map(str, cpp_files()))


def check_format(layout: Layout) -> Check:
    if not cpp_files():
        return Check("sources: formatting", True)
    result = _clang_format(layout, "--dry-run", "--Werror")
    wrong = sorted({line.split(":")[0] for line in result.stdout.splitlines() if "clang-format-violations" in line})
    text = "\n".join("    " + name for name in wrong) or console.tail(result.stdout, 10)
    return Check("sources: formatting", result.returncode == 0, f"{text}\n    Run `./ur format`.")


def _findings(result: "subprocess.CompletedProcess[str]") -> str:
    return "\n".join("    " + line for line in result.stdout.splitlines())


def check_ruff(layout: Layout) -> Check:
    """Style, imports and likely bugs of all Python, as ruff.toml selects."""
    result = _run_tool(layout, "ruff", "check", "--color", "never", "--output-format", "concise",
                       "--cache-dir", str(layout.base / "ruff_cache"))
    return Check("sources: ruff", result.returncode == 0, f"{_findings(result)}\n    In `./ur shell`, `ruff check --fix` corrects some.")


def _test_folders() -> List[str]:
    """Returns the folders with tests in Python. Each is checked alone: the names of their modules repeat."""
    folders = {path.relative_to(ROOT).parent for path in git.files(ROOT) if path.match("test_*.py")}
    return sorted(str(folder) for folder in folders if "test" in folder.parts)


def check_mypy(layout: Layout) -> Check:
    """Types of all Python except tests, as mypy.ini selects, and of the tests, as mypy_tests.ini does."""
    def run(cache: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
        return _run_tool(layout, "mypy", "--no-color-output", "--no-pretty", "--cache-dir", str(layout.base / cache), *arguments)

    results = [run("mypy_cache"), *(run("mypy_tests_cache", "--config-file", "mypy_tests.ini", folder) for folder in _test_folders())]
    failed = [result for result in results if result.returncode]
    return Check("sources: mypy", not failed, "\n".join(dict.fromkeys("\n".join(map(_findings, failed)).splitlines())))


def check_dockerfile(layout: Layout) -> Check:
    result = _run_tool(layout, "hadolint", "--no-color", "Dockerfile")
    return Check("sources: hadolint", result.returncode == 0, _findings(result))


def check_paths() -> Check:
    found = []
    for path in git.files(ROOT):
        if path == pathlib.Path(__file__) or path.suffix in (".png", ".patch"):
            continue
        try:
            lines = path.read_text().splitlines()
        except UnicodeDecodeError:
            continue
        for number, line in enumerate(lines, 1):
            if _MACHINE_SPECIFIC.search(line) and not line.startswith("#!"):
                found.append(f"    {path.relative_to(ROOT)}:{number}: {line.strip()[:100]}")
    return Check("sources: machine-specific paths and registry addresses", not found, "\n".join(found))


def checks(layout: Layout) -> List[Check]:
    console.step("Checking the sources")
    return [check_format(layout), check_ruff(layout), check_mypy(layout), check_dockerfile(layout), check_paths()]


def format_sources(layout: Layout) -> int:
    result = _clang_format(layout, "-i")
    if result.returncode:
        raise console.Failure(result.stdout)
    console.line(f"{len(cpp_files())} C++ files are formatted")
    return 0


def databases(layout: Layout) -> List[pathlib.Path]:
    """Returns compilation databases without unity builds, so that each file has an entry."""
    databases = []
    for name, package in build(Options(layout, tests=True)).items():
        if not (package.folder / "src").is_dir():
            continue  # interfaces or Python
        folder = layout.base / "tidy" / name
        command = ["cmake", "-S", str(package.folder), "-B", str(folder), *cmake_arguments(Options(layout), True),
                   "-DCMAKE_UNITY_BUILD=OFF", f"-DCMAKE_PREFIX_PATH={layout.install}"]
        subprocess.run(command, check=True, env=build_environment(layout, 1), stdout=subprocess.DEVNULL)
        databases.append(folder / "compile_commands.json")
    return databases


def tidy(layout: Layout) -> List[Check]:
    program = next((found for found in map(shutil.which, ("clang-tidy-19", "clang-tidy")) if found), None)
    if program is None:
        raise console.Failure("clang-tidy is not installed: sudo apt-get install -y clang-tidy")
    found = []
    for database in databases(layout):
        sources = [path for path in cpp_files() if path.suffix == ".cpp" and str(path) in database.read_text()]
        for source in sources:
            console.line(f"    {source.relative_to(ROOT)}")
            found.append(_check_tidy(program, database, source))
    return found


def _check_tidy(program: str, database: pathlib.Path, source: pathlib.Path) -> Check:
    result = subprocess.run([program, "--quiet", "-p", str(database.parent), str(source)], cwd=ROOT, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, universal_newlines=True)
    ok = result.returncode == 0 and "warning:" not in result.stdout
    return Check(f"clang-tidy: {source.relative_to(ROOT)}", ok, result.stdout or console.tail(result.stderr, 10))


def run(layout: Layout, with_tidy: bool) -> int:
    everything = checks(layout) + (tidy(layout) if with_tidy else [])
    for check in everything:
        if not check.ok:
            console.line(f"FAILED  {check.name}\n{check.text}")
    bad = sum(1 for check in everything if not check.ok)
    console.line(f"{len(everything) - bad} checks passed, {bad} failed")
    return 1 if bad else 0
