#include "diagnostics/plugin_problems.hpp"

#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace ur_ros_rtde {
namespace {
bool first_in_this_process(const std::string & problem)
{
  static std::mutex mutex;
  static std::set<std::string> known;
  const std::lock_guard lock(mutex);
  return known.insert(problem).second;
}
}  // namespace

ReportProblem log_plugin_problems(std::shared_ptr<rcl_cxx::Node> node)
{
  return [node = std::move(node)](const std::string & problem) {
    if (node->get_context()->ok() && first_in_this_process(problem)) {
      RCL_CXX_ERROR(node->get_logger(), "{}", problem);
    }
  };
}

}  // namespace ur_ros_rtde
