#include <fmt/format.h>

#include <memory>

#include "robot_api/handlers.hpp"
#include "robot_api/waiting_reply.hpp"

namespace ur_simulator::robot_api {
namespace {

std::string_view program_state_name(const Pendant & pendant)
{
  const ProgramRunner & runner = pendant.runner();
  return !runner.running() ? "STOPPED" : runner.paused() ? "PAUSED" : "PLAYING";
}

Reply program_state_reply(const Pendant & pendant, std::string_view action)
{
  const std::string_view state = program_state_name(pendant);
  return json_reply(200, {{"state", state},
                          {"message", fmt::format("Program state changed: {}", state)},
                          {"details", fmt::format("{} successful", action)}});
}

Reply rejected_action(const std::string & reason)
{
  return error_reply(500, "Program state was not changed", reason);
}

Answer play(const Call & call)
{
  // The program may have to be requested from a host.
  auto reply = std::make_shared<std::optional<Reply>>();
  call.pendant.play([reply, &pendant = call.pendant](const Pendant::Result & result) {
    *reply = result ? program_state_reply(pendant, "Play") : rejected_action(result.error());
  });
  return [reply] { return *reply; };
}

Answer pause(const Call & call)
{
  if (const auto result = call.pendant.pause(); !result) {
    return rejected_action(result.error());
  }
  // The program may end before it pauses.
  return wait_for(
      call.pendant,
      [](const Pendant & pendant) { return !pendant.runner().running() || pendant.runner().paused(); },
      [](const Pendant & pendant) { return program_state_reply(pendant, "Pause"); });
}

Answer resume(const Call & call)
{
  const auto result = call.pendant.resume();
  return result ? program_state_reply(call.pendant, "Resume") : rejected_action(result.error());
}

Answer stop(const Call & call)
{
  call.pendant.stop();
  return wait_for(
      call.pendant, [](const Pendant & pendant) { return !pendant.runner().running(); },
      [](const Pendant & pendant) { return program_state_reply(pendant, "Stop"); });
}

/// Loads the program whose name is in the field. `missing_status`: the status if there is none.
Answer load(const Call & call, std::string_view field, unsigned missing_status)
{
  const auto name = call.body.at(std::string(field)).get<std::string>();
  const auto loaded = call.pendant.load_program(name);
  if (!loaded) {
    const bool missing = loaded.error() == Pendant::LoadError::not_found;
    return error_reply(missing ? missing_status : 500, "Program was not loaded",
                       missing ? fmt::format("there is no program '{}'", name)
                               : fmt::format("program '{}' has an error: see the log", name));
  }
  return json_reply(200, {{std::string(field), name}, {"message", "Program loaded"}, {"details", nullptr}});
}

}  // namespace

Answer get_program_state(const Call & call)
{
  return json_reply(
      200, {{"state", program_state_name(call.pendant)}, {"message", nullptr}, {"details", nullptr}});
}

Answer change_program_state(const Call & call)
{
  const auto action = call.body.at("action").get<std::string>();
  if (action == "play") {
    return play(call);
  }
  if (action == "pause") {
    return pause(call);
  }
  return action == "resume" ? resume(call) : stop(call);
}

Answer get_loaded_program(const Call & call)
{
  return json_reply(200, {{"name", call.pendant.loaded_program()}, {"message", nullptr}});
}

Answer load_program(const Call & call)
{
  return load(call, "name", 404);
}

Answer load_program_by_program_name(const Call & call)
{
  return load(call, "programName", 500);
}

}  // namespace ur_simulator::robot_api
