#include <cstdlib>
#include <map>
#include <utility>

#include "script_api/robot_context.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr double default_timeout = 2.0;   // s, of the read functions (script manual)
constexpr double connect_timeout = 2.0;   // s
constexpr std::int32_t max_numbers = 30;  // limit of one read (script manual, "socket_read_ascii_float")

/// The sockets of the running program by name. They are closed when another program runs.
class Sockets {
 public:
  explicit Sockets(OpenSocket open) : open_(std::move(open)) {}

  std::shared_ptr<ScriptSocket> open(const CallContext & context, const std::string & name,
                                     const std::string & address, std::uint16_t port)
  {
    clear_if_new_program(context);
    return sockets_[name] = open_(address, port);
  }
  /// nullptr if no socket of this name is open.
  std::shared_ptr<ScriptSocket> find(const CallContext & context, const std::string & name)
  {
    clear_if_new_program(context);
    const auto found = sockets_.find(name);
    return found == sockets_.end() ? nullptr : found->second;
  }
  void close(const CallContext & context, const std::string & name)
  {
    clear_if_new_program(context);
    sockets_.erase(name);
  }

 private:
  void clear_if_new_program(const CallContext & context)
  {
    if (program_ != context.program) {
      program_ = context.program;
      sockets_.clear();
    }
  }

  OpenSocket open_;
  std::uint64_t program_ = 0;
  std::map<std::string, std::shared_ptr<ScriptSocket>> sockets_;
};

using SocketsPtr = std::shared_ptr<Sockets>;
using SocketPtr = std::shared_ptr<ScriptSocket>;

/// Waits for the connection. Result: True, or False on failure or timeout.
class ConnectOperation final : public urscript::Operation {
 public:
  explicit ConnectOperation(SocketPtr socket) : socket_(std::move(socket)) {}
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    waited_ += context.cycle_time;
    if (socket_->connected()) {
      return Value(true);
    }
    const bool ended = socket_->failed() || waited_ >= connect_timeout;
    return ended ? std::optional(Value(false)) : std::nullopt;
  }

 private:
  SocketPtr socket_;
  double waited_ = 0.0;
};

/// Removes a value from the received bytes; nothing while it is incomplete.
using Extractor = std::function<std::optional<Value>(std::string & received)>;

/// Waits for a value. Result: `default_value` if the time is up or the connection is closed.
class ReadOperation final : public urscript::Operation {
 public:
  ReadOperation(SocketPtr socket, Extractor extract, Value default_value, double timeout)
      : socket_(std::move(socket)),
        extract_(std::move(extract)),
        default_value_(std::move(default_value)),
        timeout_(timeout)
  {
  }
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    waited_ += context.cycle_time;
    if (auto value = extract_(socket_->received())) {
      return value;
    }
    const bool no_timeout = timeout_ <= 0.0;
    const bool ended = socket_->failed() || (!no_timeout && waited_ >= timeout_);
    return ended ? std::optional(default_value_) : std::nullopt;
  }

 private:
  SocketPtr socket_;
  Extractor extract_;
  Value default_value_;
  double timeout_;
  double waited_ = 0.0;
};

Outcome open(Sockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string address = reader.string(0, "address");
  const std::int32_t port = reader.integer(1, "port");
  reader.require(port > 0 && port < 65536, fmt::format("port must be in [1, 65535], is {}", port));
  const std::string name = reader.string(2, "socket_name");
  if (!reader) {
    return reader.failure();
  }
  return std::make_unique<ConnectOperation>(
      sockets.open(context, name, address, static_cast<std::uint16_t>(port)));
}

Outcome send(Sockets & sockets, CallContext & context, const std::string & bytes, const std::string & name)
{
  const SocketPtr socket = sockets.find(context, name);
  const bool sent = socket != nullptr && socket->connected();
  if (sent) {
    socket->send(bytes);
  }
  return Value(sent);
}

Outcome read(Sockets & sockets, CallContext & context, const std::string & name, Extractor extract,
             Value default_value, double timeout)
{
  SocketPtr socket = sockets.find(context, name);
  if (socket == nullptr) {
    return NextCycle{std::move(default_value)};
  }
  return std::make_unique<ReadOperation>(std::move(socket), std::move(extract), std::move(default_value),
                                         timeout);
}

std::optional<std::string> extract_line(std::string & received)
{
  const std::size_t end = received.find('\n');
  if (end == std::string::npos) {
    return std::nullopt;
  }
  std::string line = received.substr(0, end);
  received.erase(0, end + 1);
  if (line.ends_with('\r')) {
    line.pop_back();
  }
  return line;
}

std::optional<Value> extract_line_value(std::string & received)
{
  auto line = extract_line(received);
  return line ? std::optional(Value(std::move(*line))) : std::nullopt;
}

/// Extracts all received bytes or, with prefix and suffix, the text between them.
Extractor string_extractor(const std::string & prefix, const std::string & suffix)
{
  return [prefix, suffix](std::string & received) -> std::optional<Value> {
    if (received.empty()) {
      return std::nullopt;
    }
    if (prefix.empty() && suffix.empty()) {
      return Value(std::exchange(received, {}));
    }
    const std::size_t begin = received.find(prefix);
    const std::size_t text = begin == std::string::npos ? begin : begin + prefix.size();
    const std::size_t end = text == std::string::npos ? text : received.find(suffix, text);
    if (end == std::string::npos) {
      return std::nullopt;
    }
    Value value(received.substr(text, end - text));
    received.erase(0, end + suffix.size());
    return value;
  };
}

Value number_list(const std::vector<double> & numbers, bool whole)
{
  urscript::List list;
  for (const double number : numbers) {
    list.push_back(whole ? Value(static_cast<std::int32_t>(number)) : Value(number));
  }
  return Value(std::move(list));
}

/// The list of the numbers with their count as first element.
Value list_with_count(std::vector<double> numbers, bool whole)
{
  numbers.insert(numbers.begin(), static_cast<double>(numbers.size()));
  return number_list(numbers, whole);
}

Extractor integer_extractor(std::size_t number, std::size_t size)
{
  return [number, size](std::string & received) -> std::optional<Value> {
    if (received.size() < number * size) {
      return std::nullopt;
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < number; ++i) {
      std::uint32_t word = 0;
      for (std::size_t byte = 0; byte < size; ++byte) {
        word = word << 8 | static_cast<std::uint8_t>(received[i * size + byte]);
      }
      values.push_back(size == 4 ? static_cast<double>(static_cast<std::int32_t>(word)) : word);
    }
    received.erase(0, number * size);
    return list_with_count(std::move(values), true);
  };
}

/// Extracts `number` numbers in parentheses: "(1.5, 2, 3)".
Extractor float_extractor(std::size_t number)
{
  return [number](std::string & received) -> std::optional<Value> {
    const std::size_t begin = received.find('(');
    const std::size_t end = begin == std::string::npos ? begin : received.find(')', begin);
    if (end == std::string::npos) {
      return std::nullopt;
    }
    std::vector<double> values;
    const std::string text = received.substr(begin + 1, end - begin - 1);
    received.erase(0, end + 1);
    const char * at = text.c_str();
    for (char * next = nullptr; *at != '\0'; at = next + (*next == ',' ? 1 : 0)) {
      const double value = std::strtod(at, &next);
      if (next == at || !std::isfinite(value)) {
        return list_with_count({}, false);
      }
      values.push_back(value);
    }
    return values.size() == number ? list_with_count(std::move(values), false) : list_with_count({}, false);
  };
}

Outcome read_numbers(Sockets & sockets, CallContext & context, Arguments arguments,
                     Extractor (*make_extractor)(std::size_t number), bool whole)
{
  ArgumentReader reader(arguments);
  const std::int32_t number = reader.integer(0, "number");
  reader.require(number > 0 && number <= max_numbers,
                 fmt::format("number must be in [1, {}], is {}", max_numbers, number));
  const std::string name = reader.string(1, "socket_name");
  const double timeout = reader.number(2, "timeout");
  return reader ? read(sockets, context, name, make_extractor(static_cast<std::size_t>(number)),
                       list_with_count({}, whole), timeout)
                : reader.failure();
}

void add_send_builtins(Library & library, const SocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const auto add = [&](const char * builtin, const char * argument,
                       std::string (*bytes)(ArgumentReader & reader)) {
    library.add({builtin, {argument, name}, 1, [sockets, bytes](CallContext & context, Arguments arguments) {
                   ArgumentReader reader(arguments);
                   const std::string text = bytes(reader);
                   const std::string socket = reader.string(1, "socket_name");
                   return reader ? send(*sockets, context, text, socket) : Outcome(reader.failure());
                 }});
  };
  add("socket_send_string", "str", [](ArgumentReader & reader) { return reader.value(0).text(); });
  add("socket_send_line", "str", [](ArgumentReader & reader) { return reader.value(0).text() + "\n"; });
  add("socket_send_byte", "value",
      [](ArgumentReader & reader) { return std::string(1, static_cast<char>(reader.integer(0, "value"))); });
  add("socket_send_int", "value", [](ArgumentReader & reader) {
    const auto value = static_cast<std::uint32_t>(reader.integer(0, "value"));
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
    }
    return bytes;
  });
}

void add_read_builtins(Library & library, const SocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const urscript::Parameter timeout{"timeout", Value(default_timeout)};
  library.add({"socket_read_line", {name, timeout}, 0, [sockets](CallContext & context, Arguments arguments) {
                 ArgumentReader reader(arguments);
                 const std::string socket = reader.string(0, "socket_name");
                 const double wait = reader.number(1, "timeout");
                 return reader ? read(*sockets, context, socket, extract_line_value, Value(""), wait)
                               : Outcome(reader.failure());
               }});
  library.add(
      {"socket_read_string",
       {name, {"prefix", Value("")}, {"suffix", Value("")}, {"interpret_escape", Value(false)}, timeout},
       0,
       [sockets](CallContext & context, Arguments arguments) {
         ArgumentReader reader(arguments);
         const std::string socket = reader.string(0, "socket_name");
         const Extractor extract = string_extractor(reader.string(1, "prefix"), reader.string(2, "suffix"));
         const double wait = reader.number(4, "timeout");
         return reader ? read(*sockets, context, socket, extract, Value(""), wait)
                       : Outcome(reader.failure());
       }});
  const auto add = [&](const char * builtin, Extractor (*make_extractor)(std::size_t), bool whole) {
    library.add({builtin,
                 {"number", name, timeout},
                 1,
                 [sockets, make_extractor, whole](CallContext & context, Arguments arguments) {
                   return read_numbers(*sockets, context, arguments, make_extractor, whole);
                 }});
  };
  add("socket_read_byte_list", [](std::size_t number) { return integer_extractor(number, 1); }, true);
  add("socket_read_binary_integer", [](std::size_t number) { return integer_extractor(number, 4); }, true);
  add("socket_read_ascii_float", float_extractor, false);
}

void add_socket_builtins(Library & library, OpenSocket open_socket)
{
  const auto sockets = std::make_shared<Sockets>(std::move(open_socket));
  library.add(
      {"socket_open",
       {"address", "port", {"socket_name", Value("socket_0")}},
       2,
       [sockets](CallContext & context, Arguments arguments) { return open(*sockets, context, arguments); }});
  library.add({"socket_close",
               {{"socket_name", Value("socket_0")}},
               0,
               [sockets](CallContext & context, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const std::string name = reader.string(0, "socket_name");
                 sockets->close(context, name);
                 return reader ? Outcome(Value()) : reader.failure();
               }});
  add_send_builtins(library, sockets);
  add_read_builtins(library, sockets);
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
