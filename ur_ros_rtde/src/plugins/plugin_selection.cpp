#include "plugins/plugin_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace ur_ros_rtde {
namespace {
using ByName = std::map<std::string, PluginEntry>;

void report_unknown(const char * parameter, const std::vector<std::string> & names, const ByName & known,
                    const ReportProblem & report)
{
  std::vector<std::string> known_names;
  for (const auto & [name, entry] : known) {
    known_names.push_back(name);
  }
  for (const std::string & name : names) {
    if (!name.empty() && !known.contains(name)) {
      report(fmt::format("parameter {} names \"{}\", and there is no such plugin; there are: {}", parameter,
                         name, fmt::join(known_names, ", ")));
    }
  }
}

bool contains(const std::vector<std::string> & names, const std::string & name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
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
  report_unknown("plugins", chosen, known, report);
  report_unknown("plugins_blacklist", blacklist, known, report);

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
