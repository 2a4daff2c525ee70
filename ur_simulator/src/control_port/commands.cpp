#include "control_port/commands.hpp"

#include <fmt/format.h>

#include <array>
#include <exception>

#include "control_port/reply.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

std::array<std::span<const Command>, 5> command_groups()
{
  return {world_commands(), gripper_commands(), robot_commands(), connection_commands(), query_commands()};
}

json help()
{
  json list = json::array();
  for (const auto group : command_groups()) {
    for (const Command & command : group) {
      list.push_back({{"command", command.name}, {"fields", command.fields}, {"help", command.help}});
    }
  }
  return {{"ok", true}, {"commands", std::move(list)}};
}

const Command * find_command(std::string_view name)
{
  for (const auto group : command_groups()) {
    for (const Command & command : group) {
      if (command.name == name) {
        return &command;
      }
    }
  }
  return nullptr;
}

}  // namespace

json execute_request(ControlPortContext & context, const json & request)
{
  if (!request.is_object()) {
    return error_reply(R"(a request is a JSON object with a field "command": try {"command": "help"})");
  }
  try {
    RequestFields fields(request);
    const std::string name = fields.string("command");
    if (name == "help") {
      return help();
    }
    const Command * command = find_command(name);
    if (command == nullptr) {
      return error_reply(fmt::format("command '{}' is not known: \"help\" lists all commands", name));
    }
    json reply{{"ok", true}};
    reply.update(command->execute(context, fields));
    return reply;
  } catch (const std::exception & error) {
    return error_reply(error.what());
  }
}

}  // namespace ur_simulator::control_port
