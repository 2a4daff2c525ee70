#include "robot_api/openapi.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "robot_api/request_check.hpp"
#include "robot_api/routes.hpp"

namespace ur_simulator::robot_api {
namespace {

using nlohmann::json;

std::string lower(std::string_view text)
{
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

json field_schema(const Field & field)
{
  json schema{{"type", "string"}};
  if (!field.choices.empty()) {
    schema["enum"] = split_choices(field.choices);
  }
  return schema;
}

json body_description(const Route & route)
{
  json properties = json::object();
  json required = json::array();
  for (const Field & field : route.fields) {
    if (!field.name.empty()) {
      properties[std::string(field.name)] = field_schema(field);
      if (field.required) {
        required.push_back(field.name);
      }
    }
  }
  const bool file = route.body_type == BodyType::file;
  if (file) {
    properties[std::string(file_field)] = {{"type", "string"}, {"format", "binary"}};
    required.push_back(file_field);
  }
  const json schema{
      {"type", "object"}, {"properties", std::move(properties)}, {"required", std::move(required)}};
  const char * const type = file ? "multipart/form-data" : "application/json";
  return {{"required", true}, {"content", {{type, {{"schema", schema}}}}}};
}

json operation(const Route & route)
{
  json description{{"responses", {{"200", {{"description", "Successful Response"}}}}}};
  if (route.requires_remote_control) {
    description["responses"]["403"] = {{"description", "The robot is not in remote control"}};
  }
  if (route.body_type != BodyType::none) {
    description["requestBody"] = body_description(route);
    description["responses"]["422"] = {{"description", "Validation Error"}};
  }
  if (const std::string_view parameter = path_parameter(route.path); !parameter.empty()) {
    description["parameters"] = json::array(
        {{{"name", parameter}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}}});
  }
  return description;
}

}  // namespace

json openapi_document(const PolyscopeVersion & version)
{
  json paths = json::object();
  for (const Route & route : routes()) {
    if (version >= route.since && route.path != "/openapi.json") {
      paths[std::string(route.path)][lower(route.method)] = operation(route);
    }
  }
  return {{"openapi", "3.1.0"},
          {"info", {{"title", "Robot API"}, {"version", api_version(version)}}},
          {"servers", json::array({{{"url", base_path}}})},
          {"paths", std::move(paths)}};
}

}  // namespace ur_simulator::robot_api
