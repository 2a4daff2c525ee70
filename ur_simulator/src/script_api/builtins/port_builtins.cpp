#include <cmath>
#include <cstdint>
#include <limits>

#include "port_map/port_map.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr std::int32_t min_register_value = std::numeric_limits<std::int16_t>::min();
constexpr std::int32_t max_register_value = std::numeric_limits<std::uint16_t>::max();

PortMap port_map_of(RobotContext & robot)
{
  return {robot.state(), robot.access.version};
}

unsigned port_address(ArgumentReader & reader, unsigned count)
{
  const std::int32_t address = reader.integer(0, "address");
  reader.require(address >= 0 && static_cast<unsigned>(address) < count,
                 fmt::format("address must be in [0, {}], is {}", count - 1, address));
  return reader ? static_cast<unsigned>(address) : 0;
}

Outcome read_port_bit(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const unsigned address = port_address(reader, PortMap::bit_count);
  return reader ? Outcome(Value(*port_map_of(robot).read_bit(address))) : reader.failure();
}

Outcome write_port_bit(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const unsigned address = port_address(reader, PortMap::bit_count);
  const bool value = reader.boolean(1, "value");
  if (!reader) {
    return reader.failure();
  }
  port_map_of(robot).write_bit(address, value);
  return Value();
}

Outcome read_port_register(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const unsigned address = port_address(reader, PortMap::register_count);
  if (!reader) {
    return reader.failure();
  }
  const std::uint16_t word = *port_map_of(robot).read_register(address);
  return Value(std::int32_t{static_cast<std::int16_t>(word)});
}

Outcome write_port_register(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const unsigned address = port_address(reader, PortMap::register_count);
  const double value = std::trunc(reader.number(1, "value"));
  reader.require(
      value >= min_register_value && value <= max_register_value,
      fmt::format("value must be in [{}, {}], is {}", min_register_value, max_register_value, value));
  if (!reader) {
    return reader.failure();
  }
  const auto word = static_cast<std::uint16_t>(static_cast<std::int32_t>(value));
  PortMap ports = port_map_of(robot);
  // Writing a read-only address has no effect: Robotiq's program for the FT 300 writes 410, a TCP speed.
  if (ports.check_register(address, word) == PortWrite::illegal_value) {
    return Failure{fmt::format("value {} is not possible at address {}", value, address)};
  }
  ports.write_register(address, word);
  return Value();
}

}  // namespace

void add_port_builtins(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "read_port_bit", {"address"}, 1, read_port_bit);
  add_robot_builtin(library, robot, "read_port_register", {"address"}, 1, read_port_register);
  add_robot_builtin(library, robot, "write_port_bit", {"address", "value"}, 2, write_port_bit);
  add_robot_builtin(library, robot, "write_port_register", {"address", "value"}, 2, write_port_register);
}

}  // namespace ur_simulator::script_api
