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
  return {{"commands", std::move(list)}};
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

Action prepare_request(const json & request)
{
  if (!request.is_object()) {
    throw RequestError(R"(a request is a JSON object with a field "command": try {"command": "help"})");
  }
  RequestFields fields(request);
  const std::string name = fields.string("command");
  if (name == "help") {
    return [](ControlPortContext &) { return help(); };
  }
  const Command * command = find_command(name);
  if (command == nullptr) {
    throw RequestError(fmt::format("command '{}' is not known: \"help\" lists all commands", name),
                       "command");
  }
  Action action = command->prepare(fields);
  fields.reject_unknown();
  return action;
}

json execute_request(ControlPortContext & context, const json & request)
{
  try {
    json reply{{"ok", true}};
    reply.update(prepare_request(request)(context));
    return reply;
  } catch (const std::exception & error) {
    return error_reply(error.what());
  }
}

}  // namespace ur_simulator::control_port
