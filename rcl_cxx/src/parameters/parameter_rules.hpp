#pragma once

#include <string>

#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// Checks the type of a value, and the range of each number in it.
SetParametersResult check_value(const Parameter & parameter, ParameterType type,
                                const ParameterDescriptor & descriptor);

/// Converts integers where floating-point numbers are wanted: `-p speed:=1`. Other values stay as they are.
ParameterValue as_type(const ParameterValue & value, ParameterType type);

}  // namespace rcl_cxx::detail
