#include "ur_ros_rtde/registers.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde_robot/program/extension_registers.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {

void expect(const Status & status)
{
  if (!status) {
    throw RobotError(status.error());
  }
}

/// Its place in a Sample.
std::size_t checked(int index, const script::RegisterRange & free)
{
  if (!free.contains(index)) {
    throw RobotError(Error{ErrorCode::invalid_goal, fmt::format("output register {}: extensions may use {}",
                                                                index, script::to_string(free))});
  }
  return static_cast<std::size_t>(index - free.first);
}

Sample newest(const Robot & robot)
{
  if (auto sample = robot.latest()) {
    return *sample;
  }
  throw RobotError(Error{ErrorCode::link_lost, "nothing has come from the controller yet"});
}

}  // namespace

void Registers::set_int(int index, std::int32_t value)
{
  expect(robot_.set_input_register(index, value));
}

void Registers::set_double(int index, double value)
{
  expect(robot_.set_input_register(index, value));
}

std::int32_t Registers::get_int(int index) const
{
  const std::size_t place = checked(index, script::free_int_outputs);
  return newest(robot_).output_int_registers[place];
}

double Registers::get_double(int index) const
{
  const std::size_t place = checked(index, script::free_float_outputs);
  return newest(robot_).output_double_registers[place];
}

}  // namespace ur_ros_rtde
