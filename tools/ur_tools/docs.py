"""Builds the site of the documentation with Sphinx, and serves it on this machine."""

import argparse
import functools
import hashlib
import http.server
import os
import pathlib
import re
import shutil
import subprocess
from typing import Iterator, List, Tuple

from . import console, git, pins, venv
from .layout import ROOT, STATE

FOLDER = STATE / "docs"
REQUIREMENTS = ROOT / "wheels" / "docs.txt"
MEGABYTES = 15
CONFIGURATION = ROOT / "docs" / "site"
# Pages outside of docs/, in the order of the menu.
OTHER_PAGES = ("CONTRIBUTING.md", "CHANGELOG.rst", "SECURITY.md", "CODE_OF_CONDUCT.md", "ur_simulator/README.md")
SECTIONS = (("Use", "docs/use", "*.md"), ("Commands", "docs/use/commands", "*.md"), ("Reference", "reference", "*.md"),
            ("Internals", "docs/internals", "*.md"))


def ensure_sphinx() -> pathlib.Path:
    """Returns the Python of an environment of its own: Sphinx and the build tools need different versions of the same packages."""
    folder = FOLDER / "venv"
    python, stamp_file = folder / "bin" / "python", folder / "ur_stamp.txt"
    stamp = hashlib.sha256(REQUIREMENTS.read_bytes() + str(folder).encode()).hexdigest()
    if stamp_file.is_file() and stamp_file.read_text() == stamp:
        return python
    console.step(f"Installing Sphinx ({MEGABYTES} MB)")
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([venv.find_python(venv.NEWEST, "Sphinx needs"), "-m", "venv", str(folder)], check=True)
    pins.install(python, REQUIREMENTS)
    stamp_file.write_text(stamp)
    return python


def _title(page: pathlib.Path) -> str:
    return next((line[2:] for line in page.read_text().splitlines() if line.startswith("# ")), page.stem)


def _links(page: pathlib.Path) -> List[pathlib.Path]:
    """Returns the files that a page links to, in its list of the documentation first."""
    before, _, after = page.read_text().partition("\n## Documentation\n")
    return [pathlib.Path(os.path.normpath(page.parent / name)) for name in re.findall(r"\]\(([\w./]+)", after + before)]


def _menu(source: pathlib.Path) -> Iterator[Tuple[str, List[str]]]:
    """Yields the headings of the menu with their pages, in the order in which README.md, of the folder or of the project, links to them."""
    for heading, folder, pattern in SECTIONS:
        pages, contents = list((source / folder).glob(pattern)), source / folder / "README.md"
        first = [contents] if contents in pages else []
        linked = [page for page in _links(contents if first else source / "README.md") if page in pages]
        yield heading, [str(page.relative_to(source)) for page in dict.fromkeys((*first, *linked, *sorted(pages, key=_title)))]
    yield "Project", list(OTHER_PAGES)


def _write_index(source: pathlib.Path) -> None:
    """The first page is README.md; only the site needs a menu."""
    menu = "".join("\n".join(("", "```{toctree}", ":hidden:", f":caption: {heading}", "", *pages, "```", ""))
                   for heading, pages in _menu(source))
    (source / "index.md").write_text((source / "README.md").read_text() + menu)


def _stage(python: pathlib.Path, source: pathlib.Path) -> None:
    """Copies the files that git tracks or would add, which the pages link to, and adds what is generated."""
    shutil.rmtree(source, ignore_errors=True)
    git.copy_files(source)
    if subprocess.run([str(python), "-m", "ur_tools.docs_reference", str(source)], cwd=ROOT / "tools").returncode != 0:
        raise console.Failure("The reference cannot be generated: see the error above")
    _write_index(source)
    (source / "README.md").unlink()  # it is index.md


def run_sphinx(python: pathlib.Path, source: pathlib.Path, output: pathlib.Path) -> None:
    command = [str(python), "-m", "sphinx", "--quiet", "--fail-on-warning", "--keep-going", "--conf-dir", str(CONFIGURATION),
               "--doctree-dir", str(FOLDER / "doctrees"), str(source), str(output)]
    if subprocess.run(command).returncode != 0:
        raise console.Failure("The pages have the errors above; their paths are relative to the copy in .ur/docs/source")


def build(output: pathlib.Path) -> pathlib.Path:
    """Returns the first page of the site. Raises Failure if a link is dead or a page is malformed."""
    python, source = ensure_sphinx(), FOLDER / "source"
    console.step("Building the site (about 20 s)")
    _stage(python, source)
    run_sphinx(python, source, output)
    return output / "index.html"


def _serve(folder: pathlib.Path, port: int) -> None:
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(folder))
    try:
        server = http.server.ThreadingHTTPServer(("127.0.0.1", port), handler)
    except OSError as error:
        raise console.Failure(f"127.0.0.1:{port} cannot be used: {error.strerror}. Choose another one, or any: --port 0") from None
    with server:
        console.line(f"The site is at http://127.0.0.1:{server.server_address[1]} until Ctrl-C.")
        server.serve_forever()


def run(options: argparse.Namespace) -> int:
    first = build(FOLDER / "html")
    console.line(f"The site is in {first.parent.relative_to(ROOT)}; its first page is index.html. `--serve` shows it.")
    if options.serve:
        _serve(first.parent, options.port)
    return 0
