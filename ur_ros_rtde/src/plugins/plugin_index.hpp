#pragma once

#include <functional>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// One <class> of a plugin description: what is known of a plugin before its library is loaded.
struct PluginEntry {
  std::string name;  ///< name of the plugin and its action: "move_l"
  std::string type;  ///< "ur_ros_rtde::MoveL"
  std::string base;  ///< "ur_ros_rtde::CommandPlugin" or "ur_ros_rtde::DashboardPlugin"
  std::string description;
  std::string package;
  std::string library;  ///< path of the library, or the expected path if it was not found
};

using ReportProblem = std::function<void(const std::string &)>;

/// Names of the base classes in plugin descriptions.
inline constexpr const char * command_base = "ur_ros_rtde::CommandPlugin";
inline constexpr const char * dashboard_base = "ur_ros_rtde::DashboardPlugin";

/// All plugins that packages register for ur_ros_rtde in the ament index, ordered by package and position in
/// the description. Invalid descriptions are reported with file and line and skipped.
std::vector<PluginEntry> find_plugins(const ReportProblem & report);

/// The plugins of one description. `prefix`: installation prefix of the package.
std::vector<PluginEntry> read_plugins_file(const std::string & file, const std::string & package,
                                           const std::string & prefix, const ReportProblem & report);

}  // namespace ur_ros_rtde
