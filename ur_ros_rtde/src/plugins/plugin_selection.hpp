#pragma once

#include <string>
#include <vector>

#include "plugins/plugin_index.hpp"

namespace ur_ros_rtde {

/// Selects the plugins with the given base class by the parameters `plugins` (empty: all) and
/// `plugins_blacklist`, ordered by name. Reports names that no plugin of any base class has, with the most
/// similar name, and plugins whose name is already taken by another package.
std::vector<PluginEntry> select_plugins(const std::vector<PluginEntry> & all, const std::string & base,
                                        const std::vector<std::string> & chosen,
                                        const std::vector<std::string> & blacklist,
                                        const ReportProblem & report);

}  // namespace ur_ros_rtde
