#include <memory>
#include <optional>

#include "dashboard/commands.hpp"

namespace ur_simulator::dashboard {

PendingReply play(Pendant & pendant, std::string_view)
{
  auto reply = std::make_shared<std::optional<std::string>>();
  if (pendant.in_manual_mode()) {
    pendant.log().error("dashboard", "play was rejected: the operational mode is MANUAL");
    *reply = "Failed to execute: play";
  } else {
    pendant.play(
        [reply](const Pendant::Result & result) { *reply = reply_to(result, "Starting program", "play"); });
  }
  return [reply] { return *reply; };
}

PendingReply stop(Pendant & pendant, std::string_view)
{
  pendant.stop();
  return [&pendant]() -> std::optional<std::string> {
    if (pendant.state().runtime_state == RuntimeState::stopping) {
      return std::nullopt;
    }
    return "Stopped";
  };
}

PendingReply pause(Pendant & pendant, std::string_view)
{
  return [&pendant,
          reply = reply_to(pendant.pause(), "Pausing program", "pause")]() -> std::optional<std::string> {
    if (pendant.state().runtime_state == RuntimeState::pausing) {
      return std::nullopt;
    }
    return reply;
  };
}

PendingReply generate_flight_report(Pendant & pendant, std::string_view type)
{
  return pendant.reports().start_flight_report(type);
}

PendingReply generate_support_file(Pendant & pendant, std::string_view folder)
{
  return pendant.reports().start_support_file(folder);
}

}  // namespace ur_simulator::dashboard
