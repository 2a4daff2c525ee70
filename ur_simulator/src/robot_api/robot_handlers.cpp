#include <fmt/format.h>

#include <array>

#include "robot_api/handlers.hpp"
#include "robot_api/waiting_reply.hpp"

namespace ur_simulator::robot_api {
namespace {

struct RobotAction {
  std::string_view name;
  Pendant::Result (*execute)(Pendant & pendant);
  bool (*completed)(const Pendant & pendant);
};

bool has_mode(const Pendant & pendant, RobotMode mode)
{
  return pendant.state().robot_mode == mode;
}

constexpr std::array robot_actions_table{
    RobotAction{"POWER_ON", [](Pendant & pendant) { return pendant.power_on(); },
                [](const Pendant & pendant) {
                  return has_mode(pendant, RobotMode::idle) || has_mode(pendant, RobotMode::running);
                }},
    RobotAction{"POWER_OFF", [](Pendant & pendant) { return pendant.power_off(); },
                [](const Pendant & pendant) { return has_mode(pendant, RobotMode::power_off); }},
    RobotAction{"BRAKE_RELEASE", [](Pendant & pendant) { return pendant.release_brakes(); },
                [](const Pendant & pendant) { return has_mode(pendant, RobotMode::running); }},
    RobotAction{
        "UNLOCK_PROTECTIVE_STOP",
        [](Pendant & pendant) { return pendant.unlock_protective_stop(UnlockDelay::waived); },
        [](const Pendant & pendant) { return pendant.state().safety_mode != SafetyMode::protective_stop; }},
    RobotAction{"RESTART_SAFETY", [](Pendant & pendant) { return pendant.restart_safety(); },
                [](const Pendant & pendant) {
                  return !pendant.restarting_safety() && has_mode(pendant, RobotMode::power_off);
                }},
};

std::string_view robot_mode_name(RobotMode mode)
{
  return mode == RobotMode::updating_firmware ? "UPDATING" : to_string(mode);
}

/// The Robot API has fewer modes than the safety system.
std::string_view safety_mode_name(SafetyMode mode)
{
  switch (mode) {
    case SafetyMode::normal:
      return "NORMAL";
    case SafetyMode::reduced:
    case SafetyMode::recovery:
      return "REDUCED";
    case SafetyMode::protective_stop:
    case SafetyMode::safeguard_stop:
      return "PROTECTIVE_STOP";
    case SafetyMode::system_emergency_stop:
    case SafetyMode::robot_emergency_stop:
      return "EMERGENCY_STOP";
    default:
      return "FAULT";
  }
}

}  // namespace

Answer change_robot_state(const Call & call)
{
  const auto name = call.body.at("action").get<std::string>();
  const RobotAction & action = *std::ranges::find(robot_actions_table, name, &RobotAction::name);
  if (const auto result = action.execute(call.pendant); !result) {
    return error_reply(409, "Conflict", result.error());
  }
  return wait_for(call.pendant, action.completed, [name](const Pendant & pendant) {
    const std::string_view mode = robot_mode_name(pendant.state().robot_mode);
    return json_reply(200, {{"state", mode},
                            {"message", fmt::format("Robot state changed: {}", mode)},
                            {"details", name + " successful"}});
  });
}

Answer get_robot_mode(const Call & call)
{
  return json_reply(200, {{"mode", robot_mode_name(call.pendant.state().robot_mode)}, {"message", nullptr}});
}

Answer get_safety_mode(const Call & call)
{
  return json_reply(200,
                    {{"mode", safety_mode_name(call.pendant.state().safety_mode)}, {"message", nullptr}});
}

}  // namespace ur_simulator::robot_api
