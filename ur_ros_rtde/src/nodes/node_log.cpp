#include "nodes/node_log.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ur_ros_rtde {
namespace {
constexpr std::size_t most_listed_commands = 12;
}  // namespace

LogFunction log_connection(const rcl_cxx::Node & node)
{
  return [log = log_to(node.get_logger()), context = node.get_context()](LogLevel level,
                                                                         const std::string & text) {
    const bool problem = level == LogLevel::warn || level == LogLevel::error;
    log(problem && !context->ok() ? LogLevel::debug : level, text);
  };
}

LogFunction log_to(const rcl_cxx::Logger & logger)
{
  return [logger](LogLevel level, const std::string & text) {
    switch (level) {
      case LogLevel::debug:
        RCL_CXX_DEBUG(logger, "{}", text);
        break;
      case LogLevel::info:
        RCL_CXX_INFO(logger, "{}", text);
        break;
      case LogLevel::warn:
        RCL_CXX_WARN(logger, "{}", text);
        break;
      case LogLevel::error:
        RCL_CXX_ERROR(logger, "{}", text);
        break;
    }
  };
}

void log_commands(const rcl_cxx::Logger & logger, std::string_view what,
                  const std::vector<std::string> & names)
{
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  if (names.size() <= most_listed_commands) {
    RCL_CXX_INFO(logger, "{}: {}", what, all);
    return;
  }
  RCL_CXX_DEBUG(logger, "all {}: {}", what, all);
  RCL_CXX_INFO(logger, "{}: {}, listed by `ur plugins`", what, names.size());
}

}  // namespace ur_ros_rtde
