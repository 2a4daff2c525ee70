"""docs/use/troubleshooting.md and troubleshooting_motions.md contain every error code and every error text of the driver."""

import re

from error_texts import error_texts
from ur_tools.layout import ROOT

BACKGROUND = True
PAGES = [(ROOT / "docs" / "use" / name).read_text() for name in ("troubleshooting.md", "troubleshooting_motions.md")]
CODES = re.findall(r"^uint16 (\w+) = \d+", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)
OF_OTHERS = re.compile(r"^## Texts of (?:ur_rtde|the pendant)\n.*?(?=^## |\Z)", re.M | re.S)


def explained(page):
    """Returns the texts of a page. A paragraph has a line `text`<br> for each one, followed by cause and remedy."""
    found = []
    for paragraph in re.split(r"\n{2,}", page):
        texts, explanation = re.match(r"((?:`[^`\n]+`<br>(?:\n|\Z))*)(.*)", paragraph, re.S).groups()
        assert "<br>" not in explanation and (explanation or not texts), paragraph
        found += re.findall(r"`([^`]+)`", texts)
    return found


def test_each_error_code_has_a_section():
    sections = re.findall(r"^### ([A-Z_]+)$", "\n".join(PAGES), re.M)
    assert sorted(sections) == sorted(set(CODES) - {"NONE"})


def test_each_error_text_is_explained_once_and_each_explained_text_exists():
    texts = error_texts()
    known = set().union(*texts.values())
    to_explain = known - texts["invalid_goal"]  # these state field, value and limit
    assert len(to_explain) > 150
    found = [text for page in PAGES for text in explained(OF_OTHERS.sub("", page))]
    missing = to_explain - set(found)
    outdated = set(found) - known
    assert not missing and not outdated, "\n".join(["Not explained:", *sorted(missing), "Outdated:", *sorted(outdated)])
    assert len(found) == len(set(found))
