"""./ur fuzz: builds the libFuzzer targets of the simulator and the driver with clang and runs them, starting from their corpora."""

import pathlib
import shutil
import subprocess
from typing import Dict, List

from . import console
from . import fuzz_campaign as campaign
from .environment import build_environment
from .layout import ROOT, Layout

PROJECT = ROOT / "tools" / "fuzz"
COMPILER = "clang++"
INPUT_BYTES = 4096
INPUT_SECONDS = 10
# A small quarantine and short stacks of allocations save time. Remove them to see where the memory of a report came from.
ASAN_OPTIONS = "quarantine_size_mb=8:malloc_context_size=2"


def folders() -> Dict[str, pathlib.Path]:
    """Returns the folder fuzz/ of the package of each target."""
    return {path.stem[len("fuzz_"):]: path.parent for path in sorted(ROOT.glob("*/fuzz/fuzz_*.cpp"))}


def targets() -> List[str]:
    return sorted(folders())


def selected(names: List[str]) -> List[str]:
    unknown = sorted(set(names) - set(targets()))
    if unknown:
        raise console.Failure(f"there is no fuzz target {', '.join(unknown)}; the targets are {', '.join(targets())}")
    return names or targets()


def build_folder(layout: Layout, fast: bool) -> pathlib.Path:
    return layout.base / ("fuzz-fast" if fast else "fuzz")


def _build(layout: Layout, names: List[str], fast: bool, jobs: int) -> None:
    folder = build_folder(layout, fast)
    cmake = str(layout.venv / "bin" / "cmake")
    env = build_environment(layout, jobs)
    subprocess.run([cmake, "-S", str(PROJECT), "-B", str(folder), "-GNinja", "-DCMAKE_BUILD_TYPE=Release",
                    f"-DCMAKE_CXX_COMPILER={COMPILER}", f"-DFUZZ_FAST={'ON' if fast else 'OFF'}"], env=env, check=True)
    subprocess.run([cmake, "--build", str(folder), "--target", *(f"fuzz_{name}" for name in names)], env=env, check=True)


def command(layout: Layout, name: str, fast: bool, *options: str) -> List[str]:
    """Returns the command that fuzzes one target. The inputs that it finds are kept between runs and builds."""
    folder = build_folder(layout, False)
    found = folder / "corpus" / name
    found.mkdir(parents=True, exist_ok=True)
    return [str(build_folder(layout, fast) / f"fuzz_{name}"), *options, f"-max_len={INPUT_BYTES}", f"-timeout={INPUT_SECONDS}",
            f"-artifact_prefix={folder}/{name}-", "-print_final_stats=1", str(found), str(folders()[name] / "corpus" / name)]


def _environment(layout: Layout) -> Dict[str, str]:
    """Returns the environment of a target."""
    env = build_environment(layout, 1)
    env["LD_LIBRARY_PATH"] = str(layout.venv / "lib")  # of ament_index_cpp
    env.setdefault("ASAN_OPTIONS", ASAN_OPTIONS)
    return env


def _campaign(layout: Layout, names: List[str], fast: bool, options: List[str], executions: int, jobs: int) -> List[str]:
    """Runs the targets and returns those that failed."""
    _build(layout, names, fast, jobs)
    folder = build_folder(layout, False)
    targets = [campaign.Target(name, command(layout, name, fast, *options), folder / f"{name}.log") for name in names]
    results = campaign.run(targets, _environment(layout), executions, jobs)
    console.line(campaign.table(results))
    return [result.name for result in results if result.failed]


def run(layout: Layout, names: List[str], seconds: int, executions: int, fast: bool, jobs: int) -> int:
    """Fuzzes the targets; 0 seconds, -1 executions: no limit. After a fast run, the saved inputs run with all sanitizers."""
    chosen = selected(names)
    if shutil.which(COMPILER) is None:
        raise console.Failure(f"{COMPILER} is not installed; libFuzzer is part of clang (Debian package clang)")
    failed = _campaign(layout, chosen, fast, [f"-max_total_time={seconds}", f"-runs={executions}"], executions, jobs)
    passed = [name for name in chosen if name not in failed]
    if fast and passed:
        console.step("Running the saved inputs with AddressSanitizer")
        failed += _campaign(layout, passed, False, ["-runs=0"], -1, jobs)
    folder = build_folder(layout, False)
    for name in failed:
        console.line(f"{name} failed: {folder}/{name}.log has the report, {folder}/{name}-* is the input. Add it to "
                     f"{folders()[name].relative_to(ROOT)}/corpus/{name} with the fix.")
    return 1 if failed else 0
