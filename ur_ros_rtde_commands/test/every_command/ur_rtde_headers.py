"""The public functions of ur_rtde's interfaces, and their rows in docs/use/commands/README.md.

A function is covered by the action of the same name: moveJ_IK by move_j_ik, powerOn by power_on or dashboard/power_on. If the
names differ, a row of the index contains the action in the first cell and the function in another one:
    | `stop_l` | `stopL` | … |
An excluded function has a separate row with the reason:
    | `disconnect` | ends the interface, which the driver owns |
"""

import os
import pathlib
import re

HEADERS = {"RTDEControlInterface": "rtde_control_interface.h", "RTDEIOInterface": "rtde_io_interface.h",
           "DashboardClient": "dashboard_client.h"}
_CODE = re.compile(r"`([\w/]+)(?:\(\))?`")


def _header(name):
    for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep):
        file = pathlib.Path(prefix, "include", "ur_rtde_vendor", "ur_rtde", name)
        if file.is_file():
            return file.read_text()
    raise FileNotFoundError(f"ur_rtde/{name} is in no prefix of AMENT_PREFIX_PATH")


def functions(interface):
    """Returns the names of the public member functions without constructors and destructor."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", _header(HEADERS[interface]), flags=re.S)
    text = re.sub(r"=\s*\{[^{}]*\}", "", text)  # default arguments
    body = text[re.search(rf"class\s+(?:\w+\s+)*{interface}\b[^;]*?\{{", text).end():]
    public, found, depth = False, set(), 0
    for part in re.split(r"([{}]|\b(?:public|private|protected)\s*:)", body):
        if part == "}" and depth == 0:
            break
        depth += {"{": 1, "}": -1}.get(part, 0)
        if part.endswith(":"):
            public = part.startswith("public") if depth == 0 else public
        elif public and depth == 0:
            found |= set(re.findall(r"\b([a-zA-Z]\w*)\s*\([^()]*(?:\([^()]*\)[^()]*)*\)\s*(?:const\s*)?(?:;|$)", part))
    return sorted(name for name in found if name != interface)


def snake_case(name):
    """Converts names: moveJ_IK to move_j_ik, getActualTCPPose to get_actual_tcp_pose, setTcp to set_tcp."""
    words = re.sub(r"([a-z0-9])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3_\2\4", name)
    return re.sub(r"_+", "_", words).lower()


def index_rows(text):
    """Yields the names in the first cell, the names in the other cells, and the second cell, for each row of all tables."""
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        first = _CODE.findall(cells[0])
        if line.startswith("|") and first and len(cells) > 1:
            yield first, {name for cell in cells[1:] for name in _CODE.findall(cell)}, cells[1]


def uncovered(names, actions, index):
    """Returns the functions that are neither covered by an action nor excluded with a reason."""
    rows = list(index_rows(index))
    mapped = {name for first, others, _ in rows if set(first) & actions for name in others}
    excluded = {name for first, _, reason in rows if not set(first) & actions and reason for name in first}
    return [name for name in names if name not in mapped | excluded
            and not {snake_case(name), f"dashboard/{snake_case(name)}"} & actions]
