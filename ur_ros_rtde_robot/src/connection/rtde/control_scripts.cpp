#include "connection/rtde/control_scripts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ur_rtde/script_client.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace ur_ros_rtde {
namespace {

bool has_word(std::string_view text, std::string_view word)
{
  const auto in_word = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    if ((at == 0 || !in_word(at - 1)) && !in_word(at + word.size())) {
      return true;
    }
  }
  return false;
}

/// The function of the extension's URCap that the controller reports as unknown: "name 'f' is not defined" or
/// "compile_error_name_not_found:f:", depending on its version. Empty for any other error.
std::string missing_function(const ScriptExtension & extension, const std::string & complaint)
{
  const auto contains = [&complaint](std::string_view part) {
    return complaint.find(part) != std::string::npos;
  };
  if (extension.urcap.empty() ||
      (!contains("not defined") && !contains("not_found") && !contains("not found"))) {
    return {};
  }
  const auto function =
      std::find_if(extension.urcap_functions.begin(), extension.urcap_functions.end(),
                   [&complaint](const std::string & name) { return has_word(complaint, name); });
  return function == extension.urcap_functions.end() ? std::string() : *function;
}

}  // namespace

std::vector<std::string> ControlScripts::set(const std::vector<ScriptExtension> & extensions)
{
  const std::lock_guard lock(mutex_);
  const std::string base = ur_rtde::ScriptClient::getDefaultScript();
  std::vector<std::string> problems;
  extensions_.clear();
  left_out_.clear();
  for (const ScriptExtension & extension : extensions) {
    if (needs_missing_urcap(extension)) {
      left_out_.try_emplace(
          extension.name,
          LeftOut{extension.name,
                  fmt::format("it needs {}: if the robot has it, set the parameter urcap_extensions. The "
                              "program of the External Control URCap would not start without it",
                              extension.urcap)});
      continue;
    }
    extensions_.push_back(extension);
    if (const auto composed = script::compose(base, extensions_); !composed) {
      extensions_.pop_back();
      left_out_.try_emplace(extension.name, LeftOut{extension.name, composed.error().message});
      problems.push_back(
          fmt::format("the extension {} is left out: {}", extension.name, composed.error().message));
    }
  }
  script_ = script::compose(base, extensions_).value();
  return problems;
}

bool ControlScripts::needs_missing_urcap(const ScriptExtension & extension) const
{
  return options_.control_mode == ControlMode::control_urcap && !options_.urcap_extensions &&
         !extension.urcap.empty();
}

bool ControlScripts::has_extensions() const
{
  const std::lock_guard lock(mutex_);
  return !extensions_.empty();
}

script::Result<script::ControlScript> ControlScripts::resolved(const script::ControlScript & script,
                                                               const ControllerVersion & version) const
{
  return script::for_controller(script, version.major, version.minor, options_.upper_range_registers);
}

std::string ControlScripts::resolved_text(const script::ControlScript & script,
                                          const ControllerVersion & version) const
{
  const auto resolved_script = resolved(script, version);
  if (!resolved_script) {
    throw std::runtime_error(
        fmt::format("line {}: {}", resolved_script.error().line, resolved_script.error().message));
  }
  return resolved_script->text.text();
}

std::string ControlScripts::text(const ControllerVersion & version) const
{
  const std::lock_guard lock(mutex_);
  return extensions_.empty() ? std::string() : resolved_text(script_, version);
}

std::string ControlScripts::program(const ControllerVersion & version) const
{
  const std::lock_guard lock(mutex_);
  const auto script = script::compose(ur_rtde::ScriptClient::getDefaultScript(), extensions_);
  // What follows its node in the program of the URCap might move the arm.
  return resolved_text(script.value(), version) + "halt\n";
}

Expected<int> ControlScripts::id(const std::string & name) const
{
  const std::lock_guard lock(mutex_);
  if (const auto found = script_.ids.find(name); found != script_.ids.end()) {
    return found->second;
  }
  const auto left_out = left_out_.find(name);
  return tl::unexpected(Error{ErrorCode::not_supported,
                              left_out == left_out_.end()
                                  ? fmt::format("the control program has no extension {}", name)
                                  : fmt::format("the control program runs without the extension {}: {}", name,
                                                left_out->second.why)});
}

std::string ControlScripts::place(const ControllerVersion & version, int line) const
{
  const std::lock_guard lock(mutex_);
  const auto script = resolved(script_, version);
  return script ? script::place(*script, line) : std::string();
}

void ControlScripts::leave_out_unfit(const ControllerVersion & version)
{
  std::unique_lock lock(mutex_);
  const std::string base = ur_rtde::ScriptClient::getDefaultScript();
  std::vector<std::string> problems;
  std::erase_if(extensions_, [&](const ScriptExtension & extension) {
    const auto alone = resolved(script::compose(base, {extension}).value(), version);
    if (alone) {
      return false;
    }
    const LeftOut left_out{extension.name, fmt::format("with PolyScope {}, its code is not complete: {}",
                                                       to_string(version), alone.error().message)};
    problems.push_back(fmt::format("the extension {} is left out: {}", left_out.name, left_out.why));
    left_out_[left_out.name] = left_out;
    return true;
  });
  if (!problems.empty()) {
    script_ = script::compose(base, extensions_).value();
  }
  lock.unlock();
  for (const std::string & problem : problems) {
    log_(LogLevel::error, problem);
  }
}

std::optional<ControlScripts::LeftOut> ControlScripts::leave_out(const ControllerVersion & version, int line,
                                                                 const std::string & complaint)
{
  const std::lock_guard lock(mutex_);
  const auto script = resolved(script_, version);
  const std::string where = script ? script::place(*script, line) : std::string();
  const auto culprit =
      std::find_if(extensions_.begin(), extensions_.end(), [&](const ScriptExtension & extension) {
        return where.find(fmt::format("`{}`", extension.name)) != std::string::npos;
      });
  if (culprit == extensions_.end()) {
    return std::nullopt;
  }
  LeftOut left_out{culprit->name, fmt::format("the controller does not take {}: {}", where, complaint)};
  if (const std::string function = missing_function(*culprit, complaint); !function.empty()) {
    left_out.urcap = culprit->urcap;
    left_out.why = fmt::format(
        "the robot does not know the function {} in a program of the driver: install {} on it and "
        "use control_mode: control_urcap with urcap_extensions. The functions of a URCap belong to the "
        "programs of the "
        "pendant",
        function, culprit->urcap);
  }
  left_out_[left_out.name] = left_out;
  extensions_.erase(culprit);
  script_ = script::compose(ur_rtde::ScriptClient::getDefaultScript(), extensions_).value();
  return left_out;
}

std::string ControlScripts::missing_urcaps_message() const
{
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::vector<std::string>> names;
  for (const auto & [name, left_out] : left_out_) {
    if (!left_out.urcap.empty()) {
      names[left_out.urcap].push_back(name);
    }
  }
  std::vector<std::string> parts;
  for (const auto & [urcap, extensions] : names) {
    parts.push_back(fmt::format("{} (for {})", urcap, fmt::join(extensions, ", ")));
  }
  return parts.empty() ? std::string()
                       : fmt::format(
                             "unknown in programs of the driver: {}; goals for these commands are rejected; "
                             "to use them, install it on the robot and use control_mode: control_urcap with "
                             "urcap_extensions",
                             fmt::join(parts, "; "));
}

}  // namespace ur_ros_rtde
