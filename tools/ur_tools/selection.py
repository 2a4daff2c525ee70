"""Selects tests by name or by changed files."""

import ast
import difflib
import pathlib
import re
from dataclasses import dataclass, field
from typing import Callable, Dict, Iterable, List, Optional, Set

from . import console, docs, git
from .layout import ROOT
from .packages import Package

TOOLS = "tools"  # stands for tools/test
_CASE = re.compile(r"^\s*(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)", re.M)
_TARGET = re.compile(r"\b(?:add_executable|ament_add_gtest)\((\w+)[\s)]")
_FUZZ_REPLAY = re.compile(r"\badd_fuzz_replay\((\w+)")
_CPP = (".cpp", ".hpp", ".h", ".c")
# A change below these folders affects all packages.
_ALL_PACKAGES = ("wheels/", "tools/cmake/")
_DOCUMENTS = (".md", ".rst", ".cff")
# Files and folders at the top whose contents only tests and the checks of the sources read.
_ONLY_READ = (".", "Dockerfile", "LICENSE", "compose.", "mypy", "ruff.toml")
_BUILDS_SITE = "docs.build("
# Folders that belong to a module of ur_tools.
_FOLDERS_OF_MODULES = {"bench/": "bench", "chaos/": "chaos", "demo/": "demo",
                       "compare_recording/": "compare_recording",
                       "tools/sanitizers/": "testing", "tools/system_packages.txt": "system_packages"}


@dataclass
class Source:
    """A file with tests."""

    package: str
    path: pathlib.Path
    cases: List[str] = field(default_factory=list)  # of GoogleTest: Suite.case

    @property
    def is_pytest(self) -> bool:
        return self.path.suffix == ".py"


def test_folders(packages: Dict[str, Package], root: pathlib.Path = ROOT) -> Dict[str, pathlib.Path]:
    return {**{name: package.folder / "test" for name, package in packages.items()}, TOOLS: root / "tools" / "test"}


def sources(packages: Dict[str, Package], root: pathlib.Path = ROOT) -> List[Source]:
    found = []
    for package, folder in test_folders(packages, root).items():
        for path in sorted(folder.rglob("*")):
            if path.suffix == ".py" and path.name.startswith("test_"):
                found.append(Source(package, path))
            elif path.suffix == ".cpp":
                found.append(Source(package, path, [".".join(case) for case in _CASE.findall(path.read_text())]))
            elif path.name == "CMakeLists.txt":
                text = path.read_text()
                names = _TARGET.findall(text) + [f"fuzz.{name}" for name in _FUZZ_REPLAY.findall(text)]
                found += [Source(package, path.with_name(f"{name}.cpp")) for name in names]
    return found


class Selection:
    """Selected tests, and the packages to build for them (None: all)."""

    def __init__(self, chooses: Callable[..., bool], packages: Optional[Set[str]]):
        self._chooses = chooses
        self.packages = None if packages is None or TOOLS in packages else sorted(packages)

    def chooses(self, package: str, name: str, path: Optional[pathlib.Path]) -> bool:
        """`path`: the pytest file, or the program of a GoogleTest."""
        return self._chooses(package, name, path)


def everything() -> Selection:
    return Selection(lambda *_: True, None)


# --- By name ------------------------------------------------------------------------------------------------------------


def _as_name(word: str) -> str:
    """Returns the file name of a path, and other words unchanged."""
    return pathlib.PurePath(word).stem if "/" in word and re.search(r"\.(py|cpp)$", word) else word


def _names(source: Source) -> List[str]:
    return [source.path.stem, *source.cases]


def _matches(word: str, source: Source, packages: Iterable[str]) -> bool:
    if word in packages:
        return source.package == word
    suites = {case.split(".")[0] for case in source.cases}
    # CTest adds prefixes and parameters: robot.StopTest.KeepsItsLine, Each/UnreachablePathTest.is_rejected/2.
    if suites & set(re.split(r"[./]", word)):
        return True
    return word.lower() in source.package or any(word.lower() in name.lower() for name in _names(source))


def by_name(words: List[str], packages: Dict[str, Package], root: pathlib.Path = ROOT) -> Selection:
    known = sources(packages, root)
    words = [_as_name(word) for word in words]
    folders = test_folders(packages, root)
    matching: Dict[str, List[Source]] = {word: [one for one in known if _matches(word, one, folders)] for word in words}
    for word, found in matching.items():
        if not found:
            raise console.Failure(_unknown(word, known, folders))

    def chooses(package: str, name: str, path: Optional[pathlib.Path]) -> bool:
        for word in words:
            if word in folders:
                if package == word:
                    return True
            elif word.lower() in name.lower() or path is not None and word.lower() in path.stem.lower():
                return True
        return False

    return Selection(chooses, {source.package for found in matching.values() for source in found})


def _unknown(word: str, known: List[Source], packages: Iterable[str]) -> str:
    if word in packages:
        return f"the package {word} has no tests"
    names: Dict[str, str] = {name.lower(): name for source in known for name in _names(source)}
    names.update({name.split(".")[0].lower(): name.split(".")[0] for source in known for name in source.cases})
    names.update({name.lower(): name for name in packages})
    near = [names[name] for name in difflib.get_close_matches(word.lower(), names, 4, 0.6)]
    hint = f"Did you mean {' or '.join(near)}?" if near else f"Packages: {', '.join(packages)}"
    return f"no test file, package or GoogleTest case has \"{word}\" in its name. {hint}"


# --- By change ------------------------------------------------------------------------------------------------------------


def default_base(root: pathlib.Path = ROOT) -> str:
    found = git.run("rev-parse", "--verify", "--quiet", "origin/main^{commit}", root=root)
    return "origin/main" if found.returncode == 0 else "HEAD"


def changed_files(base: str, root: pathlib.Path = ROOT) -> List[str]:
    """Returns the files changed since the merge base of HEAD and `base`, including uncommitted and new ones."""
    common = git.run("merge-base", base, "HEAD", root=root)
    if common.returncode != 0:
        raise console.Failure(f"--base {base}: git finds no commit that it shares with HEAD. {common.stderr.strip()}".rstrip())
    found: Set[str] = set()
    for arguments in (("diff", "--name-only", "--no-renames", "-z", common.stdout.strip()),
                      ("ls-files", "--others", "--exclude-standard", "-z")):
        result = git.run(*arguments, root=root)
        if result.returncode != 0:
            raise console.Failure(f"git {arguments[0]} failed: {result.stderr.strip()}")
        found.update(name for name in result.stdout.split("\0") if name)
    return sorted(found)


def _imports(path: pathlib.Path) -> Set[str]:
    """Returns the modules of ur_tools that a Python file imports or runs."""
    text = path.read_text()
    found = set(re.findall(r"""ur_tools(?:\.|" / ")(\w+)""", text))
    if re.search(r"""ROOT / ["']ur["']""", text):
        found.add("main")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            if node.module == "ur_tools" or node.level == 1 and not node.module:
                found.update(alias.name for alias in node.names)
            elif node.level == 1 and node.module:
                found.add(node.module)
    return found


class Affected:
    """The tests that changed files can affect."""

    def __init__(self, packages: Dict[str, Package], root: pathlib.Path = ROOT):
        self._packages, self._root = packages, root
        self._folders = {package.folder.relative_to(root).as_posix(): name for name, package in packages.items()}
        self._pytests = [source for source in sources(packages, root) if source.is_pytest]
        self.everything = False
        self.all_of: Set[str] = set()  # packages
        self.programs_of: Set[str] = set()  # packages whose GoogleTest programs run
        self.files: Set[pathlib.Path] = set()  # of pytest

    def add(self, name: str) -> None:
        folder = self._folders.get(name.split("/")[0])
        if name.startswith(_ALL_PACKAGES):
            self.everything = True
        elif name.endswith(_DOCUMENTS):
            self._add_document(name)
        elif name.startswith("docs/site/"):
            self._add_mentions(_BUILDS_SITE)
        elif folder:
            self._add_of_package(folder, name)
        elif name.startswith("tools/test/"):
            self._add_test_file(TOOLS, name)
        elif name.startswith("tools/ur_tools/"):
            self._add_module(pathlib.PurePath(name).stem)
        elif name == "ur":
            self._add_module("main")
        elif any(name.startswith(prefix) for prefix in _FOLDERS_OF_MODULES):
            self._add_module(next(module for prefix, module in _FOLDERS_OF_MODULES.items() if name.startswith(prefix)))
            self._add_mentions(f'"{name.split("/")[0]}"')
        elif name.startswith("tools/"):
            self._add_mentions(pathlib.PurePath(name).stem)
        elif name.startswith(_ONLY_READ):
            self._add_mentions(f'"{name.split("/")[0]}"')
        elif not name.endswith(".png"):
            self.everything = True

    def _dependents(self, name: str) -> Set[str]:
        found = {name}
        for other, package in self._packages.items():  # in build order
            if package.depends & found:
                found.add(other)
        return found

    def _add_of_package(self, package: str, name: str) -> None:
        if name.split("/")[1] == "test":
            self._add_test_file(package, name)
        else:
            self.all_of |= self._dependents(package) | {TOOLS}

    def _add_test_file(self, package: str, name: str) -> None:
        path = self._root / name
        if path.suffix == ".py" and path.name.startswith("test_"):
            self.files.add(path)
        elif path.suffix in _CPP or path.name == "CMakeLists.txt":
            self.programs_of.add(package)
        else:  # a helper module of the tests, which other tests may import
            self.all_of.add(package)
            self._add_mentions(pathlib.PurePath(name).parent.as_posix())

    def _add_document(self, name: str) -> None:
        path = pathlib.PurePath(name)
        if len(path.parts) > 3:  # of a folder that tests read as a whole
            self._add_mentions(f'"{path.parts[-2]}"')
        self._add_mentions(f'ROOT / "{path.name}"' if len(path.parts) == 1 else f'"{path.name}"')
        is_in_docs = path.parts[0] == "docs"
        self._add_mentions('glob("docs/' if is_in_docs else f'ROOT.glob("{"*/" * (len(path.parts) - 1)}*{path.suffix}"')
        if is_in_docs or name in ("README.md", *docs.OTHER_PAGES):
            self._add_mentions(_BUILDS_SITE)

    def _add_module(self, module: str) -> None:
        graph = {path.stem: _imports(path) for path in (self._root / "tools" / "ur_tools").glob("*.py")}
        users = {module}
        while True:
            # main imports all modules; its commands have their own tests.
            more = {name for name, used in graph.items() if used & users and name != "main"} - users
            if not more:
                break
            users |= more
        self.files.update(source.path for source in self._pytests if source.package == TOOLS and _imports(source.path) & users)

    def _add_mentions(self, text: str) -> None:
        """Adds the pytest files that contain the text, or whose folder has a helper module that does."""
        for source in self._pytests:
            helpers = (path for path in source.path.parent.glob("*.py") if not path.name.startswith("test_"))
            if any(text in path.read_text() for path in (source.path, *helpers)):
                self.files.add(source.path)

    def selection(self) -> Selection:
        if self.everything:
            return everything()
        files = {path for path in self.files if path.is_file()}  # without deleted files
        packages = self.all_of | self.programs_of | {source.package for source in self._pytests if source.path in files}

        def chooses(package: str, _name: str, path: Optional[pathlib.Path]) -> bool:
            is_pytest = path is not None and path.suffix == ".py"
            return package in self.all_of or not is_pytest and package in self.programs_of or path in files

        return Selection(chooses, packages)


def by_change(base: str, packages: Dict[str, Package], root: pathlib.Path = ROOT) -> Selection:
    names = changed_files(base, root)
    affected = Affected(packages, root)
    for name in names:
        affected.add(name)
    selection = affected.selection()
    console.line(f"{len(names)} file{'s' * (len(names) != 1)} changed since {base}"
                 + (": all tests" if affected.everything else ""))
    return selection
