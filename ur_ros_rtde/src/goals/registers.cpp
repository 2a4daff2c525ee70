#include "ur_ros_rtde/registers.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde {
namespace {

void throw_if_failed(const Status & status)
{
  if (!status) {
    throw RobotError(status.error());
  }
}

/// The index of an output register in a Sample.
std::size_t sample_index(int index, const script::RegisterRange & free)
{
  if (!free.contains(index)) {
    throw RobotError(Error{ErrorCode::invalid_goal, fmt::format("output register {}: extensions may use {}",
                                                                index, script::to_string(free))});
  }
  return static_cast<std::size_t>(index - Sample::first_output_register);
}

Sample latest_sample(const Robot & robot)
{
  if (auto sample = robot.latest()) {
    return *sample;
  }
  throw RobotError(Error{ErrorCode::link_lost, "no data has been received from the controller yet"});
}

}  // namespace

void Registers::set_int(int index, std::int32_t value)
{
  throw_if_failed(robot_.set_input_register(index, value));
}

void Registers::set_double(int index, double value)
{
  throw_if_failed(robot_.set_input_register(index, value));
}

std::int32_t Registers::get_int(int index) const
{
  const std::size_t i = sample_index(index, script::free_int_outputs);
  return latest_sample(robot_).output_int_registers[i];
}

double Registers::get_double(int index) const
{
  const std::size_t i = sample_index(index, script::free_float_outputs);
  return latest_sample(robot_).output_double_registers[i];
}

}  // namespace ur_ros_rtde
