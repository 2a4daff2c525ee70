#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "urscript/library.hpp"

namespace ur_simulator {

struct HttpAddress {
  std::string host;
  std::uint16_t port = 80;
  std::string path = "/";
};

/// A request of a program to an HTTP server. Used on the controller's thread. The last reference cancels it.
class HttpRequest {
 public:
  virtual ~HttpRequest() = default;
  /// The body of the response, or why there is none; nothing while it is in progress.
  virtual const std::optional<tl::expected<std::string, std::string>> & response() const = 0;
};

/// Starts to send an XML document.
using PostXml = std::function<std::shared_ptr<HttpRequest>(const HttpAddress & to, std::string body)>;

/// A copy of the library with rpc_factory() added.
std::shared_ptr<const urscript::Library> with_xml_rpc(const urscript::Library & library, PostXml post);

}  // namespace ur_simulator
