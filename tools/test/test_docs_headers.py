"""The reference of the plugin API has what the headers declare for authors of plugins, with its comments."""

import pathlib
import re
import textwrap

import pytest
from ur_tools import docs_headers, docs_plugin_api
from ur_tools.layout import ROOT

BACKGROUND = True
HEADER = """
#pragma once

#include <string>

class Forward;

namespace ours {
namespace detail {
struct Hidden {};
}

/// What it is for. More about it.
///
///     Example example{1};
template <typename T>
class Example : public Base<T> {
 public:
  using Value = T;
  /// Makes one.
  explicit Example(int value = 1, std::vector<int> more = {})
      : value_(value), more_{std::move(more)}
  {
  }
  Example(const Other & other) : value_(acquire(*other.value_)) {}
  virtual ~Example() = default;
  Example(const Example &) = delete;

  // Values

  /// The value: { is a brace.
  int value() const { return value_; }
  int other(const std::string & text = "};",
            char c = '}') const;
  struct Nested {
    double time = 1.0;  ///< s
    std::function<void(int)> call{};
  };

  // For the driver

  void start();

 protected:
  void hook();

 private:
  int value_ = 10'000;
};

/// Colors.
enum class Color {
  red = 1,  ///< like blood,
            ///< or roses
  blue,
};

constexpr int limit{3};  // of something

/// For both functions.

/// The first.
void first(Color color);
inline Color second() { return Color::red; }

template <typename T>
int Example<T>::other(const std::string & text, char c) const
{
  return 1;
}
}  // namespace ours

/// A macro.
#define MAKE(name) \\
  int name;
"""


@pytest.fixture(scope="module")
def found():
    header = HEADER.replace("namespace ours", "namespace ur_ros_rtde")
    return {declaration.name or declaration.text: declaration for declaration in docs_headers.declarations(header)}


def test_definitions_forward_declarations_and_details_are_left_out(found):
    assert list(found) == ["Example", "Color", "constexpr int limit{3};", "", "first", "second", "MAKE"]


def test_the_public_members_of_a_class_have_no_bodies_and_initializers(found):
    assert found["Example"].text == "template <typename T>\nclass Example : public Base<T>"
    assert [member.text for member in found["Example"].members] == [
        "using Value = T;", "explicit Example(int value = 1, std::vector<int> more = {});", "Example(const Other & other);",
        "int value() const;",
        "int other(const std::string & text = \"};\",\n          char c = '}') const;", "struct Nested"]
    assert [member.title for member in found["Example"].members] == ["", "", "", "Values", "", ""]
    nested = found["Example"].members[-1].members
    assert [(member.text, member.comment) for member in nested] == [("double time = 1.0;", "s"), ("std::function<void(int)> call{};", "")]


def test_comments_belong_to_what_they_stand_at(found):
    assert found["Example"].comment == "What it is for. More about it.\n\n    Example example{1};"
    assert [(value.text, value.comment) for value in found["Color"].members] == [("red = 1", "like blood, or roses"), ("blue", "")]
    assert (found[""].comment, found["first"].comment, found["second"].comment) == ("For both functions.", "The first.", "")
    assert found["MAKE"].text == "MAKE(name)"


PAGES = {name: "\n".join(page) for name, page in docs_plugin_api.pages()}
HEADERS = [f"{name}.hpp" for _, _, groups in docs_plugin_api.PAGES for names in groups.values() for name in names]


def test_the_reference_has_every_public_header_of_ur_ros_rtde():
    folder = ROOT / "ur_ros_rtde" / "include"
    public = {str(path.relative_to(folder)) for path in folder.rglob("*.hpp") if "detail" not in path.parts}
    assert len(public) > 15 and public - set(HEADERS) == set() and len(set(HEADERS)) == len(HEADERS)


def test_the_reference_has_every_header_that_a_page_names():
    """But for those of which it says that they are not for plugins."""
    for page in ("writing_a_plugin.md", "plugins.md"):
        named = set(re.findall(r"`(?:\w+/)*(\w+\.hpp)`", (ROOT / "docs" / "use" / page).read_text()))
        assert named - {pathlib.PurePath(header).name for header in HEADERS} == set(), page


def test_every_class_says_what_it_is_for():
    sections = [section for page in PAGES.values() for section in re.split(r"^###+ ", page, flags=re.M)[1:]]
    types = [section.split("\n") for section in sections if not re.match(r"\w+ of \w+\.hpp", section)]
    assert len(types) > 50
    assert [lines[0] for lines in types if not re.match(r"\S.*[.:]$", lines[2]) or lines[2].startswith("Header:")] == []


def test_every_example_of_a_header_is_on_the_page_of_its_class():
    examples = 0
    for header in HEADERS:
        text = (ROOT / header.split("/")[0] / "include" / header).read_text()
        for lines in re.findall(r"(?:^///     .*\n)+", text, re.M):
            example = textwrap.dedent(re.sub(r"^///", "", lines, flags=re.M)).strip()
            assert any(f"```cpp\n{example}\n```" in page for page in PAGES.values()), header
            examples += 1
    assert examples >= 8


def test_the_reference_has_nothing_private_and_leads_to_the_tutorial():
    for page in PAGES.values():
        assert "](../docs/use/writing_a_plugin.md)" in page
        assert not re.search(r"\b\w+_;|#pragma|\bprivate:|= default;|For the driver", page)
    assert "until_joints_reached(const std::vector<double> & positions);" in PAGES["plugin_api"]
    assert "[Write a command](../docs/use/writing_a_plugin.md#write-a-command)" in PAGES["plugin_api"]
