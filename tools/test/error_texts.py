"""The texts of the errors and warnings in the sources of the driver."""

import re

from ur_tools.layout import ROOT

PACKAGES = ("ur_ros_rtde", "ur_ros_rtde_robot", "ur_ros_rtde_commands", "ur_ros_rtde_trajectory", "ur_ros_rtde_gripper_commands",
            "ur_ros_rtde_tutorials")
_STRING = r"\"(?:[^\"\\]|\\.)*\""
_TEXT = rf"(?:fmt::format\(\s*)?((?:{_STRING}\s*)+)"
_ERROR = re.compile(rf"ErrorCode::(\w+),\s*{_TEXT}")
_LOG = re.compile(rf"LogLevel::(?:error|warn),\s*{_TEXT}")


def normalized(text):
    """Returns a text as in docs/use/troubleshooting*.md: … for each value, one space between words, no quotes of code."""
    text = re.sub(r"\{[^{}]*\}", "…", text.replace('\\"', '"').replace("`", "'"))
    return re.sub(r"\s+", " ", text).strip()


def has_words(text):
    """Returns whether a text says something by itself, unlike "…: …"."""
    return len(re.findall(r"[a-z]{2,}", text)) >= 2


def _joined(literals):
    return normalized("".join(re.findall(r"\"((?:[^\"\\]|\\.)*)\"", literals)))


def sources():
    for package in PACKAGES:
        for folder in ("src", "include"):
            yield from sorted((ROOT / package / folder).rglob("*.[ch]pp"))


def error_texts():
    """Returns the texts of errors by the name of their code; those that are only logged have the code "log"."""
    found = {}
    for file in sources():
        content = file.read_text()
        for code, literals in _ERROR.findall(content):
            found.setdefault(code, set()).add(_joined(literals))
        for literals in _LOG.findall(content):
            found.setdefault("log", set()).add(_joined(literals))
    return {code: {text for text in texts if has_words(text)} for code, texts in found.items()}
