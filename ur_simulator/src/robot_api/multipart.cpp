#include "robot_api/multipart.hpp"

#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>

namespace ur_simulator::robot_api {
namespace {

namespace beast = boost::beast;

constexpr std::string_view line_end = "\r\n";

beast::string_view to_beast(std::string_view text)
{
  return {text.data(), text.size()};
}

std::string to_string(beast::string_view text)
{
  return {text.data(), text.size()};
}

std::string unquoted(std::string value)
{
  const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
  return quoted ? value.substr(1, value.size() - 2) : value;
}

/// The parameter of a header value such as `form-data; name="file"`.
std::optional<std::string> header_parameter(std::string_view value, std::string_view name)
{
  const std::size_t parameters = value.find(';');
  if (parameters == std::string_view::npos) {
    return std::nullopt;
  }
  for (const auto & [key, text] : beast::http::param_list(to_beast(value.substr(parameters)))) {
    if (beast::iequals(key, to_beast(name))) {
      return unquoted(to_string(text));
    }
  }
  return std::nullopt;
}

/// The field name of a part, from its Content-Disposition header.
std::optional<std::string> field_name(std::string_view headers)
{
  constexpr std::string_view disposition = "Content-Disposition:";
  while (!headers.empty()) {
    const std::string_view line = headers.substr(0, headers.find(line_end));
    headers.remove_prefix(std::min(headers.size(), line.size() + line_end.size()));
    if (beast::iequals(to_beast(line.substr(0, disposition.size())), to_beast(disposition))) {
      return header_parameter(line.substr(disposition.size()), "name");
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> form_field(std::string_view content_type, std::string_view body,
                                      std::string_view name)
{
  constexpr std::string_view form_type = "multipart/form-data";
  const auto boundary = header_parameter(content_type, "boundary");
  if (!beast::iequals(to_beast(content_type.substr(0, form_type.size())), to_beast(form_type)) || !boundary) {
    return std::nullopt;
  }
  const std::string delimiter = "--" + *boundary;
  if (!body.starts_with(delimiter)) {
    return std::nullopt;  // a preamble is allowed, but no client sends one
  }
  body.remove_prefix(delimiter.size());
  const std::string separator = std::string(line_end) + delimiter;
  while (body.starts_with(line_end)) {
    body.remove_prefix(line_end.size());
    const std::size_t end = body.find(separator);
    const std::string_view part = body.substr(0, end);
    const std::size_t header_end = part.find("\r\n\r\n");
    if (end == std::string_view::npos || header_end == std::string_view::npos) {
      return std::nullopt;
    }
    if (field_name(part.substr(0, header_end)) == name) {
      return std::string(part.substr(header_end + 4));
    }
    body.remove_prefix(end + separator.size());
  }
  return std::nullopt;
}

}  // namespace ur_simulator::robot_api
