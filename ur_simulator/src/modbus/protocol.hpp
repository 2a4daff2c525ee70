#pragma once

#include <string>
#include <string_view>

#include "port_map/port_map.hpp"

namespace ur_simulator::modbus {

/// Executes a request of the MODBUS application protocol (V1.1b3) and returns the response: both without
/// header, from the function code on. `request` must not be
/// empty. Supports the functions 1 to 6, 15 and 16; all other ones and invalid
/// requests are answered with an exception. Coils and discrete inputs are the same data, and so are holding
/// and input registers. A request writes all of its values or none.
std::string execute(PortMap & ports, std::string_view request);

}  // namespace ur_simulator::modbus
