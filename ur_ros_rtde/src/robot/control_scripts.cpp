#include "robot/control_scripts.hpp"

#include <fmt/format.h>
#include <ur_rtde/script_client.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace ur_ros_rtde {

std::string ControlScripts::leave_out(const std::string & name, const std::string & why)
{
  left_out_[name] = why;
  std::erase_if(extensions_, [&](const ScriptExtension & extension) { return extension.name == name; });
  return fmt::format("the extension {} is left out: {}", name, why);
}

std::vector<std::string> ControlScripts::set(const std::vector<ScriptExtension> & extensions)
{
  const std::lock_guard lock(mutex_);
  const std::string base = ur_rtde::ScriptClient::controlScript();
  std::vector<std::string> problems;
  extensions_.clear();
  left_out_.clear();
  for (const ScriptExtension & extension : extensions) {
    extensions_.push_back(extension);
    if (const auto composed = script::compose(base, extensions_); !composed) {
      extensions_.pop_back();
      left_out_.try_emplace(extension.name, composed.error().message);
      problems.push_back(
          fmt::format("the extension {} is left out: {}", extension.name, composed.error().message));
    }
  }
  script_ = script::compose(base, extensions_).value();
  return problems;
}

bool ControlScripts::has_extensions() const
{
  const std::lock_guard lock(mutex_);
  return !extensions_.empty();
}

script::Result<script::ControlScript> ControlScripts::resolved(const ControllerVersion & version) const
{
  return script::for_controller(script_, version.major, version.minor, upper_range_);
}

std::string ControlScripts::text(const ControllerVersion & version) const
{
  const std::lock_guard lock(mutex_);
  if (extensions_.empty()) {
    return {};
  }
  const auto script = resolved(version);
  return script ? script->text.text() : std::string();
}

std::string ControlScripts::program(const ControllerVersion & version) const
{
  const std::lock_guard lock(mutex_);
  const auto base = script::compose(ur_rtde::ScriptClient::controlScript(), extensions_);
  const auto script = base ? script::for_controller(*base, version.major, version.minor, upper_range_) : base;
  if (!script) {
    throw std::runtime_error(fmt::format("line {}: {}", script.error().line, script.error().message));
  }
  return script->text.text();
}

Expected<int> ControlScripts::id(const std::string & name) const
{
  const std::lock_guard lock(mutex_);
  if (const auto found = script_.ids.find(name); found != script_.ids.end()) {
    return found->second;
  }
  const auto left_out = left_out_.find(name);
  return tl::unexpected(Error{
      ErrorCode::not_supported,
      left_out == left_out_.end()
          ? fmt::format("the control program has no extension {}", name)
          : fmt::format("the control program runs without the extension {}: {}", name, left_out->second)});
}

std::string ControlScripts::place(const ControllerVersion & version, int line) const
{
  const std::lock_guard lock(mutex_);
  const auto script = resolved(version);
  return script ? script::place(*script, line) : std::string();
}

std::optional<std::string> ControlScripts::leave_out(const ControllerVersion & version, int line,
                                                     const std::string & complaint)
{
  const std::lock_guard lock(mutex_);
  const auto script = resolved(version);
  const std::string where = script ? script::place(*script, line) : std::string();
  const auto culprit =
      std::find_if(extensions_.begin(), extensions_.end(), [&](const ScriptExtension & extension) {
        return where.find(fmt::format("`{}`", extension.name)) != std::string::npos;
      });
  if (culprit == extensions_.end()) {
    return std::nullopt;
  }
  const std::string sentence = leave_out(
      std::string(culprit->name), fmt::format("the controller does not take {}: {}", where, complaint));
  script_ = script::compose(ur_rtde::ScriptClient::controlScript(), extensions_).value();
  return sentence;
}

}  // namespace ur_ros_rtde
