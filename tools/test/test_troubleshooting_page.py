"""docs/use/troubleshooting.md contains every error code and every error text of the driver."""

import re

from error_texts import error_texts
from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "use" / "troubleshooting.md").read_text()
CODES = re.findall(r"^uint16 (\w+) = \d+", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)


def documented(page):
    """Returns the texts in the first column of the tables with two columns."""
    rows = [line.strip("|").split(" | ") for line in page.splitlines() if line.startswith("| `")]
    return {text for cells in rows if len(cells) == 2 for text in re.findall(r"`([^`]+)`", cells[0])}


def test_each_error_code_has_a_section():
    sections = set(re.findall(r"^### ([A-Z_]+)", PAGE, re.M))
    assert sections == set(CODES) - {"NONE"}


def test_each_error_text_is_explained_and_each_explained_text_exists():
    texts = error_texts()
    known = set().union(*texts.values())
    to_explain = known - texts["invalid_goal"]  # these state field, value and limit
    assert len(to_explain) > 150
    missing = to_explain - documented(PAGE)
    outdated = documented(PAGE.split("\n## Texts of ur_rtde")[0]) - known
    assert not missing and not outdated, "\n".join(["Not explained:", *sorted(missing), "Outdated:", *sorted(outdated)])
