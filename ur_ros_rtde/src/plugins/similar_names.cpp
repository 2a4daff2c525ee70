#include "plugins/similar_names.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace ur_ros_rtde {
namespace {

/// Levenshtein distance. `row[i]` is the distance of the first i characters of `a` to the beginning of `b`.
std::size_t distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(a.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char c : b) {
    std::size_t diagonal = row[0]++;
    for (std::size_t i = 1; i < row.size(); ++i) {
      const std::size_t replaced = diagonal + (a[i - 1] == c ? 0 : 1);
      diagonal = std::exchange(row[i], std::min({row[i] + 1, row[i - 1] + 1, replaced}));
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> most_similar(std::string_view name, const std::vector<std::string> & names)
{
  const auto best = std::min_element(names.begin(), names.end(), [name](const auto & a, const auto & b) {
    return distance(name, a) < distance(name, b);
  });
  const bool found =
      best != names.end() && distance(name, *best) <= std::max<std::size_t>(1, best->size() / 5);
  return found ? std::optional(*best) : std::nullopt;
}

}  // namespace ur_ros_rtde
