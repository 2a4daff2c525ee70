"""Results of ./ur bench as JSON files.

    {"format": "ur bench 1", "machine": {...}, "commit": "...", "settings": {...},
     "runs": [{"begin": s since the epoch, "load": {...}, "figures": {...}, "samples": {...}}, ...]}

`figures` has the values of the rows (bench_rows), `samples` what the report draws.
"""

import json
import os
import pathlib
from dataclasses import asdict, dataclass
from typing import Dict, List

from . import console

FORMAT = "ur bench 1"


@dataclass
class Results:
    machine: Dict[str, object]
    commit: str
    settings: Dict[str, object]
    runs: List[dict]


def _problem(content: object) -> str:
    """Returns why the content of a file is not a result; empty if it is one."""
    if not isinstance(content, dict) or not str(content.get("format", "")).startswith("ur bench "):
        return "it was not written by ./ur bench --output"
    if content["format"] != FORMAT:
        return f"it has the format \"{content['format']}\", this version reads \"{FORMAT}\""
    kinds = {"machine": dict, "commit": str, "settings": dict, "runs": list}
    wrong = [key for key, kind in kinds.items() if not isinstance(content.get(key), kind)]
    if not wrong and not all(isinstance(run, dict) and isinstance(run.get("figures"), dict) for run in content["runs"]):
        wrong = ["runs"]
    if wrong:
        return f"its field {wrong[0]} is missing or has the wrong type"
    return "" if content["runs"] else "it has no runs"


def load(path: pathlib.Path, option: str) -> Results:
    """Reads a file that was given with `option`. Raises Failure if it is not a result."""
    try:
        content = json.loads(path.read_text())
    except OSError as error:
        raise console.Failure(f"{option} {path}: {error.strerror}") from None
    except ValueError:  # also of the text's encoding
        raise console.Failure(f"{option} {path}: it is not a JSON file") from None
    problem = _problem(content)
    if problem:
        raise console.Failure(f"{option} {path}: {problem}")
    return Results(content["machine"], content["commit"], content["settings"], content["runs"])


def save(path: pathlib.Path, results: Results) -> None:
    path.write_text(json.dumps({"format": FORMAT, **asdict(results)}) + "\n")


def check_writable(path: pathlib.Path, option: str) -> None:
    """Raises Failure if the file cannot be written."""
    if path.is_dir():
        raise console.Failure(f"{option} {path}: it is a folder, give a file")
    if not path.absolute().parent.is_dir():
        raise console.Failure(f"{option} {path}: there is no such folder")
    if not os.access(path if path.exists() else path.absolute().parent, os.W_OK):
        raise console.Failure(f"{option} {path}: it cannot be written")


def check_same(old: Results, new: Results, path: pathlib.Path) -> None:
    """Raises Failure if runs of `new` must not be added to those of `old`, which are in the file."""
    for what in ("commit", "machine", "settings"):
        before, now = getattr(old, what), getattr(new, what)
        if before != now:
            raise console.Failure(f"--append {path}: its runs have {_difference(what, before, now)}; choose another file")


def _difference(what: str, before: object, now: object) -> str:
    if isinstance(before, dict) and isinstance(now, dict):
        key = next(key for key in (*before, *now) if before.get(key) != now.get(key))
        return f"{key} {before.get(key)}, this run has {now.get(key)}"
    return f"{what} {before}, this run has {now}"
