#include "plugins/plugin_index.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <filesystem>
#include <fstream>

#include "plugins/ament_index.hpp"

namespace ur_ros_rtde {
namespace {
namespace fs = std::filesystem;

/// Resource type of pluginlib_export_plugin_description_file(ur_ros_rtde plugins.xml).
constexpr const char * resource_type = "ur_ros_rtde__pluginlib__plugin";

std::string attribute(const tinyxml2::XMLElement & element, const char * name)
{
  const char * value = element.Attribute(name);
  return value != nullptr ? value : "";
}

/// Searches for the library as pluginlib does: <library path="name"/> without prefix and suffix.
std::string library_file(const std::string & path, const std::string & package, const std::string & prefix)
{
  const fs::path given(path);
  const fs::path as_library = given.parent_path() / ("lib" + given.filename().string() + ".so");
  for (const fs::path & folder :
       {fs::path(prefix) / "lib", fs::path(prefix) / "lib" / package, fs::path(prefix)}) {
    for (const fs::path & file : {as_library, given}) {
      std::error_code ignored;
      if (fs::is_regular_file(folder / file, ignored)) {
        return (folder / file).string();
      }
    }
  }
  return (fs::path(prefix) / "lib" / as_library).string();
}

std::vector<PluginEntry> read_library(const tinyxml2::XMLElement & library, const std::string & file,
                                      const std::string & package, const std::string & prefix,
                                      const ReportProblem & report)
{
  std::vector<PluginEntry> entries;
  const std::string path = attribute(library, "path");
  if (path.empty()) {
    report(fmt::format("{}:{}: <library> has no path, its plugins are left out", file, library.GetLineNum()));
    return entries;
  }
  for (const auto * element = library.FirstChildElement("class"); element != nullptr;
       element = element->NextSiblingElement("class")) {
    PluginEntry entry{attribute(*element, "name"),
                      attribute(*element, "type"),
                      attribute(*element, "base_class_type"),
                      "",
                      package,
                      library_file(path, package, prefix)};
    if (entry.name.empty() || entry.type.empty()) {
      report(fmt::format("{}:{}: a <class> needs name and type, this one is left out", file,
                         element->GetLineNum()));
      continue;
    }
    if (entry.base != command_base && entry.base != dashboard_base) {
      report(
          fmt::format("{}:{}: plugin {} has the base_class_type \"{}\", which is neither {} nor {}: left out",
                      file, element->GetLineNum(), entry.name, entry.base, command_base, dashboard_base));
      continue;
    }
    const auto * description = element->FirstChildElement("description");
    if (description != nullptr && description->GetText() != nullptr) {
      entry.description = description->GetText();
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}
}  // namespace

std::vector<PluginEntry> read_plugins_file(const std::string & file, const std::string & package,
                                           const std::string & prefix, const ReportProblem & report)
{
  std::vector<PluginEntry> entries;
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    report(fmt::format("{} (package {}) cannot be read: {}", file, package, document.ErrorStr()));
    return entries;
  }
  const tinyxml2::XMLElement * root = document.RootElement();
  if (root == nullptr) {
    report(fmt::format("{} (package {}) has no element: it has to begin with <library> or <class_libraries>",
                       file, package));
    return entries;
  }
  const std::string root_name = root->Name();
  if (root_name != "library" && root_name != "class_libraries") {
    report(fmt::format("{}:{}: begins with <{}>, it has to begin with <library> or <class_libraries>", file,
                       root->GetLineNum(), root_name));
    return entries;
  }
  const auto * first = root_name == "library" ? root : root->FirstChildElement("library");
  for (const auto * library = first; library != nullptr; library = library->NextSiblingElement("library")) {
    for (PluginEntry & entry : read_library(*library, file, package, prefix, report)) {
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

std::vector<PluginEntry> find_plugins(const ReportProblem & report)
{
  std::vector<PluginEntry> all;
  for (const auto & [package, prefix] : ament_index::resources(resource_type)) {
    std::ifstream lines(prefix / "share/ament_index/resource_index" / resource_type / package);
    if (!lines) {
      report(fmt::format("the ament index of package {} in {} cannot be read", package, prefix.string()));
      continue;
    }
    for (std::string line; std::getline(lines, line);) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) {
        continue;
      }
      const std::string file = (prefix / line).string();
      for (PluginEntry & entry : read_plugins_file(file, package, prefix.string(), report)) {
        all.push_back(std::move(entry));
      }
    }
  }
  return all;
}

}  // namespace ur_ros_rtde
