"""Configuration of Sphinx for `./ur docs`, which copies the pages and adds the generated ones."""

project = "ur_ros_rtde"
author = "the authors of ur_ros_rtde"
extensions = ["myst_parser", "sphinxcontrib.mermaid"]
html_theme = "furo"
html_title = "ur_ros_rtde"
html_copy_source = False
html_show_sphinx = False
root_doc = "index"
include_patterns = ["index.md", "CONTRIBUTING.md", "CHANGELOG.rst", "SECURITY.md", "CODE_OF_CONDUCT.md", "docs/**/*.md", "reference/*.md",
                    "ur_simulator/README.md"]
myst_heading_anchors = 5
suppress_warnings = ["myst.header"]  # the commands are headings of level 3, so that the pages of all groups look the same
myst_fence_as_directive = ["mermaid"]
highlight_language = "none"
