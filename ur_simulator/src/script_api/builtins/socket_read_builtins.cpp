#include <functional>
#include <limits>
#include <utility>

#include "script_api/builtins/socket_builtins.hpp"
#include "script_api/socket_extractors.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr double default_timeout = 2.0;   // s, of the read functions (script manual)
constexpr std::int32_t max_numbers = 30;  // limit of one read (script manual, "socket_read_ascii_float")
constexpr std::uint32_t read_cost = 100;  // instructions

/// The value of a read that is not complete when its time is up or the socket is closed.
using Fallback = std::function<Value(std::string & received)>;

Fallback always(Value value)
{
  return [value = std::move(value)](std::string &) { return value; };
}

/// Waits for a value.
class ReadOperation final : public urscript::PendingCall {
 public:
  ReadOperation(const std::shared_ptr<ScriptSocket> & socket, Extractor extract, Fallback otherwise,
                double timeout)
      : socket_(socket), extract_(std::move(extract)), otherwise_(std::move(otherwise)), timeout_(timeout)
  {
  }
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    const auto socket = socket_.lock();
    if (socket == nullptr) {
      std::string nothing;
      return otherwise_(nothing);
    }
    if (auto value = extract_(socket->received())) {
      return value;
    }
    waited_ += context.cycle_time;
    const bool no_timeout = timeout_ <= 0.0;
    const bool ended = socket->failed() || (!no_timeout && waited_ >= timeout_);
    return ended ? std::optional(otherwise_(socket->received())) : std::nullopt;
  }
  bool is_network_call() const override { return true; }

 private:
  std::weak_ptr<ScriptSocket> socket_;
  Extractor extract_;
  Fallback otherwise_;
  double timeout_;
  double waited_ = 0.0;
};

// Data that has arrived is returned in the same cycle.
Outcome read_socket(ProgramSockets & sockets, CallContext & context, const std::string & name,
                    Extractor extract, Fallback otherwise, double timeout)
{
  const auto socket = sockets.find(context.program, name);
  if (socket == nullptr) {
    std::string nothing;
    Value value = otherwise(nothing);
    return context.secondary ? Outcome(std::move(value)) : Outcome(NextCycle{std::move(value)});
  }
  if (auto value = extract(socket->received())) {
    context.received_data = true;
    return std::move(*value);
  }
  return std::make_unique<ReadOperation>(socket, std::move(extract), std::move(otherwise), timeout);
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
  return reader ? read_socket(sockets, context, name, string_extractor(prefix, suffix), always(""), timeout)
                : reader.failure();
}

Outcome read_socket_line(ProgramSockets & sockets, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string name = reader.string(0, "socket_name");
  const double timeout = reader.number(1, "timeout");
  return reader ? read_socket(sockets, context, name, line_extractor(), always(""), timeout)
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
  return read_socket(sockets, context, name, variable_extractor(variable), always(0), default_timeout);
}

/// A function that reads a number of numbers.
struct NumberReader {
  const char * builtin;
  Extractor (*make_extractor)(std::size_t number);
  Fallback (*make_fallback)(std::size_t number);
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
  return read_socket(sockets, context, name, numbers.make_extractor(count), numbers.make_fallback(count),
                     timeout);
}

Extractor byte_extractor(std::size_t number)
{
  return integer_extractor(number, 1);
}
Extractor word_extractor(std::size_t number)
{
  return integer_extractor(number, 4);
}
Fallback fewer_bytes(std::size_t number)
{
  return [number](std::string & received) { return available_bytes(received, number); };
}
Fallback no_integers(std::size_t number)
{
  return always(failed_numbers(number, -1));
}
Fallback no_floats(std::size_t number)
{
  return always(failed_numbers(number, std::numeric_limits<double>::quiet_NaN()));
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
  const NumberReader readers[] = {{"socket_read_byte_list", byte_extractor, fewer_bytes},
                                  {"socket_read_binary_integer", word_extractor, no_integers},
                                  {"socket_read_ascii_float", float_extractor, no_floats}};
  for (const NumberReader & numbers : readers) {
    add(numbers.builtin, {"number", name, timeout}, 1,
        [numbers](ProgramSockets & open_sockets, CallContext & context, Arguments arguments) {
          return read_numbers(open_sockets, numbers, context, arguments);
        });
  }
}

}  // namespace ur_simulator::script_api
