"""./ur fuzz: builds the libFuzzer targets of the simulator and the driver with clang and runs them, starting from their corpora."""

import pathlib
import shutil
import subprocess
from typing import Dict, List

from . import console
from .environment import build_environment
from .layout import ROOT, Layout

PROJECT = ROOT / "tools" / "fuzz"
COMPILER = "clang++"
INPUT_BYTES = 4096
INPUT_SECONDS = 10


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


def _build(layout: Layout, names: List[str], jobs: int) -> pathlib.Path:
    folder = layout.base / "fuzz"
    cmake = str(layout.venv / "bin" / "cmake")
    env = build_environment(layout, jobs)
    subprocess.run([cmake, "-S", str(PROJECT), "-B", str(folder), "-GNinja", "-DCMAKE_BUILD_TYPE=Release",
                    f"-DCMAKE_CXX_COMPILER={COMPILER}"], env=env, check=True)
    subprocess.run([cmake, "--build", str(folder), "--target", *(f"fuzz_{name}" for name in names)], env=env, check=True)
    return folder


def command(folder: pathlib.Path, name: str, seconds: int, executions: int = -1) -> List[str]:
    """Returns the command that fuzzes one target. Inputs that it finds are kept between runs; `folder` is the build."""
    found = folder / "corpus" / name
    found.mkdir(parents=True, exist_ok=True)
    return [str(folder / f"fuzz_{name}"), f"-max_total_time={seconds}", f"-runs={executions}", f"-max_len={INPUT_BYTES}",
            f"-timeout={INPUT_SECONDS}", f"-artifact_prefix={folder}/{name}-", "-print_final_stats=1", str(found),
            str(folders()[name] / "corpus" / name)]


def run(layout: Layout, names: List[str], seconds: int, executions: int, jobs: int) -> int:
    chosen = selected(names)
    if shutil.which(COMPILER) is None:
        raise console.Failure(f"{COMPILER} is not installed; libFuzzer is part of clang (Debian package clang)")
    folder = _build(layout, chosen, max(jobs, 1))
    env = build_environment(layout, 1)
    env["LD_LIBRARY_PATH"] = str(layout.venv / "lib")  # of ament_index_cpp
    failed = [name for name in chosen if subprocess.run(command(folder, name, seconds, executions), env=env).returncode != 0]
    for name in failed:
        console.line(f"{name} failed; the input is in {folder}/{name}-*. Add it to "
                     f"{folders()[name].relative_to(ROOT)}/corpus/{name} with the fix.")
    return 1 if failed else 0
