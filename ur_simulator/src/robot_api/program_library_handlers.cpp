#include <fmt/format.h>

#include "robot_api/handlers.hpp"
#include "robot_api/program_file.hpp"

namespace ur_simulator::robot_api {
namespace {

using nlohmann::json;

constexpr std::size_t max_programs = 200;

json date(std::int64_t milliseconds)
{
  return milliseconds == 0 ? json() : json(milliseconds);
}

Reply missing_program(const std::string & name)
{
  return error_reply(404, "Program not found", fmt::format("there is no program '{}'", name));
}

Reply stored_reply(const std::string & name, std::string_view message)
{
  return json_reply(200, {{"programName", name}, {"message", message}});
}

Reply invalid_file(const std::string & reason)
{
  return validation_error({"body", std::string(file_field)}, "Invalid .urpx file format: " + reason);
}

}  // namespace

Answer list_programs(const Call & call)
{
  json programs = json::array();
  for (const auto & [name, program] : call.pendant.programs()) {
    programs.push_back({{"name", name},
                        {"description", program.description},
                        {"createdDate", program.created},
                        {"lastSavedDate", date(program.saved)},
                        {"lastModifiedDate", nullptr},
                        {"programState", "FINAL"}});
  }
  return json_reply(200, {{"programs", std::move(programs)}, {"message", nullptr}});
}

Answer download_program(const Call & call)
{
  const StoredProgram * program = call.pendant.find_program(call.parameter);
  if (program == nullptr) {
    return missing_program(call.parameter);
  }
  Reply reply;
  reply.body = program_document(call.parameter, *program);
  reply.content_type = "application/octet-stream";
  return reply;
}

Answer upload_program(const Call & call)
{
  auto file = read_program_file(call.file);
  if (!file) {
    return invalid_file(file.error());
  }
  if (call.pendant.find_program(file->name) != nullptr) {
    const bool conflict = call.pendant.options().version >= PolyscopeVersion{10, 14, 0, 0};
    return error_reply(conflict ? 409 : 400, "Program with this name already exists",
                       fmt::format("the name is '{}'", file->name));
  }
  if (call.pendant.programs().size() >= max_programs) {
    return error_reply(507, "Insufficient Storage", fmt::format("there are {} programs", max_programs));
  }
  call.pendant.store_program(file->name, std::move(file->program));
  return stored_reply(file->name, "Program uploaded");
}

Answer update_program(const Call & call)
{
  auto file = read_program_file(call.file);
  if (!file) {
    return invalid_file(file.error());
  }
  const StoredProgram * stored = call.pendant.find_program(file->name);
  if (stored == nullptr) {
    return missing_program(file->name);
  }
  if (stored == call.pendant.find_program(call.pendant.loaded_program()) && call.pendant.runner().running()) {
    return error_reply(409, "Program is loaded and active", fmt::format("stop '{}' first", file->name));
  }
  call.pendant.store_program(file->name, std::move(file->program));
  return stored_reply(file->name, "Program updated");
}

}  // namespace ur_simulator::robot_api
