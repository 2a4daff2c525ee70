#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "urscript/library.hpp"

namespace ur_simulator {

// Messages of the XML-RPC specification (xmlrpc.com, "XML-RPC Specification"). A pose is a structure with the
// members x, y, z, rx, ry and rz (UR, "XML-RPC communication").

/// The body of the request.
std::string xml_rpc_request(std::string_view method, urscript::Arguments arguments);

/// The value that the server returned, or the reason why there is none.
tl::expected<urscript::Value, std::string> parse_xml_rpc_response(std::string_view body);

}  // namespace ur_simulator
