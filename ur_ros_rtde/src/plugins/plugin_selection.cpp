#include "plugins/plugin_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace ur_ros_rtde {
namespace {
using ByName = std::map<std::string, PluginEntry>;

/// Levenshtein distance.
std::size_t edit_distance(const std::string & a, const std::string & b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// `known` is not empty.
std::string nearest(const std::string & name, const std::set<std::string> & known)
{
  return *std::min_element(known.begin(), known.end(), [&name](const auto & a, const auto & b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
}

/// Reports names that no plugin has. Names of the other server's plugins are valid, because both servers may
/// have the same parameters.
void report_unknown(const char * parameter, const std::vector<std::string> & names,
                    const std::vector<PluginEntry> & all, const ReportProblem & report)
{
  std::set<std::string> known;
  for (const PluginEntry & entry : all) {
    known.insert(entry.name);
  }
  for (const std::string & name : names) {
    if (!name.empty() && !known.contains(name)) {
      report(fmt::format("parameter {} names \"{}\", but no installed plugin has that name{}", parameter,
                         name,
                         known.empty() ? "" : fmt::format("; the nearest is \"{}\"", nearest(name, known))));
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
  report_unknown("plugins", chosen, all, report);
  report_unknown("plugins_blacklist", blacklist, all, report);

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
