#include "world_file/yaml_json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace ur_simulator {
namespace {

using nlohmann::json;

constexpr int max_nesting = 16;
constexpr int max_nodes = 100000;

/// The number that the whole text is.
template <typename Number>
std::optional<Number> parse_number(std::string_view text)
{
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return number;
}

/// The text of a scalar. JSON, in which it is reported, consists of UTF-8.
const std::string & text_of(const YAML::Node & node)
{
  try {
    (void)json(node.Scalar()).dump();
  } catch (const json::type_error &) {
    throw YamlError(line_of(node), "the text is not UTF-8: save the file with this encoding");
  }
  return node.Scalar();
}

json scalar_to_json(const YAML::Node & node)
{
  const std::string & text = text_of(node);
  if (node.Tag() == "!") {  // quoted
    return text;
  }
  if (text == "true" || text == "True" || text == "TRUE") {
    return true;
  }
  if (text == "false" || text == "False" || text == "FALSE") {
    return false;
  }
  if (const auto integer = parse_number<std::int64_t>(text)) {
    return *integer;
  }
  // from_chars accepts "inf" and "nan", which are strings in YAML.
  const bool digits = text.find_first_of("0123456789") != std::string::npos;
  if (const auto number = digits ? parse_number<double>(text) : std::nullopt) {
    return *number;
  }
  return text;
}

class Converter {
 public:
  json convert(const YAML::Node & node, int depth)
  {
    if (depth > max_nesting) {
      throw YamlError(line_of(node), fmt::format("the file is nested more than {} levels deep", max_nesting));
    }
    if (++nodes_ > max_nodes) {
      throw YamlError(line_of(node), fmt::format("the file has more than {} values", max_nodes));
    }
    switch (node.Type()) {
      case YAML::NodeType::Scalar:
        return scalar_to_json(node);
      case YAML::NodeType::Sequence:
        return convert_sequence(node, depth);
      case YAML::NodeType::Map:
        return convert_map(node, depth);
      default:
        return nullptr;
    }
  }

 private:
  json convert_sequence(const YAML::Node & node, int depth)
  {
    json result = json::array();
    for (const YAML::Node & element : node) {
      result.push_back(convert(element, depth + 1));
    }
    return result;
  }

  json convert_map(const YAML::Node & node, int depth)
  {
    json result = json::object();
    for (const auto & field : node) {
      const YAML::Node & key = field.first;
      if (!key.IsScalar()) {
        throw YamlError(line_of(key), "a name of a field is missing: give name: value");
      }
      const std::string & name = text_of(key);
      if (result.contains(name)) {
        throw YamlError(line_of(key), fmt::format("field '{}' is given twice: remove one of them", name));
      }
      result[name] = convert(field.second, depth + 1);
    }
    return result;
  }

  int nodes_ = 0;
};

}  // namespace

int line_of(const YAML::Node & node)
{
  return node.Mark().line + 1;
}

int line_of(const YAML::Node & map, const std::string & field)
{
  if (map.IsMap()) {
    for (const auto & entry : map) {
      if (entry.first.IsScalar() && entry.first.Scalar() == field) {
        return line_of(entry.first);
      }
    }
  }
  return line_of(map);
}

json to_json(const YAML::Node & node)
{
  return Converter().convert(node, 0);
}

}  // namespace ur_simulator
