#pragma once

#include <string>
#include <vector>

#include "plugins/plugin_index.hpp"

namespace ur_ros_rtde {

/// Selects the plugins with the given base class by the parameters `plugins` (empty: all) and
/// `plugins_blacklist`, ordered by name. Reports plugins whose name is already taken by another package.
/// Names that no plugin of any base class has: throws rcl_cxx::ParameterError if they are chosen, reports
/// them if they are in the blacklist, with a similar name.
std::vector<PluginEntry> select_plugins(const std::vector<PluginEntry> & all, const std::string & base,
                                        const std::vector<std::string> & chosen,
                                        const std::vector<std::string> & blacklist,
                                        const ReportProblem & report);

}  // namespace ur_ros_rtde
