#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "client_log/client_log.hpp"
#include "script_api/http_request.hpp"

namespace ur_simulator {

/// Posts an XML document to an HTTP/1.1 server, on a connection of its own. Connecting is limited to 5 s of
/// the host's time, the response to 1 MiB.
std::shared_ptr<HttpRequest> post_xml(boost::asio::io_context & io, const HttpAddress & to, std::string body,
                                      PeerLog log);

}  // namespace ur_simulator
