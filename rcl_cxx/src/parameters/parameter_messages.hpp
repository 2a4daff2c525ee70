#pragma once

#include <rcl_interfaces/msg/parameter.hpp>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rcl_interfaces/msg/parameter_event.hpp>
#include <rcl_interfaces/msg/parameter_value.hpp>
#include <string>

#include "parameters/parameters.hpp"

namespace rcl_cxx::detail {
rcl_interfaces::msg::ParameterValue to_message(const ParameterValue & value);
/// An unknown type becomes "not set".
ParameterValue from_message(const rcl_interfaces::msg::ParameterValue & message);

rcl_interfaces::msg::Parameter to_message(const Parameter & parameter);
Parameter from_message(const rcl_interfaces::msg::Parameter & message);

rcl_interfaces::msg::ParameterDescriptor to_message(const std::string & name,
                                                    const Parameters::Entry & entry);

/// Without stamp and node.
rcl_interfaces::msg::ParameterEvent to_message(const ParameterChanges & changes);

}  // namespace rcl_cxx::detail
