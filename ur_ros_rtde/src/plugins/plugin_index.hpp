#pragma once

#include <functional>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// One <class> of a plugins.xml: what is known of a plugin before its library is loaded.
struct PluginEntry {
  std::string name;  ///< "move_l": the plugin's and its action's
  std::string type;  ///< "ur_ros_rtde::MoveL"
  std::string base;  ///< "ur_ros_rtde::CommandPlugin" or "ur_ros_rtde::DashboardPlugin"
  std::string description;
  std::string package;
  std::string library;  ///< path of the file, or what was looked for
};

using ReportProblem = std::function<void(const std::string &)>;

/// The base classes, as plugins.xml files name them.
inline constexpr const char * command_base = "ur_ros_rtde::CommandPlugin";
inline constexpr const char * dashboard_base = "ur_ros_rtde::DashboardPlugin";

/// What all packages of the ament index that register plugins for ur_ros_rtde declare, by package, in the
/// order of their files. What cannot be read is reported with file and line, and left out.
std::vector<PluginEntry> find_plugins(const ReportProblem & report);

/// The same of one file. `prefix` is what the package is installed to.
std::vector<PluginEntry> read_plugins_file(const std::string & file, const std::string & package,
                                           const std::string & prefix, const ReportProblem & report);

}  // namespace ur_ros_rtde
