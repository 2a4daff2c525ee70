#include "control_port/commands.hpp"

#include <fmt/format.h>

#include <array>
#include <exception>

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

std::array<std::span<const Command>, 4> all_commands()
{
  return {world_commands(), robot_commands(), link_commands(), inquiry_commands()};
}

json refusal(const std::string & error)
{
  return {{"ok", false}, {"error", error}};
}

json help()
{
  json list = json::array();
  for (const auto group : all_commands()) {
    for (const Command & command : group) {
      list.push_back({{"command", command.name}, {"fields", command.fields}, {"help", command.help}});
    }
  }
  return {{"ok", true}, {"commands", std::move(list)}};
}

const Command * find(std::string_view name)
{
  for (const auto group : all_commands()) {
    for (const Command & command : group) {
      if (command.name == name) {
        return &command;
      }
    }
  }
  return nullptr;
}

}  // namespace

json handle(Bench & bench, const json & request)
{
  if (!request.is_object()) {
    return refusal(R"(a request is a JSON object with a field "command": try {"command": "help"})");
  }
  try {
    Fields fields(request);
    const std::string name = fields.text("command");
    if (name == "help") {
      return help();
    }
    const Command * command = find(name);
    if (command == nullptr) {
      return refusal(fmt::format("command '{}' is not known: \"help\" lists all commands", name));
    }
    json reply{{"ok", true}};
    reply.update(command->run(bench, fields));
    return reply;
  } catch (const std::exception & error) {
    return refusal(error.what());
  }
}

}  // namespace ur_simulator::control_port
