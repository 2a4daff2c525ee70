#include "robot_api/program_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace ur_simulator::robot_api {
namespace {

using nlohmann::json;

/// The text at the path, or "".
std::string text_at(const json & document, const json::json_pointer & path)
{
  return document.contains(path) && document.at(path).is_string() ? document.at(path).get<std::string>() : "";
}

std::int64_t date_at(const json & document, const json::json_pointer & path)
{
  const bool present = document.contains(path) && document.at(path).is_number_integer();
  return present ? document.at(path).get<std::int64_t>() : 0;
}

/// A name that URScript accepts.
std::string identifier(std::string name)
{
  std::ranges::replace_if(name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return "program_" + name;
}

}  // namespace

tl::expected<NamedProgram, std::string> read_program_file(std::string_view document)
{
  const json file = json::parse(document, nullptr, false);
  const json::json_pointer information("/program/programInformation");
  const json::json_pointer script("/program/urscript/script");
  if (file.is_discarded()) {
    return tl::make_unexpected("it is not JSON");
  }
  for (const json::json_pointer & path : {information / "name", script}) {
    if (!file.contains(path) || !file.at(path).is_string()) {
      return tl::make_unexpected(fmt::format("it has no text at {}", path.to_string()));
    }
  }
  NamedProgram result;
  result.name = text_at(file, information / "name");
  StoredProgram & program = result.program;
  program.document = document;
  program.description = text_at(file, information / "description");
  program.created = date_at(file, information / "createdDate");
  program.saved = date_at(file, information / "lastSavedDate");
  program.script =
      fmt::format("def {}():\n{}\n{}\nend\n", identifier(result.name),
                  text_at(file, json::json_pointer("/application/urscript/script")), text_at(file, script));
  return result;
}

std::string program_document(const std::string & name, const StoredProgram & program)
{
  if (!program.document.empty()) {
    return program.document;
  }
  const json information{{"name", name},
                         {"description", program.description},
                         {"createdDate", program.created},
                         {"lastSavedDate", program.saved},
                         {"lastModifiedDate", nullptr},
                         {"programState", "FINAL"}};
  const json document{
      {"program", {{"programInformation", information}, {"urscript", {{"script", program.script}}}}}};
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace ur_simulator::robot_api
