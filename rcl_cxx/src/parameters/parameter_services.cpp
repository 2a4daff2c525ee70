#include "parameters/parameter_services.hpp"

#include <algorithm>

#include "parameters/parameter_messages.hpp"
#include "rcl_cxx/error.hpp"

namespace rcl_cxx::detail {
namespace {
namespace srv = rcl_interfaces::srv;

std::uint64_t dots_in(std::string_view name)
{
  return static_cast<std::uint64_t>(std::count(name.begin(), name.end(), '.'));
}

bool is_listed(const std::string & name, const std::vector<std::string> & prefixes, std::uint64_t depth)
{
  const bool recursive = depth == srv::ListParameters::Request::DEPTH_RECURSIVE;
  if (prefixes.empty()) {
    return recursive || dots_in(name) < depth;
  }
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string & prefix) {
    if (name == prefix) {
      return true;
    }
    const bool below = name.size() > prefix.size() && name.starts_with(prefix) && name[prefix.size()] == '.';
    return below && (recursive || dots_in(std::string_view(name).substr(prefix.size() + 1)) < depth);
  });
}

rcl_interfaces::msg::SetParametersResult to_message(const SetParametersResult & result)
{
  rcl_interfaces::msg::SetParametersResult message;
  message.successful = result.has_value();
  message.reason = result ? std::string{} : result.error();
  return message;
}

/// If a name is unknown, the response is empty, as in rclcpp, and a warning names the parameter.
template <typename Function>
auto for_each_known(const Logger & logger, const std::vector<std::string> & names, Function function)
{
  std::vector<decltype(function(std::string{}))> results;
  try {
    for (const std::string & name : names) {
      results.push_back(function(name));
    }
  } catch (const ParameterError & error) {
    RCL_CXX_WARN(logger, "parameter request: {}", error.what());
    results.clear();
  }
  return results;
}
}  // namespace

rcl_interfaces::msg::ListParametersResult list_parameters(const std::vector<Parameter> & parameters,
                                                          const std::vector<std::string> & prefixes,
                                                          std::uint64_t depth)
{
  rcl_interfaces::msg::ListParametersResult result;
  for (const Parameter & parameter : parameters) {
    if (!is_listed(parameter.name, prefixes, depth)) {
      continue;
    }
    result.names.push_back(parameter.name);
    const std::size_t last_dot = parameter.name.rfind('.');
    if (last_dot != std::string::npos) {
      const std::string prefix = parameter.name.substr(0, last_dot);
      if (std::find(result.prefixes.begin(), result.prefixes.end(), prefix) == result.prefixes.end()) {
        result.prefixes.push_back(prefix);
      }
    }
  }
  return result;
}

ParameterServices::ParameterServices(Node & node, std::shared_ptr<Parameters> parameters)
{
  const Logger & logger = node.get_logger();
  const auto add = [&]<typename S>(const char * name, auto callback) {
    services_.push_back(
        node.create_service<S>(std::string("~/") + name, std::move(callback), QoS::parameters()));
  };
  add.template operator()<srv::DescribeParameters>(
      "describe_parameters", [parameters, logger](const auto & request, auto & response) {
        response.descriptors = for_each_known(logger, request.names, [&](const std::string & name) {
          return to_message(name, parameters->get(name));
        });
      });
  add.template operator()<srv::GetParameterTypes>(
      "get_parameter_types", [parameters, logger](const auto & request, auto & response) {
        response.types = for_each_known(logger, request.names, [&](const std::string & name) {
          return static_cast<std::uint8_t>(parameters->get(name).value.get_type());
        });
      });
  add.template operator()<srv::GetParameters>(
      "get_parameters", [parameters, logger](const auto & request, auto & response) {
        response.values = for_each_known(logger, request.names, [&](const std::string & name) {
          return to_message(parameters->get(name).value);
        });
      });
  add.template operator()<srv::ListParameters>(
      "list_parameters", [parameters](const auto & request, auto & response) {
        response.result = list_parameters(parameters->all(), request.prefixes, request.depth);
      });
  add.template operator()<srv::SetParameters>(
      "set_parameters", [parameters](const auto & request, auto & response) {
        for (const auto & parameter : request.parameters) {
          response.results.push_back(to_message(parameters->set({from_message(parameter)})));
        }
      });
  add.template operator()<srv::SetParametersAtomically>(
      "set_parameters_atomically", [parameters](const auto & request, auto & response) {
        std::vector<Parameter> all;
        std::transform(request.parameters.begin(), request.parameters.end(), std::back_inserter(all),
                       [](const auto & parameter) { return from_message(parameter); });
        response.result = to_message(parameters->set(all));
      });
}

}  // namespace rcl_cxx::detail
