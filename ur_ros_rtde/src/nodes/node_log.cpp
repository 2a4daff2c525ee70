#include "nodes/node_log.hpp"

namespace ur_ros_rtde {

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

}  // namespace ur_ros_rtde
