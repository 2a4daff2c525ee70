#include <cstddef>
#include <cstdint>
#include <string_view>

#include "script_api/xml_rpc.hpp"

// The response of an XML-RPC server to a program. What was decoded is encoded again.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  const auto value = ur_simulator::parse_xml_rpc_response({reinterpret_cast<const char *>(data), size});
  if (value) {
    (void)ur_simulator::xml_rpc_request("echo", std::span(&*value, 1));
  }
  return 0;
}
