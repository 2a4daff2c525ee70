#include "script_api/robot_context.hpp"
#include "state/io_values.hpp"

namespace ur_simulator::script_api {

namespace {

// Bits of Io::analog_io_types, as in RTDE's analog_io_types: inputs 0 and 1, then outputs 0 and 1. 1:
// voltage, 0: current.
constexpr std::uint32_t input_type_bit = 0;
constexpr std::uint32_t output_type_bit = 2;

std::size_t port(ArgumentReader & reader, const char * name)
{
  const std::int32_t n = reader.integer(0, name);
  reader.require(n == 0 || n == 1, fmt::format("{} must be 0 or 1, is {}", name, n));
  return reader ? static_cast<std::size_t>(n) : 0;
}

bool is_voltage(const Io & io, std::size_t output)
{
  return bit_of(io.analog_io_types, output_type_bit + static_cast<unsigned>(output));
}

Outcome set_output(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::size_t n = port(reader, "n");
  const double level = reader.number(1, "f");
  reader.require(level >= 0.0 && level <= 1.0, fmt::format("f must be in [0, 1], is {}", level));
  if (!reader) {
    return reader.failure();
  }
  Io & io = robot.state().io;
  io.analog_outputs[n] = analog_value(level, is_voltage(io, n));
  return Value();
}

Outcome get_output(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::size_t n = port(reader, "n");
  const Io & io = robot.state().io;
  return reader ? Outcome(Value(analog_level(io.analog_outputs[n], is_voltage(io, n)))) : reader.failure();
}

/// 2 and 3 are the inputs of the tool, "for backwards compatibility".
Outcome get_any_input(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t n = reader.integer(0, "n");
  reader.require(n >= 0 && n <= 3, fmt::format("n must be in [0, 3], is {}", n));
  if (!reader) {
    return reader.failure();
  }
  const Io & io = robot.state().io;
  const auto & inputs = n < 2 ? io.analog_inputs : io.tool_analog_inputs;
  return Value(inputs[static_cast<std::size_t>(n % 2)]);
}

template <std::array<double, 2> Io::* inputs>
Outcome get_input(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::size_t n = port(reader, "n");
  return reader ? Outcome(Value((robot.state().io.*inputs)[n])) : reader.failure();
}

template <std::uint32_t Io::* types, std::uint32_t first_bit>
Outcome set_domain(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::uint32_t mask = 1U << (first_bit + port(reader, "port"));
  const std::int32_t domain = reader.integer(1, "domain");
  reader.require(domain == 0 || domain == 1,
                 fmt::format("domain must be 0 (current) or 1 (voltage), is {}", domain));
  if (!reader) {
    return reader.failure();
  }
  std::uint32_t & bits = robot.state().io.*types;
  bits = domain == 1 ? bits | mask : bits & ~mask;
  return Value();
}

}  // namespace

void add_analog_io_builtins(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "set_analog_out", {"n", "f"}, 2, set_output);
  add_robot_builtin(library, robot, "set_standard_analog_out", {"n", "f"}, 2, set_output);
  add_robot_builtin(library, robot, "get_analog_out", {"n"}, 1, get_output);
  add_robot_builtin(library, robot, "get_standard_analog_out", {"n"}, 1, get_output);
  add_robot_builtin(library, robot, "get_analog_in", {"n"}, 1, get_any_input);
  add_robot_builtin(library, robot, "get_standard_analog_in", {"n"}, 1, get_input<&Io::analog_inputs>);
  add_robot_builtin(library, robot, "get_tool_analog_in", {"n"}, 1, get_input<&Io::tool_analog_inputs>);
  add_robot_builtin(library, robot, "set_analog_outputdomain", {"port", "domain"}, 2,
                    set_domain<&Io::analog_io_types, output_type_bit>);
  add_robot_builtin(library, robot, "set_standard_analog_input_domain", {"port", "domain"}, 2,
                    set_domain<&Io::analog_io_types, input_type_bit>);
  add_robot_builtin(library, robot, "set_tool_analog_input_domain", {"port", "domain"}, 2,
                    set_domain<&Io::tool_analog_input_types, 0>);
  library.add_indexed_name("analog_in", "get_analog_in");
  library.add_indexed_name("analog_out", "get_analog_out", "set_analog_out");
}

}  // namespace ur_simulator::script_api
