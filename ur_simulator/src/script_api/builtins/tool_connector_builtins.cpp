#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

void require_range(ArgumentReader & reader, const char * name, double value, double min, double max)
{
  reader.require(value >= min && value <= max,
                 fmt::format("{} must be in [{}, {}], is {}", name, min, max, value));
}

Outcome set_tool_voltage(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t voltage = reader.integer(0, "voltage");
  reader.require(voltage == 0 || voltage == 12 || voltage == 24,
                 fmt::format("voltage must be 0, 12 or 24, is {}", voltage));
  if (!reader) {
    return reader.failure();
  }
  robot.state().io.tool_output_voltage = voltage;
  return Value();
}

Outcome set_output_mode(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t mode = reader.integer(0, "mode");
  require_range(reader, "mode", mode, 0, 1);
  if (!reader) {
    return reader.failure();
  }
  robot.state().io.tool_output_mode = mode;
  return Value();
}

Outcome set_digital_output_mode(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t n = reader.integer(0, "n");
  const std::int32_t mode = reader.integer(1, "mode");
  require_range(reader, "n", n, 0, 1);
  require_range(reader, "mode", mode, 1, 3);
  if (!reader) {
    return reader.failure();
  }
  robot.state().io.tool_digital_output_modes[static_cast<std::size_t>(n)] = mode;
  return Value();
}

Outcome set_communication(RobotContext & robot, Arguments arguments)
{
  // Script manual, "set_tool_communication".
  constexpr std::array baud_rates{9600, 19200, 38400, 57600, 115200, 1000000, 2000000, 5000000};
  ArgumentReader reader(arguments);
  ToolCommunication line;
  line.enabled = reader.boolean(0, "enabled");
  line.baud_rate = reader.integer(1, "baud_rate");
  line.parity = reader.integer(2, "parity");
  line.stop_bits = reader.integer(3, "stop_bits");
  line.rx_idle_chars = reader.number(4, "rx_idle_chars");
  line.tx_idle_chars = reader.number(5, "tx_idle_chars");
  reader.require(
      std::ranges::find(baud_rates, line.baud_rate) != baud_rates.end(),
      fmt::format("baud_rate must be one of {}, is {}", fmt::join(baud_rates, ", "), line.baud_rate));
  require_range(reader, "parity", line.parity, 0, 2);
  require_range(reader, "stop_bits", line.stop_bits, 1, 2);
  require_range(reader, "rx_idle_chars", line.rx_idle_chars, 1.0, 40.0);
  require_range(reader, "tx_idle_chars", line.tx_idle_chars, 0.0, 40.0);
  if (!reader) {
    return reader.failure();
  }
  robot.state().io.tool_communication = line;
  return Value();
}

}  // namespace

void add_tool_connector_builtins(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "set_tool_voltage", {"voltage"}, 1, set_tool_voltage);
  add_robot_builtin(library, robot, "set_tool_output_mode", {"mode"}, 1, set_output_mode);
  add_robot_builtin(library, robot, "set_tool_digital_output_mode", {"n", "mode"}, 2,
                    set_digital_output_mode);
  add_robot_builtin(library, robot, "set_tool_communication",
                    {"enabled", "baud_rate", "parity", "stop_bits", "rx_idle_chars", "tx_idle_chars"}, 6,
                    set_communication);
}

}  // namespace ur_simulator::script_api
