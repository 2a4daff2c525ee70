#include "process/parameter_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <rcl_cxx/error.hpp>
#include <rcl_cxx/node.hpp>
#include <set>
#include <string>
#include <vector>

#include "plugins/plugin_index.hpp"
#include "plugins/similar_names.hpp"

namespace ur_ros_rtde {
namespace {

/// "gripper.input" of an installed plugin `gripper`, which was left out: why, is in the log.
bool is_of_plugin(const std::string & parameter)
{
  return std::ranges::any_of(find_plugins([](const std::string &) {}), [&](const PluginEntry & plugin) {
    return parameter.starts_with(plugin.name + ".");
  });
}

}  // namespace

void check_parameter_names(const Servers & servers)
{
  std::vector<std::string> known;
  std::set<std::string> given;
  for (const auto & server : servers) {
    std::ranges::move(server->node().list_parameters(), std::back_inserter(known));
    for (const std::string & name : server->node().undeclared_overrides()) {
      given.insert(name);
    }
  }
  for (const std::string & name : given) {
    if (std::ranges::find(known, name) != known.end()) {
      continue;  // of another node of this process
    }
    if (const auto meant = most_similar(name, known); meant && !is_of_plugin(name)) {
      throw rcl_cxx::ParameterError(name,
                                    fmt::format("there is no parameter {}; did you mean {}?", name, *meant));
    }
    RCL_CXX_WARN(servers.front()->node().get_logger(),
                 "parameter {} is set, but no node of this process has it", name);
  }
}

}  // namespace ur_ros_rtde
