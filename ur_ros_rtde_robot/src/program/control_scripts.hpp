#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "script/control_script.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/program/script_extension.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The control script that is to run: ur_rtde's own, with what extensions add to it. Thread-safe.
class ControlScripts {
 public:
  explicit ControlScripts(bool upper_range_registers) : upper_range_(upper_range_registers) {}

  /// In place of those before. The sentences tell of each that cannot be added, and why; it is left out.
  std::vector<std::string> set(const std::vector<ScriptExtension> & extensions);
  bool has_extensions() const;

  /// For this controller; without a `def` around it, markers and register offset resolved. Empty when there
  /// is nothing to add to ur_rtde's own.
  std::string text(const ControllerVersion & version) const;
  /// The same, also when there is nothing to add. Throws std::runtime_error.
  std::string program(const ControllerVersion & version) const;
  /// The number that triggers the extension; not_supported with the reason when it was left out.
  Expected<int> id(const std::string & name) const;
  /// "extension `x`, line 3", for a line of text(); empty for a line that is of no extension.
  std::string place(const ControllerVersion & version, int line) const;
  /// Why an extension is left out.
  struct LeftOut {
    std::string name;
    std::string why;
    std::string urcap = {};  ///< that the robot lacks; empty: the extension is at fault
  };
  /// The controller does not take this line of text(): its extension is left out from now on. None if the
  /// line is of no extension.
  std::optional<LeftOut> leave_out(const ControllerVersion & version, int line,
                                   const std::string & complaint);
  /// A sentence about all extensions that are left out because the robot lacks their URCap; empty if there
  /// are none.
  std::string without_urcap() const;

 private:
  script::Result<script::ControlScript> resolved(const ControllerVersion & version) const;

  const bool upper_range_;
  mutable std::mutex mutex_;
  std::vector<ScriptExtension> extensions_;
  std::map<std::string, LeftOut> left_out_;  ///< by name
  script::ControlScript script_;
};

}  // namespace ur_ros_rtde
