#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "script/control_script.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/robot_options.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Composes the control script: that of ur_rtde plus the code of the extensions. Thread-safe.
class ControlScripts {
 public:
  ControlScripts(const RobotOptions & options, LogFunction log) : options_(options), log_(std::move(log)) {}

  /// Replaces the extensions. Returns one message per faulty one, which is omitted, with the reason.
  std::vector<std::string> set(const std::vector<ScriptExtension> & extensions);
  bool has_extensions() const;

  /// The script for this controller without an enclosing `def`, with version markers and register offset
  /// resolved. Empty if there are no extensions. Throws std::runtime_error.
  std::string text(const ControllerVersion & version) const;
  /// Like text(), but also without extensions, and at its end, the program ends to which it was added: for
  /// the External Control URCap. Throws std::runtime_error.
  std::string program(const ControllerVersion & version) const;
  /// The number that triggers the extension; not_supported with the reason if it was omitted.
  Expected<int> id(const std::string & name) const;
  /// "extension `x`, line 3" for a line of text(); empty if the line does not belong to an extension.
  std::string place(const ControllerVersion & version, int line) const;
  /// An omitted extension.
  struct LeftOut {
    std::string name;
    std::string why;
    std::string urcap = {};  ///< missing on the robot; empty: the extension is faulty
  };
  /// Omits the extensions whose code is incomplete in this version of the controller, as when only one end of
  /// a block has a version marker. Logs each with the reason.
  void leave_out_unfit(const ControllerVersion & version);
  /// Omits the extension to which this line of text() belongs, since the controller rejects it. None if the
  /// line does not belong to an extension.
  std::optional<LeftOut> leave_out(const ControllerVersion & version, int line,
                                   const std::string & complaint);
  /// Message about all extensions that were omitted because their URCap is missing on the robot; empty if
  /// there are none.
  std::string missing_urcaps_message() const;

 private:
  script::Result<script::ControlScript> resolved(const script::ControlScript & script,
                                                 const ControllerVersion & version) const;
  bool needs_missing_urcap(const ScriptExtension & extension) const;
  std::string resolved_text(const script::ControlScript & script, const ControllerVersion & version) const;

  const RobotOptions options_;
  const LogFunction log_;
  mutable std::mutex mutex_;
  std::vector<ScriptExtension> extensions_;
  std::map<std::string, LeftOut> left_out_;  ///< by name
  script::ControlScript script_;
};

}  // namespace ur_ros_rtde
