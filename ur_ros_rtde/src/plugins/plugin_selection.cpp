#include "plugins/plugin_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <rcl_cxx/error.hpp>

#include "plugins/similar_names.hpp"

namespace ur_ros_rtde {
namespace {
using ByName = std::map<std::string, PluginEntry>;

bool contains(const std::vector<std::string> & names, const std::string & name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// One text per name that no plugin has. Names of the other server's plugins are valid, because both servers
/// may have the same parameters.
std::vector<std::string> unknown(const char * parameter, const std::vector<std::string> & names,
                                 const std::vector<PluginEntry> & all)
{
  std::vector<std::string> known;
  for (const PluginEntry & entry : all) {
    known.push_back(entry.name);
  }
  std::vector<std::string> texts;
  for (const std::string & name : names) {
    if (!name.empty() && !contains(known, name)) {
      const auto similar = most_similar(name, known);
      texts.push_back(fmt::format("parameter {} names \"{}\", but no installed plugin has that name{}",
                                  parameter, name,
                                  similar ? fmt::format("; did you mean \"{}\"?", *similar) : ""));
    }
  }
  return texts;
}
}  // namespace

std::vector<PluginEntry> select_plugins(const std::vector<PluginEntry> & all, const std::string & base,
                                        const std::vector<std::string> & chosen,
                                        const std::vector<std::string> & blacklist,
                                        const ReportProblem & report)
{
  ByName known;
  for (const PluginEntry & entry : all) {
    if (entry.base != base) {
      continue;
    }
    const auto [first, added] = known.try_emplace(entry.name, entry);
    if (!added) {
      report(fmt::format(
          "plugin {} of package {} ({}) is left out: package {} has one of that name already ({})",
          entry.name, entry.package, entry.library, first->second.package, first->second.library));
    }
  }
  for (const std::string & text : unknown("plugins_blacklist", blacklist, all)) {
    report(text);
  }
  if (const auto wrong = unknown("plugins", chosen, all); !wrong.empty()) {
    throw rcl_cxx::ParameterError("plugins",
                                  fmt::format("{}; `ur plugins` lists all", fmt::join(wrong, "; ")));
  }

  const bool choose =
      std::any_of(chosen.begin(), chosen.end(), [](const auto & name) { return !name.empty(); });
  std::vector<PluginEntry> selected;
  for (const auto & [name, entry] : known) {
    if ((!choose || contains(chosen, name)) && !contains(blacklist, name)) {
      selected.push_back(entry);
    }
  }
  return selected;
}

}  // namespace ur_ros_rtde
