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

/// "gripper.input" of an installed plugin `gripper` that has no parameter: it was left out. Why, is in the
/// log.
bool is_of_plugin_left_out(const std::string & parameter, const std::vector<std::string> & known)
{
  const auto is_of = [](const PluginEntry & plugin, const std::string & name) {
    return name.starts_with(plugin.name + ".");
  };
  return std::ranges::any_of(find_plugins([](const std::string &) {}), [&](const PluginEntry & plugin) {
    return is_of(plugin, parameter) &&
           std::ranges::none_of(known, [&](const std::string & name) { return is_of(plugin, name); });
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
    if (const auto meant = most_similar(name, known); meant && !is_of_plugin_left_out(name, known)) {
      throw rcl_cxx::ParameterError(name,
                                    fmt::format("there is no parameter {}; did you mean {}?", name, *meant));
    }
    RCL_CXX_WARN(servers.front()->node().get_logger(),
                 "parameter {} is set, but no node of this process has it", name);
  }
}

}  // namespace ur_ros_rtde
