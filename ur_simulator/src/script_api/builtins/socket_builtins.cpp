#include "script_api/builtins/socket_builtins.hpp"

#include <utility>

namespace ur_simulator::script_api {

namespace {

constexpr double connect_timeout = 2.0;  // s (script manual, "socket_open")

/// Waits for the connection. Result: True, or False on failure or timeout.
class ConnectOperation final : public urscript::PendingCall {
 public:
  explicit ConnectOperation(std::shared_ptr<ScriptSocket> socket) : socket_(std::move(socket)) {}
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    waited_ += context.cycle_time;
    if (socket_->connected()) {
      return Value(true);
    }
    const bool ended = socket_->failed() || waited_ >= connect_timeout;
    return ended ? std::optional(Value(false)) : std::nullopt;
  }
  bool is_network_call() const override { return true; }

 private:
  std::shared_ptr<ScriptSocket> socket_;
  double waited_ = 0.0;
};

Outcome open_socket(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string address = reader.string(0, "address");
  const std::int32_t port = reader.integer(1, "port");
  reader.require(port > 0 && port < 65536, fmt::format("port must be in [1, 65535], is {}", port));
  const std::string name = reader.string(2, "socket_name");
  if (!reader) {
    return reader.failure();
  }
  auto socket = sockets.open(context.program, name, address, static_cast<std::uint16_t>(port));
  if (!socket) {
    return Failure{fmt::format("socket_open: {} sockets are open, close one first", ProgramSockets::limit)};
  }
  return std::make_unique<ConnectOperation>(std::move(socket));
}

Outcome close_socket(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string name = reader.string(0, "socket_name");
  sockets.close(context.program, name);
  return reader ? Outcome(Value()) : reader.failure();
}

Outcome send_bytes(ProgramSockets & sockets, CallContext & context, const std::string & bytes,
                   const std::string & name)
{
  const auto socket = sockets.find(context.program, name);
  const bool sent = socket != nullptr && socket->connected();
  if (sent) {
    socket->send(bytes);
  }
  return Value(sent);
}

std::string text_bytes(ArgumentReader & reader)
{
  return reader.value(0).text(urscript::TextFormat::message);
}

std::string integer_bytes(ArgumentReader & reader)
{
  const auto value = static_cast<std::uint32_t>(reader.integer(0, "value"));
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
  }
  return bytes;
}

void add_socket_send_builtins(Library & library, const ProgramSocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const auto add = [&](const char * builtin, const char * argument,
                       std::string (*bytes)(ArgumentReader & reader)) {
    library.add({builtin, {argument, name}, 1, [sockets, bytes](CallContext & context, Arguments arguments) {
                   ArgumentReader reader(arguments);
                   const std::string text = bytes(reader);
                   const std::string socket = reader.string(1, "socket_name");
                   return reader ? send_bytes(*sockets, context, text, socket) : Outcome(reader.failure());
                 }});
  };
  add("socket_send_string", "str", text_bytes);
  add("socket_send_line", "str", [](ArgumentReader & reader) { return text_bytes(reader) + "\n"; });
  add("socket_send_byte", "value",
      [](ArgumentReader & reader) { return std::string(1, static_cast<char>(reader.integer(0, "value"))); });
  add("socket_send_int", "value", integer_bytes);
}

Outcome set_variable(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string variable = reader.string(0, "name");
  const std::int32_t value = reader.integer(1, "value");
  const std::string name = reader.string(2, "socket_name");
  if (!reader) {
    return reader.failure();
  }
  send_bytes(sockets, context, fmt::format("SET {} {}\n", variable, value), name);
  return Value();
}

void add_socket_builtins(Library & library, OpenSocket open)
{
  const auto sockets = std::make_shared<ProgramSockets>(std::move(open));
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const auto add = [&](const char * builtin, std::vector<urscript::Parameter> parameters,
                       std::size_t required, auto function) {
    library.add({builtin, std::move(parameters), required,
                 [sockets, function](CallContext & context, Arguments arguments) {
                   return function(*sockets, context, arguments);
                 }});
  };
  add("socket_open", {"address", "port", name}, 2, open_socket);
  add("socket_close", {name}, 0, close_socket);
  add("socket_set_var", {"name", "value", name}, 2, set_variable);
  add_socket_send_builtins(library, sockets);
  add_socket_read_builtins(library, sockets);
  library.add_end_handler([sockets](std::uint64_t program) { sockets->close_all(program); });
}

}  // namespace

}  // namespace ur_simulator::script_api

namespace ur_simulator {

std::shared_ptr<const urscript::Library> with_sockets(const urscript::Library & library,
                                                      OpenSocket open_socket)
{
  auto extended = std::make_shared<urscript::Library>(library);
  script_api::add_socket_builtins(*extended, std::move(open_socket));
  return extended;
}

}  // namespace ur_simulator
