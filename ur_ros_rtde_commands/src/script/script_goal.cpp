#include "script/script_goal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace ur_ros_rtde {
namespace {
namespace fs = std::filesystem;

constexpr std::uintmax_t max_script_size = 1'000'000;  // bytes
constexpr double max_timeout = 86400.0;                // s

void check_file(const std::string & path, Check & check)
{
  const fs::path file(path);
  std::error_code error;
  check.that(file.is_absolute(), fmt::format("path is \"{}\", it must be absolute", path))
      .that(fs::is_regular_file(file, error),
            fmt::format("path is \"{}\": no such file on the machine of command_server", path));
  if (check.ok()) {
    const std::uintmax_t size = fs::file_size(file, error);
    check.that(!error && size > 0 && size <= max_script_size,
               fmt::format("path is \"{}\": the file has {} bytes, it must have 1 to {}", path, size,
                           max_script_size));
  }
}

std::string script_text(const SendScriptAction::Goal & goal)
{
  if (goal.path.empty()) {
    return goal.script;
  }
  std::ifstream file(goal.path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw RobotError(
        {ErrorCode::invalid_goal, fmt::format("path is \"{}\": the file cannot be read", goal.path)});
  }
  return text.str();
}
}  // namespace

void check_script_goal(const SendScriptAction::Goal & goal, Check & check)
{
  check
      .that(goal.script.empty() != goal.path.empty(),
            fmt::format("script has {} bytes and path {}: set exactly one of them", goal.script.size(),
                        goal.path.size()))
      .that(goal.script.size() <= max_script_size,
            fmt::format("script has {} bytes, it may have at most {}", goal.script.size(), max_script_size))
      .above_zero("timeout", goal.timeout, max_timeout, "s");
  if (check.ok() && !goal.path.empty()) {
    check_file(goal.path, check);
  }
}

Outcome run_script_goal(const SendScriptAction::Goal & goal, GoalRun<SendScriptAction> & run, ScriptKind kind,
                        double timeout)
{
  ScriptOptions options;
  options.kind = kind;
  options.may_be_paused = true;
  options.timeout = std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(timeout));
  options.on_text = [&run](const std::string & text) {
    const auto elapsed = run.elapsed();
    const auto whole = std::chrono::floor<std::chrono::seconds>(elapsed);
    run.feedback().output = text;
    run.feedback().elapsed.sec = static_cast<std::int32_t>(whole.count());
    run.feedback().elapsed.nanosec = static_cast<std::uint32_t>((elapsed - whole).count());
    run.publish();
  };
  const ScriptReport report = run.run_script(script_text(goal), options);
  run.result().output = report.text;
  run.result().line = report.line;
  run.result().run_time = report.duration;
  return report ? Outcome::success(to_string(report.end)) : Outcome(report.error);
}

}  // namespace ur_ros_rtde
