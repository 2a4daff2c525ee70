"""./ur fuzz: builds the libFuzzer targets of the simulator with clang and runs them, starting from their corpora."""

import pathlib
import shutil
import subprocess
from typing import List

from . import console
from .environment import build_environment
from .layout import ROOT, Layout

FUZZ = ROOT / "ur_simulator" / "fuzz"
COMPILER = "clang++"
INPUT_BYTES = 4096
INPUT_SECONDS = 10


def targets() -> List[str]:
    return sorted(path.stem[len("fuzz_"):] for path in FUZZ.glob("fuzz_*.cpp"))


def selected(names: List[str]) -> List[str]:
    unknown = sorted(set(names) - set(targets()))
    if unknown:
        raise console.Failure(f"there is no fuzz target {', '.join(unknown)}; the targets are {', '.join(targets())}")
    return names or targets()


def _build(layout: Layout, names: List[str], jobs: int) -> pathlib.Path:
    folder = layout.base / "fuzz"
    cmake = str(layout.venv / "bin" / "cmake")
    env = build_environment(layout, jobs)
    subprocess.run([cmake, "-S", str(ROOT / "ur_simulator"), "-B", str(folder), "-GNinja", "-DCMAKE_BUILD_TYPE=Release",
                    f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DUR_SIMULATOR_FUZZ=ON"], env=env, check=True)
    subprocess.run([cmake, "--build", str(folder), "--target", *(f"fuzz_{name}" for name in names)], env=env, check=True)
    return folder


def command(folder: pathlib.Path, name: str, seconds: int) -> List[str]:
    """Returns the command that fuzzes one target. Inputs that it finds are kept between runs; `folder` is the build."""
    found = folder / "corpus" / name
    found.mkdir(parents=True, exist_ok=True)
    return [str(folder / "fuzz" / f"fuzz_{name}"), f"-max_total_time={seconds}", f"-max_len={INPUT_BYTES}",
            f"-timeout={INPUT_SECONDS}", f"-artifact_prefix={folder}/{name}-", "-print_final_stats=1", str(found),
            str(FUZZ / "corpus" / name)]


def run(layout: Layout, names: List[str], seconds: int, jobs: int) -> int:
    chosen = selected(names)
    if shutil.which(COMPILER) is None:
        raise console.Failure(f"{COMPILER} is not installed; libFuzzer is part of clang (Debian package clang)")
    folder = _build(layout, chosen, max(jobs, 1))
    failed = [name for name in chosen if subprocess.run(command(folder, name, seconds)).returncode != 0]
    for name in failed:
        console.line(f"{name} failed; the input is in {folder}/{name}-*. Add it to {FUZZ.relative_to(ROOT)}/corpus/{name} with the fix.")
    return 1 if failed else 0
