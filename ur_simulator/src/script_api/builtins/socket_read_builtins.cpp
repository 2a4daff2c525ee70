#include <limits>
#include <utility>

#include "script_api/builtins/socket_builtins.hpp"
#include "script_api/socket_extractors.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr double default_timeout = 2.0;   // s, of the read functions (script manual)
constexpr std::int32_t max_numbers = 30;  // limit of one read (script manual, "socket_read_ascii_float")
constexpr std::uint32_t read_cost = 100;  // instructions

/// Waits for a value. Result: `default_value` if the time is up or the socket is closed.
class ReadOperation final : public urscript::Operation {
 public:
  ReadOperation(const std::shared_ptr<ScriptSocket> & socket, Extractor extract, Value default_value,
                double timeout)
      : socket_(socket),
        extract_(std::move(extract)),
        default_value_(std::move(default_value)),
        timeout_(timeout)
  {
  }
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    const auto socket = socket_.lock();
    if (socket == nullptr) {
      return default_value_;
    }
    if (auto value = extract_(socket->received())) {
      return value;
    }
    waited_ += context.cycle_time;
    const bool no_timeout = timeout_ <= 0.0;
    const bool ended = socket->failed() || (!no_timeout && waited_ >= timeout_);
    return ended ? std::optional(default_value_) : std::nullopt;
  }

 private:
  std::weak_ptr<ScriptSocket> socket_;
  Extractor extract_;
  Value default_value_;
  double timeout_;
  double waited_ = 0.0;
};

// Data that has arrived is returned in the same cycle.
Outcome read_socket(ProgramSockets & sockets, CallContext & context, const std::string & name,
                    Extractor extract, Value default_value, double timeout)
{
  const auto socket = sockets.find(context.program, name);
  if (socket == nullptr) {
    return NextCycle{std::move(default_value)};
  }
  if (auto value = extract(socket->received())) {
    context.received_data = true;
    return std::move(*value);
  }
  return std::make_unique<ReadOperation>(socket, std::move(extract), std::move(default_value), timeout);
}

Outcome read_string(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string name = reader.string(0, "socket_name");
  std::string prefix = reader.string(1, "prefix");
  std::string suffix = reader.string(2, "suffix");
  if (reader.boolean(3, "interpret_escape")) {
    prefix = interpret_escapes(prefix);
    suffix = interpret_escapes(suffix);
  }
  const double timeout = reader.number(4, "timeout");
  return reader ? read_socket(sockets, context, name, string_extractor(prefix, suffix), Value(""), timeout)
                : reader.failure();
}

Outcome read_socket_line(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string name = reader.string(0, "socket_name");
  const double timeout = reader.number(1, "timeout");
  return reader ? read_socket(sockets, context, name, line_extractor(), Value(""), timeout)
                : reader.failure();
}

Outcome get_variable(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string variable = reader.string(0, "name");
  const std::string name = reader.string(1, "socket_name");
  if (!reader) {
    return reader.failure();
  }
  if (const auto socket = sockets.find(context.program, name)) {
    socket->send("GET " + variable + "\n");
  }
  return read_socket(sockets, context, name, variable_extractor(variable), Value(0), default_timeout);
}

/// A function that reads a number of numbers.
struct NumberReader {
  const char * builtin;
  Extractor (*make_extractor)(std::size_t number);
  Value value_if_failed;
};

Outcome read_numbers(ProgramSockets & sockets, const NumberReader & numbers, CallContext & context,
                     Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t number = reader.integer(0, "number");
  reader.require(number > 0 && number <= max_numbers,
                 fmt::format("number must be in [1, {}], is {}", max_numbers, number));
  const std::string name = reader.string(1, "socket_name");
  const double timeout = reader.number(2, "timeout");
  if (!reader) {
    return reader.failure();
  }
  const auto count = static_cast<std::size_t>(number);
  return read_socket(sockets, context, name, numbers.make_extractor(count),
                     failed_numbers(count, numbers.value_if_failed), timeout);
}

}  // namespace

void add_socket_read_builtins(Library & library, const ProgramSocketsPtr & sockets)
{
  const urscript::Parameter name{"socket_name", Value("socket_0")};
  const urscript::Parameter timeout{"timeout", Value(default_timeout)};
  const auto add = [&](const char * builtin, std::vector<urscript::Parameter> parameters,
                       std::size_t required, auto function) {
    library.add({builtin, std::move(parameters), required,
                 [sockets, function](CallContext & context, Arguments arguments) {
                   return function(*sockets, context, arguments);
                 },
                 false, read_cost});
  };
  add("socket_read_line", {name, timeout}, 0, read_socket_line);
  add("socket_read_string",
      {name, {"prefix", Value("")}, {"suffix", Value("")}, {"interpret_escape", Value(false)}, timeout}, 0,
      read_string);
  add("socket_get_var", {"name", name}, 1, get_variable);
  const NumberReader readers[] = {
      {"socket_read_byte_list", [](std::size_t number) { return integer_extractor(number, 1); }, Value(-1)},
      {"socket_read_binary_integer", [](std::size_t number) { return integer_extractor(number, 4); },
       Value(-1)},
      {"socket_read_ascii_float", float_extractor, Value(std::numeric_limits<double>::quiet_NaN())},
  };
  for (const NumberReader & numbers : readers) {
    add(numbers.builtin, {"number", name, timeout}, 1,
        [numbers](ProgramSockets & open_sockets, CallContext & context, Arguments arguments) {
          return read_numbers(open_sockets, numbers, context, arguments);
        });
  }
}

}  // namespace ur_simulator::script_api
