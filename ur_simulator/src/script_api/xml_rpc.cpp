#include "script_api/xml_rpc.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>

#include "urscript/interpreter/containers.hpp"

namespace ur_simulator {

namespace {

using tinyxml2::XMLElement;
using urscript::List;
using urscript::Structure;
using urscript::Type;
using urscript::Value;

constexpr std::array<const char *, 6> pose_members{"x", "y", "z", "rx", "ry", "rz"};
constexpr int max_depth = 14;  // of values in each other

std::string escaped(std::string_view text)
{
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string encode(const Value & value);

std::string member(std::string_view name, const Value & value)
{
  return fmt::format("<member><name>{}</name>{}</member>", escaped(name), encode(value));
}

std::string array(const List & elements)
{
  std::string data;
  for (const Value & element : elements) {
    data += encode(element);
  }
  return fmt::format("<array><data>{}</data></array>", data);
}

std::string encode_matrix(const urscript::Matrix & matrix)
{
  List rows;
  for (std::size_t row = 0; row < matrix.rows; ++row) {
    List elements;
    for (std::size_t column = 0; column < matrix.columns; ++column) {
      elements.emplace_back(matrix.at(row, column));
    }
    rows.emplace_back(std::move(elements));
  }
  return array(rows);
}

std::string content(const Value & value)
{
  switch (value.type()) {
    case Type::boolean:
      return fmt::format("<boolean>{:d}</boolean>", value.boolean());
    case Type::integer:
      return fmt::format("<int>{}</int>", value.integer());
    case Type::floating:
      return fmt::format("<double>{}</double>", value.floating());
    case Type::pose: {
      std::string members;
      for (std::size_t i = 0; i < pose_members.size(); ++i) {
        members += member(pose_members[i], value.pose()[static_cast<Eigen::Index>(i)]);
      }
      return fmt::format("<struct>{}</struct>", members);
    }
    case Type::list:
      return array(value.list());
    case Type::matrix:
      return encode_matrix(value.matrix());
    case Type::structure: {
      std::string members;
      for (const auto & [name, element] : value.structure().members) {
        members += member(name, element);
      }
      return fmt::format("<struct>{}</struct>", members);
    }
    default:
      return fmt::format("<string>{}</string>", escaped(value.text()));
  }
}

std::string encode(const Value & value)
{
  return fmt::format("<value>{}</value>", content(value));
}

// ---- responses; std::runtime_error says what is wrong with one

template <typename Number>
Number parse_number(const std::string & text)
{
  const std::size_t begin = text.find_first_not_of(" \t\r\n+");
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  Number number{};
  if (begin == std::string::npos) {
    throw std::runtime_error("a number is empty");
  }
  const char * end = text.data() + last + 1;
  const auto [parsed, error] = std::from_chars(text.data() + begin, end, number);
  if (error != std::errc() || parsed != end) {
    throw std::runtime_error(fmt::format("'{}' is not a number of its type", text.substr(0, 40)));
  }
  return number;
}

Value string_value(const std::string & text)
{
  if (text.size() > urscript::string_limit) {
    throw std::runtime_error(fmt::format("a string is longer than {} bytes", urscript::string_limit));
  }
  return text;
}

const XMLElement & child(const XMLElement & parent, const char * name)
{
  const XMLElement * found = parent.FirstChildElement(name);
  if (found == nullptr) {
    throw std::runtime_error(fmt::format("<{}> has no <{}>", std::string(parent.Name()).substr(0, 40), name));
  }
  return *found;
}

std::string text(const XMLElement & element)
{
  const char * content = element.GetText();
  return content == nullptr ? "" : content;
}

Value decode(const XMLElement & value, int depth);

Value decode_array(const XMLElement & array, int depth)
{
  List elements;
  for (const auto * value = child(array, "data").FirstChildElement("value"); value != nullptr;
       value = value->NextSiblingElement("value")) {
    elements.push_back(decode(*value, depth + 1));
  }
  auto list = urscript::make_list(elements);  // a matrix if it is one
  return list ? std::move(*list) : throw std::runtime_error(list.error());
}

/// Nothing if the structure is none.
std::optional<Vector6> as_pose(const Structure & structure)
{
  Vector6 pose;
  for (std::size_t i = 0; i < pose_members.size(); ++i) {
    const Value * found = structure.find(pose_members[i]);
    if (found == nullptr || !found->is_number() || structure.members.size() != pose_members.size()) {
      return std::nullopt;
    }
    pose[static_cast<Eigen::Index>(i)] = *found->number();
  }
  return pose;
}

Value decode_structure(const XMLElement & structure, int depth)
{
  Structure result;
  for (const auto * member = structure.FirstChildElement("member"); member != nullptr;
       member = member->NextSiblingElement("member")) {
    result.members.emplace_back(text(child(*member, "name")), decode(child(*member, "value"), depth + 1));
  }
  const auto pose = as_pose(result);
  return pose ? Value::pose(*pose) : Value(std::move(result));
}

Value decode_typed(const XMLElement & value, int depth)
{
  const std::string type = value.Name();
  if (type == "array") {
    return decode_array(value, depth);
  }
  if (type == "struct") {
    return decode_structure(value, depth);
  }
  if (type == "boolean") {
    return parse_number<int>(text(value)) != 0;
  }
  if (type == "int" || type == "i4") {
    return parse_number<std::int32_t>(text(value));
  }
  if (type == "double") {
    return parse_number<double>(text(value));
  }
  if (type == "string") {
    return string_value(text(value));
  }
  throw std::runtime_error(fmt::format("URScript has no type for '{}'", type.substr(0, 40)));
}

Value decode(const XMLElement & value, int depth)
{
  if (depth > max_depth) {
    throw std::runtime_error(fmt::format("values are nested deeper than {} levels", max_depth));
  }
  const XMLElement * typed = value.FirstChildElement();
  return typed == nullptr ? string_value(text(value))  // a value without a type is a string
                          : decode_typed(*typed, depth);
}

Value parse_response(std::string_view body)
{
  tinyxml2::XMLDocument document;  // limits the depth of tags
  if (document.Parse(body.data(), body.size()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(fmt::format("{} in line {}", document.ErrorName(), document.ErrorLineNum()));
  }
  const XMLElement * response = document.FirstChildElement("methodResponse");
  if (response == nullptr) {
    throw std::runtime_error("it has no <methodResponse>");
  }
  if (const XMLElement * fault = response->FirstChildElement("fault")) {
    const Value value = decode(child(*fault, "value"), 0);
    const Value * reason = value.is(Type::structure) ? value.structure().find("faultString") : nullptr;
    throw std::runtime_error("fault: " + (reason == nullptr ? value : *reason).text());
  }
  const XMLElement * parameters = response->FirstChildElement("params");
  const XMLElement * parameter = parameters == nullptr ? nullptr : parameters->FirstChildElement("param");
  return parameter == nullptr ? Value() : decode(child(*parameter, "value"), 0);
}

}  // namespace

std::string xml_rpc_request(std::string_view method, urscript::Arguments arguments)
{
  std::string parameters;
  for (const Value & argument : arguments) {
    parameters += fmt::format("<param>{}</param>", encode(argument));
  }
  return fmt::format(
      "<?xml version=\"1.0\"?><methodCall><methodName>{}</methodName><params>{}</params></methodCall>",
      escaped(method), parameters);
}

tl::expected<Value, std::string> parse_xml_rpc_response(std::string_view body)
{
  try {
    return parse_response(body);
  } catch (const std::exception & error) {
    return tl::unexpected(fmt::format("XML-RPC response: {}", error.what()));
  }
}

}  // namespace ur_simulator
