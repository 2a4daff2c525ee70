#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

// Bits of Io::analog_io_types, as RTDE's: inputs 0 and 1, then outputs 0 and 1; set for voltage, clear for
// current.
constexpr std::uint32_t input_type_bit = 0;
constexpr std::uint32_t output_type_bit = 2;

std::size_t port(ArgumentReader & in, const char * name)
{
  const std::int32_t n = in.integer(0, name);
  in.require(n == 0 || n == 1, fmt::format("{} = {} is neither 0 nor 1", name, n));
  return in ? static_cast<std::size_t>(n) : 0;
}

bool is_voltage(const Io & io, std::size_t output)
{
  return ((io.analog_io_types >> (output_type_bit + output)) & 1U) != 0;
}

// A level of 0..1 is 4..20 mA or 0..10 V.
double physical(double level, bool voltage)
{
  return voltage ? level * 10.0 : 0.004 + level * 0.016;
}
double relative(double value, bool voltage)
{
  return voltage ? value / 10.0 : (value - 0.004) / 0.016;
}

Outcome set_output(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::size_t n = port(in, "n");
  const double level = in.number(1, "f");
  in.require(level >= 0.0 && level <= 1.0, fmt::format("f = {} is outside of [0, 1]", level));
  if (!in) {
    return in.failure();
  }
  Io & io = robot.state().io;
  io.analog_outputs[n] = physical(level, is_voltage(io, n));
  return Value();
}

Outcome get_output(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::size_t n = port(in, "n");
  const Io & io = robot.state().io;
  return in ? Outcome(Value(relative(io.analog_outputs[n], is_voltage(io, n)))) : in.failure();
}

template <std::array<double, 2> Io::* inputs>
Outcome get_input(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::size_t n = port(in, "n");
  return in ? Outcome(Value((robot.state().io.*inputs)[n])) : in.failure();
}

template <std::uint32_t Io::* types, std::uint32_t first_bit>
Outcome set_domain(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::uint32_t mask = 1U << (first_bit + port(in, "port"));
  const std::int32_t domain = in.integer(1, "domain");
  in.require(domain == 0 || domain == 1,
             fmt::format("domain = {} is neither 0 (current) nor 1 (voltage)", domain));
  if (!in) {
    return in.failure();
  }
  std::uint32_t & bits = robot.state().io.*types;
  bits = domain == 1 ? bits | mask : bits & ~mask;
  return Value();
}

Outcome set_tool_voltage(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::int32_t voltage = in.integer(0, "voltage");
  in.require(voltage == 0 || voltage == 12 || voltage == 24,
             fmt::format("a tool voltage of {} V: it is 0, 12 or 24", voltage));
  if (!in) {
    return in.failure();
  }
  robot.state().io.tool_output_voltage = voltage;
  return Value();
}

}  // namespace

void add_analog_io_builtins(Library & library, const RobotPtr & robot)
{
  add_bound(library, robot, "set_analog_out", {"n", "f"}, 2, set_output);
  add_bound(library, robot, "set_standard_analog_out", {"n", "f"}, 2, set_output);
  add_bound(library, robot, "get_analog_out", {"n"}, 1, get_output);
  add_bound(library, robot, "get_standard_analog_out", {"n"}, 1, get_output);
  add_bound(library, robot, "get_analog_in", {"n"}, 1, get_input<&Io::analog_inputs>);
  add_bound(library, robot, "get_standard_analog_in", {"n"}, 1, get_input<&Io::analog_inputs>);
  add_bound(library, robot, "get_tool_analog_in", {"n"}, 1, get_input<&Io::tool_analog_inputs>);
  add_bound(library, robot, "set_analog_outputdomain", {"port", "domain"}, 2,
            set_domain<&Io::analog_io_types, output_type_bit>);
  add_bound(library, robot, "set_standard_analog_input_domain", {"port", "domain"}, 2,
            set_domain<&Io::analog_io_types, input_type_bit>);
  add_bound(library, robot, "set_tool_analog_input_domain", {"port", "domain"}, 2,
            set_domain<&Io::tool_analog_input_types, 0>);
  add_bound(library, robot, "set_tool_voltage", {"voltage"}, 1, set_tool_voltage);
}

}  // namespace ur_simulator::script_api
