#include "safety/safety.hpp"

namespace ur_simulator {
namespace {

constexpr std::uint32_t bit(unsigned number)
{
  return 1U << number;
}

}  // namespace

std::uint32_t robot_status_bits(RobotMode mode, RuntimeState runtime, bool freedrive)
{
  const bool powered = mode == RobotMode::power_on || mode == RobotMode::idle ||
                       mode == RobotMode::backdrive || mode == RobotMode::running;
  const bool running = runtime == RuntimeState::playing || runtime == RuntimeState::resuming;
  return (powered ? bit(0) : 0U) | (running ? bit(1) : 0U) | (freedrive ? bit(2) : 0U);
}

std::uint32_t safety_status_bits(SafetyMode mode)
{
  constexpr std::uint32_t stopped = bit(10);
  switch (mode) {
    case SafetyMode::normal:
      return bit(0);
    case SafetyMode::reduced:
      return bit(1);
    case SafetyMode::protective_stop:
      return bit(2) | stopped;
    case SafetyMode::recovery:
      return bit(3);
    case SafetyMode::safeguard_stop:
      return bit(4) | stopped;
    case SafetyMode::system_emergency_stop:
      return bit(5) | bit(7) | stopped;
    case SafetyMode::robot_emergency_stop:
      return bit(6) | bit(7) | stopped;
    case SafetyMode::violation:
      return bit(8) | stopped;
    case SafetyMode::fault:
      return bit(9) | stopped;
    case SafetyMode::validate_joint_id:
    case SafetyMode::undefined:
      return stopped;
  }
  return stopped;
}

}  // namespace ur_simulator
