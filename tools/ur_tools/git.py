"""Runs git in a checkout, also in one of another user; lists the sources, also without git."""

import os
import pathlib
import shutil
import subprocess
from typing import Iterator, List

from .layout import ROOT

# Variables that name the repository of a git hook: a program that runs git elsewhere would change that one.
REPOSITORY_VARIABLES = ("GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_COMMON_DIR", "GIT_CONFIG", "GIT_CONFIG_PARAMETERS", "GIT_DIR",
                   "GIT_GRAFT_FILE", "GIT_IMPLICIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_INTERNAL_SUPER_PREFIX", "GIT_NAMESPACE",
                   "GIT_NO_REPLACE_OBJECTS", "GIT_OBJECT_DIRECTORY", "GIT_PREFIX", "GIT_QUARANTINE_PATH", "GIT_REPLACE_REF_BASE",
                   "GIT_SHALLOW_FILE", "GIT_WORK_TREE")
_GENERATED = (".git", ".ur", "build", "install", "log")  # folders in the root of the checkout
_CACHES = ("__pycache__", ".pytest_cache")


def run(*arguments: str, root: pathlib.Path = ROOT) -> "subprocess.CompletedProcess[str]":
    """Returns the result of git in `root`, even if that belongs to another user (from git 2.38 on). The status is 127 if git is not
    installed."""
    command = ["git", "-c", f"safe.directory={root}", *arguments]
    env = {name: value for name, value in os.environ.items() if name not in REPOSITORY_VARIABLES}
    try:
        return subprocess.run(command, cwd=root, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                              errors="surrogateescape")
    except FileNotFoundError:
        return subprocess.CompletedProcess(command, 127, "", "git is not installed")


def files(root: pathlib.Path = ROOT) -> List[pathlib.Path]:
    """Returns the files that git tracks or would add, without deleted ones. Without git, all but generated ones."""
    names = run("ls-files", "--cached", "--others", "--exclude-standard", "-z", root=root).stdout.split("\0")
    found = [root / name for name in names if name] or _walk(root)  # there are none in an ignored folder of another repository
    return sorted({path for path in found if path.is_file()})


def copy_files(target: pathlib.Path) -> None:
    """Copies the files of this checkout, as `git clone` would, with changed and new ones."""
    for path in files():
        copy = target / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)


def _walk(root: pathlib.Path) -> Iterator[pathlib.Path]:
    for folder, folders, names in os.walk(root):
        excluded = _GENERATED if pathlib.Path(folder) == root else ()
        folders[:] = [name for name in folders if name not in (*excluded, *_CACHES)]
        yield from (pathlib.Path(folder, name) for name in names)
