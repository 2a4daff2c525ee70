#include "script_api/xml_rpc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/property_tree/xml_parser.hpp>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "urscript/interpreter/containers.hpp"

namespace ur_simulator {

namespace {

using boost::property_tree::ptree;
using urscript::List;
using urscript::Structure;
using urscript::Type;
using urscript::Value;

constexpr std::array<const char *, 6> pose_members{"x", "y", "z", "rx", "ry", "rz"};
constexpr int max_depth = 14;  // of values in each other
constexpr int max_tags = 100;  // in each other

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

Value decode(const ptree & value, int depth);

Value decode_array(const ptree & array, int depth)
{
  List elements;
  for (const auto & [name, element] : array.get_child("data")) {
    if (name == "value") {
      elements.push_back(decode(element, depth + 1));
    }
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

Value decode_structure(const ptree & structure, int depth)
{
  Structure result;
  for (const auto & [name, element] : structure) {
    if (name == "member") {
      result.members.emplace_back(element.get<std::string>("name"),
                                  decode(element.get_child("value"), depth + 1));
    }
  }
  const auto pose = as_pose(result);
  return pose ? Value::pose(*pose) : Value(std::move(result));
}

Value decode_typed(const std::string & type, const ptree & value, int depth)
{
  if (type == "array") {
    return decode_array(value, depth);
  }
  if (type == "struct") {
    return decode_structure(value, depth);
  }
  const std::string & text = value.data();
  if (type == "boolean") {
    return parse_number<int>(text) != 0;
  }
  if (type == "int" || type == "i4") {
    return parse_number<std::int32_t>(text);
  }
  if (type == "double") {
    return parse_number<double>(text);
  }
  if (type == "string") {
    return string_value(text);
  }
  throw std::runtime_error(fmt::format("URScript has no type for '{}'", type.substr(0, 40)));
}

Value decode(const ptree & value, int depth)
{
  if (depth > max_depth) {
    throw std::runtime_error(fmt::format("values are nested deeper than {} levels", max_depth));
  }
  return value.empty() ? string_value(value.data())  // a value without a type is a string
                       : decode_typed(value.front().first, value.front().second, depth);
}

/// Whether more than `limit` tags are open at a time. Comments may count as tags.
bool nested_deeper(std::string_view document, int limit)
{
  int depth = 0;
  while (!document.empty()) {
    const std::string_view part = document.substr(0, document.find('<', 1));  // begins with a tag
    document.remove_prefix(part.size());
    const bool opens = part.starts_with('<') && !part.starts_with("<?") && part.find("/>") == part.npos;
    depth = part.starts_with("</") ? std::max(0, depth - 1) : depth + (opens ? 1 : 0);
    if (depth > limit) {
      return true;
    }
  }
  return false;
}

Value parse_response(const std::string & body)
{
  if (nested_deeper(body, max_tags)) {  // the parser of the library recurses
    throw std::runtime_error(fmt::format("it is nested deeper than {} tags", max_tags));
  }
  std::istringstream stream(body);
  ptree document;
  boost::property_tree::read_xml(stream, document, boost::property_tree::xml_parser::no_comments);
  const ptree & response = document.get_child("methodResponse");
  if (const auto fault = response.get_child_optional("fault.value")) {
    const Value value = decode(*fault, 0);
    const Value * text = value.is(Type::structure) ? value.structure().find("faultString") : nullptr;
    throw std::runtime_error("fault: " + (text == nullptr ? value : *text).text());
  }
  const auto value = response.get_child_optional("params.param.value");
  return value ? decode(*value, 0) : Value();
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
    return parse_response(std::string(body));
  } catch (const std::exception & error) {
    return tl::unexpected(fmt::format("XML-RPC response: {}", error.what()));
  }
}

}  // namespace ur_simulator
