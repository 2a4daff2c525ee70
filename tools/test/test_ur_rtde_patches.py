"""The patches of ur_rtde, and docs/ur_rtde_patches.md, which lists them."""

import re

from ur_tools.layout import ROOT

PATCHES = sorted((ROOT / "ur_rtde_vendor" / "patches").glob("*.patch"))
PAGE = (ROOT / "docs" / "ur_rtde_patches.md").read_text()
ROW = re.compile(r"^\| \[(\d{4})\]\(\.\./ur_rtde_vendor/patches/([\w.-]+)\) (.+?) \| (.+?) \| (.+?) \| (.+?) \| (.+?) \|$", re.M)


def preface(patch):
    return patch.read_text().split("\ndiff --git ", 1)[0]


def test_the_patches_are_numbered_without_gaps():
    assert [patch.name[:5] for patch in PATCHES] == [f"{number:04d}-" for number in range(1, len(PATCHES) + 1)]


def test_each_patch_states_defect_evidence_fix_and_upstream_candidate():
    incomplete = []
    for patch in PATCHES:
        title, *paragraphs = preface(patch).split("\n\n")
        fields = re.findall(r"^(Defect|Evidence|Fix|Upstream candidate):\s", "\n\n".join(paragraphs), re.M)
        if not title or "\n" in title or fields != ["Defect", "Evidence", "Fix", "Upstream candidate"]:
            incomplete.append(f"{patch.name}: {title}: {fields}")
    assert not incomplete, "\n".join(incomplete)


def test_the_page_has_number_title_and_upstream_candidate_of_each_patch_in_order():
    def row(patch):
        candidate = re.search(r"^Upstream candidate: (.*)", preface(patch), re.M | re.S).group(1)
        return patch.name[:4], patch.name, preface(patch).split("\n")[0], " ".join(candidate.split()).rstrip(".")

    listed = [(number, file, title, candidate) for number, file, title, *_, candidate in ROW.findall(PAGE)]
    expected = [row(patch) for patch in PATCHES]
    assert listed == expected, [row for row in (*listed, *expected) if (row in listed) != (row in expected)]
