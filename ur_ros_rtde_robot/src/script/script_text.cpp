#include "script/script_text.hpp"

namespace ur_ros_rtde::script {

void ScriptText::copy(std::string_view part, int line, std::size_t source)
{
  for (const char c : part) {
    if (Origin & here = origins_.back(); here.line == 0) {
      here = {source, line};
    }
    text_.push_back(c);
    if (c == '\n') {
      origins_.emplace_back();
      ++line;
    }
  }
}

void ScriptText::end_line()
{
  if (!text_.empty() && text_.back() != '\n') {
    text_.push_back('\n');
    origins_.emplace_back();
  }
}

void ScriptText::insert(std::string_view lines)
{
  end_line();
  for (const char c : lines) {
    text_.push_back(c);
    if (c == '\n') {
      origins_.emplace_back();
    }
  }
  end_line();
}

Origin ScriptText::origin(int line) const
{
  const auto index = static_cast<std::size_t>(line) - 1;
  return line >= 1 && index < origins_.size() ? origins_[index] : Origin{};
}

}  // namespace ur_ros_rtde::script
