#include "robot_api/request_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "robot_api/multipart.hpp"

namespace ur_simulator::robot_api {
namespace {

using nlohmann::json;

/// Replaces "%20" and the like. Invalid escapes stay as they are.
std::string decode_percent(std::string_view text)
{
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char * const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      decoded += static_cast<char>(code);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

/// The part of a path that the route's parameter stands for, or nullopt if the path is not that of the route.
std::optional<std::string_view> match(const Route & route, std::string_view path)
{
  if (path_parameter(route.path).empty()) {
    return path == route.path ? std::optional(std::string_view()) : std::nullopt;
  }
  const std::string_view parent = route.path.substr(0, route.path.find('{'));
  if (!path.starts_with(parent)) {
    return std::nullopt;
  }
  const std::string_view parameter = path.substr(parent.size());
  const bool one_part = !parameter.empty() && parameter.find('/') == std::string_view::npos;
  return one_part ? std::optional(parameter) : std::nullopt;
}

std::vector<const Route *> routes_of(std::string_view path, const PolyscopeVersion & version)
{
  std::vector<const Route *> found;
  for (const Route & route : routes()) {
    if (version >= route.since && match(route, path)) {
      found.push_back(&route);
    }
  }
  return found;
}

/// The same path with or without the slash at its end.
std::string toggle_slash(std::string_view path)
{
  return path.ends_with('/') ? std::string(path.substr(0, path.size() - 1)) : std::string(path) + "/";
}

/// The reply for a path that is none of the API.
Reply unknown_path(std::string_view path, const PolyscopeVersion & version)
{
  const std::string other = toggle_slash(path);
  Reply reply = json_reply(404, {{"detail", "Not Found"}});
  if (!routes_of(other, version).empty()) {
    reply = {.status = 307};
    reply.headers.emplace_back("Location", std::string(base_path) + other);
  }
  return reply;
}

Reply unknown_method(const std::vector<const Route *> & same_path)
{
  Reply reply = json_reply(405, {{"detail", "Method Not Allowed"}});
  std::string allowed;
  for (const Route * route : same_path) {
    allowed += (allowed.empty() ? "" : ", ") + std::string(route->method);
  }
  reply.headers.emplace_back("Allow", std::move(allowed));
  return reply;
}

/// The error in a field of the body, or nullopt.
std::optional<Reply> check_field(const json & body, const Field & field)
{
  const std::string name(field.name);
  if (!body.contains(name)) {
    return field.required ? std::optional(validation_error({"body", name}, "Field required")) : std::nullopt;
  }
  if (!body.at(name).is_string()) {
    return validation_error({"body", name}, "Input should be a valid string");
  }
  const auto choices = split_choices(field.choices);
  if (!choices.empty() && std::ranges::find(choices, body.at(name).get<std::string>()) == choices.end()) {
    return validation_error({"body", name}, fmt::format("Input should be {}", fmt::join(choices, " or ")));
  }
  return std::nullopt;
}

/// Reads the body into the call. Returns the reply if it is invalid.
std::optional<Reply> read_body(const Route & route, const HttpRequest & request, Call & call)
{
  if (route.body_type == BodyType::file) {
    auto file = form_field(request.content_type, request.body, file_field);
    if (!file) {
      return validation_error({"body", std::string(file_field)}, "Field required");
    }
    call.file = std::move(*file);
    return std::nullopt;
  }
  if (route.body_type == BodyType::none) {
    return std::nullopt;
  }
  call.body = json::parse(request.body, nullptr, false);
  if (call.body.is_discarded()) {
    return validation_error({"body"}, "JSON decode error");
  }
  if (!call.body.is_object()) {
    return validation_error({"body"}, "Input should be a valid dictionary or object");
  }
  for (const Field & field : route.fields) {
    if (!field.name.empty()) {
      if (auto error = check_field(call.body, field)) {
        return error;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string_view> split_choices(std::string_view choices)
{
  std::vector<std::string_view> parts;
  while (!choices.empty()) {
    parts.push_back(choices.substr(0, choices.find('|')));
    choices.remove_prefix(std::min(choices.size(), parts.back().size() + 1));
  }
  return parts;
}

std::string_view path_parameter(std::string_view path)
{
  const std::size_t begin = path.find('{');
  return begin == std::string_view::npos ? std::string_view()
                                         : path.substr(begin + 1, path.size() - begin - 2);
}

Answer execute_request(const HttpRequest & request, Pendant & pendant)
{
  const PolyscopeVersion & version = pendant.options().version;
  std::string_view path = std::string_view(request.target).substr(0, request.target.find_first_of("?#"));
  if (!path.starts_with(base_path)) {
    return json_reply(404, {{"detail", "Not Found"}});
  }
  path.remove_prefix(base_path.size());
  const auto same_path = routes_of(path, version);
  if (same_path.empty()) {
    return unknown_path(path, version);
  }
  const auto found = std::ranges::find(same_path, request.method, &Route::method);
  if (found == same_path.end()) {
    return unknown_method(same_path);
  }
  const Route & route = **found;
  Call call{pendant, decode_percent(*match(route, path)), {}, {}};
  if (auto error = read_body(route, request, call)) {
    return *std::move(error);
  }
  if (route.requires_remote_control && !pendant.remote_control()) {
    return error_reply(403, "Forbidden",
                       "Not authorized to perform this operation under the current robot control mode.");
  }
  return route.handle(call);
}

}  // namespace ur_simulator::robot_api
