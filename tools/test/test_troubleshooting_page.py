"""docs/troubleshooting.md contains every error code and every error text of the driver."""

import re

from error_texts import error_texts
from ur_tools.layout import ROOT

BACKGROUND = True
PAGE = (ROOT / "docs" / "troubleshooting.md").read_text()
CODES = re.findall(r"^uint16 (\w+) = \d+", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)


def rows():
    """Yields the texts, and cause and remedy, of each row of the tables of texts."""
    for line in PAGE.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if line.startswith("| `") and len(cells) == 2:
            yield re.findall(r"`([^`]+)`", cells[0]), cells[1]


def documented():
    return {text for texts, _ in rows() for text in texts}


def test_each_error_code_has_a_section():
    sections = set(re.findall(r"^### ([A-Z_]+)", PAGE, re.M))
    assert sections == set(CODES) - {"NONE"}


def test_each_error_text_is_explained():
    texts = {code: found for code, found in error_texts().items() if code != "invalid_goal"}  # these state field, value and limit
    assert sum(map(len, texts.values())) > 150
    missing = {text for found in texts.values() for text in found} - documented()
    assert not missing, "\n".join(sorted(missing))


def test_each_row_has_a_remedy():
    assert all(len(remedy) > 15 for _, remedy in rows())


def test_the_texts_of_the_driver_exist():
    own = PAGE.split("\n## Texts of ur_rtde")[0]
    known = {text for found in error_texts().values() for text in found}
    assert {text for text in documented() if f"`{text}`" in own} - known == set()
