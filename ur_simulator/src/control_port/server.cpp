#include "control_port/server.hpp"

#include <fmt/format.h>

#include <utility>

#include "control_port/reply.hpp"
#include "control_port/request_fields.hpp"

namespace ur_simulator::control_port {
namespace {

constexpr std::size_t max_line_size = 1024 * 1024;
constexpr int max_nesting = 16;

/// Parser callback. nlohmann::json is recursive: deep nesting would overflow the stack.
bool reject_deep_nesting(int depth, nlohmann::json::parse_event_t, nlohmann::json &)
{
  if (depth > max_nesting) {
    throw RequestError(fmt::format("the request is nested more than {} levels deep", max_nesting));
  }
  return true;
}

}  // namespace

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               RequestHandler handle_request)
    : handle_request_(std::move(handle_request)),
      server_(io, address, port,
              {max_line_size,
               error_reply(fmt::format("a line has at most {} bytes", max_line_size)).dump() + "\n"},
              [this](std::string_view line, const auto &) { return reply_to(line); })
{
}

std::string Server::reply_to(std::string_view line) const
{
  if (line.find_first_not_of(" \t\r") == std::string_view::npos) {
    return "";
  }
  nlohmann::json reply;
  try {
    const nlohmann::json request = nlohmann::json::parse(line, reject_deep_nesting, false);
    reply = request.is_discarded() ? error_reply("the line is not JSON: send one object per line")
                                   : handle_request_(request);
  } catch (const RequestError & error) {
    reply = error_reply(error.what());
  }
  // Strings of clients may contain invalid UTF-8: dump() replaces it instead of throwing.
  return reply.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace ur_simulator::control_port
