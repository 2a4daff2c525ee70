#include "world_file/world_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "world_file/yaml_json.hpp"

namespace ur_simulator {
namespace {

using nlohmann::json;

constexpr std::size_t max_file_size = 1024 * 1024;
constexpr double max_time = 1e7;  // s

/// A section with objects, and the command of the control port that places one of them.
struct Section {
  std::string_view name;
  std::string_view command;
  bool list;  ///< of objects; otherwise one object
};

constexpr std::array sections{Section{"surfaces", "place_surface", true}, Section{"boxes", "place_box", true},
                              Section{"springs", "attach_spring", true},
                              Section{"load", "attach_load", false}};

std::string read_file(const std::string & path)
{
  std::ifstream file(path, std::ios::binary);
  std::string text(max_file_size + 1, '\0');
  if (file) {
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
  }
  if (!file.is_open() || file.bad()) {
    throw std::runtime_error(
        fmt::format("world file '{}' (--world) cannot be read: {}", path, std::strerror(errno)));
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > max_file_size) {
    throw std::runtime_error(
        fmt::format("world file '{}' (--world) has more than {} bytes, the limit", path, max_file_size));
  }
  return text;
}

/// Calls the function. Adds the line of the field to its error.
template <typename Function>
auto located(const YAML::Node & node, Function && function)
{
  try {
    return function();
  } catch (const control_port::RequestError & error) {
    throw YamlError(line_of(node, error.field()), error.what());
  }
}

class WorldFileReader {
 public:
  explicit WorldFileReader(const std::string & path) : path_(path) {}

  WorldFile read(const YAML::Node & root)
  {
    if (root.IsNull()) {
      return {};
    }
    if (!root.IsMap()) {
      throw YamlError(line_of(root), "the file must consist of sections, such as surfaces: or events:");
    }
    WorldFile result;
    for (const auto & section : root) {
      read_section(section.first, section.second, result);
    }
    std::ranges::stable_sort(result.events, {}, &WorldFileCommand::time);
    return result;
  }

 private:
  void read_section(const YAML::Node & name, const YAML::Node & content, WorldFile & result)
  {
    const std::string text = name.IsScalar() ? name.Scalar() : "";
    if (!read_sections_.insert(text).second) {
      throw YamlError(line_of(name), fmt::format("section '{}' is given twice: combine them", text));
    }
    if (text == "events") {
      for_each_element(name, content,
                       [&](const YAML::Node & node) { result.events.push_back(read_event(node)); });
      return;
    }
    const auto section = std::ranges::find(sections, text, &Section::name);
    if (section == sections.end()) {
      throw YamlError(line_of(name),
                      fmt::format("section '{}' is not known: it must be one of surfaces, boxes, "
                                  "springs, load, events",
                                  text));
    }
    const auto add = [&](const YAML::Node & node) {
      json request = object_of(node);
      if (request.contains("command")) {
        throw YamlError(line_of(node, "command"),
                        fmt::format("field 'command' is not known in section '{}'", text));
      }
      request["command"] = section->command;
      result.objects.push_back(prepare(node, 0.0, request));
    };
    section->list ? for_each_element(name, content, add) : add(content);
  }

  template <typename Function>
  static void for_each_element(const YAML::Node & name, const YAML::Node & content, Function && function)
  {
    if (content.IsNull()) {
      return;
    }
    if (!content.IsSequence()) {
      throw YamlError(line_of(name),
                      fmt::format("section '{}' must be a list: begin each entry with '- '", name.Scalar()));
    }
    for (const YAML::Node & element : content) {
      function(element);
    }
  }

  WorldFileCommand read_event(const YAML::Node & node)
  {
    json request = object_of(node);
    const double time =
        located(node, [&] { return control_port::RequestFields(request).number("at", {0.0, max_time}); });
    request.erase("at");
    return prepare(node, time, request);
  }

  static json object_of(const YAML::Node & node)
  {
    json result = to_json(node);
    if (!result.is_object()) {
      throw YamlError(line_of(node),
                      fmt::format("the entry is {}: it must consist of fields, name: value", result.dump()));
    }
    return result;
  }

  WorldFileCommand prepare(const YAML::Node & node, double time, const json & request)
  {
    auto action = located(node, [&] { return control_port::prepare_request(request); });
    const std::string origin =
        fmt::format("{}:{}: {}", path_, line_of(node), request.at("command").get<std::string>());
    return {time, origin, std::move(action)};
  }

  std::string path_;
  std::set<std::string> read_sections_;
};

}  // namespace

WorldFile read_world_file(const std::string & path)
{
  return parse_world_file(read_file(path), path);
}

WorldFile parse_world_file(const std::string & text, const std::string & path)
{
  try {
    return WorldFileReader(path).read(YAML::Load(text));
  } catch (const YamlError & error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", path, error.line(), error.what()));
  } catch (const YAML::Exception & error) {
    throw std::runtime_error(fmt::format("{}:{}: no valid YAML: {}", path, error.mark.line + 1, error.msg));
  }
}

}  // namespace ur_simulator
