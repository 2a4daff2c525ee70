#pragma once

#include <memory>
#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameter_types.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters_atomically.hpp>
#include <string>
#include <vector>

#include "parameters/parameters.hpp"
#include "rcl_cxx/node.hpp"

namespace rcl_cxx::detail {
/// The response of ~/list_parameters. `depth` limits the number of parts between dots; 0 is no limit.
rcl_interfaces::msg::ListParametersResult list_parameters(const std::vector<Parameter> & parameters,
                                                          const std::vector<std::string> & prefixes,
                                                          std::uint64_t depth);

/// The six parameter services of a node.
class ParameterServices {
 public:
  ParameterServices(Node & node, std::shared_ptr<Parameters> parameters);

 private:
  std::vector<std::shared_ptr<ServiceBase>> services_;
};

}  // namespace rcl_cxx::detail
