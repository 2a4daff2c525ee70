#include <cstdlib>
#include <map>
#include <utility>

#include "script_api/robot.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr double default_timeout = 2.0;    // s, of reading
constexpr double connect_timeout = 2.0;    // s
constexpr std::int32_t most_numbers = 30;  // the manual's limit of one read

/// The sockets of one program, by name. They end with it.
class Sockets {
 public:
  explicit Sockets(OpenSocket open) : open_(std::move(open)) {}

  std::shared_ptr<ScriptSocket> open(const CallContext & context, const std::string & name,
                                     const std::string & address, std::uint16_t port)
  {
    belong_to(context);
    return sockets_[name] = open_(address, port);
  }
  /// nullptr when none of that name is open.
  std::shared_ptr<ScriptSocket> find(const CallContext & context, const std::string & name)
  {
    belong_to(context);
    const auto found = sockets_.find(name);
    return found == sockets_.end() ? nullptr : found->second;
  }
  void close(const CallContext & context, const std::string & name)
  {
    belong_to(context);
    sockets_.erase(name);
  }

 private:
  void belong_to(const CallContext & context)
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

/// Waits for a connection; True or False.
class Connecting final : public urscript::Operation {
 public:
  explicit Connecting(SocketPtr socket) : socket_(std::move(socket)) {}
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    waited_ += context.cycle_time;
    if (socket_->connected()) {
      return Value(true);
    }
    const bool over = socket_->failed() || waited_ >= connect_timeout;
    return over ? std::optional(Value(false)) : std::nullopt;
  }

 private:
  SocketPtr socket_;
  double waited_ = 0.0;
};

/// Takes what it waits for out of what was received; nothing while it is not all there.
using Take = std::function<std::optional<Value>(std::string & received)>;

/// Waits for what `take` takes; `otherwise` when the time is up or the peer has gone.
class SocketReading final : public urscript::Operation {
 public:
  SocketReading(SocketPtr socket, Take take, Value otherwise, double timeout)
      : socket_(std::move(socket)),
        take_(std::move(take)),
        otherwise_(std::move(otherwise)),
        timeout_(timeout)
  {
  }
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    waited_ += context.cycle_time;
    if (auto value = take_(socket_->received())) {
      return value;
    }
    const bool for_ever = timeout_ <= 0.0;
    const bool over = socket_->failed() || (!for_ever && waited_ >= timeout_);
    return over ? std::optional(otherwise_) : std::nullopt;
  }

 private:
  SocketPtr socket_;
  Take take_;
  Value otherwise_;
  double timeout_;
  double waited_ = 0.0;
};

Outcome open(Sockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string address = in.string(0, "address");
  const std::int32_t port = in.integer(1, "port");
  in.require(port > 0 && port < 65536, fmt::format("port = {} is outside of 1..65535", port));
  const std::string name = in.string(2, "socket_name");
  if (!in) {
    return in.failure();
  }
  return std::make_unique<Connecting>(sockets.open(context, name, address, static_cast<std::uint16_t>(port)));
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

Outcome read(Sockets & sockets, CallContext & context, const std::string & name, Take take, Value otherwise,
             double timeout)
{
  SocketPtr socket = sockets.find(context, name);
  if (socket == nullptr) {
    return NextCycle{std::move(otherwise)};
  }
  return std::make_unique<SocketReading>(std::move(socket), std::move(take), std::move(otherwise), timeout);
}

std::optional<std::string> take_line(std::string & received)
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

std::optional<Value> take_line_value(std::string & received)
{
  auto line = take_line(received);
  return line ? std::optional(Value(std::move(*line))) : std::nullopt;
}

/// All that is there, or, with prefix and suffix, what stands between them.
Take taking_string(const std::string & prefix, const std::string & suffix)
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

/// How many came, then they themselves.
Value counted(std::vector<double> numbers, bool whole)
{
  numbers.insert(numbers.begin(), static_cast<double>(numbers.size()));
  return number_list(numbers, whole);
}

Take taking_bytes(std::size_t number, std::size_t size)
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
    return counted(std::move(values), true);
  };
}

/// "(1.5, 2, 3)": so many numbers in parentheses.
Take taking_floats(std::size_t number)
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
        return counted({}, false);
      }
      values.push_back(value);
    }
    return values.size() == number ? counted(std::move(values), false) : counted({}, false);
  };
}

Outcome read_numbers(Sockets & sockets, CallContext & context, Arguments arguments,
                     Take (*taking)(std::size_t number), bool whole)
{
  ArgumentReader in(arguments);
  const std::int32_t number = in.integer(0, "number");
  in.require(number > 0 && number <= most_numbers,
             fmt::format("number = {} is outside of 1..{}", number, most_numbers));
  const std::string name = in.string(1, "socket_name");
  const double timeout = in.number(2, "timeout");
  return in ? read(sockets, context, name, taking(static_cast<std::size_t>(number)), counted({}, whole),
                   timeout)
            : in.failure();
}

void add_sending(Library & library, const SocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const auto add = [&](const char * builtin, const char * argument,
                       std::string (*bytes)(ArgumentReader & in)) {
    library.add({builtin, {argument, name}, 1, [sockets, bytes](CallContext & context, Arguments arguments) {
                   ArgumentReader in(arguments);
                   const std::string text = bytes(in);
                   const std::string socket = in.string(1, "socket_name");
                   return in ? send(*sockets, context, text, socket) : Outcome(in.failure());
                 }});
  };
  add("socket_send_string", "str", [](ArgumentReader & in) { return in.value(0).text(); });
  add("socket_send_line", "str", [](ArgumentReader & in) { return in.value(0).text() + "\n"; });
  add("socket_send_byte", "value",
      [](ArgumentReader & in) { return std::string(1, static_cast<char>(in.integer(0, "value"))); });
  add("socket_send_int", "value", [](ArgumentReader & in) {
    const auto value = static_cast<std::uint32_t>(in.integer(0, "value"));
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
    }
    return bytes;
  });
}

void add_reading(Library & library, const SocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const urscript::Parameter timeout{"timeout", Value(default_timeout)};
  library.add({"socket_read_line", {name, timeout}, 0, [sockets](CallContext & context, Arguments arguments) {
                 ArgumentReader in(arguments);
                 const std::string socket = in.string(0, "socket_name");
                 const double wait = in.number(1, "timeout");
                 return in ? read(*sockets, context, socket, take_line_value, Value(""), wait)
                           : Outcome(in.failure());
               }});
  library.add(
      {"socket_read_string",
       {name, {"prefix", Value("")}, {"suffix", Value("")}, {"interpret_escape", Value(false)}, timeout},
       0,
       [sockets](CallContext & context, Arguments arguments) {
         ArgumentReader in(arguments);
         const std::string socket = in.string(0, "socket_name");
         const Take take = taking_string(in.string(1, "prefix"), in.string(2, "suffix"));
         const double wait = in.number(4, "timeout");
         return in ? read(*sockets, context, socket, take, Value(""), wait) : Outcome(in.failure());
       }});
  const auto add = [&](const char * builtin, Take (*taking)(std::size_t), bool whole) {
    library.add({builtin,
                 {"number", name, timeout},
                 1,
                 [sockets, taking, whole](CallContext & context, Arguments arguments) {
                   return read_numbers(*sockets, context, arguments, taking, whole);
                 }});
  };
  add("socket_read_byte_list", [](std::size_t number) { return taking_bytes(number, 1); }, true);
  add("socket_read_binary_integer", [](std::size_t number) { return taking_bytes(number, 4); }, true);
  add("socket_read_ascii_float", taking_floats, false);
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
                 ArgumentReader in(arguments);
                 const std::string name = in.string(0, "socket_name");
                 sockets->close(context, name);
                 return in ? Outcome(Value()) : in.failure();
               }});
  add_sending(library, sockets);
  add_reading(library, sockets);
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
