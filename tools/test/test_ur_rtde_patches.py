"""The patches of ur_rtde, and docs/ur_rtde_patches.md, which lists them."""

import re

import pytest
from ur_tools.layout import ROOT

PATCHES = sorted((ROOT / "ur_rtde_vendor" / "patches").glob("*.patch"))
PAGE = (ROOT / "docs" / "ur_rtde_patches.md").read_text()
ROW = re.compile(r"^\| \[(\d{4})\]\(\.\./ur_rtde_vendor/patches/([\w.-]+)\) (.+?) \| (.+?) \| (.+?) \| (.+?) \| (.+?) \|$", re.M)


def preface(patch):
    return patch.read_text().split("\ndiff --git ", 1)[0]


def test_the_patches_are_numbered_without_gaps():
    assert [patch.name[:5] for patch in PATCHES] == [f"{number:04d}-" for number in range(1, len(PATCHES) + 1)]


@pytest.mark.parametrize("patch", PATCHES, ids=lambda patch: patch.stem)
def test_each_patch_states_defect_evidence_fix_and_upstream_candidate(patch):
    title, *paragraphs = preface(patch).split("\n\n")
    assert title and "\n" not in title
    fields = re.findall(r"^(Defect|Evidence|Fix|Upstream candidate):\s", "\n\n".join(paragraphs), re.M)
    assert fields == ["Defect", "Evidence", "Fix", "Upstream candidate"]


def test_the_page_lists_the_patches_in_order():
    assert [row[1] for row in ROW.findall(PAGE)] == [patch.name for patch in PATCHES]


@pytest.mark.parametrize("patch", PATCHES, ids=lambda patch: patch.stem)
def test_the_page_has_the_number_title_and_upstream_candidate_of_the_patch(patch):
    row, = (row for row in ROW.findall(PAGE) if row[1] == patch.name)
    text = preface(patch)
    candidate = " ".join(re.search(r"^Upstream candidate: (.*)", text, re.M | re.S).group(1).split())
    assert (row[0], row[2], row[6]) == (patch.name[:4], text.split("\n")[0], candidate.rstrip("."))
