#pragma once

#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace ur_simulator {

/// Content of a YAML file that cannot be used, with its line.
class YamlError : public std::runtime_error {
 public:
  YamlError(int line, const std::string & text) : std::runtime_error(text), line_(line) {}
  /// 1-based.
  int line() const { return line_; }

 private:
  int line_;
};

/// Line of a node in its file, 1-based.
int line_of(const YAML::Node & node);
/// The line of a field of a map; that of the map if it has no such field.
int line_of(const YAML::Node & map, const std::string & field);

/// Converts a node. Plain scalars have the types of YAML's core schema: null, true and false, integers,
/// numbers; all others and quoted scalars are strings. Throws YamlError for keys that are no strings or occur
/// twice, and if the content is nested too deeply or, because of aliases, too large.
nlohmann::json to_json(const YAML::Node & node);

}  // namespace ur_simulator
