#pragma once

#include <cstdint>  // before rfc7230.hpp of Boost.Beast 1.83 (Ubuntu 24.04), which lacks it
#include <optional>
#include <string>
#include <string_view>

namespace ur_simulator::robot_api {

/// Returns the content of a field of a multipart/form-data body (RFC 7578), or nullopt if the content type is
/// another one, the body is incomplete, or the field is missing.
std::optional<std::string> form_field(std::string_view content_type, std::string_view body,
                                      std::string_view name);

}  // namespace ur_simulator::robot_api
