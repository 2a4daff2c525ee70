#pragma once

#include <string>

#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// Whether `value` suits the declaration of parameter `name`: its type (unless dynamic) and its range, for
/// arrays that of each element. The reason of a refusal says what would do.
SetParametersResult check_value(const std::string & name, ParameterType type,
                                const ParameterDescriptor & options, const ParameterValue & value);

/// An integer where a floating-point number is wanted ("-p speed:=1") as such a number; the same for arrays.
ParameterValue as_type(const ParameterValue & value, ParameterType type);

}  // namespace rcl_cxx::detail
