#pragma once

#include <string>
#include <string_view>

namespace ur_simulator::modbus {

// Messages in the client log, from the function code on, which must exist.

/// "read holding registers 400 to 405", "write registers 128 to 129: 00 01 00 02"
std::string describe_request(std::string_view request);
/// "00 01 00 02", "written", "exception 2"
std::string describe_response(std::string_view response);

}  // namespace ur_simulator::modbus
