#include "ur_ros_rtde/registers.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde/robot.hpp"

namespace ur_ros_rtde {
namespace {

constexpr int first_output = 12;
constexpr int last_output = 19;
constexpr int acknowledgement = 18;

void expect(const Status & status)
{
  if (!status) {
    throw RobotError(status.error());
  }
}

std::size_t checked(int index, bool also_allowed)
{
  if (index < first_output || index > last_output || !also_allowed) {
    throw RobotError(Error{ErrorCode::invalid_goal,
                           fmt::format("output register {}: extensions may use {} to {} (float: not {})",
                                       index, first_output, last_output, acknowledgement)});
  }
  return static_cast<std::size_t>(index - first_output);
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
  return newest(robot_).output_int_registers[checked(index, true)];
}

double Registers::get_double(int index) const
{
  return newest(robot_).output_double_registers[checked(index, index != acknowledgement)];
}

}  // namespace ur_ros_rtde
