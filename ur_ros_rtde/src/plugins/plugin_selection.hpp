#pragma once

#include <string>
#include <vector>

#include "plugins/plugin_index.hpp"

namespace ur_ros_rtde {

/// What the parameters `plugins` (empty: all) and `plugins_blacklist` leave of the plugins with this base, in
/// the order of their names. Reported and left out: names in the lists that no plugin of any base has, with
/// the nearest one; a name that a package before has already.
std::vector<PluginEntry> select_plugins(const std::vector<PluginEntry> & all, const std::string & base,
                                        const std::vector<std::string> & chosen,
                                        const std::vector<std::string> & blacklist,
                                        const ReportProblem & report);

}  // namespace ur_ros_rtde
