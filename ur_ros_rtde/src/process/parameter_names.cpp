#include "process/parameter_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <rcl_cxx/error.hpp>
#include <rcl_cxx/node.hpp>
#include <set>
#include <string>
#include <vector>

#include "plugins/similar_names.hpp"

namespace ur_ros_rtde {

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
    if (const auto meant = most_similar(name, known)) {
      throw rcl_cxx::ParameterError(name,
                                    fmt::format("there is no parameter {}; did you mean {}?", name, *meant));
    }
    RCL_CXX_WARN(servers.front()->node().get_logger(),
                 "parameter {} is set, but no node of this process has it", name);
  }
}

}  // namespace ur_ros_rtde
