#include <charconv>

#include "script_api/http_request.hpp"
#include "script_api/robot_context.hpp"
#include "script_api/xml_rpc.hpp"

// rpc_factory(): functions of an XML-RPC server (script manual, "Remote Procedure Call").

namespace ur_simulator::script_api {

namespace {

constexpr std::uint32_t rpc_factory_cost = 100;

/// Waits for the response, without a limit as on the robot; the end of the thread cancels it.
class RemoteCallOperation final : public urscript::PendingCall {
 public:
  explicit RemoteCallOperation(std::shared_ptr<HttpRequest> request) : request_(std::move(request)) {}

  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    const auto & response = request_->response();
    if (!response) {
      return std::nullopt;
    }
    if (!*response) {
      return tl::unexpected("XML-RPC: " + response->error());
    }
    return parse_xml_rpc_response(**response).map([](Value value) {
      return std::optional(std::move(value));
    });
  }
  bool is_network_call() const override { return true; }

 private:
  std::shared_ptr<HttpRequest> request_;
};

class XmlRpcHandle final : public urscript::RemoteObject {
 public:
  XmlRpcHandle(PostXml post, HttpAddress server) : post_(std::move(post)), server_(std::move(server)) {}

  Outcome call(const std::string & method, Arguments arguments) override
  {
    if (method == "closeXMLRPCClientConnection") {  // each call has a connection of its own
      return Value();
    }
    return std::make_unique<RemoteCallOperation>(post_(server_, xml_rpc_request(method, arguments)));
  }

 private:
  PostXml post_;
  HttpAddress server_;
};

/// http://host[:port][/path]
std::optional<HttpAddress> parse_http_address(std::string_view url)
{
  constexpr std::string_view scheme = "http://";
  if (!url.starts_with(scheme)) {
    return std::nullopt;
  }
  url.remove_prefix(scheme.size());
  HttpAddress address;
  const std::size_t path = std::min(url.find('/'), url.size());
  address.path = path == url.size() ? "/" : std::string(url.substr(path));
  const std::string_view authority = url.substr(0, path);
  const std::size_t colon = std::min(authority.find(':'), authority.size());
  address.host = authority.substr(0, colon);
  if (colon < authority.size()) {
    const char * end = authority.data() + authority.size();
    const auto [parsed, error] = std::from_chars(authority.data() + colon + 1, end, address.port);
    if (error != std::errc() || parsed != end || address.port == 0) {
      return std::nullopt;
    }
  }
  const bool printable = std::ranges::all_of(url, [](char c) { return c > ' ' && c < 127; });
  return address.host.empty() || !printable ? std::nullopt : std::optional(address);
}

Outcome rpc_factory(const PostXml & post, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string type = reader.string(0, "type");
  const std::string url = reader.string(1, "url");
  reader.require(type == "xmlrpc", fmt::format("type must be \"xmlrpc\", is \"{}\"", type));
  const auto address = parse_http_address(url);
  reader.require(address.has_value(), fmt::format("url must be http://host:port/path, is \"{}\"", url));
  if (!reader) {
    return reader.failure();
  }
  return Value(std::shared_ptr<urscript::RemoteObject>(std::make_shared<XmlRpcHandle>(post, *address)));
}

}  // namespace

}  // namespace ur_simulator::script_api

namespace ur_simulator {

std::shared_ptr<const urscript::Library> with_xml_rpc(const urscript::Library & library, PostXml post)
{
  auto extended = std::make_shared<urscript::Library>(library);
  extended->add({"rpc_factory",
                 {"type", "url"},
                 2,
                 [post = std::move(post)](urscript::CallContext &, urscript::Arguments arguments) {
                   return script_api::rpc_factory(post, arguments);
                 },
                 false,
                 script_api::rpc_factory_cost});
  return extended;
}

}  // namespace ur_simulator
